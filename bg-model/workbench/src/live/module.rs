//! The running program, compiled for WebAssembly.
//!
//! In: what cargo says of the program that it runs, or a file. Out: a module that answers a page.

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;
use thiserror::Error;

/// What a program is compiled for.
const TARGET: &str = "wasm32-unknown-unknown";
/// The optimisations of the release profile: a run of the module is awaited by whoever moves a slider.
const PROFILE: [(&str, &str); 4] = [
    ("CARGO_PROFILE_RELEASE_OPT_LEVEL", "3"),
    ("CARGO_PROFILE_RELEASE_LTO", "fat"),
    ("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "1"),
    ("CARGO_PROFILE_RELEASE_STRIP", "true"),
];

/// This repository's own release builds do without optimisation where a module does not; settings that come after it
/// win.
const WORKBENCH: &str = "profile.release.package.bg-workbench.opt-level = 3";

/// Where the module is from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Module {
    /// Cargo builds it of the program that is running.
    Built,
    /// It is in this file.
    File(PathBuf),
}

/// A module that there is none of.
#[derive(Debug, Error)]
pub enum ModuleError {
    /// The model is that of a text, which is no program.
    #[error("a text has no program of its own; write it into the page that `bond serve` opens, which has sliders")]
    Text,
    /// The target is missing.
    #[error("the target {TARGET} is not installed; rustup target add {TARGET}")]
    Target,
    /// A program cannot be started.
    #[error("{program} cannot be started: {source}; install Rust, or give the compiled program as --live=FILE.wasm")]
    Missing {
        /// Its name.
        program: String,
        /// Why.
        source: io::Error,
    },
    /// The running program has no name that cargo could build.
    #[error("the program's own name is not known; give the compiled program as --live=FILE.wasm")]
    Nameless,
    /// The build fails.
    #[error(
        "`cargo build --target {TARGET}` of `{0}` failed; see above, or start the program by `cargo run` in its package"
    )]
    Build(String),
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file is no module of a program of this crate.
    #[error("{}: not a program of bg-workbench compiled for {TARGET}", .0.display())]
    Foreign(PathBuf),
}

impl From<Option<PathBuf>> for Module {
    fn from(file: Option<PathBuf>) -> Self {
        file.map_or(Self::Built, Self::File)
    }
}

impl Module {
    /// The module's bytes; one that is built has the model of this number.
    ///
    /// # Errors
    /// It cannot be built or read, or is none.
    pub fn wasm(&self, model: usize) -> Result<Vec<u8>, ModuleError> {
        self.wasm_with(model, &[])
    }

    /// The same; one that is built has more settings of cargo's, such as `profile.release.package.syn.opt-level = "s"`.
    ///
    /// # Errors
    /// As [`Module::wasm`].
    pub fn wasm_with(&self, model: usize, settings: &[String]) -> Result<Vec<u8>, ModuleError> {
        let path = match self {
            Self::Built => built(model, settings)?,
            Self::File(path) => path.clone(),
        };
        let wasm = std::fs::read(&path).map_err(|source| ModuleError::Unreadable { path: path.clone(), source })?;
        if answers(&wasm) { Ok(wasm) } else { Err(ModuleError::Foreign(path)) }
    }
}

/// Whether it is a WebAssembly module with the names that `bg-live` exports.
fn answers(wasm: &[u8]) -> bool {
    let names = |name: &[u8]| wasm.windows(name.len()).any(|bytes| bytes == name);
    wasm.starts_with(b"\0asm") && [&b"bg_live_reserve"[..], b"bg_live_answer", b"bg_live_length"].into_iter().all(names)
}

/// What cargo says of something that it built, as far as it is read here.
#[derive(Deserialize)]
struct Artifact {
    target: Named,
    filenames: Vec<PathBuf>,
}

#[derive(Deserialize)]
struct Named {
    name: String,
}

/// Builds the running program and gives the module's file.
fn built(model: usize, settings: &[String]) -> Result<PathBuf, ModuleError> {
    let program = std::env::current_exe().map_err(|_| ModuleError::Nameless)?;
    let name = program.file_stem().and_then(|name| name.to_str()).ok_or(ModuleError::Nameless)?;
    let is_example = program.parent().is_some_and(|folder| folder.ends_with("examples"));
    check_target()?;
    let cargo = tool("CARGO", "cargo");
    let mut build = Command::new(&cargo);
    build.args(["build", "--release", "--target", TARGET, "--message-format=json-render-diagnostics"]);
    for setting in [WORKBENCH].into_iter().chain(settings.iter().map(String::as_str)) {
        build.args(["--config", setting]);
    }
    build.args([if is_example { "--example" } else { "--bin" }, name]);
    build.envs(PROFILE).env("BG_LIVE_MODEL", model.to_string());
    if let Some(package) = std::env::var_os("CARGO_MANIFEST_DIR") {
        build.current_dir(package);
    }
    let output = build.stderr(Stdio::inherit()).output().map_err(|source| missing(&cargo, source))?;
    let failed = || ModuleError::Build(name.to_owned());
    if !output.status.success() {
        return Err(failed());
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    let artifacts = messages.lines().filter_map(|line| serde_json::from_str::<Artifact>(line).ok());
    let mut files = artifacts.filter(|artifact| artifact.target.name == name).flat_map(|artifact| artifact.filenames);
    files.find(|file| file.extension().is_some_and(|extension| extension == "wasm")).ok_or_else(failed)
}

/// Asks the compiler for its libraries of the target.
fn check_target() -> Result<(), ModuleError> {
    let rustc = tool("RUSTC", "rustc");
    let mut asked = Command::new(&rustc);
    asked.args(["--print", "target-libdir", "--target", TARGET]);
    let output = asked.stderr(Stdio::inherit()).output().map_err(|source| missing(&rustc, source))?;
    let folder = String::from_utf8_lossy(&output.stdout);
    if Path::new(folder.trim_end()).is_dir() { Ok(()) } else { Err(ModuleError::Target) }
}

/// The tool that the variable names, else the one that is found by its name.
fn tool(variable: &str, name: &str) -> String {
    std::env::var(variable).unwrap_or_else(|_| name.to_owned())
}

fn missing(program: &str, source: io::Error) -> ModuleError {
    ModuleError::Missing { program: program.to_owned(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_module_is_refused() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let refused = |bytes: &[u8]| {
            std::fs::write(file.path(), bytes).unwrap();
            Module::from(Some(file.path().to_owned())).wasm(0).map_err(|fault| fault.to_string())
        };
        for bytes in [&b"text"[..], b"\0asm\x01\0\0\0", b"bg_live_reserve bg_live_answer bg_live_length"] {
            assert!(refused(bytes).unwrap_err().contains("not a program of bg-workbench compiled for wasm32"));
        }
        assert!(refused(b"\0asm bg_live_reserve bg_live_answer bg_live_length").is_ok());
        let absent = Module::from(Some(PathBuf::from("absent.wasm"))).wasm(0).unwrap_err();
        assert!(absent.to_string().starts_with("cannot read absent.wasm: "));
    }
}
