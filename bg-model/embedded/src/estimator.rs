//! The observer: a model that moves on by one step with each sample.

use bg_model::fixed_step::{FixedStep, NotFinite};
use bg_model::input::Input;
use bg_model::nalgebra::SVector;
use bg_model::scalar::Scalar;
use bg_model::system::Model;

use crate::{Drive, DriveInputs, DriveParameters, Fault, Measured, RATE};

const STATES: usize = Drive::STATES;
const SWITCHES: usize = Drive::SWITCHES;
const OUTPUTS: usize = Drive::OUTPUTS;

/// An observer that calculates in `S`.
#[derive(Clone, Debug)]
pub struct Estimator<S: Scalar<Switch = bool>> {
    model: Drive<S>,
    run: FixedStep<S, STATES, SWITCHES>,
}

impl<S: Scalar<Switch = bool>> Estimator<S> {
    /// An observer of a machine that these parameters describe, at rest.
    ///
    /// # Errors
    /// Parameters that cannot be.
    pub fn new(parameters: DriveParameters) -> Result<Self, Fault> {
        let model = Drive::in_scalar(parameters, DriveInputs::default())?;
        let run = FixedStep::new(&model, &Model::start(&model)?, 0.0, 1.0 / RATE)?;
        Ok(Self { model, run })
    }

    /// Takes a sample and moves on to the time of the next one. Allocates nothing.
    ///
    /// # Errors
    /// A state that would not be a finite number: the observer stays as it was.
    pub fn sample(&mut self, measured: &Measured) -> Result<(), NotFinite> {
        let inputs = self.model.inputs_mut();
        inputs.voltage = Input::constant(measured.voltage);
        inputs.current = Input::constant(measured.current);
        inputs.speed = Input::constant(measured.speed);
        self.run.advance(&self.model)
    }

    /// All states, as `Drive` has them.
    pub fn state(&self) -> &SVector<S, STATES> {
        self.run.state()
    }

    /// Current (A), speed of the rotor (rad/s), twist (rad), speed of the load (rad/s).
    pub fn outputs(&self) -> [S; OUTPUTS] {
        let mut y = SVector::repeat(S::from_f64(0.0));
        self.model.outputs(S::from_f64(self.run.time()), self.run.state(), self.run.negative(), &mut y);
        y.data.0[0]
    }
}
