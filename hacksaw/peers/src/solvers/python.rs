//! Solvers that come with Python packages: a process of `python/peers.py`, which does one run for each line it gets.
//!
//! In: the problem and a Python with the packages of `python/requirements.txt`, or a folder to make a virtual
//! environment in. Out: the solvers, the versions, and what could not be had. The process rests while other solvers
//! run.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::rc::Rc;
use std::time::Duration;

use clap::ValueEnum;
use serde::Deserialize;
use serde_json::json;

use super::{Line, Run, Setting, Solver, Source, Work};
use crate::machine::IS_FOR_THIS_PROCESSOR;
use crate::poses::Poses;
use crate::problem::{ABSOLUTE, Problem, instants};

/// The sources of this file.
pub const SOURCES: [Source; 3] = [Source::Heyoka, Source::Cvode, Source::Casadi];

/// What Python offers.
pub struct Python {
    /// The solvers.
    pub solvers: Vec<Box<dyn Solver>>,
    /// Versions by package, and Python's.
    pub versions: BTreeMap<String, String>,
    /// What is missing and why.
    pub faults: Vec<String>,
}

#[derive(Deserialize)]
struct Offer {
    solvers: Vec<Listed>,
    versions: BTreeMap<String, String>,
    faults: Vec<Missing>,
}

#[derive(Deserialize)]
struct Listed {
    name: String,
    source: String,
    locates_events: bool,
    settings: Vec<f64>,
}

#[derive(Deserialize)]
struct Missing {
    source: String,
    fault: String,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Run { seconds: f64, poses: Poses, work: Work, compile_seconds: Option<f64> },
    Fault { fault: String },
}

/// A Python interpreter with the packages: a virtual environment in `folder`, made where there is none.
///
/// # Errors
/// No Python, no network, or a package that cannot be installed: what the failing command says.
pub fn environment(folder: &Path) -> Result<PathBuf, String> {
    let requirements = scripts().join("requirements.txt");
    let wanted = std::fs::read_to_string(&requirements).map_err(|fault| fault.to_string())?;
    let (python, done) = (folder.join("bin/python"), folder.join("installed.txt"));
    if std::fs::read_to_string(&done).is_ok_and(|installed| installed == wanted) {
        return Ok(python);
    }
    command(Command::new("python3").args(["-m", "venv"]).arg(folder))?;
    let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
    command(Command::new(&python).args(pip).arg(&requirements))?;
    std::fs::write(done, wanted).map_err(|fault| fault.to_string())?;
    Ok(python)
}

/// Starts the process.
///
/// # Errors
/// It does not start or does not answer.
pub fn start(python: &Path, problem: &Problem, sources: &[Source]) -> Result<Python, String> {
    let (process, offer) = spawned(python, problem, sources)?;
    let process = Rc::new(RefCell::new(process));
    let solvers = offer.solvers.into_iter().enumerate().map(|(index, listed)| -> Box<dyn Solver> {
        let source = *sources.iter().find(|&&source| name(source) == listed.source).expect("one of those asked for");
        let line =
            Line { name: listed.name, source, locates_events: listed.locates_events, setting: Setting::Tolerance };
        Box::new(Remote { line, settings: listed.settings, index, process: process.clone() })
    });
    let faults = offer.faults.into_iter().map(|missing| format!("{}: {}", missing.source, missing.fault));
    Ok(Python { solvers: solvers.collect(), versions: offer.versions, faults: faults.collect() })
}

/// heyoka's runs side by side.
pub struct Batches {
    process: Process,
    /// Versions by package, and Python's.
    pub versions: BTreeMap<String, String>,
}

impl Batches {
    /// Starts the process.
    ///
    /// # Errors
    /// It does not start, or there is no heyoka.
    pub fn new(python: &Path, problem: &Problem) -> Result<Self, String> {
        let (process, offer) = spawned(python, problem, &[Source::Heyoka])?;
        match offer.faults.into_iter().next() {
            Some(missing) => Err(missing.fault),
            None => Ok(Self { process, versions: offer.versions }),
        }
    }

    /// The runs with the parameters `values` at a tolerance: time, s, of all, and each one's poses at its end.
    ///
    /// # Errors
    /// What heyoka says.
    pub fn run(&mut self, tolerance: f64, values: &[[f64; 4]]) -> Result<(f64, Poses), String> {
        match self.process.ask(&json!({ "batch": tolerance, "values": values }))? {
            Answer::Run { seconds, poses, .. } => Ok((seconds, poses)),
            Answer::Fault { fault } => Err(fault),
        }
    }
}

fn spawned(python: &Path, problem: &Problem, sources: &[Source]) -> Result<(Process, Offer), String> {
    let script = scripts().join("peers.py");
    // CasADi leaves what it compiles in the working folder.
    let absolute = std::path::absolute(python).map_err(|fault| format!("{}: {fault}", python.display()))?;
    let mut started = Command::new(absolute);
    started.arg(script).current_dir(std::env::temp_dir()).stdin(Stdio::piped()).stdout(Stdio::piped());
    let child = started.spawn();
    let mut child = child.map_err(|fault| format!("{}: {fault}", python.display()))?;
    let (stdin, stdout) = (child.stdin.take(), child.stdout.take());
    let (stdin, stdout) = (stdin.expect("is piped"), BufReader::new(stdout.expect("is piped")));
    let mut process = Process { child, stdin, stdout };
    let names: Vec<String> = sources.iter().map(|&source| name(source)).collect();
    let offer = process.ask(&json!({
        "constants": problem.constants(), "start": problem.start, "cutting": problem.cuts_after(&problem.start),
        "samples": instants(), "absolute": ABSOLUTE, "sources": names, "c_flags": c_flags(),
    }))?;
    Ok((process, offer))
}

/// The flags of the C compiler: those that match the build of the Rust crates.
fn c_flags() -> Vec<&'static str> {
    if IS_FOR_THIS_PROCESSOR { vec!["-O3", "-march=native"] } else { vec!["-O3"] }
}

fn name(source: Source) -> String {
    source.to_possible_value().expect("no source is skipped").get_name().to_owned()
}

fn scripts() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("python")
}

fn command(command: &mut Command) -> Result<(), String> {
    let text = format!("{:?}", command.get_program());
    let output = command.output().map_err(|fault| format!("{text}: {fault}"))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(format!("{text}: {}", said.lines().last().unwrap_or("failed without a word")))
}

struct Process {
    child: Child,
    stdin: ChildStdin,
    stdout: BufReader<ChildStdout>,
}

impl Process {
    fn ask<T: for<'a> Deserialize<'a>>(&mut self, question: &serde_json::Value) -> Result<T, String> {
        let mut answer = String::new();
        writeln!(self.stdin, "{question}").map_err(|fault| fault.to_string())?;
        self.stdout.read_line(&mut answer).map_err(|fault| fault.to_string())?;
        if answer.is_empty() {
            return Err("the Python process has ended".to_owned());
        }
        serde_json::from_str(&answer).map_err(|fault| format!("{fault}: {}", &answer[..answer.len().min(80)]))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Remote {
    line: Line,
    settings: Vec<f64>,
    index: usize,
    process: Rc<RefCell<Process>>,
}

impl Solver for Remote {
    fn line(&self) -> &Line {
        &self.line
    }

    fn settings(&self) -> &[f64] {
        &self.settings
    }

    fn run(&mut self, setting: f64) -> Result<Run, String> {
        match self.process.borrow_mut().ask(&json!({ "solver": self.index, "setting": setting }))? {
            Answer::Run { seconds, poses, work, compile_seconds } => {
                let compiled = compile_seconds.map(Duration::from_secs_f64);
                Ok(Run { wall: Duration::from_secs_f64(seconds), poses, work, compiled })
            }
            Answer::Fault { fault } => Err(fault),
        }
    }
}
