//! What the figures were measured on: date, machine, versions.

use std::collections::BTreeMap;
use std::process::Command;

use serde::Serialize;

/// What identifies a measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The day, as in 2026-01-31.
    pub date: String,
    /// The processor's name.
    pub processor: String,
    /// How many cores this process may use.
    pub cores: usize,
    /// The operating system and its version.
    pub system: String,
    /// Versions of compilers, crates and packages.
    pub versions: BTreeMap<String, String>,
}

/// Whether this program was built for the processor at hand, by `RUSTFLAGS="-C target-cpu=native"`: a build for every
/// x86-64 has no AVX2.
pub const IS_FOR_THIS_PROCESSOR: bool = cfg!(target_feature = "avx2");

/// The crates whose versions matter.
const CRATES: [&str; 6] = ["bg-model", "differential-equations", "diffsol", "hacksaw", "nalgebra", "ode_solvers"];

impl Machine {
    /// This one, now, with `python`'s versions.
    pub fn here(python: BTreeMap<String, String>) -> Self {
        let mut versions = python;
        versions.insert("rustc".to_owned(), said("rustc", "--version"));
        versions.insert("cc".to_owned(), said("cc", "--version"));
        versions.extend(locked());
        let processor = field("/proc/cpuinfo", "model name").unwrap_or_else(|| std::env::consts::ARCH.to_owned());
        let release = field("/etc/os-release", "PRETTY_NAME").unwrap_or_else(|| std::env::consts::OS.to_owned());
        let kernel = std::fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
        Self {
            date: chrono::Utc::now().format("%Y-%m-%d").to_string(),
            processor,
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{release}, kernel {}", kernel.trim()),
            versions,
        }
    }

    /// All of it in one sentence.
    pub fn sentence(&self) -> String {
        let versions: Vec<String> = self.versions.iter().map(|(name, version)| format!("{name} {version}")).collect();
        format!(
            "Measured on {}: {}, {} cores, {}; {}. Rust and C are compiled {}.",
            self.date,
            self.processor,
            self.cores,
            self.system,
            versions.join(", "),
            if IS_FOR_THIS_PROCESSOR { "for this processor" } else { "for every processor of its kind" }
        )
    }
}

/// The versions in the lock file that this program was built with.
fn locked() -> BTreeMap<String, String> {
    let lock: toml::Table = include_str!("../Cargo.lock").parse().expect("cargo writes TOML");
    let packages = lock["package"].as_array().expect("a list of packages");
    let text = |package: &toml::Value, key: &str| package[key].as_str().unwrap_or_default().to_owned();
    let packages = packages.iter().map(|package| (text(package, "name"), text(package, "version")));
    let mut versions: BTreeMap<String, String> = BTreeMap::new();
    for (name, version) in packages.filter(|(name, _)| CRATES.contains(&name.as_str())) {
        versions.entry(name).and_modify(|all| *all = format!("{all} and {version}")).or_insert(version);
    }
    versions
}

/// The first line that a program says of itself, without its name.
fn said(program: &str, argument: &str) -> String {
    let output = Command::new(program).arg(argument).output();
    let output = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    let line = output.lines().next().unwrap_or("none").trim_start_matches(program).trim();
    line.to_owned()
}

/// The value of a line `name: value` or `name="value"` of a file.
fn field(path: &str, name: &str) -> Option<String> {
    let text = std::fs::read_to_string(path).ok()?;
    let line = text.lines().find(|line| line.starts_with(name))?;
    Some(line.split_once([':', '='])?.1.trim().trim_matches('"').to_owned())
}
