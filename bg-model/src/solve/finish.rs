//! Where a run has come to, at its end or where it failed.

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
    /// What the run has cost.
    pub statistics: Statistics,
}
