//! The command `linearize`: the linear model at an equilibrium or at some time, its modes and frequency responses.

use std::process::ExitCode;

use bg_model::run::{Request, State};

use super::arguments::LinearizeArguments;
use super::run::{chosen, follow, machine};
use super::{InputError, ended};
use crate::ask::inputs;
use crate::ask::machine::Machine;
use crate::ask::request::{Integration, RequestError};
use crate::ask::scenes::Scene;
use crate::files::{FileError, RunFolder, console};
use crate::program::Program;
use crate::run::running::at_rest;
use crate::show::figures::FigureError;
use crate::show::figures::bode::bode;
use crate::show::output::OutputError;
use bg_analysis::linear::{Response, StateSpace, logarithmic, responses_csv};

const JSON: &str = "linear.json";
const ARRAYS: &str = "linear.npz";
const MODES: &str = "modes.txt";
const RESPONSES: &str = "responses.csv";
/// The most Bode diagrams; the others are in the table of responses.
const MOST: usize = 40;
/// The frequencies of a response in each decade, and at most.
const IN_DECADE: f64 = 100.0;
const MOST_FREQUENCIES: f64 = 2000.0;
/// What a model may not have.
const LINEAR: &str = "linear models";

pub fn linearize(program: &Program, arguments: &LinearizeArguments) -> Result<ExitCode, InputError> {
    check_time("--at", arguments.at)?;
    let (chosen, named) = chosen(program, &arguments.model)?;
    let scene = program.scene_called(&arguments.model.scene);
    let folder = RunFolder::claim(&arguments.out, &names(scene))?;
    let machine = machine(program, scene, &chosen)?;
    let integration = Integration::by(arguments.method, arguments.rtol);
    let (space, sentence) = linearised(&*machine, arguments.at, &|t| integration.request_to(t))?;
    let inputs = inputs::text(&named, [0.0, arguments.at.unwrap_or(0.0)]);
    let text = format!("{sentence}\n{}{inputs}", space.table());
    let (written, faults) = write(folder, &space, &text);
    let written =
        written.map_or_else(|| "nothing".to_owned(), |count| format!("{count} files in {}", arguments.out.display()));
    let json = || serde_json::from_str(&space.json()).expect("a linear model is JSON");
    let printed = console::tell_as(arguments.json, &format!("{text}\nwritten: {written}\n"), json);
    Ok(ended(faults.into_iter().chain(printed.err().map(OutputError::from))))
}

/// Refuses a time that no run reaches.
pub fn check_time(name: &'static str, at: Option<f64>) -> Result<(), InputError> {
    match at.filter(|at| !(at.is_finite() && *at >= 0.0)) {
        Some(value) => Err(InputError::Range { name, value, range: "a finite number, at least 0".to_owned() }),
        None => Ok(()),
    }
}

/// The names of all files that may be written.
fn names(scene: &Scene) -> Vec<String> {
    let description = scene.description;
    let pairs = description
        .inputs
        .iter()
        .flat_map(|input| description.outputs.iter().map(move |output| diagram(input.name, output.name)));
    let responses = (!description.inputs.is_empty()).then_some(RESPONSES);
    [JSON, ARRAYS, MODES].into_iter().chain(responses).map(str::to_owned).chain(pairs.take(MOST)).collect()
}

fn diagram(input: &str, output: &str) -> String {
    format!("bode_{output}_over_{input}.svg")
}

/// What is asked of a run to an instant, s.
pub type To<'a> = &'a dyn Fn(f64) -> Result<Request, RequestError>;

/// The linear model at `at`, s, and a sentence on where that is; without `at` it is the equilibrium near the start. A
/// run to `at` is made as `to` says.
pub fn linearised(machine: &dyn Machine, at: Option<f64>, to: To<'_>) -> Result<(StateSpace, String), InputError> {
    let Some(t) = at else {
        let (state, rest) = at_rest(machine)?;
        return Ok((machine.known(LINEAR, machine.linearised(&state))??, rest.sentence()));
    };
    let state = state_at(machine, t, to)?;
    Ok((machine.known(LINEAR, machine.linearised(&state))??, format!("where the run is at t = {t:?} s")))
}

/// The state that a run reaches at `t` (s).
fn state_at(machine: &dyn Machine, t: f64, to: To<'_>) -> Result<State, InputError> {
    if t == 0.0 {
        return Ok(machine.start(None)?);
    }
    let outcome = follow(machine, to(t)?, None)?;
    match outcome.failure {
        None => Ok(outcome.run.last),
        Some(failure) => Err(InputError::NotReached { t, failure }),
    }
}

/// Writes the files; gives their number, where they are there, and what failed.
fn write(mut folder: RunFolder, space: &StateSpace, text: &str) -> (Option<usize>, Vec<OutputError>) {
    let mut faults = Vec::new();
    let responses = responses(space);
    let outcome = fill(&mut folder, space, text, &responses, &mut faults);
    match outcome.and_then(|()| folder.publish()) {
        Ok(files) => (Some(files.len()), faults),
        Err(fault) => {
            faults.push(fault.into());
            (None, faults)
        }
    }
}

/// Of all outputs to all inputs, over the band in which something happens.
fn responses(space: &StateSpace) -> Vec<Response> {
    let (first, last) = space.band();
    let points = (IN_DECADE * (last / first).log10()).clamp(2.0, MOST_FREQUENCIES) as usize;
    let all = space.responses(&[], &[], &logarithmic(first, last, points));
    all.expect("no name is asked for")
}

fn fill(
    folder: &mut RunFolder,
    space: &StateSpace,
    text: &str,
    responses: &[Response],
    faults: &mut Vec<OutputError>,
) -> Result<(), FileError> {
    folder.write_text(MODES, text)?;
    folder.write_text(JSON, &space.json())?;
    folder.write(ARRAYS, |file| file.write_all(&space.npz().map_err(std::io::Error::other)?))?;
    if responses.is_empty() {
        return Ok(());
    }
    folder.write_text(RESPONSES, &responses_csv(responses))?;
    for response in responses.iter().take(MOST) {
        let file = diagram(&response.input.name, &response.output.name);
        match bode(response) {
            Ok(svg) => folder.write_text(&file, &svg)?,
            // An output that the input does not reach.
            Err(FigureError::Empty) => {}
            Err(source) => faults.push(OutputError::Figure { file, source }),
        }
    }
    Ok(())
}
