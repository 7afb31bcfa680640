//! A scene's model with its parameters and inputs, whatever its type.
//!
//! In: a scene, values of all parameters, inputs. Out: the model as a trait object. Commands and pages ask it for runs
//! and linear models, so that they are compiled once, and not for each model.

use std::ops::ControlFlow;

use bg_analysis::linear::{Equilibrium, LinearError, StateSpace, equilibrium, linearise_at};
use bg_model::description::Description;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, MechanismVisitor, ModelVisitor, Scenes};
use bg_model::nalgebra::SVector;
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::run::{Request, RunError, Simulation, State, Trajectory};
use bg_model::system::{Model, branches};
use thiserror::Error;

use crate::scenes::{Fixed, Scene, own_parameters};

/// A model that can be run and linearised.
pub trait Machine {
    /// What it consists of.
    fn description(&self) -> &'static Description;

    /// The state that a run starts from: `from`, or without one its own start.
    ///
    /// # Errors
    /// The start cannot be assembled, or the state is not one of this model.
    fn start(&self, from: Option<&State>) -> Result<State, RunError>;

    /// Makes a run from there, and tells `told` the time reached, s, after each step.
    ///
    /// # Errors
    /// As [`Machine::start`], or the run stops before its end.
    fn run(&self, request: Request, from: Option<&State>, told: &mut dyn FnMut(f64)) -> Result<Trajectory, RunError>;

    /// The equilibrium near the state `guess`, with the inputs as at `t` (s).
    ///
    /// # Errors
    /// There is none.
    fn equilibrium(&self, t: f64, guess: &[f64]) -> Result<Equilibrium, LinearError>;

    /// The linear model in `state`, one of this model, in the branches of its switches that are known there.
    ///
    /// # Errors
    /// There is none.
    fn linearised(&self, state: &State) -> Result<StateSpace, LinearError>;

    /// What pictures show at `t` (s) and the state `x`: a value for each result of the drawing.
    fn shown(&self, t: f64, x: &[f64]) -> Vec<f64>;
}

impl<Me: Mechanism> Machine for Me {
    fn description(&self) -> &'static Description {
        Me::describe()
    }

    fn start(&self, from: Option<&State>) -> Result<State, RunError> {
        simulation(self, Request::default(), from).start()
    }

    fn run(&self, request: Request, from: Option<&State>, told: &mut dyn FnMut(f64)) -> Result<Trajectory, RunError> {
        let each_step = |t| {
            told(t);
            ControlFlow::Continue(())
        };
        simulation(self, request, from).each_step(each_step).run()
    }

    fn equilibrium(&self, t: f64, guess: &[f64]) -> Result<Equilibrium, LinearError> {
        equilibrium(self, t, guess)
    }

    fn linearised(&self, state: &State) -> Result<StateSpace, LinearError> {
        linearise_at(self, state)
    }

    fn shown(&self, t: f64, x: &[f64]) -> Vec<f64> {
        self.visit::<f64, _>(Shown { t, x })
    }
}

fn simulation<'a>(machine: &impl Mechanism, request: Request, from: Option<&State>) -> Simulation<'a> {
    let simulation = Simulation::of(machine, request);
    match from {
        Some(state) => simulation.from(state),
        None => simulation,
    }
}

/// What is shown of a model at one moment.
struct Shown<'a> {
    t: f64,
    x: &'a [f64],
}

impl ModelVisitor<f64> for Shown<'_> {
    type Output = Vec<f64>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Vec<f64>
    where
        Mo: Model<f64, N, G, M>,
    {
        let x = SVector::from_column_slice(self.x);
        let mut values = Vec::new();
        model.shown(self.t, &x, &branches(model, self.t, &x), &mut values);
        values
    }
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

/// What a model is made of.
#[derive(Clone, Copy)]
pub struct Making<'a, P> {
    /// The scene.
    pub scene: &'a Scene,
    /// The models of its mechanism.
    pub scenes: &'a [Scene],
    /// Values of all parameters.
    pub values: &'a P,
    /// The inputs in the order of the description.
    pub inputs: &'a [Input],
}

impl<P: Parameters> Making<'_, P> {
    /// The model, of a mechanism with these parameters.
    ///
    /// # Errors
    /// [`MachineError`].
    pub fn made<Me: Scenes<Parameters = P>>(self) -> Result<Box<dyn Machine>, MachineError> {
        Me::model(self.scene.index, self)
    }
}

impl<P: Parameters> MechanismVisitor for Making<'_, P> {
    type Output = Result<Box<dyn Machine>, MachineError>;

    fn visit<Sc: Mechanism + 'static>(self) -> Self::Output {
        let own = own_parameters(self.scene, self.scenes, self.values)?;
        Ok(Box::new(Sc::make(own, self.inputs)?))
    }
}
