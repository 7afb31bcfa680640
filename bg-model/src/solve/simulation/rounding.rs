//! Whether rounding, and not the method, makes the error of the steps.
//!
//! In: accepted steps. Out: how many of them have tolerances below rounding. The error estimate of an explicit method
//! is a sum of rates times the step. Where forces are differences of nearly equal states (stiff joints), rounding of
//! the states changes the rates so much that the estimate exceeds a tight tolerance: the steps become shorter, and the
//! result no better.

use alloc::vec;

use super::sizes::SizeMonitor;
use crate::solve::integrator::{Method, StepControl, rounding};
use crate::solve::stepper::Stepper;

/// Above this relative tolerance rounding makes nothing of a step's error: at most 1.5e-2 of what is allowed was
/// measured at 1e-9.
const LOOSEST: f64 = 1e-10;
/// Accepted steps from one look to the next.
const WAIT: u64 = 64;
/// The error estimate of explicit methods is two to four times the step times the change of the rate.
const ESTIMATE: f64 = 4.0;

/// Looks at the rounding now and then.
#[derive(Clone, Debug, Default)]
pub(super) struct RoundingMonitor {
    /// Whether rounding was above the tolerances at the last look.
    is_above: bool,
}

impl RoundingMonitor {
    /// None where the tolerances are far above rounding.
    pub fn new(relative: f64) -> Option<Self> {
        may_matter(relative).then(Self::default)
    }

    /// Counts an accepted step before it is taken over.
    pub fn follow(&mut self, stepper: &mut Stepper<'_>, sizes: &SizeMonitor) {
        if stepper.statistics.steps.is_multiple_of(WAIT) {
            self.is_above = is_exposed(stepper.method) && {
                let h = stepper.h;
                let (_, flow, start, _, scale) = stepper.split();
                let states = start.x.len();
                let [mut there, mut rate, mut changes] = [(); 3].map(|()| vec![0.0; states]);
                rounding(&flow, start.borrowed(), [&mut there, &mut rate, &mut changes]);
                let allowed = |i| sizes.without_noise(i, scale) + scale.relative * start.x[i].abs();
                (0..states).any(|i| (changes[i] * (ESTIMATE * h)).abs() / allowed(i) > 1.0)
            };
        }
        stepper.statistics.rounded += u64::from(self.is_above);
    }
}

/// Whether this relative tolerance may be below what rounding makes of a step's error.
pub(super) fn may_matter(relative: f64) -> bool {
    relative <= LOOSEST
}

/// An implicit method damps what rounding does, and Taylor series take no differences of rates.
pub(super) fn is_exposed(method: &dyn Method) -> bool {
    matches!(method.control(), StepControl::Stabilised { .. }) && !method.needs_series()
}
