//! The command `sensitivity`: which parameter moves which output, as table, CSV and figure.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::ExitCode;

use bg_model::description::{OutputInfo, ParameterInfo};
use bg_model::run::{Request, Trajectory};
use bg_model::sensitivity::Sensitivities;
use bg_model::simulation::{Peaks, Samples};
use clap::Args;

use super::arguments::{IntegrationArguments, ModelArguments};
use super::gradient::{self, OneNumber};
use super::run::{chosen, machine, request};
use super::{InputError, ended};
use crate::ask::inputs;
use crate::ask::machine::Machine;
use crate::ask::parameters::{Chosen, nearest};
use crate::ask::scenes::Scene;
use crate::files::{FileError, RunFolder, console, json};
use crate::program::Program;
use crate::run::summary::{longest_step, short};
use crate::show::figures::FigureError;
use crate::show::output::OutputError;
use crate::studies::sensitivity::figure::influence;
use crate::studies::sensitivity::{
    Course, Influence, Measure, Question, courses, courses_csv, csv, influences, text, without_influence,
};

const TABLE: &str = "sensitivity.txt";
const CSV: &str = "sensitivity.csv";
const COURSES: &str = "sensitivity_over_time.csv";
const FIGURE: &str = "sensitivity.svg";

/// What is differentiated, and by what.
#[derive(Debug, Args)]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub model: ModelArguments,

    #[command(flatten)]
    pub integration: IntegrationArguments,

    /// The parameters; several with commas [default: all that the scene leaves adjustable]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub by: Vec<String>,

    /// The outputs; several with commas [default: all]
    #[arg(long = "output", value_name = "NAME", value_delimiter = ',')]
    pub outputs: Vec<String>,

    #[command(flatten)]
    pub one: OneNumber,

    /// Also the outputs at these times, s
    #[arg(long, value_name = "SECONDS", value_delimiter = ',', allow_negative_numbers = true)]
    pub at: Vec<f64>,

    /// How many parameters the printed table has for each measure of an output; the files have all
    #[arg(long, value_name = "COUNT", default_value_t = 5)]
    pub most: usize,

    /// Print what is found as JSON in place of the text
    #[arg(long)]
    pub json: bool,

    /// Folder for sensitivity.txt, sensitivity.csv, sensitivity_over_time.csv and sensitivity.svg; of one number for
    /// gradient.txt and gradient.csv
    #[arg(long, value_name = "DIR", default_value = "out/sensitivity")]
    pub out: PathBuf,
}

pub fn sensitivity(program: &Program, arguments: &SensitivityArguments) -> Result<ExitCode, InputError> {
    if arguments.one.is_asked() {
        return gradient::gradient(program, arguments);
    }
    let (chosen, named) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let parameters = adjustable(scene, &chosen, &arguments.by, "--by")?;
    let outputs = observed(scene, &arguments.outputs, "--output")?;
    let at = at(&arguments.at, arguments.integration.t_end)?;
    let request = with_times(request(&arguments.integration, 0.0, None)?, at);
    let names = [TABLE, CSV, COURSES, FIGURE].map(str::to_owned);
    let folder = RunFolder::claim(&arguments.out, &names)?;
    let machine = machine(program, scene, &chosen)?;
    let peaks = instants_of_peaks(&*machine, &request)?;
    let found = differentiated(&*machine, &with_times(request.clone(), &peaks), &parameters)?;
    let mut measures = Measure::ALL.to_vec();
    measures.extend(at.iter().map(|&t| Measure::At(t)));
    let rows = rows(&request);
    let question = Question { outputs: &outputs, parameters: &parameters, measures: &measures, rows };
    let all = influences(&found, &question);
    let inputs = inputs::text(&named, [0.0, found.trajectory.last.t]);
    let told = format!("{}{inputs}", told(&found, &all, &question, arguments.most));
    let table = format!("{}{inputs}", text(&all, question.parameters.len()));
    let (written, faults) = write(folder, &scene.name, &found, (&all, &table), &question);
    let written =
        written.map_or_else(|| "nothing".to_owned(), |count| format!("{count} files in {}", arguments.out.display()));
    let told = format!("{told}\nwritten: {written}\n");
    let printed = console::tell_as(arguments.json, &told, || json::rows(&csv(&all)));
    Ok(ended(faults.into_iter().chain(printed.err().map(OutputError::from))))
}

/// These times, all of them in a run that ends at `end` (s).
pub fn at(times: &[f64], end: f64) -> Result<&[f64], InputError> {
    match times.iter().find(|at| !(0.0..=end).contains(*at)) {
        Some(&value) => {
            Err(InputError::Range { name: "--at", value, range: format!("a time in the run, 0 to {end} s") })
        }
        None => Ok(times),
    }
}

/// The parameters of these names with their values, of a scene; without names all that it leaves adjustable.
pub fn adjustable(
    scene: &Scene,
    chosen: &Chosen,
    names: &[String],
    option: &'static str,
) -> Result<Vec<(&'static ParameterInfo, f64)>, InputError> {
    let own = scene.description.parameters;
    let value = |info: &'static ParameterInfo| (info, chosen.values.get(info.name).unwrap_or(info.default));
    if names.is_empty() {
        return Ok(own.iter().map(value).collect());
    }
    let find = |name: &String| {
        let found = own.iter().find(|info| info.name == name).map(value);
        found.ok_or_else(|| unknown(option, "parameter", name, &scene.name, own.iter().map(|info| info.name)))
    };
    names.iter().map(find).collect()
}

/// The outputs of these names with their places; a name without components stands for all of them. Without names all.
pub fn observed(
    scene: &Scene,
    names: &[String],
    option: &'static str,
) -> Result<Vec<(usize, &'static OutputInfo)>, InputError> {
    let all = scene.description.outputs;
    if names.is_empty() {
        return Ok(all.iter().enumerate().collect());
    }
    let mut found = Vec::new();
    for name in names {
        let before = found.len();
        found.extend(all.iter().enumerate().filter(|(_, output)| output.name == name || output.of == name));
        if found.len() == before {
            return Err(unknown(option, "output", name, &scene.name, all.iter().map(|output| output.name)));
        }
    }
    Ok(found)
}

/// A name that a scene does not have.
pub fn unknown(
    option: &'static str,
    kind: &'static str,
    name: &str,
    scene: &str,
    names: impl Iterator<Item = &'static str>,
) -> InputError {
    let near = nearest(name, names).map_or_else(
        || format!("; the command `scene {scene}` lists the {kind}s"),
        |near| format!("; did you mean `{near}`?"),
    );
    InputError::Unknown { option, fault: format!("scene `{scene}` has no {kind} `{name}` to be asked for{near}") }
}

/// With samples at these times as well.
fn with_times(mut request: Request, at: &[f64]) -> Request {
    if let Samples::At(times) = &mut request.samples {
        times.extend(at);
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
    }
    request
}

/// The instants of the samples that were asked for, s.
fn rows(request: &Request) -> &[f64] {
    if let Samples::At(times) = &request.samples { times } else { &[] }
}

/// A run of a scene and the derivatives over it of outputs by parameters, given `by` and `of` their names; or the
/// sentence why there are none.
pub fn derivatives(
    program: &Program,
    scene: &Scene,
    chosen: &Chosen,
    request: Request,
    [by, of]: [&[String]; 2],
) -> Result<(Trajectory, Vec<Course>), String> {
    let found = adjustable(scene, chosen, by, "by").and_then(|parameters| {
        let outputs = observed(scene, of, "outputs")?;
        let machine = machine(program, scene, chosen)?;
        let found = differentiated(&*machine, &request, &parameters)?;
        let courses =
            courses(&found, &Question { outputs: &outputs, parameters: &parameters, measures: &[], rows: &[] });
        Ok((found.trajectory, courses))
    });
    found.map_err(|fault| fault.to_string())
}

/// When the outputs of a run are least and largest, s.
fn instants_of_peaks(machine: &dyn Machine, request: &Request) -> Result<Vec<f64>, InputError> {
    let without_samples = Request { peaks: true, samples: Samples::At(Vec::new()), ..request.clone() };
    let run = machine.run(without_samples, None, &mut |_| ControlFlow::Continue(()))?;
    let peaks = run.columns.iter().filter_map(|column| column.peaks);
    // At the instant of an event a sample is the side before it.
    let both_sides = |t: f64| [t, t.next_up()].into_iter().filter(|t| *t <= request.t_end);
    Ok(peaks.flat_map(|Peaks { least, largest }| [least.t, largest.t]).flat_map(both_sides).collect())
}

/// A run with its derivatives by these parameters.
fn differentiated(
    machine: &dyn Machine,
    request: &Request,
    parameters: &[(&'static ParameterInfo, f64)],
) -> Result<Sensitivities, InputError> {
    let by: Vec<&str> = parameters.iter().map(|(info, _)| info.name).collect();
    Ok(machine.known("derivatives by parameters", machine.sensitivities(request, &by))??)
}

/// What is printed.
fn told(found: &Sensitivities, all: &[Influence], question: &Question, most: usize) -> String {
    let still = without_influence(all, question);
    let still = if still.is_empty() {
        String::new()
    } else {
        format!("\nno influence on these outputs: {}\n", still.join(", "))
    };
    let (t, events) = (found.trajectory.last.t, found.trajectory.statistics.events);
    let samples = longest_step(question.rows).map_or_else(String::new, |step| {
        format!("mean, rms and course are those of samples at most {} s apart\n", short(step))
    });
    format!(
        "derivatives of {} outputs by {} parameters over {t} s, {events} events\n{samples}\n{}{still}",
        question.outputs.len(),
        question.parameters.len(),
        text(all, most)
    )
}

/// Writes the files; gives their number, where they are there, and what failed.
fn write(
    mut folder: RunFolder,
    scene: &str,
    found: &Sensitivities,
    (all, table): (&[Influence], &str),
    question: &Question,
) -> (Option<usize>, Vec<OutputError>) {
    let mut faults = Vec::new();
    let mut fill = || -> Result<(), FileError> {
        folder.write_text(TABLE, table)?;
        folder.write_text(CSV, &csv(all))?;
        folder.write_text(COURSES, &courses_csv(&found.trajectory.times, &courses(found, question), question))?;
        match influence(&format!("{scene}: change of each course for a change of the parameter by its size"), all) {
            Ok(svg) => folder.write_text(FIGURE, &svg)?,
            Err(FigureError::Empty) => {}
            Err(source) => faults.push(OutputError::Figure { file: FIGURE.to_owned(), source }),
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
