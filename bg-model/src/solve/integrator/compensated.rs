//! Compensated sums of the states over the steps: what rounding keeps from a sum is added to the next step.
//!
//! In: a state and its change in a step. Out: their sum. Without it the momenta of long runs drift by a random walk. Source:
//! W. Kahan, Communications of the ACM 8 (1965); Hairer, Lubich, Wanner, section VIII.5.

use nalgebra::SVector;

use crate::model::scalar::Scalar;

/// What rounding has kept from the states.
#[derive(Clone, Debug)]
pub(super) struct CompensatedSum<S, const N: usize> {
    /// At the start of the step.
    pub start: SVector<S, N>,
    /// At the end of the step that was tried last.
    pub end: SVector<S, N>,
}

impl<S: Scalar, const N: usize> CompensatedSum<S, N> {
    /// Nothing yet.
    pub fn new() -> Self {
        let nothing = SVector::from([S::from_f64(0.0); N]);
        Self { start: nothing, end: nothing }
    }

    /// State `i` after a step that starts at `from` and changes it by `change`.
    #[inline(always)]
    pub fn add(&mut self, i: usize, from: S, change: S) -> S {
        let change = change + self.start.data.0[0][i];
        let to = from + change;
        self.end.data.0[0][i] = change - (to - from);
        to
    }

    /// The step that was tried last was accepted.
    pub fn advance(&mut self) {
        self.start = self.end;
    }

    /// Nothing is added to the next step.
    pub fn restart(&mut self) {
        self.start.fill(S::from_f64(0.0));
    }
}
