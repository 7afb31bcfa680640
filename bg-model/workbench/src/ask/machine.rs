//! A model with its parameters and inputs, whatever its type.
//!
//! In: what a command or a page asks. Out: runs, linear models, derivatives, of a trait object: commands are compiled
//! once, and not for each model.

use std::ops::ControlFlow;
use std::rc::Rc;

#[cfg(not(target_arch = "wasm32"))]
use bg_analysis::criterion::of_run::{Found, Look, Slopes};
#[cfg(not(target_arch = "wasm32"))]
use bg_analysis::identify::identify;
use bg_analysis::identify::{Data, Identified, IdentifyError, Variable};
#[cfg(not(target_arch = "wasm32"))]
use bg_analysis::linear::linearise_at;
use bg_analysis::linear::{Equilibrium, LinearError, StateSpace, equilibrium};
#[cfg(not(target_arch = "wasm32"))]
use bg_analysis::optimize::{Job, Minimum, OptimizeError, Task, Trial, minimum};
use bg_model::description::Description;
use bg_model::dynamics::{self, branches};
use bg_model::extended::Accuracy;
use bg_model::mechanism::{Accompanied, Differentiable, Followed, Liftable, Reversible};
use bg_model::parameters::ParameterError;
#[cfg(not(target_arch = "wasm32"))]
use bg_model::run::in_lanes;
use bg_model::run::{LaneError, Request, RunError, Simulation, State, Trajectory};
use bg_model::scalar::DoubleDouble;
use bg_model::sensitivity::{Gradients, Objective, Sensitivities, SensitivityError};
#[cfg(not(target_arch = "wasm32"))]
use bg_model::sensitivity::{directions, gradient, sensitivities};
use thiserror::Error;

#[cfg(not(target_arch = "wasm32"))]
use crate::ask::reference::solve;
use crate::ask::reference::{ReferenceError, Solution};
use crate::ask::scenes::Fixed;

/// A model that can be run. What gives an `Option` is `None` where the model has not got it, which is so unless it is
/// written.
pub trait Machine {
    /// It over slices.
    fn model(&self) -> Rc<dyn dynamics::Machine>;

    /// The equilibrium near the state `guess`, with the inputs as at `t` (s).
    ///
    /// # Errors
    /// There is none.
    fn equilibrium(&self, _t: f64, _guess: &[f64]) -> Option<Result<Equilibrium, LinearError>> {
        None
    }

    /// The linear model in `state`, one of this model, in the branches of its switches that are known there.
    ///
    /// # Errors
    /// There is none.
    fn linearised(&self, _state: &State) -> Option<Result<StateSpace, LinearError>> {
        None
    }

    /// A run from its own start with the derivatives of all outputs by the parameters called `by`.
    ///
    /// # Errors
    /// The run cannot be made, or has no derivatives; no parameter has such a name.
    fn sensitivities(&self, _request: &Request, _by: &[&str]) -> Option<Result<Sensitivities, SensitivityError>> {
        None
    }

    /// The derivatives of one number of a run from its own start by the parameters called `by`, by the run followed
    /// backwards.
    ///
    /// # Errors
    /// As [`Machine::sensitivities`].
    fn gradient(
        &self,
        _request: &Request,
        _objective: &Objective<'_>,
        _by: &[&str],
    ) -> Option<Result<Gradients, SensitivityError>> {
        None
    }

    /// The `variables` with which it comes nearest to `data`, the other parameters as they are. `told` is told of each
    /// run the variables' values and the root of the mean square of what is left, in parts of the noise.
    ///
    /// # Errors
    /// As [`bg_analysis::identify::identify`].
    fn identified(
        &self,
        _request: &Request,
        _data: &Data,
        _variables: &[Variable],
        _told: &mut dyn FnMut(&[f64], f64),
    ) -> Option<Result<Identified, IdentifyError>> {
        None
    }

    /// What is known of a run from its own start for some criteria, with the slopes of these by the parameters called
    /// `by`.
    ///
    /// # Errors
    /// As [`Machine::sensitivities`].
    #[cfg(not(target_arch = "wasm32"))]
    fn looked(
        &self,
        _look: &Look,
        _request: &Request,
        _by: &[&str],
    ) -> Option<Result<(Found, Slopes), SensitivityError>> {
        None
    }

    /// What a search for the optimum that `job` asks for has found; `told` is told of each run, and says whether it
    /// goes on.
    ///
    /// # Errors
    /// As [`bg_analysis::optimize::minimum`].
    #[cfg(not(target_arch = "wasm32"))]
    fn minimum(
        &self,
        _task: &Task,
        _job: &Job,
        _told: &mut dyn FnMut(&Trial) -> ControlFlow<()>,
    ) -> Option<Result<Minimum, OptimizeError>> {
        None
    }

    /// Its outputs at `instants` (s, ascending, from 0 on) as exactly as `accuracy` says: a solution that runs are
    /// measured against.
    ///
    /// # Errors
    /// As [`solve`].
    fn solution(&self, _accuracy: Accuracy, _instants: &[f64]) -> Option<Result<Solution, ReferenceError>> {
        None
    }

    /// A run from its own start with each of these values of its own parameters, the inputs as they are, side by side
    /// where that is possible: each the same to the bit as by itself.
    fn in_lanes(&self, _request: &Request, _own: &[Vec<f64>]) -> Option<Vec<Result<Trajectory, LaneError>>> {
        None
    }
}

impl dyn Machine + '_ {
    /// What it consists of.
    #[must_use]
    pub fn description(&self) -> &'static Description {
        self.model().description()
    }

    /// The state that a run starts from: `from`, or without one its own start.
    ///
    /// # Errors
    /// The start cannot be assembled, or the state is not one of this model.
    pub fn start(&self, from: Option<&State>) -> Result<State, RunError> {
        self.simulation(Request::default(), from).start()
    }

    /// Makes a run from there, and tells `told` the time reached, s, after each step; where it breaks, the run ends.
    ///
    /// # Errors
    /// As for its start, or the run stops before its end.
    pub fn run(
        &self,
        request: Request,
        from: Option<&State>,
        told: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Trajectory, RunError> {
        self.simulation(request, from).each_step(told).run()
    }

    /// What pictures show at `t` (s) and the state `x`: a value for each result of the drawing.
    #[must_use]
    pub fn shown(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let model = &*self.model();
        let mut values = Vec::new();
        model.shown(t, x, &branches(model, t, x), &mut values);
        values
    }

    /// `found`, which there may be none of; `what` it is, in words.
    ///
    /// # Errors
    /// It is not there.
    pub(crate) fn known<T>(&self, what: &'static str, found: Option<T>) -> Result<T, Absent> {
        found.ok_or_else(|| Absent { what, model: self.description().name })
    }

    fn simulation<'a>(&self, request: Request, from: Option<&State>) -> Simulation<'a> {
        let simulation = Simulation::over(self.model(), request);
        match from {
            Some(state) => simulation.from(state),
            None => simulation,
        }
    }
}

/// A model, compiled or loaded, of which all is known that a machine is asked; gradients and runs side by side where it
/// has them.
pub struct Studied<Mo> {
    model: Mo,
    over_slices: Rc<dyn dynamics::Machine>,
    reversible: Option<fn(&Mo) -> &dyn Reversible>,
    accompanied: Option<fn(&Mo) -> &dyn Accompanied>,
}

impl<Mo: Differentiable> Studied<Mo> {
    /// That of `model`, without gradients and runs side by side.
    pub fn new(model: Mo) -> Self {
        Self { over_slices: model.machine(), model, reversible: None, accompanied: None }
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl<Mo: Reversible> Studied<Mo> {
    /// That of `model`, with gradients.
    pub fn reversible(model: Mo) -> Self {
        Self { reversible: Some(|model| model), ..Self::new(model) }
    }

    /// That of `model`, with all.
    pub fn complete(model: Mo) -> Self
    where
        Mo: Accompanied,
    {
        Self { accompanied: Some(|model| model), ..Self::reversible(model) }
    }
}

/// A page asks a model for its runs and its equilibrium: what else it could be asked is not compiled there.
impl<Mo: Followed + Liftable<DoubleDouble>> Machine for Studied<Mo> {
    fn model(&self) -> Rc<dyn dynamics::Machine> {
        Rc::clone(&self.over_slices)
    }

    fn equilibrium(&self, t: f64, guess: &[f64]) -> Option<Result<Equilibrium, LinearError>> {
        Some(equilibrium(&self.model, t, guess))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn linearised(&self, state: &State) -> Option<Result<StateSpace, LinearError>> {
        Some(linearise_at(&self.model, state))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn sensitivities(&self, request: &Request, by: &[&str]) -> Option<Result<Sensitivities, SensitivityError>> {
        let directions = directions(self.model.description(), by).map_err(Into::into);
        Some(directions.and_then(|by| sensitivities(&self.model, request, &by)))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn gradient(
        &self,
        request: &Request,
        objective: &Objective<'_>,
        by: &[&str],
    ) -> Option<Result<Gradients, SensitivityError>> {
        let model = self.reversible?(&self.model);
        let directions = directions(model.description(), by).map_err(Into::into);
        Some(directions.and_then(|by| gradient(model, request, objective, &by)))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn identified(
        &self,
        request: &Request,
        data: &Data,
        variables: &[Variable],
        told: &mut dyn FnMut(&[f64], f64),
    ) -> Option<Result<Identified, IdentifyError>> {
        Some(identify(&self.model, request, data, variables, told))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn looked(&self, look: &Look, request: &Request, by: &[&str]) -> Option<Result<(Found, Slopes), SensitivityError>> {
        let made = || {
            let (values, by) = (self.model.values(), directions(self.model.description(), by)?);
            let found = look.run(&*self.over_slices, &values, request)?;
            let slopes = look.slopes(&self.model, &values, request, &by, &found)?;
            Ok((found, slopes))
        };
        Some(made())
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn minimum(
        &self,
        task: &Task,
        job: &Job,
        told: &mut dyn FnMut(&Trial) -> ControlFlow<()>,
    ) -> Option<Result<Minimum, OptimizeError>> {
        Some(minimum(&self.model, task, job, told))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn solution(&self, accuracy: Accuracy, instants: &[f64]) -> Option<Result<Solution, ReferenceError>> {
        Some(solve(&self.model, accuracy, instants, &|_| true))
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn in_lanes(&self, request: &Request, own: &[Vec<f64>]) -> Option<Vec<Result<Trajectory, LaneError>>> {
        Some(in_lanes(self.accompanied?(&self.model), request, own))
    }
}

/// What a model has not got.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{model}` was made without {what}; a program that is compiled with `bond_graph!` has them")]
pub struct Absent {
    what: &'static str,
    model: &'static str,
}

/// A model that there is not.
#[derive(Debug, Error)]
pub enum MachineError {
    /// The scene keeps a parameter at another value.
    #[error(transparent)]
    Fixed(#[from] Fixed),
    /// The parameters cannot be.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
}
