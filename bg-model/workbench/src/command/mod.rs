//! The command line: what a user asks for, and what results.
//!
//! In: arguments. Out: a run with its files and the summary on stdout, or one line `error: ...` on stderr.
//! Exit codes: 0 done; 1 the run or an output failed, what could be written is; 2 the input cannot be used, nothing was
//! run.

mod arguments;
mod asked;
pub mod calls;
mod campbell;
pub mod colour;
mod compare;
pub mod config;
mod fmu;
mod golden;
mod gradient;
mod graph;
mod identify;
mod linearize;
pub mod manual;
mod methods;
mod optimize;
mod plot;
mod precision;
mod progress;
mod report;
mod run;
mod sensitivity;
mod sweep;

use std::ffi::OsString;
use std::fmt::Display;
use std::path::PathBuf;
use std::process::ExitCode;

use bg_model::parameters::ParameterError;
use bg_model::run::RunError;
use bg_model::sensitivity::SensitivityError;
use bg_model::simulation::MissingColumn;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::error::ErrorKind;
use clap::{Arg, CommandFactory, FromArgMatches};
use thiserror::Error;

use crate::ask::inputs::InputSettingError;
use crate::ask::machine::Absent;
use crate::ask::parameters::{self, SettingError};
use crate::ask::request::RequestError;
use crate::ask::scenes::{Fixed, Scene};
use crate::files::{FileError, console};
use crate::live::ModuleError;
use crate::program::Program;
use crate::run::recipe::AgainError;
use crate::run::running::BeginError;
use crate::run::samples::Unreadable;
use crate::show::output::OutputError;
use crate::show::{described, tables};
use crate::studies::golden::GoldenError;
use crate::studies::identify::IdentifyError;
use crate::studies::identify::data::Unusable;
use crate::studies::optimize::AskedError;
use crate::studies::precision::measure::MeasureError;
use crate::studies::sweep::SweepError;
use arguments::{Cli, Command, GoldenCommand};
use bg_analysis::linear::LinearError;
use config::Words;
use fmu::LibraryError;

/// Input that cannot be used.
#[derive(Debug, Error)]
enum InputError {
    #[error("interrupted")]
    Interrupted,
    #[error(transparent)]
    Again(#[from] AgainError),
    #[error(transparent)]
    Setting(#[from] SettingError),
    #[error("{name} {}: must be {range}", parameters::number(*value))]
    Range { name: &'static str, value: f64, range: String },
    #[error("--{} {}: {}", .0.field.replace('_', "-"), parameters::number(.0.value), .0.fault)]
    Request(#[from] RequestError),
    #[error("{place}: {fault}")]
    Fixed { place: String, fault: Fixed },
    #[error("{0}: neither a scene nor a run; the command `scene` lists the scenes")]
    NothingToCompare(String),
    #[error(transparent)]
    Input(#[from] InputSettingError),
    #[error(transparent)]
    Linear(#[from] LinearError),
    #[error("--at {t}: the run failed before: {failure}")]
    NotReached { t: f64, failure: String },
    #[error("--from {}: {fault}", path.display())]
    From { path: PathBuf, fault: String },
    #[error("--show {}: {fault}; give an SVG file", path.display())]
    Show { path: PathBuf, fault: String },
    #[error(transparent)]
    Model(#[from] ParameterError),
    #[error(transparent)]
    Absent(#[from] Absent),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Column(#[from] MissingColumn),
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Unreadable(#[from] Unreadable),
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error(transparent)]
    Golden(#[from] GoldenError),
    #[error("{option}: {fault}")]
    Unknown { option: &'static str, fault: String },
    #[error(transparent)]
    Sensitivity(#[from] SensitivityError),
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    #[error(transparent)]
    Optimize(#[from] AskedError),
    #[error(transparent)]
    Data(#[from] Unusable),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("--live: {0}")]
    Live(#[from] ModuleError),
    #[error(transparent)]
    Library(#[from] LibraryError),
}

impl From<BeginError> for InputError {
    fn from(fault: BeginError) -> Self {
        match fault {
            BeginError::Run(fault) => fault.into(),
            BeginError::Linear(fault) => fault.into(),
            BeginError::Absent(fault) => fault.into(),
        }
    }
}

impl From<crate::program::case::CaseError> for InputError {
    fn from(fault: crate::program::case::CaseError) -> Self {
        Self::Measure(fault.into())
    }
}

impl Program {
    /// Does what `arguments` ask for, the program's name first, and gives the exit code: 0 done, 1 the run or an output
    /// failed, 2 the input cannot be used.
    pub fn main(self, arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
        match config::words(arguments) {
            Ok(words) => self.obey(&words),
            Err(fault) => refuse(&fault),
        }
    }

    /// The same of words that are taken apart.
    pub fn obey(self, words: &Words) -> ExitCode {
        main(&self, words)
    }
}

/// Does what the words ask for and gives the exit code.
fn main(program: &Program, words: &Words) -> ExitCode {
    let mut cli = command(program).color(colour::set(words.all()));
    if let Some(path) = &words.path {
        // Of two values the one on the command line counts.
        cli = cli.args_override_self(true);
        if let Some(fault) = fault_of_file(cli.clone(), words) {
            return refuse(&format!("{} {}: {fault}", config::OPTION, path.display()));
        }
    }
    let cli = cli.try_get_matches_from(words.all()).and_then(|matches| Cli::from_arg_matches(&matches));
    console::set_quiet(cli.as_ref().is_ok_and(|cli| cli.quiet));
    let outcome = match cli {
        Err(fault) if fault.use_stderr() => return refuse(&console::in_one_line(&fault.render().to_string())),
        // Help and version.
        Err(help) => Ok(ended(console::printed(help.print()).err())),
        Ok(Cli { command: None, run, .. }) => run::simulate(program, &run, None),
        Ok(Cli { command: Some(command), .. }) => obey(program, command),
    };
    outcome.unwrap_or_else(|fault| refuse(&fault))
}

/// What is wrong with the options of a file, whatever stands on the command line.
fn fault_of_file(cli: clap::Command, words: &Words) -> Option<String> {
    let fault = cli.try_get_matches_from(words.command.iter().chain(&words.of_file)).err()?;
    // What a command needs beside its options, and what two options have against each other, is told of the whole.
    let is_of_one = matches!(
        fault.kind(),
        ErrorKind::UnknownArgument | ErrorKind::InvalidValue | ErrorKind::ValueValidation | ErrorKind::TooManyValues
    );
    is_of_one.then(|| console::in_one_line(&fault.render().to_string()))
}

fn obey(program: &Program, command: Command) -> Result<ExitCode, InputError> {
    match command {
        Command::Run(arguments) => run::simulate(program, &arguments, None),
        Command::Report(arguments) => report::report(program, &arguments),
        Command::Precision(arguments) => precision::measure_all(program, &arguments),
        Command::Golden(GoldenCommand::Record(arguments)) => golden::record(program, &arguments),
        Command::Golden(GoldenCommand::Check(arguments)) => golden::check(program, &arguments),
        Command::Compare(arguments) => compare::compare(program, &arguments),
        Command::Sweep(arguments) => sweep::obey(program, &arguments),
        Command::Linearize(arguments) => linearize::linearize(program, &arguments),
        Command::Identify(arguments) => identify::identify(program, &arguments),
        Command::Optimize(arguments) => optimize::optimize(program, &arguments),
        Command::Campbell(arguments) => campbell::campbell(program, &arguments),
        Command::Plot(arguments) => plot::plot(program, &arguments),
        Command::Sensitivity(arguments) => sensitivity::sensitivity(program, &arguments),
        Command::Scene { scene, json: true } => {
            let wanted = |known: &&Scene| scene.as_ref().is_none_or(|scene| known.name == *scene);
            let all = program.models.scenes.iter().filter(wanted).map(described::scene).collect::<serde_json::Value>();
            Ok(say(&format!("{all:#}\n")))
        }
        Command::Scene { scene: None, json: false } => Ok(say(&tables::scenes(&program.models.scenes))),
        Command::Scene { scene: Some(name), json: false } => {
            Ok(say(&tables::scene(program.scene_called(&name), program.models.defaults().table())))
        }
        Command::Graph(arguments) => graph::graph(program, &arguments),
        Command::Fmu(arguments) => fmu::pack(program, &arguments),
        Command::Parameters { json: true, .. } => {
            Ok(say(&format!("{:#}\n", parameters::json(program.models.defaults().table()))))
        }
        Command::Parameters { toml: true, .. } => Ok(say(&parameters::to_toml(&program.models.defaults()))),
        Command::Parameters { .. } => Ok(say(&parameters::table(program.models.defaults().table()))),
        Command::Completions { shell } => Ok(say(&manual::completions(self::command(program), shell))),
        Command::Man { out: None } => Ok(say(&manual::page(self::command(program)))),
        Command::Man { out: Some(folder) } => {
            let written = manual::pages(self::command(program), &folder)?;
            Ok(ended(console::tell(&format!("{written}\n")).err()))
        }
    }
}

/// The commands, as far as they do not depend on a program.
#[must_use]
pub fn commands() -> clap::Command {
    Cli::command()
}

/// The command line with the program's names, and its parameters in the help.
fn command(program: &Program) -> clap::Command {
    let help = format!(
        "Parameters (name, default, unit, meaning); defaults < --params < --set:\n{}\n\
         Files: a folder has the files of one run. They are written aside and take their place at the end, when those \
         of the\n\
         run before are removed; a run that is stopped leaves the earlier one's. Files that no run wrote are left \
         alone: a run\n\
         that would replace one is refused, as is a second run into the same folder at once. What a run wrote is \
         listed in\n\
         `.run` in the folder.\n\n\
         Exit code: 0 done, 1 the run or an output failed (what could be written is), 2 the input cannot be used.",
        parameters::table(program.models.defaults().table())
    );
    let texts = &program.texts;
    let command = Cli::command().name(texts.name.clone()).bin_name(texts.name.clone()).version(texts.version.clone());
    let command = every(command.about(texts.about.clone()).after_help(help.clone()), program, &texts.name);
    let command = command.mut_subcommand("report", |report| report.after_help(help.clone()));
    command.mut_subcommand("run", |run| run.after_help(help))
}

/// `command`, called by `words`, and all commands below it, each as [`named`] has it.
fn every(command: clap::Command, program: &Program, words: &str) -> clap::Command {
    let names: Vec<String> = command.get_subcommands().map(|command| command.get_name().to_owned()).collect();
    let command = match &program.texts.file {
        Some(file) if names.is_empty() => {
            let places: String = command.get_positionals().map(|place| format!(" {place}")).collect();
            command.override_usage(format!("{words} {file} [OPTIONS]{places}"))
        }
        _ => command,
    };
    let command = named(command, program);
    names.into_iter().fold(command, |command, name| {
        let words = format!("{words} {name}");
        command.mut_subcommand(name, |own| every(own, program, &words))
    })
}

/// `command` with the names of scenes and cases where it takes any.
fn named(command: clap::Command, program: &Program) -> clap::Command {
    let scene = |argument: Arg| {
        let is_optional = argument.get_long().is_none();
        let names =
            program.models.scenes.iter().map(|scene| PossibleValue::new(scene.name.clone()).help(scene.summary()));
        let argument = argument.value_parser(PossibleValuesParser::new(names));
        if is_optional { argument } else { argument.required(false).default_value(program.scene.clone()) }
    };
    let cases = |argument: Arg| {
        let names = program.cases.iter().map(|case| PossibleValue::new(case.name.clone()).help(case.about.clone()));
        let measured = if program.measured.is_empty() { vec![program.scene.clone()] } else { program.measured.clone() };
        argument.value_parser(PossibleValuesParser::new(names)).default_values(measured)
    };
    let takes = |command: &clap::Command, id: &str| command.get_arguments().any(|argument| argument.get_id() == id);
    let command = if takes(&command, "scene") { command.mut_arg("scene", scene) } else { command };
    if takes(&command, "cases") { command.mut_arg("cases", cases) } else { command }
}

/// Prints `text`, which is all there is to do.
fn say(text: &str) -> ExitCode {
    ended(console::print(text).err())
}

/// Input that cannot be used.
fn refuse(fault: &impl Display) -> ExitCode {
    console::complain(fault);
    ExitCode::from(2)
}

/// What is done is done; `faults` are what failed of it.
fn ended(faults: impl IntoIterator<Item = impl Display>) -> ExitCode {
    let failed = faults.into_iter().inspect(console::complain).count() > 0;
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
