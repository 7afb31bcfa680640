//! The command `identify`: parameters from measured columns, with what is known of them.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_model::description::ParameterInfo;
use bg_model::integrator::Integrator;
use bg_model::run::Request;
use clap::Args;

use super::arguments::{IntegrationArguments, ModelArguments};
use super::methods::integrator;
use super::progress::bar;
use super::run::{chosen, machine, request};
use super::sensitivity::{adjustable, observed, unknown};
use super::{InputError, ended};
use crate::ask::inputs;
use crate::ask::parameters::{Chosen, bounds};
use crate::ask::scenes::Scene;
use crate::files::{FileError, RunFolder, console};
use crate::program::Program;
use crate::show::figures::FigureError;
use crate::show::figures::fit::fit;
use crate::show::output::OutputError;
use crate::studies::identify::data::{pair, read_file};
use crate::studies::identify::{Data, Identified, Variable, report};

const REPORT: &str = "identify.txt";
const FOUND: &str = "identified.toml";

/// What is fitted to what.
#[derive(Debug, Args)]
pub struct IdentifyArguments {
    /// What was measured: a CSV file whose first column is `t`, in s, and whose other columns have the names of
    /// outputs. Fields may be empty
    #[arg(value_name = "FILE.csv")]
    pub data: PathBuf,

    /// The parameters to fit; several with commas. They start at their defaults, or at what --params and --set say; the
    /// others stay there
    #[arg(long, value_name = "NAME", value_delimiter = ',', required = true)]
    pub fit: Vec<String>,

    /// Bounds of a parameter inside its range, such as k=1e3..1e5; can be given again and again. One that cannot come
    /// below zero is fitted by its logarithm
    #[arg(long, value_name = "NAME=LOWER..UPPER", allow_hyphen_values = true)]
    pub bounds: Vec<String>,

    /// Which output a column measures that has another name; can be given again and again
    #[arg(long, value_name = "NAME=OUTPUT")]
    pub column: Vec<String>,

    /// Use the columns of these outputs only; several with commas [default: all]
    #[arg(long = "output", value_name = "NAME", value_delimiter = ',')]
    pub outputs: Vec<String>,

    #[command(flatten)]
    pub model: ModelArguments,

    /// The integrator
    #[arg(long, value_name = "NAME", default_value_t, value_parser = integrator())]
    pub method: Integrator,

    /// Relative tolerance of each step
    #[arg(long, value_name = "NUMBER", default_value = "1e-8")]
    pub rtol: f64,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,

    /// Folder for identify.txt, identified.toml (for --params) and a figure of each column
    #[arg(long, value_name = "DIR", default_value = "out/identify")]
    pub out: PathBuf,
}

pub fn identify(program: &Program, arguments: &IdentifyArguments) -> Result<ExitCode, InputError> {
    let (chosen, named_inputs) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let outputs = scene.description.outputs;
    let variables = variables(scene, &chosen, &arguments.fit, &arguments.bounds)?;
    let named = columns(scene, &arguments.column)?;
    let only: Vec<usize> = match arguments.outputs.as_slice() {
        [] => Vec::new(),
        names => observed(scene, names, "--output")?.into_iter().map(|(place, _)| place).collect(),
    };
    let data = read_file(&arguments.data, outputs, &named, &only)?;
    let folder = RunFolder::claim(&arguments.out, &files(&data, scene))?;
    let request = integration(arguments, &data)?;
    let machine = machine(program, scene, &chosen)?;
    let bar = bar(1, "run {pos}: {msg}");
    let found = machine.identified(&request, &data, &variables, &mut |values, error| {
        bar.inc(1);
        bar.set_message(format!("error {error:.3e} of the noise, {values:?}"));
    });
    bar.finish_and_clear();
    let found = machine.known("derivatives by parameters", found)??;
    let inputs = inputs::text(&named_inputs, [0.0, data.times.last().copied().unwrap_or_default()]);
    let told = format!("{}{inputs}", report::text(&found, &data, outputs));
    let (written, faults) = write(folder, &told, &found, &data, scene);
    let written =
        written.map_or_else(|| "nothing".to_owned(), |count| format!("{count} files in {}", arguments.out.display()));
    let json = || report::json(&found, &data, outputs);
    let printed = console::tell_as(arguments.json, &format!("{told}\nwritten: {written}\n"), json);
    let unfinished = if !found.has_converged {
        Some("the fit did not converge; start nearer with --set, or fit fewer".to_owned())
    } else if !found.leaves_noise() {
        Some("what the best fit leaves is no noise; fit what else may differ, or start elsewhere with --set".to_owned())
    } else {
        None
    };
    let faults = faults.iter().map(ToString::to_string).chain(printed.err().map(|fault| fault.to_string()));
    Ok(ended(faults.chain(unfinished)))
}

/// The parameters of these names, with their bounds.
pub(super) fn variables(
    scene: &Scene,
    chosen: &Chosen,
    names: &[String],
    bounds: &[String],
) -> Result<Vec<Variable>, InputError> {
    let mut variables: Vec<Variable> = adjustable(scene, chosen, names, "--fit")?.into_iter().map(variable).collect();
    bounds.iter().try_for_each(|text| bound(&mut variables, text, &scene.name))?;
    Ok(variables)
}

/// The columns that have other names than the outputs that they measure.
pub(super) fn columns(scene: &Scene, pairs: &[String]) -> Result<Vec<(String, usize)>, InputError> {
    let named = pairs.iter().map(|text| pair(text, scene.description.outputs)).collect::<Result<Vec<_>, _>>();
    named.map_err(|fault| InputError::Unknown { option: "--column", fault })
}

fn variable((info, start): (&'static ParameterInfo, f64)) -> Variable {
    Variable { info, start, lower: info.range.lower, upper: info.range.upper }
}

/// Sets the bounds that `NAME=LOWER..UPPER` gives.
fn bound(variables: &mut [Variable], text: &str, scene: &str) -> Result<(), InputError> {
    let wrong = |fault: String| InputError::Unknown { option: "--bounds", fault: format!("{text}: {fault}") };
    let form = || wrong("give it as NAME=LOWER..UPPER, for example k=1e3..1e5".to_owned());
    let (name, range) = text.split_once('=').ok_or_else(form)?;
    let names: Vec<&'static str> = variables.iter().map(|of| of.info.name).collect();
    let found = variables.iter_mut().find(|of| of.info.name == name.trim());
    let Some(variable) = found else {
        return Err(unknown("--bounds", "parameter", name.trim(), scene, names.into_iter()));
    };
    let [lower, upper] = bounds(variable.info, range).map_err(wrong)?;
    if !(lower..=upper).contains(&variable.start) {
        return Err(wrong(format!("`{}` starts at {}; start inside with --set", variable.info.name, variable.start)));
    }
    (variable.lower, variable.upper) = (lower, upper);
    Ok(())
}

/// How runs are integrated.
fn integration(arguments: &IdentifyArguments, data: &Data) -> Result<Request, InputError> {
    let t_end = data.times.last().copied().unwrap_or_default();
    let (method, rtol, fixed_step) = (arguments.method, arguments.rtol, Request::default().fixed_step);
    request(&IntegrationArguments { t_end, method, hint: None, fixed_step, rtol, atol: None, step: t_end }, 0.0, None)
}

/// The figure of a column.
fn figure(output: &str) -> String {
    format!("fit_{output}.svg")
}

fn files(data: &Data, scene: &Scene) -> Vec<String> {
    let figures = data.columns.iter().map(|column| figure(scene.description.outputs[column.output].name));
    [REPORT, FOUND].into_iter().map(str::to_owned).chain(figures).collect()
}

/// Writes the files; gives their number, where they are there, and what failed.
fn write(
    mut folder: RunFolder,
    told: &str,
    found: &Identified,
    data: &Data,
    scene: &Scene,
) -> (Option<usize>, Vec<OutputError>) {
    let mut faults = Vec::new();
    let mut fill = || -> Result<(), FileError> {
        folder.write_text(REPORT, told)?;
        folder.write_text(FOUND, &report::toml(found))?;
        for (column, measured) in found.columns.iter().zip(&data.columns) {
            let output = &scene.description.outputs[column.output];
            let file = figure(output.name);
            match fit(output.name, output.unit, &data.times, &measured.values, &column.model) {
                Ok(svg) => folder.write_text(&file, &svg)?,
                Err(FigureError::Empty) => {}
                Err(source) => faults.push(OutputError::Figure { file, source }),
            }
        }
        Ok(())
    };
    match fill().and_then(|()| folder.publish()) {
        Ok(files) => (Some(files.len()), faults),
        Err(fault) => {
            faults.push(fault.into());
            (None, faults)
        }
    }
}
