//! A system over slices: what is asked of it, whatever the number of its states and switches.
//!
//! In: nothing. Out: [`Dynamics`]. What makes one of a system whose numbers are in its type is
//! [`dynamics`](super::dynamics).

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::Complex;

#[cfg(doc)]
use super::system::System;
use crate::model::capability::SeriesSize;
#[cfg(doc)]
use crate::model::capability::{
    Elimination, Impacts, Inlined, Joints, Linearised, Memories, Named, SecondOrder, Series, Storages, Turning,
};
use crate::model::clock::Clock;
use crate::model::delay::Delay;
use crate::model::description::StateInfo;
use crate::model::holding::{Held, Stops};
use crate::model::linear::{Sparsity, differences};
use crate::model::origin::Origin;
use crate::model::scalar::Scalar;

/// The name of the states of a system that names none.
pub(crate) const UNNAMED: &str = "state";

/// A system of ordinary differential equations: [`System`], over slices. States `x` and all that there is one of for
/// each of them have [`Dynamics::states`] numbers, the branches `negative` of the switches [`Dynamics::switches`]. Only
/// the number of states and the rate have to be written; what else a system knows of itself it may say.
///
/// # Panics
/// Each function, where a slice is shorter.
pub trait Dynamics<S: Scalar = f64> {
    /// The number of states.
    fn states(&self) -> usize;

    /// The number of switches; none by default.
    fn switches(&self) -> usize {
        0
    }

    /// [`System::rate`].
    fn rate(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]);

    /// [`System::guards`].
    fn guards(&self, _t: S, _x: &[S], _negative: &[S::Switch], _guards: &mut [S]) {}

    /// [`Memories::states`].
    fn memories(&self) -> Vec<usize> {
        Vec::new()
    }

    /// [`Memories::clocks`] with [`Memories::instants`], but those of delays.
    fn clocks(&self) -> Vec<Clock<S>> {
        Vec::new()
    }

    /// [`Memories::delays`] with [`Memories::instants`]. None by default.
    fn delays(&self) -> Vec<Delay<S>> {
        Vec::new()
    }

    /// [`System::first_branches`].
    fn first_branches(&self) -> Vec<bool> {
        vec![false; self.switches()]
    }

    /// [`System::project`].
    fn project(&self, _t: S, _negative: &[S::Switch], _x: &mut [S]) {}

    /// [`System::next_break`].
    fn next_break(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// [`Named::state_name`].
    fn state_name(&self, _index: usize) -> &'static str {
        UNNAMED
    }

    /// [`Named::switch_name`].
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// [`Inlined::runs_in_lanes`]; not by default.
    fn runs_in_lanes(&self) -> bool {
        false
    }

    /// [`Named::not_finite`].
    fn not_finite(&self, _t: S, _x: &[S], _negative: &[S::Switch]) -> Option<Origin> {
        None
    }

    /// [`Turning::joints`].
    fn turning(&self) -> &'static [&'static str] {
        &[]
    }

    /// [`Turning::pivots`].
    fn pivots(&self, _t: S, _x: &[S], _negative: &[S::Switch], _pivots: &mut [S]) {}

    /// [`Linearised::sparsity`]; full where the system does not know its Jacobian.
    fn sparsity(&self) -> Sparsity {
        Sparsity::Full
    }

    /// [`Linearised::jacobian`]; by differences where the system does not know it.
    fn jacobian(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S], slope: &mut [S]) {
        let mut rate = |t, x: &[S], dx: &mut [S]| self.rate(t, x, negative, dx);
        differences(&mut rate, t, x, entries, slope, &mut vec![S::from_f64(0.0); x.len()]);
    }

    /// [`Linearised::damping_sparsity`].
    fn damping_sparsity(&self) -> Sparsity {
        self.sparsity()
    }

    /// [`Linearised::damping`].
    fn damping(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        self.jacobian(t, x, negative, entries, &mut vec![S::from_f64(0.0); x.len()]);
    }

    /// [`Elimination::factors`]; none where there is no elimination.
    fn factors(&self) -> Option<usize> {
        None
    }

    /// [`Elimination::eliminate`].
    fn eliminate(&self, _c: S, _entries: &[S], _factors: &mut [S]) -> bool {
        false
    }

    /// The same with a complex `c`.
    fn eliminate_complex(&self, _c: Complex<f64>, _entries: &[f64], _factors: &mut [Complex<f64>]) -> bool {
        false
    }

    /// [`Elimination::substitute`].
    fn substitute(&self, _factors: &[S], _b: &mut [S]) {}

    /// The same with a complex c.
    fn substitute_complex(&self, _factors: &[Complex<f64>], _b: &mut [Complex<f64>]) {}

    /// [`SecondOrder::states`]; an empty range where none are known.
    fn second(&self) -> Range<usize> {
        0..0
    }

    /// [`SecondOrder::second_derivatives`].
    fn second_derivatives(&self, _x: &[S], _dx: &mut [S]) {}

    /// [`SecondOrder::forces`]; the rate where no states of second order are known.
    fn forces(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        self.rate(t, x, negative, dx);
    }

    /// [`SecondOrder::operations`].
    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        None
    }

    /// What a Taylor series takes; none where there is no series.
    fn series(&self) -> Option<SeriesSize> {
        None
    }

    /// [`Series::expand`]: order by order, of each all states.
    fn expand(&self, _t: S, _h: S, _negative: &[S::Switch], _rows: &mut [S], _series: &mut [S]) {}

    /// [`Joints::held`]; none where joints hold nothing.
    fn held(&self) -> Option<Held> {
        None
    }

    /// [`Joints::kept`].
    fn kept(&self) -> &[f64] {
        &[]
    }

    /// [`Joints::hold`].
    fn hold(&self, _t: S, _x: &[S], _negative: &[S::Switch], _entries: &mut [S]) {}

    /// [`Impacts::stops`]; none where nothing is hit.
    fn stops(&self) -> Option<Stops> {
        None
    }

    /// [`Impacts::kept`].
    fn kept_of_stops(&self) -> &[f64] {
        &[]
    }

    /// [`Impacts::impact`].
    fn impact(&self, _t: S, _x: &[S], _negative: &[S::Switch], _entries: &mut [S]) {}

    /// [`Storages::states`]; none of a system that does not know what it stores.
    fn stored(&self) -> Option<&'static [StateInfo]> {
        None
    }

    /// [`Storages::energy`]; 0 where nothing is known.
    fn energy(&self, _t: S, _x: &[S], _negative: &[S::Switch], curvatures: &mut [S]) -> S {
        curvatures.fill(S::from_f64(0.0));
        S::from_f64(0.0)
    }
}
