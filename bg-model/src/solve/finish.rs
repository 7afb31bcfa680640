//! Where a run has come to, at its end or where it failed, and why it ended.

use nalgebra::SVector;

use crate::solve::statistics::Statistics;

/// Where a run has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish<const N: usize, const G: usize> {
    /// Time, s.
    pub t: f64,
    /// State.
    pub x: SVector<f64, N>,
    /// The branches of the switches from `t` on; of one whose guard has just come to zero there, the branch before.
    pub negative: [bool; G],
    /// Why the run ended.
    pub ended: Ended,
    /// The states whose errors were never controlled: above rounding, and smaller than their absolute tolerance all the
    /// time. Not looked at in runs side by side, in pieces, and of steps of a fixed size.
    pub uncontrolled: [bool; N],
    /// What the run has cost.
    pub statistics: Statistics,
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
