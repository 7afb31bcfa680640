//! Compensated sums of the states over the steps: what rounding keeps from a sum is added to the next step.
//!
//! In: a state and its change in a step. Out: their sum. Without it the momenta of long runs drift by a random walk.
//! Source: W. Kahan, Communications of the ACM 8 (1965); Hairer, Lubich, Wanner, section VIII.5.

use super::side_by_side::Padded;
use crate::model::scalar::Scalar;

/// What rounding has kept from the states.
#[derive(Clone, Debug)]
pub(super) struct CompensatedSum<S, const W: usize> {
    /// At the start of the step.
    pub start: Padded<S, W>,
    /// At the end of the step that was tried last.
    pub end: Padded<S, W>,
}

/// A state that `change` moves on from `from`, with what rounding had kept before from it, and what it keeps now.
#[inline(always)]
pub(super) fn compensated<S: Scalar>(from: S, change: S, before: S) -> (S, S) {
    let change = change + before;
    let to = from + change;
    (to, change - (to - from))
}

impl<S: Scalar, const W: usize> CompensatedSum<S, W> {
    /// Nothing yet.
    pub fn new(states: usize) -> Self {
        let nothing = Padded::new(states, S::from_f64(0.0));
        Self { start: nothing.clone(), end: nothing }
    }

    /// State `i` after a step that starts at `from` and changes it by `change`.
    #[inline(always)]
    pub fn add(&mut self, i: usize, from: S, change: S) -> S {
        let (to, lost) = compensated(from, change, self.start[i]);
        self.end[i] = lost;
        to
    }

    /// The step that was tried last was accepted.
    pub fn advance(&mut self) {
        self.start.copy_from_slice(&self.end);
    }

    /// Nothing is added to the next step.
    pub fn restart(&mut self) {
        self.start.fill(S::from_f64(0.0));
    }
}
