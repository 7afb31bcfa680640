//! One point of a work-precision diagram: a case run by an integrator at a tolerance, again and again.
//!
//! In: case, integrator, tolerance or step. Out: its true errors against the reference and what it cost. Times are of
//! the run with the outputs at the reference's instants, without the building of the model.

use std::ops::ControlFlow;

use bg_model::integrator::Integrator;
use bg_model::run::{Request, RunError, Trajectory};
use bg_model::simulation::{Recording, Samples};
use bg_model::statistics::Statistics;
use serde::Serialize;
use thiserror::Error;

use super::case::{Case, CaseError};
use super::errors::{Errors, Incomparable};
use crate::ask::machine::Machine;
use crate::ask::scenes::Models;
use crate::run::running::{Outcome, follow};

/// How exact a run is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// Tolerances.
    Tolerance {
        /// Relative.
        rtol: f64,
        /// Absolute, in each state's SI unit; none where the sizes of the states give it.
        atol: Option<f64>,
    },
    /// The step, s, of a fixed-step method.
    Step(f64),
}

/// A point of the diagram.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// The case.
    pub case: String,
    /// The integrator.
    pub integrator: String,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// Absolute tolerance, SI; none where the sizes of the states give it.
    pub atol: Option<f64>,
    /// The step of a fixed-step method, s.
    pub fixed_step_s: Option<f64>,
    /// The errors; nothing where the run failed.
    pub errors: Option<Errors>,
    /// Why it failed.
    pub failure: Option<String>,
    /// The least wall time of the repeats, s.
    pub wall_minimum_s: f64,
    /// The median of the wall times, s.
    pub wall_median_s: f64,
    /// The number of repeats.
    pub repeats: usize,
    /// What a run cost in counts, which do not depend on the machine.
    pub counts: Counts,
}

/// Work in counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the rate.
    pub rates: u64,
    /// Orders of Taylor series.
    pub orders: u64,
    /// Evaluations of the Jacobian.
    pub jacobians: u64,
    /// Factorisations.
    pub factorisations: u64,
    /// Those of them with row exchanges.
    pub pivoted: u64,
    /// Switching events.
    pub events: u64,
}

impl From<&Statistics> for Counts {
    fn from(statistics: &Statistics) -> Self {
        Self {
            steps: statistics.steps,
            rejected: statistics.rejected,
            rates: statistics.rate_evaluations,
            orders: statistics.series_orders,
            jacobians: statistics.jacobian_evaluations,
            factorisations: statistics.factorisations,
            pivoted: statistics.pivoted_factorisations,
            events: statistics.events,
        }
    }
}

/// A case that cannot be measured.
#[derive(Debug, Error)]
pub enum MeasureError {
    /// It cannot be built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// It cannot be started.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The run does not fit the reference.
    #[error(transparent)]
    Incomparable(#[from] Incomparable),
}

/// After so many seconds a point is not run again.
const ENOUGH: f64 = 2.0;

/// Runs `case` `repeats` times, or for two seconds, and holds it against `reference`.
///
/// # Errors
/// The case cannot be built; a run that fails is no error here.
pub fn measure(
    case: &Case,
    models: &Models,
    integrator: Integrator,
    setting: Setting,
    repeats: usize,
    reference: &Recording,
) -> Result<Entry, MeasureError> {
    let repeats = repeats.max(1);
    let scene = case.scene(&models.scenes);
    let request = request(integrator, setting, reference);
    let mut runs = Vec::with_capacity(repeats);
    let mut first = None;
    for _ in 0..repeats {
        let (run, failure) = once(&*case.machine(models)?, &request)?;
        runs.push(run.wall.as_secs_f64());
        first.get_or_insert((run, failure));
        if runs.iter().sum::<f64>() > ENOUGH {
            break;
        }
    }
    let repeats = runs.len();
    runs.sort_unstable_by(f64::total_cmp);
    let (run, failure) = first.expect("there is a run");
    let outputs = scene.description.outputs;
    let errors = if failure.is_none() { Some(Errors::between(&run, reference, outputs)?) } else { None };
    let (rtol, atol, step) = match setting {
        Setting::Tolerance { rtol, atol } => (Some(rtol), atol, None),
        Setting::Step(step) => (None, None, Some(step)),
    };
    Ok(Entry {
        case: case.name.clone(),
        integrator: integrator.name().to_owned(),
        rtol,
        atol,
        fixed_step_s: step,
        errors,
        failure,
        wall_minimum_s: runs[0],
        wall_median_s: runs[runs.len() / 2],
        repeats,
        counts: Counts::from(&run.statistics),
    })
}

/// A run at the reference's instants.
fn request(method: Integrator, setting: Setting, reference: &Recording) -> Request {
    /// More than any method needs that is worth its time.
    const LIMIT: u64 = 20_000_000;
    let plain = Request::default();
    // Each kind of method takes one of them.
    let (rtol, atol, fixed_step) = match setting {
        Setting::Tolerance { rtol, atol } => (rtol, atol, plain.fixed_step),
        Setting::Step(step) => (plain.rtol, None, step),
    };
    let t_end = reference.times.last().copied().unwrap_or(0.0);
    let samples = Samples::At(reference.times.clone());
    Request { method, fixed_step, t_end, rtol, atol, samples, step_limit: LIMIT, ..plain }
}

/// One run; where it fails what it reached, and why.
fn once(machine: &dyn Machine, request: &Request) -> Result<(Trajectory, Option<String>), RunError> {
    let Outcome { run, failure } = follow(machine, request.clone(), None, |_| ControlFlow::Continue(()))?;
    Ok((run, failure))
}
