//! The command `run`: a scene integrated, its files written, its summary printed.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

use bg_model::run::{Request, RunError, State, sample_times};
use bg_model::simulation::{MissingColumn, Part, Recording};

use super::arguments::{IntegrationArguments, ModelArguments, RunArguments};
use super::asked::Asked;
use super::progress::{over_time, ticks};
use super::report::Look;
use super::sensitivity::observed;
use super::{InputError, ended, plot};
use crate::ask::inputs::{self, Named};
use crate::ask::machine::{Machine, MachineError};
use crate::ask::parameters::{self, Chosen};
use crate::ask::scenes::{Scene, own_values};
use crate::files::{console, whole};
use crate::live::{Live, Order, changed};
use crate::program::Program;
use crate::run::recipe::Recipe;
use crate::run::running::{self, Begin, Outcome};
use crate::run::summary::Summary;
use crate::show::output::{Claimed, OutputError, Places};
use crate::show::page::film::Film;
use crate::show::page::{Parameter, Views};
use crate::show::picture::Drawn;
use crate::show::shown::{Exhibits, PageFiles};
use crate::show::signals::Drawing;

/// Runs and writes; `look` is what a report is to show beside the run, where one is wanted.
pub fn simulate(program: &Program, arguments: &RunArguments, look: Option<&Look>) -> Result<ExitCode, InputError> {
    let Asked { scene, chosen, settings, recipe } = Asked::of(program, arguments)?;
    let Recipe { integration, begin, .. } = &recipe;
    let inputs = inputs::named(&settings, program.models.graph().description.inputs);
    let outputs = observed(scene, &arguments.outputs, "--output")?;
    let pictures = Pictures::of(program, scene, &chosen, arguments)?;
    let t0 = begin.time();
    let finest = program.extras.finest(integration.t_end);
    let request = Request { settled: program.extras.settled(), ..integration.request(t0, Some(finest))? };
    arguments.save_state.iter().try_for_each(|path| whole::probe(path))?;
    let figures = (!arguments.no_figures).then(|| program.extras.figures(scene.description)).flatten();
    let page = match look {
        Some(look) => Some(look.files.clone()),
        None => figures.is_some().then(PageFiles::of_run),
    };
    let (tables, own) = (arguments.trajectory.tables(), arguments.trajectory.form_of_csv());
    let places = Places::new(&arguments.out, tables, own, page, figures.unwrap_or_default());
    let places = if look.is_some_and(Look::is_framed) { places.without_own_table() } else { places };
    let spoken = Spoken { as_json: arguments.json, is_aside: places.has_standard_output() };
    let live = match look.and_then(|look| look.module.as_ref()) {
        Some(module) => Some(Live {
            module: module.wasm(scene.index)?,
            order: Order {
                scene: scene.name.clone(),
                parameters: chosen.values.changed().map(|(info, value)| (info.name.to_owned(), value)).collect(),
                inputs: settings,
                integration: integration.clone(),
                begin: begin.clone(),
            },
        }),
        None => None,
    };
    let claim = || Ok(places.claim()?);
    let machine = machine(program, scene, &chosen)?;
    let (mut outcome, views, claimed) = claimed_and_run(&*machine, request, begin, look, claim)?;
    let (drawings, undrawn) = pictures.drawn(scene, &outcome.run.recording);
    let shown = look.map_or(&[][..], |look| &look.drawings[..]).iter().cloned();
    let drawings: Vec<(String, String)> = shown.chain(drawings).collect();
    if !arguments.outputs.is_empty() {
        keep(&mut outcome.run.recording, outputs.iter().map(|(_, output)| output.name));
    }
    let failure = outcome.failure.as_ref().map(|failure| format!("the run failed: {failure}"));
    let saved = arguments.save_state.as_deref().map(|path| save_state(path, &outcome.run.last));
    let rows = sample_times(t0, integration.step, integration.t_end);
    let values = Parameter::all(&chosen.values, |name| program.extras.source(name));
    let about = scene.summary();
    let exhibits = Exhibits {
        description: scene.description,
        scene: &about,
        parameters: &values,
        others: &pictures.others,
        drawings: &drawings,
        views: &views,
        live: live.as_ref(),
    };
    let mut faults: Vec<String> = match report(program, outcome, &rows, claimed, (inputs, recipe), &exhibits, &spoken) {
        Ok(faults) => faults.iter().map(ToString::to_string).collect(),
        Err(fault) => vec![fault.to_string()],
    };
    faults.extend(undrawn);
    faults.extend(saved.and_then(Result::err));
    Ok(ended(faults.into_iter().chain(failure)))
}

/// What a page is to show beside the run's own charts and figures.
struct Pictures {
    /// Other runs and measurements, each with its name.
    others: Vec<(String, Recording)>,
    /// Pictures of signals, each with the text that asks for it.
    drawings: Vec<(String, Drawing)>,
    /// The values of the scene's own parameters.
    own: Vec<f64>,
}

impl Pictures {
    fn of(program: &Program, scene: &Scene, chosen: &Chosen, arguments: &RunArguments) -> Result<Self, InputError> {
        let model = scene.description;
        let others = plot::others(&arguments.others, model)?;
        for (path, (_, run)) in arguments.others.iter().zip(&others) {
            if !run.columns.iter().any(|column| model.outputs.iter().any(|output| output.name == column.name)) {
                let fault = format!("{} has no column with the name of an output", path.display());
                return Err(InputError::Unknown { option: "--with", fault });
            }
        }
        let refused = |fault: String| InputError::Unknown { option: "--plot", fault };
        let drawing = |text: &String| {
            let drawing = Drawing::read(model, text).map_err(|fault| refused(format!("{text}: {fault}")))?;
            Ok((text.clone(), drawing))
        };
        let drawings = arguments.plots.iter().map(drawing).collect::<Result<_, InputError>>()?;
        let own = own_values(scene, &program.models.scenes, &chosen.values).map_err(|fault| refused(fault.to_string()));
        let own = if arguments.plots.is_empty() { Vec::new() } else { own?.values().to_vec() };
        Ok(Self { others, drawings, own })
    }

    /// The pictures of a run with their titles, and of those that cannot be drawn why not. Other runs are in those
    /// whose columns they have.
    fn drawn(&self, scene: &Scene, run: &Recording) -> (Vec<(String, String)>, Vec<String>) {
        let (mut drawn, mut faults) = (Vec::new(), Vec::new());
        for (text, drawing) in &self.drawings {
            let others = self.others.iter().filter(|(_, other)| drawing.check(other).is_ok());
            let others = others.map(|(name, other)| (name.as_str(), other));
            let runs: Vec<(&str, &Recording)> = std::iter::once(("", run)).chain(others).collect();
            match drawing.plot(&scene.name, &runs, &self.own).drawn() {
                Ok(svg) => drawn.push((text.clone(), svg)),
                Err(fault) => faults.push(format!("--plot {text}: {fault}")),
            }
        }
        (drawn, faults)
    }
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
    let mut shown = 0;
    let told = |t| {
        // Steps are shorter than ticks, and a position costs as much as a rate.
        let tick = ticks(t);
        if tick != shown {
            bar.set_position(tick);
            shown = tick;
        }
        ControlFlow::Continue(())
    };
    let outcome = running::follow(machine, request, from, told);
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
    let description = machine.description();
    let drawing = look.map(|look| match &look.picture {
        None => Drawn::begun(description),
        Some(file) => Drawn::begun_or_kept(description, file.clone()),
    });
    let mut outcome = follow(machine, request, from.as_ref())?;
    let views = drawing
        .map_or_else(Views::default, |drawing| Film::taken(description, &mut outcome.run).views(modes, drawing.svg()));
    Ok((outcome, views, claimed))
}

/// Writes the state where the run has come to; gives what failed.
fn save_state(path: &Path, state: &State) -> Result<(), String> {
    let text = state.to_json().map_err(|fault| fault.to_string())?;
    whole::write(path, |file| file.write_all(text.as_bytes())).map_err(|fault| fault.to_string())
}

/// Leaves the columns of these names, in this order.
fn keep<'a>(run: &mut Recording, names: impl Iterator<Item = &'a str>) {
    let mut columns = std::mem::take(&mut run.columns);
    let mut named = |name: &str| {
        let place = columns.iter().position(|column| column.name == name)?;
        Some(columns.swap_remove(place))
    };
    run.columns = names.filter_map(&mut named).collect();
}

/// How the summary is given.
struct Spoken {
    /// As JSON, not as text.
    as_json: bool,
    /// On standard error, since the trajectory has standard output.
    is_aside: bool,
}

/// Writes the files and prints the summary; gives what failed.
fn report(
    program: &Program,
    outcome: Outcome,
    rows: &[f64],
    claimed: Claimed,
    (inputs, recipe): (Vec<Named>, Recipe),
    exhibits: &Exhibits<'_>,
    spoken: &Spoken,
) -> Result<Vec<OutputError>, MissingColumn> {
    let Outcome { run, failure } = outcome;
    let extras = &program.extras;
    let mut summary = Summary::new(&recipe.scene, &run, failure, extras.additions(&run)?);
    summary.program = program.texts.name_and_version();
    summary.recipe = Some(recipe);
    summary.changed_parameters =
        changed(exhibits.parameters.iter().map(|parameter| (&parameter.info, parameter.value)));
    summary.inputs = inputs;
    let mut rows = run.at(rows);
    if let Some(names) = extras.columns(&run) {
        keep(&mut rows, names.iter().map(String::as_str));
    }
    let texts = program.page(exhibits.description);
    let mut written = claimed.write(&rows, &run, &texts, exhibits, &mut summary);
    let text = if spoken.as_json {
        summary.json()
    } else {
        let page = written.page.as_ref().map_or_else(String::new, |page| format!("; open {page} there"));
        format!("{summary}\nwritten: {written}{page}\n")
    };
    let printed = match spoken {
        Spoken { is_aside: true, .. } => console::tell_aside(&text),
        // It is asked for, whether the program is to be quiet or not.
        Spoken { as_json: true, .. } => console::print(&text),
        _ => console::tell(&text),
    };
    written.faults.extend(printed.err().map(OutputError::from));
    Ok(written.faults)
}

/// What is asked of a run from `t0` (s) on: samples at the rows of the CSV file, and every `finest` (s) where that is
/// given.
pub fn request(arguments: &IntegrationArguments, t0: f64, finest: Option<f64>) -> Result<Request, InputError> {
    Ok(arguments.integration().request(t0, finest)?)
}
