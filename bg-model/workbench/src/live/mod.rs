//! A page that runs its model again: what it asks for, and what it is answered.
//!
//! In: an [`Order`] as JSON. Out: JSON again: what the page shows of the run, or why there is none. The report that
//! `report --live` writes has the program inside, compiled for WebAssembly; there [`Program::main`] registers what
//! answers. The same function answers natively, so that a test can hold one against the other, byte for byte.
//!
//! Compiled for WebAssembly a program has the modules below and no others: no command line, no files, no figures. Of
//! the mechanism's scenes it has the one whose number the variable `BG_LIVE_MODEL` says at its build, as
//! [`Scenes::only`](bg_model::mechanism::Scenes::only) counts them.

#[cfg(not(target_arch = "wasm32"))]
mod module;

use bg_model::description::{Description, ParameterInfo};
use bg_model::input::{Input, TableError};
use bg_model::parameters::ParameterError;
use bg_model::run::{RunError, sample_times};
use bg_model::simulation::{MissingColumn, Part};
use serde::Serialize;
use thiserror::Error;

use crate::ask::inputs::{Named, Setting, named};
use crate::ask::machine::MachineError;
use crate::ask::parameters::{Values, number};
use crate::ask::request::{Integration, RequestError};
use crate::ask::scenes::Scene;
use crate::program::Program;
use crate::run::running::{BeginError, Outcome, follow, going_on, part_done};
use crate::run::summary::{Check, Summary};
use crate::show::page::film::Film;
#[cfg(not(target_arch = "wasm32"))]
use crate::show::page::page;
use crate::show::page::{Balance, Bonds, Data, Parameter, Report, page_beside};
use crate::show::picture::Drawn;

#[cfg(not(target_arch = "wasm32"))]
pub use module::{Module, ModuleError};

pub use crate::show::page::order::{Live, Order};

/// A run that was not made.
#[derive(Debug, Error)]
enum Refusal {
    #[error("the order cannot be read: {0}")]
    Order(#[from] serde_json::Error),
    #[error("the model inside is not that of the scene `{0}`")]
    Scene(String),
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    #[error(transparent)]
    Model(#[from] MachineError),
    #[error(transparent)]
    Input(#[from] TableError),
    #[error("{} {}: {}", .0.field, number(.0.value), .0.fault)]
    Request(#[from] RequestError),
    #[error(transparent)]
    Begin(#[from] BeginError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Column(#[from] MissingColumn),
}

/// What a page is answered.
#[derive(Serialize)]
#[serde(untagged)]
enum Answer {
    Refused { fault: String },
    Run(Box<Shown>),
}

/// What a page shows of a run. Nothing in it depends on the clock.
#[derive(Serialize)]
struct Shown {
    /// Why the run stopped before its end, if it did.
    failure: Option<String>,
    /// Charts, energy balance, animation.
    data: Data,
    /// Effort and flow of the bonds.
    bonds: Option<Bonds>,
    /// Which samples the charts show, in words.
    note: String,
    /// What the energy balance says.
    balance: Option<String>,
    /// Names and texts of the summary.
    lines: Vec<(String, String)>,
    /// Statements about the run.
    checks: Vec<Check>,
}

/// The answer to the order `text`, JSON both. In WebAssembly there is an answer for the one scene that the module is
/// built for.
#[must_use]
pub fn answer(program: &Program, text: &str) -> String {
    let shown = |order: Order| Ok(made(program, &order, &|_| true)?.shown()?);
    told(serde_json::from_str(text).map_err(Refusal::from).and_then(shown))
}

/// The report of the run that the order asks for, HTML for a frame of a page that has `report.css`, `beside.js` and
/// `report.js` of this package beside it, and runs the model again when the report's sliders are moved.
///
/// # Errors
/// Why there is no such run: a sentence.
pub fn report(program: &Program, order: &Order) -> Result<String, String> {
    paged(program, order, &|_| true, |report| page_beside(report, Some(order)))
}

/// The same in one file with all that it needs, without sliders; `told` is asked after each step, with the part that is
/// done, whether to go on.
///
/// # Errors
/// Why there is no such run: a sentence.
#[cfg(not(target_arch = "wasm32"))]
pub fn whole_report(program: &Program, order: &Order, told: &dyn Fn(f64) -> bool) -> Result<String, String> {
    paged(program, order, told, page)
}

/// The page of the run that the order asks for, as `page` writes it.
fn paged(
    program: &Program,
    order: &Order,
    told: &dyn Fn(f64) -> bool,
    page: impl FnOnce(&Report<'_>) -> String,
) -> Result<String, String> {
    let paged = || {
        let drawing = Drawn::begun(asked(program, order)?.description);
        Ok(made(program, order, told)?.page(drawing, page)?)
    };
    paged().map_err(|refusal: Refusal| refusal.to_string())
}

/// The scene that an order asks for.
fn asked<'a>(program: &'a Program, order: &Order) -> Result<&'a Scene, Refusal> {
    let models = &program.models;
    let scene = models.named(&order.scene).filter(|scene| models.maker().has(scene.index));
    scene.ok_or_else(|| Refusal::Scene(order.scene.clone()))
}

#[cfg(target_arch = "wasm32")]
impl Program {
    /// In WebAssembly there are no arguments: the program answers a page from then on.
    pub fn main(self, arguments: impl IntoIterator<Item = std::ffi::OsString>) -> std::process::ExitCode {
        drop(arguments);
        bg_live::register(move |text| answer(&self, text));
        std::process::ExitCode::SUCCESS
    }
}

fn told(outcome: Result<Shown, Refusal>) -> String {
    let answer = match outcome {
        Ok(shown) => Answer::Run(Box::new(shown)),
        Err(refusal) => Answer::Refused { fault: refusal.to_string() },
    };
    serde_json::to_string(&answer).expect("an answer has text keys only")
}

/// A run that was asked for.
struct Made<'a> {
    program: &'a Program,
    scene: &'a Scene,
    outcome: Outcome,
    /// What can be seen of it.
    film: Film,
    /// When the rows of its CSV file are, s.
    rows: Vec<f64>,
    /// The parameters of the graph.
    values: Values,
    inputs: Vec<Named>,
}

/// Runs a scene as it is asked for; `told` is asked after each step, with the part that is done, whether to go on.
fn made<'a>(program: &'a Program, order: &Order, told: &dyn Fn(f64) -> bool) -> Result<Made<'a>, Refusal> {
    let models = &program.models;
    let scene = asked(program, order)?;
    let mut values = models.defaults();
    order.parameters.iter().try_for_each(|(name, value)| values.set(name, *value))?;
    let inputs: Vec<Input> = order.inputs.iter().map(Setting::input).collect::<Result<_, _>>()?;
    let machine = models.made(scene, &values, &inputs)?;
    let Integration { t_end, step, .. } = order.integration;
    let t0 = order.begin.time();
    let mut request = order.integration.request(t0, Some(program.extras.finest(t_end)))?;
    request.settled = program.extras.settled();
    request.parts.push(Part::Shown);
    let from = order.begin.state(&*machine)?;
    let part = part_done(&order.begin, t_end);
    let mut outcome = follow(&*machine, request, from.as_ref(), |t| going_on(told(part(t))))?;
    Ok(Made {
        program,
        scene,
        film: Film::taken(scene.description, &mut outcome.run),
        outcome,
        rows: sample_times(t0, step, t_end),
        values,
        inputs: named(&order.inputs, models.graph().description.inputs),
    })
}

impl Made<'_> {
    /// The run in numbers.
    fn summary(&self) -> Result<Summary, MissingColumn> {
        let Outcome { run, failure } = &self.outcome;
        let mut summary = Summary::new(&self.scene.name, run, failure.clone(), self.program.extras.additions(run)?);
        // WebAssembly has no clock, and the same run gives the same bytes.
        summary.wall_time_s = 0.0;
        summary.program = self.program.texts.name_and_version();
        summary.changed_parameters = changed(self.values.all());
        summary.inputs.clone_from(&self.inputs);
        Ok(summary)
    }

    /// What a page shows of it.
    fn shown(&self) -> Result<Shown, MissingColumn> {
        let Self { film, outcome: Outcome { run, .. }, rows, .. } = self;
        let description: &'static Description = self.scene.description;
        let animation = film.animation().filter(|animation| !animation.times.is_empty());
        let data = Data::new(description, run, rows, animation.as_ref(), None);
        let summary = self.summary()?;
        let lines = summary.lines().into_iter();
        Ok(Shown {
            note: data.note(run.times.len(), rows.iter().filter(|&&row| row <= summary.reached_s).count()),
            data,
            bonds: Bonds::new(description.bonds, &film.picture(String::new())),
            balance: Balance::of(description, run).map(|balance| balance.sentence()),
            lines: lines.map(|(name, text)| (name.to_owned(), text)).collect(),
            failure: summary.failure.clone(),
            checks: summary.checks,
        })
    }

    /// It as a page, with the graph as it is drawn.
    fn page(&self, drawing: Drawn, page: impl FnOnce(&Report<'_>) -> String) -> Result<String, MissingColumn> {
        let Self { program, scene, outcome: Outcome { run, .. }, film, rows, values, .. } = self;
        let rows = run.at(rows).times;
        let report = Report {
            texts: &program.page(scene.description),
            description: scene.description,
            scene: &scene.summary(),
            parameters: &Parameter::all(values, |name| program.extras.source(name)),
            summary: &self.summary()?,
            run,
            rows: &rows,
            figures: &[],
            others: &[],
            drawings: &[],
            views: &film.views(None, drawing.svg()),
            live: None,
        };
        Ok(page(&report))
    }
}

/// Those of the parameters that are not at their defaults, as `name = value unit`.
pub(crate) fn changed<'a>(values: impl Iterator<Item = (&'a ParameterInfo, f64)>) -> Vec<String> {
    let text = |(info, value): (&ParameterInfo, f64)| {
        format!("{} = {} {}", info.name, number(value), info.unit).trim_end().to_owned()
    };
    values.filter(|(info, value)| *value != info.default).map(text).collect()
}
