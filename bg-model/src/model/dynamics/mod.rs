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
mod inlined;
#[cfg(feature = "std")]
mod lanes;
mod memory;
mod over;
mod sloped;
#[cfg(feature = "std")]
mod swept;
mod typed;

use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;

use crate::model::assembly::AssemblyError;
#[cfg(doc)]
use crate::model::capability::Reversed;
use crate::model::description::Description;
use crate::model::holding::Redundancy;
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

pub use crate::model::slices::Dynamics;

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
