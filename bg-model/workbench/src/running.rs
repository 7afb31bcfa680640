//! A run of a model: where it begins, how far it comes.
//!
//! In: a model, what is asked of the run, where it begins. Out: what it reached. The command line and a page make their runs here.

use std::ops::ControlFlow;

use bg_model::mechanism::Mechanism;
use bg_model::run::{Request, RunError, Simulation, State, Stopped, Trajectory};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::linear::{LinearError, equilibrium};

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

/// A start that is none.
#[derive(Debug, Error)]
pub enum BeginError {
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Linear(#[from] LinearError),
}

impl Begin {
    /// The time at which the run begins, s.
    pub const fn time(&self) -> f64 {
        if let Self::At(state) = self { state.t } else { 0.0 }
    }

    /// The run of `model` that begins here.
    ///
    /// # Errors
    /// The mechanism cannot be assembled, has no equilibrium or no such state.
    pub fn simulation<'a, Sc: Mechanism>(
        &self,
        model: &'a Sc,
        request: Request,
    ) -> Result<Simulation<'a, Sc>, BeginError> {
        let simulation = Simulation::of(model, request);
        let simulation = match self {
            Self::Model => simulation,
            Self::At(state) => simulation.from(state),
            Self::Equilibrium => simulation.from(&at_rest(model)?),
        };
        simulation.start()?;
        Ok(simulation)
    }
}

/// The equilibrium near the start, with the inputs as at t = 0.
fn at_rest<Sc: Mechanism>(model: &Sc) -> Result<State, BeginError> {
    let mut state = Simulation::new(model).start()?;
    let guess: Vec<f64> = state.states.iter().map(|(_, value)| *value).collect();
    let rest = equilibrium(model, 0.0, &guess)?;
    for ((_, value), at_rest) in state.states.iter_mut().zip(rest.x) {
        *value = at_rest;
    }
    Ok(state)
}

/// Makes the run and tells `told` the time reached, s, after each step. One that stops before its end is no error.
///
/// # Errors
/// The run cannot start.
pub fn follow<Sc: Mechanism>(simulation: Simulation<'_, Sc>, mut told: impl FnMut(f64)) -> Result<Outcome, RunError> {
    let each_step = |t| {
        told(t);
        ControlFlow::Continue(())
    };
    match simulation.each_step(each_step).run() {
        Ok(run) => Ok(Outcome { run, failure: None }),
        Err(RunError::Stopped(stopped)) => {
            let Stopped { cause, trajectory } = *stopped;
            Ok(Outcome { run: trajectory, failure: Some(cause.to_string()) })
        }
        Err(fault) => Err(fault),
    }
}
