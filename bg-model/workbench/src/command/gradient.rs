//! The command `sensitivity` of one number: how it depends on all parameters, as table and CSV, by the run followed
//! backwards.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_model::description::OutputInfo;
use bg_model::sensitivity::{Measured, Objective};
use clap::Args;

use super::run::{chosen, machine, request};
use super::sensitivity::{SensitivityArguments, adjustable, at, observed};
use super::{InputError, ended};
use crate::ask::inputs;
use crate::ask::scenes::Scene;
use crate::files::{FileError, RunFolder, console, json};
use crate::program::Program;
use crate::show::output::OutputError;
use crate::studies::gradient::{Slope, csv, text};
use crate::studies::identify::Data;
use crate::studies::identify::data::{pair, read_file};

const TABLE: &str = "gradient.txt";
const CSV: &str = "gradient.csv";

/// One number that is differentiated.
#[derive(Debug, Args)]
#[group(id = "one", multiple = true, conflicts_with_all = ["outputs", "most"])]
pub struct OneNumber {
    /// One number by all parameters at once, by the run followed backwards: this output at the end, or at one --at
    #[arg(long = "of", value_name = "OUTPUT")]
    pub output: Option<String>,

    /// Of --of its integral over the run
    #[arg(long, requires = "output", conflicts_with = "at")]
    pub integral: bool,

    /// One number likewise: the squares of what these columns leave, in parts of each one's root mean square. A CSV
    /// file as `identify` takes it; the run ends at its last time
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["output", "at", "integral"])]
    pub data: Option<PathBuf>,

    /// Which output a column measures that has another name; can be given again and again
    #[arg(long, value_name = "NAME=OUTPUT", requires = "data")]
    pub column: Vec<String>,
}

impl OneNumber {
    /// Whether one is asked for.
    pub const fn is_asked(&self) -> bool {
        self.output.is_some() || self.data.is_some()
    }
}

/// What is differentiated, in words, with its unit.
struct Question<'a> {
    words: String,
    unit: String,
    objective: Objective<'a>,
}

pub fn gradient(program: &Program, arguments: &SensitivityArguments) -> Result<ExitCode, InputError> {
    let (chosen, named) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let parameters = adjustable(scene, &chosen, &arguments.by, "--by")?;
    let mut request = request(&arguments.integration, 0.0, None)?;
    let columns = match &arguments.one.data {
        Some(path) => {
            let outputs = scene.description.outputs;
            let named = arguments.one.column.iter().map(|text| pair(text, outputs)).collect::<Result<Vec<_>, _>>();
            let named = named.map_err(|fault| InputError::Unknown { option: "--column", fault })?;
            let data = read_file(path, outputs, &named, &[])?;
            request.t_end = data.times.last().copied().unwrap_or_default();
            measured(&data)
        }
        None => Vec::new(),
    };
    let question = question(scene, arguments, &columns, request.t_end)?;
    let folder = RunFolder::claim(&arguments.out, &[TABLE, CSV].map(str::to_owned))?;
    let machine = machine(program, scene, &chosen)?;
    let by: Vec<&str> = parameters.iter().map(|(info, _)| info.name).collect();
    let found = machine.known("gradients", machine.gradient(&request, &question.objective, &by))??;
    let slopes: Vec<Slope> = (parameters.iter().zip(&found.by))
        .map(|(&(parameter, at), &derivative)| Slope { parameter, at, derivative })
        .collect();
    let Question { words, unit, .. } = question;
    let (events, t_end) = (found.trajectory.statistics.events, request.t_end);
    let told = format!(
        "{words}: {:.6e}{}{unit}; derivatives by {} parameters over {t_end} s, {events} events\n\n{}{}",
        found.value,
        if unit.is_empty() { "" } else { " " },
        slopes.len(),
        text(found.value, &unit, &slopes),
        inputs::text(&named, [0.0, t_end])
    );
    let written = write(folder, &told, &csv(found.value, &unit, &slopes));
    let place = written
        .as_ref()
        .map_or_else(|_| "nothing".to_owned(), |count| format!("{count} files in {}", arguments.out.display()));
    let told = format!("{told}\nwritten: {place}\n");
    let printed = console::tell_as(arguments.json, &told, || json::rows(&csv(found.value, &unit, &slopes)));
    Ok(ended(written.err().map(OutputError::from).into_iter().chain(printed.err().map(OutputError::from))))
}

fn question<'a>(
    scene: &Scene,
    arguments: &SensitivityArguments,
    columns: &'a [Measured],
    t_end: f64,
) -> Result<Question<'a>, InputError> {
    let Some(name) = &arguments.one.output else {
        let words = format!("squares of what {} columns leave", columns.len());
        return Ok(Question { words, unit: String::new(), objective: Objective::squares(columns) });
    };
    let (output, info) = only(scene, name)?;
    let (name, unit) = (info.name, info.unit.to_owned());
    let at = at(&arguments.at, t_end)?;
    Ok(match at[..] {
        [_, _, ..] => {
            let fault = format!("one number has one time, and here are {}; leave --of out for several", at.len());
            return Err(InputError::Unknown { option: "--at", fault });
        }
        [t] => Question { words: format!("`{name}` at {t} s"), unit, objective: Objective::at(output, t) },
        [] if arguments.one.integral => {
            let unit = if unit.is_empty() { "s".to_owned() } else { format!("{unit}*s") };
            Question { words: format!("integral of `{name}` over time"), unit, objective: Objective::integral(output) }
        }
        [] => Question { words: format!("`{name}` at the end"), unit, objective: Objective::last(output) },
    })
}

/// The output of this name, which has no components.
pub(super) fn only(scene: &Scene, name: &str) -> Result<(usize, &'static OutputInfo), InputError> {
    let found = observed(scene, &[name.to_owned()], "--of")?;
    let [output] = found[..] else {
        let names: Vec<&str> = found.iter().map(|(_, output)| output.name).collect();
        let fault = format!("`{name}` is several numbers; give one of {}", names.join(", "));
        return Err(InputError::Unknown { option: "--of", fault });
    };
    Ok(output)
}

/// The columns, each in parts of its root mean square.
fn measured(data: &Data) -> Vec<Measured> {
    let of = |column: &crate::studies::identify::Measured| {
        let values: Vec<(f64, f64)> =
            data.times.iter().zip(&column.values).filter_map(|(&t, value)| Some((t, (*value)?))).collect();
        let square = values.iter().fold(0.0, |sum, (_, value)| sum + value * value) / values.len().max(1) as f64;
        let noise = if square > 0.0 { square.sqrt() } else { 1.0 };
        Measured { output: column.output, values, noise }
    };
    data.columns.iter().map(of).collect()
}

/// Writes the files; gives their number.
fn write(mut folder: RunFolder, told: &str, csv: &str) -> Result<usize, FileError> {
    folder.write_text(TABLE, told)?;
    folder.write_text(CSV, csv)?;
    Ok(folder.publish()?.len())
}
