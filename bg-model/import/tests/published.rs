//! Published robots as programs: imported, compiled and run as `docs/import.md` says, they swing as in MuJoCo.
//!
//! The variable `ROBOTS_PYTHON` names a Python with mujoco, gymnasium and example-robot-data, whose files these are;
//! without it nothing is done, since each robot takes minutes to compile. The program is made of this repository's
//! crates and versions.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The end of the swing, s.
const STOP: &str = "0.15";
/// The largest difference of an angle or travel, rad or m.
const ALLOWED: f64 = 1e-8;

/// A Python that has the robots.
struct Python(String);

impl Python {
    fn found() -> Option<Self> {
        let found = std::env::var("ROBOTS_PYTHON").ok();
        if found.is_none() {
            println!("skipped: ROBOTS_PYTHON names no Python with mujoco, gymnasium and example-robot-data");
        }
        found.map(Self)
    }

    fn tells(&self, arguments: &[&str]) -> String {
        let script = repository().join("bg-model/import/tests/cases/published.py");
        text(&Command::new(&self.0).arg(script).args(arguments).output().expect("ROBOTS_PYTHON is a program"))
    }
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository")
}

/// What a command that has succeeded prints.
fn text(output: &Output) -> String {
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{told}{}", String::from_utf8_lossy(&output.stderr));
    told
}

/// A crate whose program is the robot of `file`, beside those of the other robots.
fn program(name: &str, file: &Path) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(folder.join("src")).expect("a folder");
    let write = |place: &str, text: &str| std::fs::write(folder.join(place), text).expect("a file can be written");
    let robot = folder.join("src/robot.rs");
    let format = if file.extension().is_some_and(|ending| ending == "urdf") { "urdf" } else { "mjcf" };
    let import = Command::new(env!("CARGO_BIN_EXE_bg-import")).arg(format).arg(file).arg("-o").arg(&robot).output();
    text(&import.expect("bg-import runs"));
    let imported = std::fs::read_to_string(&robot).expect("bg-import has written it");
    let after = imported.split("pub graph ").nth(1).expect("a graph");
    let graph = after.split_whitespace().next().expect("its name");
    let crates = repository().join("bg-model");
    let (model, workbench) = (crates.clone(), crates.join("workbench"));
    write(
        "Cargo.toml",
        &format!(
            "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
             bg-model = {{ path = {model:?} }}\nbg-workbench = {{ path = {workbench:?} }}\n\n[profile.dev]\ndebug = \
             false\n"
        ),
    );
    let lock = repository().join("Cargo.lock");
    std::fs::copy(lock, folder.join("Cargo.lock")).expect("the repository's versions");
    write(
        "src/main.rs",
        &format!(
            "mod robot;\n\nfn main() -> std::process::ExitCode {{\n    bg_workbench::main::<robot::{graph}>()\n}}\n"
        ),
    );
    folder
}

/// Runs the program of `folder` as a user does, and gives the head and the last row of its trajectory.
fn run(folder: &Path, starts: &[(String, String, f64)]) -> (Vec<String>, Vec<f64>) {
    let trajectory = folder.join("swing.csv");
    let mut cargo = Command::new(env!("CARGO"));
    // One target folder, so that what they depend on is compiled once.
    cargo.current_dir(folder).env("CARGO_TARGET_DIR", folder.with_file_name("robots"));
    cargo.args(["run", "--quiet", "--", "run", "--rtol", "1e-11", "--atol", "1e-12", "--t-end", STOP, "--no-figures"]);
    cargo.arg("--csv").arg(&trajectory);
    for (joint, start, _) in starts {
        cargo.arg("--set").arg(format!("{joint}_start={start}"));
    }
    text(&cargo.output().expect("cargo runs"));
    let rows = std::fs::read_to_string(&trajectory).expect("the program has written it");
    let mut lines = rows.lines();
    let head = lines.next().expect("a head").split(',').map(str::to_owned).collect();
    let numbers = |line: &str| line.split(',').map(|word| word.parse().expect("a number")).collect();
    (head, lines.next_back().map(numbers).expect("a row"))
}

fn swings(name: &str) {
    let Some(python) = Python::found() else { return };
    let file = python.tells(&["where", name]);
    if file.trim().is_empty() {
        println!("skipped: the package with {name} is not installed");
        return;
    }
    let swing = python.tells(&["swing", name, STOP]);
    let joint = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        (words[0].to_owned(), words[1].to_owned(), words[2].parse::<f64>().expect("a number"))
    };
    let joints: Vec<_> = swing.lines().map(joint).collect();
    let (head, row) = run(&program(name, Path::new(file.trim())), &joints);
    let mut largest = 0.0_f64;
    for (joint, start, wanted) in &joints {
        let column = head.iter().position(|name| name == joint).unwrap_or_else(|| panic!("{joint} is not in {head:?}"));
        let moved = (wanted - start.parse::<f64>().expect("a number")).abs();
        assert!(moved > 1e-5, "{joint} has moved by {moved} only");
        largest = largest.max((row[column] - wanted).abs());
    }
    println!("{name}: {} joints, {largest:e} off after {STOP} s", joints.len());
    assert!(largest < ALLOWED, "{largest}");
}

#[test]
fn an_inverted_double_pendulum_of_gymnasium() {
    swings("inverted_double_pendulum");
}

#[test]
fn an_arm_of_universal_robots() {
    swings("ur5");
}

#[test]
fn an_open_arm_for_teaching() {
    swings("so101");
}
