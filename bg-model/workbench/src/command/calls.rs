//! What a program does for another program: runs and linear models as values, without files and terminal.
//!
//! In: parameters, inputs and settings by name. Out: what the commands `run`, `linearize` and `sensitivity` make, or
//! the sentence that they would refuse it with.

use std::collections::BTreeMap;
use std::path::PathBuf;

use bg_model::description::{InputInfo, ParameterInfo};
use bg_model::run::{Interrupt, Progress, Request, Trajectory};
use bg_model::sensitivity::Objective;
use bg_model::simulation::Recording;
use thiserror::Error;

use super::gradient::only;
use super::linearize::{check_time, linearised};
use super::sensitivity::{adjustable, derivatives};
use super::{campbell, identify, plot};
use crate::ask::inputs::{self, Named, Setting};
use crate::ask::parameters::{self, Chosen, number};
use crate::ask::request::{Integration, RequestError};
use crate::ask::scenes::{Scene, own_values};
use crate::live::{Order, whole_report};
use crate::program::Program;
use crate::run::running::{follow, going_on, part_done};
use crate::show::picture;
use crate::show::signals::Drawing;
use crate::studies::identify::data::{of_columns, read_file};
use crate::studies::identify::report;
use crate::studies::optimize::{self, Optimum, Sought, Trial};
use crate::studies::sensitivity::Course;
use crate::studies::sweep::campbell::Campbell;
use bg_analysis::linear::StateSpace;

pub use crate::run::running::Begin;

/// What cannot be done, in a sentence.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Refused(String);

/// What is asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Asked {
    /// The scene; else that of the program.
    pub scene: Option<String>,
    /// Parameters that are not at their defaults.
    pub set: BTreeMap<String, f64>,
    /// Inputs as `NAME=VALUE` or `NAME=FILE.csv`.
    pub inputs: Vec<String>,
    /// Inputs that are set to tables or functions of who asks.
    pub signals: BTreeMap<String, Setting>,
    /// How it is integrated.
    pub integration: Integration,
    /// Where it begins.
    pub start: Begin,
    /// What ends all runs that are made for it.
    pub interrupt: Interrupt,
    /// What tells how far it is of what is one run: derivatives, a linear model.
    pub progress: Progress,
}

impl Asked {
    /// What is asked of a run from `t0` (s) on.
    fn request(&self, t0: f64) -> Result<Request, RequestError> {
        Ok(Request { interrupt: self.interrupt.clone(), ..self.integration.request(t0, None)? })
    }

    /// A run that is all there is to do: it tells how far it is.
    fn alone(&self, request: Request) -> Request {
        Request { progress: self.progress.clone(), ..request }
    }

    /// What is asked of a run whose end, at `t` (s), is all that counts.
    fn to(&self, t: f64) -> Result<Request, RequestError> {
        Ok(Request { interrupt: self.interrupt.clone(), ..self.integration.request_to(t)? })
    }
}

/// A run that was made.
#[derive(Debug)]
pub struct Ran {
    /// The run, to its end or as far as it went.
    pub run: Trajectory,
    /// Why it stopped before its end, if it did.
    pub failure: Option<String>,
    /// The model's inputs in their order: what each was set to.
    pub inputs: Vec<Named>,
}

/// Is told after each step of a run which part of it is done, 0 to 1, and says whether to go on; where not, the run
/// ends there.
pub type Told<'a> = &'a dyn Fn(f64) -> bool;

fn refused(fault: impl std::fmt::Display) -> Refused {
    Refused(fault.to_string())
}

/// The program's version, and what its mechanism is.
#[must_use]
pub fn about(program: &Program) -> [String; 2] {
    [program.texts.version.clone(), program.texts.about.clone()]
}

/// The scenes with what they are.
#[must_use]
pub fn scenes(program: &Program) -> Vec<(String, String)> {
    program.models.scenes.iter().map(|scene| (scene.name.clone(), scene.summary())).collect()
}

/// The parameters of a scene, or without one of all.
///
/// # Errors
/// No such scene.
pub fn parameters(program: &Program, scene: Option<&str>) -> Result<Vec<ParameterInfo>, Refused> {
    let table = program.models.graph().description.parameters;
    match scene {
        None => Ok(table.to_vec()),
        Some(_) => {
            let scene = program.find_scene(scene).map_err(Refused)?;
            Ok(table.iter().filter(|info| scene.adjusts(info.name)).cloned().collect())
        }
    }
}

/// The outputs of a scene with their units.
///
/// # Errors
/// No such scene.
pub fn outputs(program: &Program, scene: Option<&str>) -> Result<Vec<(String, String)>, Refused> {
    let scene = program.find_scene(scene).map_err(Refused)?;
    Ok(scene.description.outputs.iter().map(|output| (output.name.to_owned(), output.unit.to_owned())).collect())
}

/// Makes the run, as far as it goes.
///
/// # Errors
/// It cannot be made.
pub fn run(program: &Program, asked: &Asked, told: Told<'_>) -> Result<Ran, Refused> {
    let request = asked.request(asked.start.time()).map_err(refused)?;
    let Given { scene, chosen, inputs } = given(program, asked)?;
    let machine = program.models.made(scene, &chosen.values, &chosen.inputs).map_err(refused)?;
    let from = asked.start.state(&*machine).map_err(refused)?;
    let part = part_done(&asked.start, request.t_end);
    let outcome = follow(&*machine, request, from.as_ref(), |t| going_on(told(part(t)))).map_err(refused)?;
    Ok(Ran { run: outcome.run, failure: outcome.failure, inputs })
}

/// The linear model where the run is at `at`, s, or at the equilibrium near the start.
///
/// # Errors
/// There is none.
pub fn linearize(program: &Program, asked: &Asked, at: Option<f64>) -> Result<StateSpace, Refused> {
    let Given { scene, chosen, .. } = given(program, asked)?;
    check_time("at", at).map_err(refused)?;
    let machine = program.models.made(scene, &chosen.values, &chosen.inputs).map_err(refused)?;
    let (space, _) = linearised(&*machine, at, &|t| Ok(asked.alone(asked.to(t)?))).map_err(refused)?;
    Ok(space)
}

/// A run to its end, with the derivatives of the outputs `of` by the parameters `by` over it; without names of all
/// outputs, or by all that the scene leaves adjustable. It begins at the model's own start.
///
/// # Errors
/// It cannot be made, or has no derivatives.
pub fn sensitivity(
    program: &Program,
    asked: &Asked,
    by: &[String],
    of: &[String],
) -> Result<(Ran, Vec<Course>), Refused> {
    let request = asked.alone(asked.request(0.0).map_err(refused)?);
    let Given { scene, chosen, inputs } = given(program, asked)?;
    let (run, courses) = derivatives(program, scene, &chosen, request, [by, of]).map_err(Refused)?;
    Ok((Ran { run, failure: None, inputs }, courses))
}

/// One number of a run, whose derivatives [`gradient`] gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Number {
    /// The output.
    pub output: String,
    /// When, s; else at the end.
    pub at: Option<f64>,
    /// Its integral over the run instead.
    pub is_integral: bool,
}

/// A number of a run with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Gradient {
    /// The number, in the output's unit, or times s.
    pub value: f64,
    /// Its derivative by each parameter, by name; SI units.
    pub by: Vec<(&'static str, f64)>,
}

/// How one number depends on the parameters `by`, without names on all that the scene leaves adjustable: by the run
/// followed backwards.
///
/// # Errors
/// It cannot be made, or has no derivatives.
pub fn gradient(program: &Program, asked: &Asked, of: &Number, by: &[String]) -> Result<Gradient, Refused> {
    let request = asked.alone(asked.request(0.0).map_err(refused)?);
    let Given { scene, chosen, .. } = given(program, asked)?;
    let (output, _) = only(scene, &of.output).map_err(refused)?;
    check_time("at", of.at).map_err(refused)?;
    let objective = match (of.at, of.is_integral) {
        (_, true) => Objective::integral(output),
        (Some(t), _) => Objective::at(output, t),
        (None, _) => Objective::last(output),
    };
    let by: Vec<&'static str> =
        adjustable(scene, &chosen, by, "by").map_err(refused)?.iter().map(|(info, _)| info.name).collect();
    let machine = program.models.made(scene, &chosen.values, &chosen.inputs).map_err(refused)?;
    let found = machine.known("gradients", machine.gradient(&request, &objective, &by)).map_err(refused)?;
    let found = found.map_err(refused)?;
    Ok(Gradient { value: found.value, by: by.into_iter().zip(found.by).collect() })
}

/// What was measured: `t`, in s, and what is named as outputs.
#[derive(Clone, Debug, PartialEq)]
pub enum Measurement {
    /// In a CSV file, whose first column is `t`.
    File(PathBuf),
    /// In columns by name.
    Columns(Vec<(String, Vec<f64>)>),
}

/// What is fitted to what.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// What was measured.
    pub data: Measurement,
    /// The parameters.
    pub parameters: Vec<String>,
    /// Their bounds, `NAME=LOWER..UPPER`, where they are narrower than their ranges.
    pub bounds: Vec<String>,
    /// Which outputs columns measure that have other names, `NAME=OUTPUT`.
    pub columns: Vec<String>,
}

/// The parameters with which outputs are nearest to what was measured, as `identify --json` gives them; `told` is told
/// of each run.
///
/// # Errors
/// It cannot be sought, or no fit came about.
pub fn identify(program: &Program, asked: &Asked, fit: &Fit, told: &dyn Fn()) -> Result<serde_json::Value, Refused> {
    let Given { scene, chosen, .. } = given(program, asked)?;
    let variables = identify::variables(scene, &chosen, &fit.parameters, &fit.bounds).map_err(refused)?;
    let named = identify::columns(scene, &fit.columns).map_err(refused)?;
    let outputs = scene.description.outputs;
    let data = match &fit.data {
        Measurement::File(path) => read_file(path, outputs, &named, &[]).map_err(refused)?,
        Measurement::Columns(columns) => {
            of_columns(columns, outputs, &named, &[]).map_err(|fault| refused(format!("data: {fault}")))?
        }
    };
    let t_end = data.times.last().copied().unwrap_or_default();
    let request = asked.to(t_end).map_err(refused)?;
    let machine = program.models.made(scene, &chosen.values, &chosen.inputs).map_err(refused)?;
    let found = machine.identified(&request, &data, &variables, &mut |_, _| told());
    let found = machine.known("derivatives by parameters", found).map_err(refused)?.map_err(refused)?;
    Ok(report::json(&found, &data, outputs))
}

/// The picture of a scene's bond graph: SVG.
///
/// # Errors
/// No such scene.
pub fn graph(program: &Program, scene: Option<&str>) -> Result<String, Refused> {
    Ok(picture::svg(program.find_scene(scene).map_err(Refused)?.description))
}

/// The report of a run, HTML in one file.
///
/// # Errors
/// It cannot be made.
pub fn page(program: &Program, asked: &Asked, told: Told<'_>) -> Result<String, Refused> {
    let Given { scene, .. } = given(program, asked)?;
    let order = Order {
        scene: scene.name.clone(),
        parameters: asked.set.clone(),
        inputs: settings(asked, program.models.graph().description.inputs)?,
        integration: asked.integration.clone(),
        begin: asked.start.clone(),
    };
    whole_report(program, &order, told).map_err(Refused)
}

/// The parameters with which what `goals` asks for is least or largest; `told` is asked after each run whether to go
/// on.
///
/// # Errors
/// It cannot be sought, or no search came about.
pub fn optimize(
    program: &Program,
    asked: &Asked,
    goals: &optimize::Asked,
    told: &(dyn Fn() -> bool + Sync),
) -> Result<(Sought, Optimum), Refused> {
    let request = asked.request(0.0).map_err(refused)?;
    let Given { scene, chosen, .. } = given(program, asked)?;
    let sought = optimize::sought(scene, &chosen.values, goals, &request, asked.integration.step).map_err(refused)?;
    let each = |_: usize, _: &Trial| told();
    let found = optimize::optimum(&program.models, scene, &chosen.values, &chosen.inputs, &sought, &each);
    Ok((sought, found.map_err(refused)?))
}

/// The modes over a parameter, `NAME=FROM..TO`, at so many values: about the model's start or its equilibrium, or where
/// its run is at `at`, s. Orders are those that are given, else 1 and 2 of a speed. `told` is asked after each value,
/// with the part that is done, whether to go on.
///
/// # Errors
/// It cannot be asked for, or no value has a linear model.
pub fn campbell(
    program: &Program,
    asked: &Asked,
    by: &str,
    points: usize,
    orders: Option<&[f64]>,
    at: Option<f64>,
    told: Told<'_>,
) -> Result<Campbell, Refused> {
    check_time("at", at).map_err(refused)?;
    let Given { scene, chosen, .. } = given(program, asked)?;
    let what = campbell::asked(scene, by, points.max(2), orders, None).map_err(refused)?;
    let place = at.or((asked.start == Begin::Model).then_some(0.0));
    let all = what.points as f64;
    let each = |done: usize| told((done as f64 / all).min(1.0));
    campbell::followed(program, scene, &chosen, what, (place, &|t| asked.to(t)), &each).map_err(refused)
}

/// A picture of a run: `v over x`, `spectrum of x`, `orders of x over angle`, or a signal over time; other runs and
/// measurements in CSV files beside it. SVG.
///
/// # Errors
/// It cannot be drawn.
pub fn plot(
    program: &Program,
    asked: &Asked,
    picture: &str,
    others: &[PathBuf],
    told: Told<'_>,
) -> Result<String, Refused> {
    let Given { scene, chosen, .. } = given(program, asked)?;
    let drawing = Drawing::read(scene.description, picture).map_err(|fault| refused(format!("{picture}: {fault}")))?;
    let others = plot::others(others, scene.description).map_err(refused)?;
    for (name, run) in &others {
        drawing.check(run).map_err(|column| refused(format!("{name} has no column `{column}`")))?;
    }
    let own = own_values(scene, &program.models.scenes, &chosen.values).map_err(refused)?;
    let mut integration = asked.integration.clone();
    integration.step = integration.step.min(integration.t_end / plot::SAMPLES);
    let Ran { run: trajectory, failure, .. } = run(program, &Asked { integration, ..asked.clone() }, told)?;
    if let Some(failure) = failure {
        return Err(refused(format!("the run failed: {failure}")));
    }
    let others = others.iter().map(|(name, run)| (name.as_str(), run));
    let runs: Vec<(&str, &Recording)> = std::iter::once(("", &trajectory.recording)).chain(others).collect();
    drawing.plot(&scene.name, &runs, own.values()).drawn().map_err(refused)
}

/// What is written in JSON, as TOML.
///
/// # Errors
/// It is no JSON, or has what TOML has not.
pub fn toml_of_json(text: &str) -> Result<String, Refused> {
    let value: serde_json::Value = serde_json::from_str(text).map_err(refused)?;
    toml::to_string(&value).map_err(refused)
}

/// What a run is made of.
struct Given<'a> {
    scene: &'a Scene,
    chosen: Chosen,
    inputs: Vec<Named>,
}

fn given<'a>(program: &'a Program, asked: &Asked) -> Result<Given<'a>, Refused> {
    let scene = program.find_scene(asked.scene.as_deref()).map_err(Refused)?;
    let graph = program.models.graph().description;
    let mut chosen = Chosen::new(graph.parameters);
    for (name, &value) in &asked.set {
        parameters::set(&mut chosen, &format!("{name}={}", number(value)), name, value).map_err(refused)?;
    }
    let settings = settings(asked, graph.inputs)?;
    chosen.inputs = inputs::made(&settings);
    Ok(Given { scene, chosen, inputs: inputs::named(&settings, graph.inputs) })
}

/// What the inputs are set to.
fn settings(asked: &Asked, infos: &[InputInfo]) -> Result<Vec<Setting>, Refused> {
    let mut settings = inputs::settings(&asked.inputs, infos).map_err(refused)?;
    for (name, setting) in &asked.signals {
        inputs::set(&mut settings, (name, setting), infos).map_err(refused)?;
    }
    Ok(settings)
}
