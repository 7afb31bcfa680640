//! Compensated sums of the states over the steps: what rounding keeps from a sum is carried over to the next step.
//!
//! In: a state and its change in a step. Out: their sum. Without it the momenta of long runs drift by a random walk. Source:
//! W. Kahan, Communications of the ACM 8 (1965); Hairer, Lubich, Wanner, section VIII.5.

use nalgebra::SVector;

/// What rounding has kept from the states.
#[derive(Clone, Debug)]
pub(super) struct Carry<const N: usize> {
    /// At the start of the step.
    start: SVector<f64, N>,
    /// At the end of the step that was tried last.
    end: SVector<f64, N>,
}

impl<const N: usize> Carry<N> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self { start: SVector::zeros(), end: SVector::zeros() }
    }

    /// State `i` after a step that starts at `from` and changes it by `change`.
    #[inline(always)]
    pub fn add(&mut self, i: usize, from: f64, change: f64) -> f64 {
        let change = change + self.start.data.0[0][i];
        let to = from + change;
        self.end.data.0[0][i] = change - (to - from);
        to
    }

    /// The step that was tried last was accepted.
    pub fn advance(&mut self) {
        self.start = self.end;
    }

    /// Nothing is carried over to the next step.
    pub fn restart(&mut self) {
        self.start.fill(0.0);
    }
}
