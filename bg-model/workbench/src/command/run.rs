//! The command `run`: a scene integrated, its files written, its summary printed.

use std::ops::ControlFlow;
use std::process::ExitCode;

use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::Parameters;
use bg_model::run::{Request, RunError, Simulation, Stopped, Trajectory, sample_times};
use bg_model::simulation::MissingColumn;

use super::arguments::{IntegrationArguments, RunArguments};
use super::progress::{over_time, ticks};
use super::{InputError, ended};
use crate::Program;
use crate::files::console;
use crate::output::{Claimed, OutputError, Places, Table};
use crate::parameters::{self, Chosen};
use crate::scenes::{Scene, own_parameters};
use crate::summary::Summary;

/// A run, and why it stopped before its end, if it did.
pub struct Outcome {
    pub run: Trajectory,
    pub failure: Option<String>,
}

pub fn simulate<Me: Scenes>(program: &Program<Me>, arguments: &RunArguments) -> Result<ExitCode, InputError> {
    let RunArguments { model, integration, .. } = arguments;
    let chosen = parameters::merge::<Me::Parameters>(model.params.as_deref(), &model.set)?;
    let finest = program.extras.finest(integration.t_end);
    let request = request(integration, Some(finest))?;
    let scene = program.scene_called(&model.scene);
    let figures = (!arguments.no_figures).then(|| program.extras.figures(scene.description)).flatten();
    let places = Places::new(&arguments.out, arguments.csv.as_deref(), figures);
    let claim = || Ok(places.claim()?);
    let run = Claiming { scene, scenes: &program.scenes, chosen: &chosen, request, claim };
    let (outcome, claimed) = Me::model(scene.index, run)?;
    let failure = outcome.failure.as_ref().map(|failure| format!("the run failed: {failure}"));
    let rows = sample_times(0.0, integration.step, integration.t_end);
    let faults = match report(program, scene, outcome, &rows, claimed, changed(&chosen.values)) {
        Ok(faults) => faults.iter().map(ToString::to_string).collect(),
        Err(fault) => vec![fault.to_string()],
    };
    Ok(ended(faults.into_iter().chain(failure)))
}

/// The model of a scene with the parameters chosen for the whole table.
pub fn model<P: Parameters, Sc: Mechanism>(
    scene: &Scene,
    scenes: &[Scene],
    chosen: &Chosen<P>,
) -> Result<Sc, InputError> {
    let own = own_parameters(scene, scenes, &chosen.values);
    let own = own.map_err(|fault| InputError::Fixed { place: chosen.places[fault.index].clone(), fault })?;
    Ok(Sc::make(own, &[])?)
}

/// A run with its progress on the terminal. One that stops before its end is no error.
pub fn integrate<Sc: Mechanism>(model: &Sc, request: Request) -> Result<Outcome, RunError> {
    let bar = over_time(request.t_end);
    let told = |t| {
        bar.set_position(ticks(t));
        ControlFlow::Continue(())
    };
    let run = Simulation::of(model, request).each_step(told).run();
    bar.finish_and_clear();
    match run {
        Ok(run) => Ok(Outcome { run, failure: None }),
        Err(RunError::Stopped(stopped)) => {
            let Stopped { cause, trajectory } = *stopped;
            Ok(Outcome { run: trajectory, failure: Some(cause.to_string()) })
        }
        Err(fault) => Err(fault),
    }
}

/// Makes a scene's model and runs it; before that `claim` claims the places that the results go to.
pub(super) struct Claiming<'a, P, F> {
    pub scene: &'a Scene,
    pub scenes: &'a [Scene],
    pub chosen: &'a Chosen<P>,
    pub request: Request,
    pub claim: F,
}

impl<P: Parameters, C, F: FnOnce() -> Result<C, InputError>> MechanismVisitor for Claiming<'_, P, F> {
    type Output = Result<(Outcome, C), InputError>;

    fn visit<Sc: Mechanism>(self) -> Self::Output {
        let model: Sc = model(self.scene, self.scenes, self.chosen)?;
        // What cannot be assembled is refused before anything is claimed.
        Simulation::new(&model).start()?;
        let claimed = (self.claim)()?;
        Ok((integrate(&model, self.request)?, claimed))
    }
}

/// Writes the files and prints the summary; gives what failed.
fn report<Me>(
    program: &Program<Me>,
    scene: &Scene,
    outcome: Outcome,
    rows: &[f64],
    claimed: Claimed,
    changed_parameters: Vec<String>,
) -> Result<Vec<OutputError>, MissingColumn> {
    let Outcome { run, failure } = outcome;
    let extras = &program.extras;
    let mut summary = Summary::new(&scene.name, &run, failure, extras.additions(&run)?);
    summary.changed_parameters = changed_parameters;
    let columns = extras.columns(&run);
    let table = Table { samples: &run.at(rows), columns: columns.as_deref() };
    let mut written = claimed.write(&table, &run, &extras.page(scene.description), &mut summary);
    let page = if written.page { "; open index.html there" } else { "" };
    let printed = console::print(&format!("{summary}\nwritten: {written}{page}\n"));
    written.faults.extend(printed.err().map(OutputError::from));
    Ok(written.faults)
}

/// What is asked of the run: samples at the rows of the CSV file, and every `finest` (s) where that is given.
pub fn request(arguments: &IntegrationArguments, finest: Option<f64>) -> Result<Request, InputError> {
    Ok(arguments.integration().request(finest)?)
}

/// The parameters that differ from their defaults, as `name = value unit`.
fn changed<P: Parameters>(values: &P) -> Vec<String> {
    let table = P::table().iter().enumerate();
    let changed = table.filter(|(index, info)| values.value(*index) != info.default);
    changed
        .map(|(index, info)| {
            let text = format!("{} = {} {}", info.name, parameters::number(values.value(index)), info.unit);
            text.trim_end().to_owned()
        })
        .collect()
}
