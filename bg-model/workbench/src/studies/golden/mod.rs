//! Golden outputs: runs that are recorded once and have to be reproduced from then on.
//!
//! In: a folder. A golden output NAME in it is two files: NAME.csv has the trajectory, all outputs; NAME.toml says how
//! it is run, its exact counts, and how far values of each unit may be off. Out: whether it is reproduced, or what
//! differs.
//!
//! | module | question |
//! |---|---|
//! | `file` | what the two files say |
//! | `counts` | what a run takes |
//! | `record` | how a golden output is written |
//! | `run` | how it is run again |
//! | `difference` | what differs |
//! | `renewal` | how it is recorded anew |
//! | `check` | all of it, for a folder |

mod check;
mod counts;
mod difference;
mod file;
mod record;
mod renewal;
mod run;

use std::fmt;
use std::io;
use std::path::PathBuf;

use bg_model::simulation::Recording;
use thiserror::Error;

pub use check::{Agreement, Deviating, check, check_of};
pub(crate) use check::{check_one, prepare};
pub use counts::Counts;
pub use difference::Difference;
pub use file::{Files, Golden, Record, Tolerance, Tolerances};
pub(crate) use record::{Destination, Recorded};
pub use run::RunFault;

use crate::ask::inputs::InputSettingError;
use crate::ask::parameters::SettingError;
use crate::ask::request::RequestError;
use crate::files::FileError;
use crate::run::samples::Unreadable;

/// The folder of golden outputs, unless another is given.
pub const FOLDER: &str = "golden";

/// The compiler, the run time and the workbench have one version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// How many instants and columns a run has, in words.
fn size(run: &Recording) -> String {
    let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    format!("{}, {}", counted(run.times.len(), "instant"), counted(run.columns.len(), "column"))
}

/// Golden outputs that are not what comes out, or no golden outputs.
#[derive(Error)]
pub enum GoldenError {
    /// What comes out is not what was recorded.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Deviates(Vec<Box<Deviating>>),
    /// A folder without any.
    #[error("no golden output is in {}: record one: {first}", folder.display())]
    Nothing {
        /// The folder.
        folder: PathBuf,
        /// The command.
        first: String,
    },
    /// A name that is not recorded.
    #[error("no golden output in {} is called `{name}`; there are: {}", folder.display(), known.join(", "))]
    Unknown {
        /// The name that was asked for.
        name: String,
        /// The folder.
        folder: PathBuf,
        /// Those that there are.
        known: Vec<String>,
    },
    /// A name that no file can have.
    #[error("--name {0}: must be a plain file name, without a dot in front")]
    Name(String),
    /// A file or folder that cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Settings that are no TOML, or lack something.
    #[error("cannot read {}: line {line}, column {column}: {message}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the parser says.
        message: String,
    },
    /// A trajectory that cannot be read.
    #[error(transparent)]
    Csv(#[from] Unreadable),
    /// Settings of another mechanism.
    #[error("{} is of `{found}`, not of `{expected}`: remove it, or choose another folder with --out", path.display())]
    OtherModel {
        /// The file.
        path: PathBuf,
        /// The mechanism that it is of.
        found: String,
        /// The mechanism of the program.
        expected: String,
    },
    /// A tolerance that cannot be.
    #[error("{}: the tolerances of `{unit}` must be finite numbers, at least 0", path.display())]
    Tolerance {
        /// The file.
        path: PathBuf,
        /// The unit.
        unit: String,
    },
    /// A scene that is not there.
    #[error("{}: there is no scene `{scene}`; the command `scene` lists the scenes", path.display())]
    Scene {
        /// The file.
        path: PathBuf,
        /// The scene that it names.
        scene: String,
    },
    /// A parameter that cannot be.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// An input that cannot be.
    #[error(transparent)]
    Input(#[from] InputSettingError),
    /// The file of an input is not the one of the recorded run.
    #[error(
        "{}: the file of the input `{input}` is not the one that the run was recorded with; restore it, or record the \
         run again",
        path.display()
    )]
    InputFile {
        /// The record.
        path: PathBuf,
        /// The input.
        input: String,
    },
    /// An integration that cannot be.
    #[error("{}: {fault}", path.display())]
    Request {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fault: RequestError,
    },
    /// A place that cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// A test that gives back an error prints it by `Debug`: what a user sees there has to be what `Display` says.
impl fmt::Debug for GoldenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
