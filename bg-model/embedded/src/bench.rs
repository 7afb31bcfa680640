//! A bench in place of a machine: a motor on whose load a weight hangs, of which the observer does not know, and what
//! sensors make of it.

use bg_model::fixed_step::{FixedStep, NotFinite};
use bg_model::input::Input;
use bg_model::nalgebra::SVector;
use bg_model::system::Model;

use crate::{Fault, Machine, MachineInputs, MachineParameters, RATE};

const STATES: usize = Machine::STATES;
const SWITCHES: usize = Machine::SWITCHES;
const OUTPUTS: usize = Machine::OUTPUTS;

/// Steps of the machine between two samples.
const STEPS: u32 = 4;
/// The smallest change of the current that is seen, A.
const CURRENT_UNIT: f64 = 0.01;
/// The smallest change of the speed that is seen, rad/s.
const SPEED_UNIT: f64 = 0.5;

/// What is known of the machine at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Voltage until the next sample, V.
    pub voltage: f64,
    /// Current, A.
    pub current: f64,
    /// Speed of the rotor, rad/s.
    pub speed: f64,
}

/// A machine under test.
#[derive(Clone, Debug)]
pub struct Bench {
    machine: Machine,
    run: FixedStep<f64, STATES, SWITCHES>,
    samples: u32,
}

impl Bench {
    /// The machine at rest.
    ///
    /// # Errors
    /// Parameters that cannot be.
    pub fn new() -> Result<Self, Fault> {
        let parameters = MachineParameters { weight: 0.8 };
        let machine = Machine::new(parameters, MachineInputs::default())?;
        let run = FixedStep::new(&machine, &Model::start(&machine)?, 0.0, 1.0 / (RATE * f64::from(STEPS)))?;
        Ok(Self { machine, run, samples: 0 })
    }

    /// Current (A), speed of the rotor (rad/s), speed of the load (rad/s).
    pub fn outputs(&self) -> [f64; OUTPUTS] {
        let mut y = SVector::zeros();
        self.machine.outputs(self.run.time(), self.run.state(), self.run.negative(), &mut y);
        y.data.0[0]
    }

    /// What is measured now, with the voltage until the next sample, to whose time the machine moves on: 12 V, back and
    /// forth, with a pause of a quarter of a second in between.
    ///
    /// # Errors
    /// A state that would not be a finite number.
    pub fn sample(&mut self) -> Result<Measured, NotFinite> {
        let voltage = [12.0, 0.0, -12.0, 0.0][self.samples as usize / 250 % 4];
        let [current, speed, _] = self.outputs();
        let measured = Measured { voltage, current: seen(current, CURRENT_UNIT), speed: seen(speed, SPEED_UNIT) };
        self.machine.inputs_mut().voltage = Input::constant(voltage);
        (0..STEPS).try_for_each(|_| self.run.advance(&self.machine))?;
        self.samples += 1;
        Ok(measured)
    }
}

/// A number as whole units.
fn seen(value: f64, unit: f64) -> f64 {
    f64::from((value / unit) as i32) * unit
}
