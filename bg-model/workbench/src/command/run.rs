//! The command `run`: a scene integrated, its files written, its summary printed.

use std::path::Path;
use std::process::ExitCode;

use bg_model::run::{Request, RunError, State, sample_times};
use bg_model::simulation::{MissingColumn, Part};

use super::arguments::{IntegrationArguments, ModelArguments, RunArguments, Start};
use super::progress::{over_time, ticks};
use super::report::Look;
use super::{InputError, ended};
use crate::Program;
use crate::files::{console, whole};
use crate::inputs::{self, Named};
use crate::live::{Live, Order, changed};
use crate::machine::{Machine, MachineError};
use crate::output::{Claimed, OutputError, PageFiles, Places, Table};
use crate::page::film::Film;
use crate::page::{Parameter, Views};
use crate::parameters::{self, Chosen};
use crate::running::{self, Begin, Outcome};
use crate::scenes::Scene;
use crate::shown::Exhibits;
use crate::summary::Summary;

/// Runs and writes; `look` is what a report is to show beside the run, where one is wanted.
pub fn simulate(program: &Program, arguments: &RunArguments, look: Option<&Look>) -> Result<ExitCode, InputError> {
    let RunArguments { model, integration, .. } = arguments;
    let graph = program.models.graph().description;
    let mut chosen = parameters::merge(graph.parameters, model.params.as_deref(), &model.set)?;
    let settings = inputs::settings(&model.input, graph.inputs)?;
    chosen.inputs = inputs::made(&settings);
    let inputs = inputs::named(&settings, graph.inputs);
    let begin = match (&arguments.from, arguments.start) {
        (Some(path), _) => Begin::At(read_state(path)?),
        (None, Start::Model) => Begin::Model,
        (None, Start::Equilibrium) => Begin::Equilibrium,
    };
    let t0 = begin.time();
    let finest = program.extras.finest(integration.t_end);
    let request = Request { settled: program.extras.settled(), ..request(integration, t0, Some(finest))? };
    arguments.save_state.iter().try_for_each(|path| whole::probe(path))?;
    let scene = program.scene_called(&model.scene);
    let figures = (!arguments.no_figures).then(|| program.extras.figures(scene.description)).flatten();
    let page = match look {
        Some(look) => Some(look.files.clone()),
        None => figures.is_some().then(PageFiles::of_run),
    };
    let places = Places::new(&arguments.out, arguments.csv.as_deref(), page, figures.unwrap_or_default());
    let live = match look.and_then(|look| look.module.as_ref()) {
        Some(module) => Some(Live {
            module: module.wasm(scene.index)?,
            order: Order {
                scene: scene.name.clone(),
                parameters: chosen.values.changed().map(|(info, value)| (info.name.to_owned(), value)).collect(),
                inputs: settings,
                integration: integration.integration(),
                begin: begin.clone(),
            },
        }),
        None => None,
    };
    let claim = || Ok(places.claim()?);
    let machine = machine(program, scene, &chosen)?;
    let (outcome, views, claimed) = claimed_and_run(&*machine, request, &begin, look, claim)?;
    let failure = outcome.failure.as_ref().map(|failure| format!("the run failed: {failure}"));
    let saved = arguments.save_state.as_deref().map(|path| save_state(path, &outcome.run.last));
    let rows = sample_times(t0, integration.step, integration.t_end);
    let values = Parameter::all(&chosen.values, |name| program.extras.source(name));
    let about = scene.summary();
    let exhibits = Exhibits {
        description: scene.description,
        scene: &about,
        parameters: &values,
        drawings: look.map_or(&[], |look| &look.drawings),
        views: &views,
        live: live.as_ref(),
    };
    let mut faults: Vec<String> = match report(program, scene, outcome, &rows, claimed, inputs, &exhibits) {
        Ok(faults) => faults.iter().map(ToString::to_string).collect(),
        Err(fault) => vec![fault.to_string()],
    };
    faults.extend(saved.and_then(Result::err));
    Ok(ended(faults.into_iter().chain(failure)))
}

/// The parameters and inputs that the arguments choose, and what is said of the inputs.
pub fn chosen(program: &Program, arguments: &ModelArguments) -> Result<(Chosen, Vec<Named>), InputError> {
    let graph = program.models.graph().description;
    let mut chosen = parameters::merge(graph.parameters, arguments.params.as_deref(), &arguments.set)?;
    let (inputs, named) = inputs::chosen_and_named(&arguments.input, graph.inputs)?;
    chosen.inputs = inputs;
    Ok((chosen, named))
}

/// The model of a scene with the parameters chosen for the whole table.
pub fn machine(program: &Program, scene: &Scene, chosen: &Chosen) -> Result<Box<dyn Machine>, InputError> {
    program.models.made(scene, &chosen.values, &chosen.inputs).map_err(|fault| match fault {
        MachineError::Fixed(fault) => InputError::Fixed { place: chosen.places[fault.index].clone(), fault },
        MachineError::Parameter(fault) => fault.into(),
    })
}

/// A run from `from`, or from the model's own start, with its progress on the terminal. One that stops before its end
/// is no error.
pub fn follow(machine: &dyn Machine, request: Request, from: Option<&State>) -> Result<Outcome, RunError> {
    let bar = over_time(request.t_end);
    let outcome = running::follow(machine, request, from, |t| bar.set_position(ticks(t)));
    bar.finish_and_clear();
    outcome
}

/// Runs a model; before that `claim` claims the places that the results go to.
pub(super) fn claimed_and_run<C>(
    machine: &dyn Machine,
    mut request: Request,
    begin: &Begin,
    look: Option<&Look>,
    claim: impl FnOnce() -> Result<C, InputError>,
) -> Result<(Outcome, Views, C), InputError> {
    if look.is_some() {
        request.parts.push(Part::Shown);
    }
    // What cannot be assembled is refused before anything is claimed.
    let from = begin.state(machine)?;
    let modes = look.map(|look| look.modes(machine)).transpose()?.flatten();
    let claimed = claim()?;
    let mut outcome = follow(machine, request, from.as_ref())?;
    let description = machine.description();
    let views = look.map_or_else(Views::default, |_| Film::taken(description, &mut outcome.run).views(modes));
    Ok((outcome, views, claimed))
}

fn read_state(path: &Path) -> Result<State, InputError> {
    let failed = |fault: String| InputError::From { path: path.to_owned(), fault };
    let text = std::fs::read_to_string(path).map_err(|fault| failed(format!("cannot be read: {fault}")))?;
    State::from_json(&text).map_err(|fault| failed(fault.to_string()))
}

/// Writes the state where the run has come to; gives what failed.
fn save_state(path: &Path, state: &State) -> Result<(), String> {
    let text = state.to_json().map_err(|fault| fault.to_string())?;
    whole::write(path, |file| file.write_all(text.as_bytes())).map_err(|fault| fault.to_string())
}

/// Writes the files and prints the summary; gives what failed.
fn report(
    program: &Program,
    scene: &Scene,
    outcome: Outcome,
    rows: &[f64],
    claimed: Claimed,
    inputs: Vec<Named>,
    exhibits: &Exhibits<'_>,
) -> Result<Vec<OutputError>, MissingColumn> {
    let Outcome { run, failure } = outcome;
    let extras = &program.extras;
    let mut summary = Summary::new(&scene.name, &run, failure, extras.additions(&run)?);
    summary.changed_parameters =
        changed(exhibits.parameters.iter().map(|parameter| (&parameter.info, parameter.value)));
    summary.inputs = inputs;
    let columns = extras.columns(&run);
    let table = Table { samples: &run.at(rows), columns: columns.as_deref() };
    let texts = extras.page(scene.description);
    let mut written = claimed.write(&table, &run, &texts, exhibits, &mut summary);
    let page = written.page.as_ref().map_or_else(String::new, |page| format!("; open {page} there"));
    let printed = console::print(&format!("{summary}\nwritten: {written}{page}\n"));
    written.faults.extend(printed.err().map(OutputError::from));
    Ok(written.faults)
}

/// What is asked of a run from `t0` (s) on: samples at the rows of the CSV file, and every `finest` (s) where that is
/// given.
pub fn request(arguments: &IntegrationArguments, t0: f64, finest: Option<f64>) -> Result<Request, InputError> {
    Ok(arguments.integration().request(t0, finest)?)
}
