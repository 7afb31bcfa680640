//! Where a run has come to, at its end or where it failed, and why it ended.

use alloc::vec::Vec;

use nalgebra::{DVector, SVector};

use crate::model::system::{switches, values};
use crate::solve::statistics::Statistics;

/// Where a run has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish {
    /// Time, s.
    pub t: f64,
    /// State.
    pub x: DVector<f64>,
    /// The branches of the switches from `t` on; of one whose guard has just come to zero there, the branch before.
    pub negative: Vec<bool>,
    /// Why the run ended.
    pub ended: Ended,
    /// The states whose errors were never controlled: above rounding, and smaller than their absolute tolerance all the
    /// time. Not looked at in runs side by side, in pieces, and of steps of a fixed size.
    pub uncontrolled: Vec<bool>,
    /// What the run has cost.
    pub statistics: Statistics,
}

impl Finish {
    /// The state as a system of `N` states takes it.
    ///
    /// # Panics
    /// The run was of another number of states.
    #[must_use]
    pub fn state<const N: usize>(&self) -> &SVector<f64, N> {
        values(self.x.as_slice())
    }

    /// The branches as a system of `G` switches takes them.
    ///
    /// # Panics
    /// The run was of another number of switches.
    #[must_use]
    pub fn branches<const G: usize>(&self) -> &[bool; G] {
        switches(&self.negative)
    }
}

/// Why a run ended. Of several reasons at one instant the condition comes first, then the observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// It came to the end of its span.
    AtEnd,
    /// The condition passed through zero.
    ByCondition,
    /// The observer had enough.
    ByObserver,
    /// It failed: only in [`Failure::last`](crate::failure::Failure::last).
    ByFailure,
}
