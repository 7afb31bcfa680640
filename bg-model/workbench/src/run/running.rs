//! A run of a model: where it begins, how far it comes.
//!
//! In: a model, what is asked of the run, where it begins. Out: what it reached. The command line and a page make their
//! runs here.

use std::ops::ControlFlow;

use bg_model::run::{Request, RunError, State, Stopped, Trajectory};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::ask::machine::{Absent, Machine};
use bg_analysis::linear::{Equilibrium, LinearError};

/// A run, and why it stopped before its end, if it did.
pub struct Outcome {
    pub run: Trajectory,
    pub failure: Option<String>,
}

/// Where a run begins.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Begin {
    /// At the model's own start.
    #[default]
    Model,
    /// In this state, at its time.
    At(State),
    /// At the equilibrium near the model's own start, inputs as at t = 0.
    Equilibrium,
}

/// An unusable start.
#[derive(Debug, Error)]
pub enum BeginError {
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Linear(#[from] LinearError),
    #[error(transparent)]
    Absent(#[from] Absent),
}

impl Begin {
    /// The time at which the run begins, s.
    pub const fn time(&self) -> f64 {
        if let Self::At(state) = self { state.t } else { 0.0 }
    }

    /// The state that a run of `machine` begins in, where that is not its own start.
    ///
    /// # Errors
    /// The mechanism cannot be assembled, has no equilibrium or no such state.
    pub fn state(&self, machine: &dyn Machine) -> Result<Option<State>, BeginError> {
        let state = match self {
            Self::Model => None,
            Self::At(state) => Some(state.clone()),
            Self::Equilibrium => Some(at_rest(machine)?.0),
        };
        machine.start(state.as_ref())?;
        Ok(state)
    }
}

/// The equilibrium near the start, with the inputs as at t = 0, and how it was found.
///
/// # Errors
/// The mechanism cannot be assembled or has no equilibrium.
pub fn at_rest(machine: &dyn Machine) -> Result<(State, Equilibrium), BeginError> {
    let mut state = machine.start(None)?;
    let rest = machine.known("equilibria", machine.equilibrium(0.0, &state.values()))??;
    for ((_, value), at_rest) in state.states.iter_mut().zip(&rest.x) {
        *value = *at_rest;
    }
    Ok((state, rest))
}

/// The part of a run that is done at an instant, s, 0 to 1: of one from there until `t_end` (s).
pub fn part_done(from: &Begin, t_end: f64) -> impl Fn(f64) -> f64 + use<> {
    let t0 = from.time();
    move |t| (t - t0) / (t_end - t0)
}

/// What a run is told that goes on, or ends here.
pub const fn going_on(is: bool) -> ControlFlow<()> {
    if is { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Makes the run from the state `from`, or from the model's own start, and tells `told` the time reached, s, after each
/// step; where it breaks, the run ends. One that stops before its end is no error.
///
/// # Errors
/// The run cannot start.
pub fn follow(
    machine: &dyn Machine,
    request: Request,
    from: Option<&State>,
    mut told: impl FnMut(f64) -> ControlFlow<()>,
) -> Result<Outcome, RunError> {
    match machine.run(request, from, &mut told) {
        Ok(run) => Ok(Outcome { run, failure: None }),
        Err(RunError::Stopped(stopped)) => {
            let Stopped { cause, trajectory } = *stopped;
            Ok(Outcome { run: trajectory, failure: Some(cause.to_string()) })
        }
        Err(fault) => Err(fault),
    }
}
