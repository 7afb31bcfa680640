//! The command `compare`: two scenes or two runs, output by output.

use std::path::Path;
use std::process::ExitCode;

use bg_model::run::Request;
use bg_model::simulation::Recording;

use super::arguments::CompareArguments;
use super::run::{follow, machine, request};
use super::{InputError, ended, say};
use crate::ask::inputs;
use crate::ask::parameters::{self, Chosen};
use crate::program::Program;
use crate::run::compare::{json, text};
use crate::run::running::Outcome;
use crate::run::samples::read_file_of;

pub fn compare(program: &Program, arguments: &CompareArguments) -> Result<ExitCode, InputError> {
    let graph = program.models.graph().description;
    let mut chosen = parameters::merge(graph.parameters, arguments.params.as_deref(), &arguments.set)?;
    let (inputs, named) = inputs::chosen_and_named(&arguments.input, graph.inputs)?;
    chosen.inputs = inputs;
    let request = request(&arguments.integration, 0.0, None)?;
    let [a, b] = [&arguments.a, &arguments.b].map(|name| side(program, name, &chosen, &request));
    let ((a, first), (b, second)) = (a?, b?);
    let is_made = |name: &String| program.models.named(name).is_some();
    let inputs = match [&arguments.a, &arguments.b].into_iter().any(is_made) {
        true => inputs::text(&named, [0.0, request.t_end]),
        false => String::new(),
    };
    let told = match arguments.json {
        true => format!("{:#}\n", json(&a, &b)),
        false => format!("{}{inputs}", text([&arguments.a, &arguments.b], &a, &b)),
    };
    let code = say(&told);
    let failures: Vec<String> = first.into_iter().chain(second).collect();
    Ok(if failures.is_empty() { code } else { ended(failures) })
}

/// A run by name, and why it stopped before its end, if it did: of a scene a new one, else the one that a file has.
fn side(
    program: &Program,
    name: &str,
    chosen: &Chosen,
    request: &Request,
) -> Result<(Recording, Option<String>), InputError> {
    if let Some(scene) = program.models.named(name) {
        let machine = machine(program, scene, chosen)?;
        let Outcome { run, failure } = follow(&*machine, request.clone(), None)?;
        let failure = failure.map(|failure| format!("the run of `{name}` failed: {failure}"));
        return Ok((run.recording, failure));
    }
    let path = Path::new(name);
    if !path.exists() {
        return Err(InputError::NothingToCompare(name.to_owned()));
    }
    let file = if path.is_dir() { path.join("trajectory.csv") } else { path.to_owned() };
    let outputs = program.models.scenes.iter().flat_map(|scene| scene.description.outputs);
    Ok((read_file_of(&file, outputs)?, None))
}
