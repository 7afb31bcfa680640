//! A system and a model as a run sees them: over slices, whatever the number of their states, switches and outputs, so
//! that what drives them is compiled once.
//!
//! In: a [`System`] or [`Model`] whose numbers are in its type. Out: the same as one table of functions, [`Dynamics`]
//! and [`Machine`]: [`Typed`] in `f64`, where rates, series and eliminations are compiled for the vectors of the
//! machine at hand; [`Over`] in any scalar; [`InVectors`] for slopes in vectors; [`InLanes`] for runs side by side;
//! [`EachAlone`] and [`RunByRun`] in their places where a model is not compiled for vectors; [`Swept`], its reverse
//! sweeps.

#[cfg(feature = "std")]
mod apart;
#[cfg(feature = "std")]
mod lanes;
mod over;
mod sloped;
#[cfg(feature = "std")]
mod swept;
mod typed;

use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use nalgebra::Complex;

use crate::model::assembly::AssemblyError;
use crate::model::capability::SeriesSize;
#[cfg(doc)]
use crate::model::capability::{Elimination, Impacts, Joints, Linearised, Reversed, SecondOrder, Series, Storages};
use crate::model::clock::Clock;
use crate::model::delay::Delay;
use crate::model::description::{Description, StateInfo};
use crate::model::holding::{Held, Redundancy, Stops};
use crate::model::linear::{Sparsity, differences};
use crate::model::origin::Origin;
use crate::model::scalar::Scalar;
#[cfg(doc)]
use crate::model::system::System;
use crate::model::system::{Model, Powers, decide_by_sign};
#[cfg(feature = "std")]
pub use apart::{EachAlone, RunByRun};
#[cfg(feature = "std")]
pub use lanes::{Abreast, InLanes};
pub use over::Over;
pub use sloped::{InVectors, Rates};
#[cfg(feature = "std")]
pub use swept::Swept;
pub use typed::Typed;

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

    /// [`System::memories`].
    fn memories(&self) -> Vec<usize> {
        Vec::new()
    }

    /// [`System::clocks`] with [`System::instants`], but those of delays.
    fn clocks(&self) -> Vec<Clock<S>> {
        Vec::new()
    }

    /// [`System::delays`] with [`System::instants`]. None by default.
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

    /// [`System::state_name`].
    fn state_name(&self, _index: usize) -> &'static str {
        "state"
    }

    /// [`System::switch_name`].
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// [`System::runs_in_lanes`]; not by default.
    fn runs_in_lanes(&self) -> bool {
        false
    }

    /// [`System::not_finite`].
    fn not_finite(&self, _t: S, _x: &[S], _negative: &[S::Switch]) -> Option<Origin> {
        None
    }

    /// [`System::turning`].
    fn turning(&self) -> &'static [&'static str] {
        &[]
    }

    /// [`System::pivots`].
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

/// A model, over slices: [`Model`]. Outputs `y` are [`Description::outputs`] many.
///
/// # Panics
/// As [`Dynamics`].
pub trait Machine<S: Scalar = f64>: Dynamics<S> {
    /// [`Model::description`].
    fn description(&self) -> &'static Description;

    /// [`Model::start`].
    ///
    /// # Errors
    /// As there.
    fn start(&self) -> Result<Vec<S>, AssemblyError>;

    /// [`Model::redundant`].
    fn redundant(&self) -> Vec<Redundancy>;

    /// [`Model::decided`].
    fn decided(&self) -> Vec<f64>;

    /// [`Model::impulse_energy`].
    ///
    /// # Errors
    /// As there.
    fn impulse_energy(&self) -> Result<S, AssemblyError>;

    /// [`Model::outputs`].
    fn outputs(&self, t: S, x: &[S], negative: &[S::Switch], y: &mut [S]);

    /// [`Model::stored_energy`].
    fn stored_energy(&self, t: S, x: &[S], negative: &[S::Switch]) -> S;

    /// [`Model::shown`].
    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>);

    /// [`Model::powers`].
    fn powers(&self, t: S, x: &[S], negative: &[S::Switch]) -> Powers<S>;

    /// [`Reversed::constants`]; none of a model without reverse sweeps.
    fn constants(&self) -> &[S] {
        &[]
    }
}

/// The branches of the switches of a system at time `t` (s) and state `x`.
#[must_use]
pub fn branches<S: Scalar>(system: &dyn Dynamics<S>, t: f64, x: &[S]) -> Vec<bool> {
    let mut negative = system.first_branches();
    let mut guards = vec![S::from_f64(0.0); system.switches()];
    decide_by_sign(&mut negative, &mut guards, |negative, guards| {
        let negative: Vec<S::Switch> = negative.iter().copied().map(S::Switch::from).collect();
        system.guards(S::from_f64(t), x, &negative, guards);
    });
    negative
}

/// A model over slices. What is generic over [`Model`] and asks for this is compiled once for each model.
pub fn shared<Mo, const N: usize, const G: usize, const M: usize>(model: Mo) -> Rc<dyn Machine>
where
    Mo: Model<f64, N, G, M> + 'static,
{
    Rc::new(Typed::<Rc<Mo>, N, G, M>::model(Rc::new(model)))
}
