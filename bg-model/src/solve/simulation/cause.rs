//! Why a run cannot go on, in the words of the system.
//!
//! In: a run where it stands. Out: a cause with its time, step, state and value.

use super::run::{Faulty, Run};
use crate::model::input;
use crate::solve::failure::{Cause, Quantity};
use crate::solve::integrator::first_not_finite;
use crate::solve::stepper::Stepper;

impl Run<'_> {
    /// Fails where a rate or a guard at the start of the next step is not finite.
    pub fn check_start(&self) -> Result<(), Cause> {
        match first_not_finite(self.stepper.start.rate.as_slice()) {
            Some(fault) => Err(self.not_finite(Quantity::Rate, fault, 0.0)),
            None => self.monitor.check_start().map_err(|guard| self.not_finite_monitored(Faulty::Guard(guard), 0.0)),
        }
    }

    /// Why no step from the start of the last attempt succeeds.
    pub fn lost(&self, error: f64) -> Cause {
        let Stepper { method, start, end, h, scale, .. } = &self.stepper;
        if let Some(faulty) = self.faulty {
            return self.not_finite_monitored(faulty, *h);
        }
        if !error.is_finite() {
            if let Some(fault) = method.faulty_rate() {
                return self.not_finite(Quantity::Rate, fault, *h);
            }
            if let Some(fault) = first_not_finite(end.x.as_slice()) {
                return self.not_finite(Quantity::State, fault, *h);
            }
            if let Some(fault) = first_not_finite(end.rate.as_slice()) {
                return self.not_finite(Quantity::Rate, fault, *h);
            }
            if let Some(fault) = self.stepper.faulty_derivative() {
                return self.not_finite(Quantity::Derivative, fault, 0.0);
            }
            if !self.controller.is_adaptive() {
                return Cause::NotSolved { t: start.t, h: *h };
            }
        }
        let index = if error.is_finite() {
            method.largest_error(start.borrowed(), scale, end.x.as_slice())
        } else {
            scale.fastest(start.borrowed())
        };
        let state = self.stepper.system.state_name(index);
        Cause::StepTooSmall { state, index, value: start.x[index], t: start.t, h: self.controller.step() }
    }

    /// What is monitored in a step of size `h` (s) is not finite.
    pub fn not_finite_monitored(&self, faulty: Faulty, h: f64) -> Cause {
        match faulty {
            Faulty::Guard(fault) => self.not_finite(Quantity::Guard, fault, h),
            Faulty::Condition(value) => Cause::Condition { value, t: self.stepper.start.t, h },
        }
    }

    fn not_finite(&self, quantity: Quantity, (index, value): (usize, f64), h: f64) -> Cause {
        let (name, origin) = match quantity {
            Quantity::Guard => (self.stepper.system.switch_name(index).unwrap_or_default(), None),
            Quantity::State | Quantity::Rate => (self.stepper.system.state_name(index), self.stepper.origin(0.0)),
            Quantity::Derivative => {
                // By time an input's derivative may be a difference.
                let reach = input::reach(self.stepper.start.t);
                (self.stepper.system.state_name(index), self.stepper.origin(reach))
            }
        };
        Cause::NonFinite { origin, quantity, name, index, value, t: self.stepper.start.t, h }
    }

    /// The first of `switches` finds no branch.
    pub fn accumulate(&self, switches: &[bool]) -> Cause {
        let switch = switches.iter().position(|switch| *switch).unwrap_or(0);
        let name = self.stepper.system.switch_name(switch).unwrap_or_default();
        Cause::EventsAccumulate { switch, name, t: self.stepper.start.t }
    }
}
