//! The programs that a gallery is made by: the examples, which cargo builds, and Chromium.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use thiserror::Error;

/// A program that failed.
#[derive(Debug, Error)]
pub enum ProgramError {
    /// It cannot be started.
    #[error("{program} does not start: {fault}")]
    Start {
        /// The program.
        program: String,
        /// Why.
        fault: std::io::Error,
    },
    /// It ended with an error.
    #[error("{program} {arguments} failed: {told}")]
    Failed {
        /// The program.
        program: String,
        /// What it was called with.
        arguments: String,
        /// What it said.
        told: String,
    },
}

/// Builds all examples of the package in `folder`, and gives the folder of the programs.
pub fn build(folder: &Path) -> Result<PathBuf, ProgramError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "--release", "--examples", "--manifest-path"]).arg(folder.join("Cargo.toml"));
    // What cargo says is its progress.
    done(command.stderr(Stdio::inherit()))?;
    let here = std::env::current_exe().map_err(|fault| ProgramError::Start { program: "cargo".to_owned(), fault })?;
    let target = here.parent().and_then(Path::parent).expect("a program stands in target/PROFILE");
    Ok(target.join("release/examples"))
}

/// Where the examples are.
#[derive(Clone, Copy, Debug)]
pub struct Programs<'a> {
    /// The package that they belong to.
    pub package: &'a Path,
    /// The built programs.
    pub folder: &'a Path,
}

impl Programs<'_> {
    /// Calls an example in the folder `place`.
    pub fn call<A: AsRef<OsStr>>(&self, name: &str, place: &Path, arguments: &[A]) -> Result<(), ProgramError> {
        let program = self.folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        // As `cargo run` would set it: a live page builds the example anew.
        let mut command = Command::new(program);
        done(command.current_dir(place).env("CARGO_MANIFEST_DIR", self.package).args(arguments))
    }
}

/// The browser's name; `None` where there is none.
pub fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome", "chrome"];
    names.into_iter().find(|name| done(Command::new(name).arg("--version")).is_ok())
}

/// A picture of the machine of a report page at `t`, s.
pub fn picture(browser: &str, page: &Path, t: f64, file: &Path) -> Result<(), ProgramError> {
    let profile = tempfile::tempdir().map_err(|fault| ProgramError::Start { program: browser.to_owned(), fault })?;
    let mut command = Command::new(browser);
    command
        .args(["--headless=new", "--no-sandbox", "--no-first-run", "--disable-extensions", "--hide-scrollbars"])
        .args(["--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"])
        .args(["--window-size=640,400", "--default-background-color=00000000"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--screenshot={}", file.display()))
        .arg(format!("file://{}#still={t}", page.display()));
    done(&mut command)
}

/// Runs a command to its end.
fn done(command: &mut Command) -> Result<(), ProgramError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|fault| ProgramError::Start { program: program.clone(), fault })?;
    if output.status.success() {
        return Ok(());
    }
    let arguments = command.get_args().map(OsStr::to_string_lossy).collect::<Vec<_>>().join(" ");
    let told = String::from_utf8_lossy(&output.stderr).trim().to_owned();
    Err(ProgramError::Failed { program, arguments, told })
}
