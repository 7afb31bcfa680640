//! A system or model in any scalar, over slices.
//!
//! In: a [`System`] or [`Model`] in the scalar. Out: [`Over`], which hands over copies.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Deref;

use nalgebra::{ArrayStorage, SVector};

use super::{Dynamics, Machine, memory};
use crate::model::assembly::AssemblyError;
use crate::model::capability::{Impacts, Joints, Named, Reversed, Storages};
use crate::model::clock::Clock;
use crate::model::delay::Delay;
use crate::model::description::{Description, StateInfo};
use crate::model::holding::{Held, Redundancy, Stops};
use crate::model::scalar::Scalar;
use crate::model::slices::UNNAMED;
use crate::model::system::{Model, Powers, System};

/// A system or model in any scalar, borrowed or held by `H`, as starts, reactions and studies ask for it. Its functions
/// are those that calculate with one number at a time, and hand over copies.
#[derive(Clone, Copy, Debug)]
pub struct Over<H, const N: usize, const G: usize, const M: usize>(pub H);

impl<S, H, const N: usize, const G: usize, const M: usize> Dynamics<S> for Over<H, N, G, M>
where
    S: Scalar,
    H: Deref,
    H::Target: System<S, N, G> + Sized,
{
    fn states(&self) -> usize {
        N
    }

    fn switches(&self) -> usize {
        G
    }

    fn rate(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        let mut rates = whole(dx);
        self.0.rate(t, &whole(x), &each(negative), &mut rates);
        dx.copy_from_slice(rates.as_slice());
    }

    fn guards(&self, t: S, x: &[S], negative: &[S::Switch], guards: &mut [S]) {
        let mut values = whole(guards);
        self.0.guards(t, &whole(x), &each(negative), &mut values);
        guards.copy_from_slice(values.as_slice());
    }

    fn clocks(&self) -> Vec<Clock<S>> {
        memory::clocks(self.0.memories())
    }

    fn delays(&self) -> Vec<Delay<S>> {
        memory::delays(self.0.memories())
    }

    fn memories(&self) -> Vec<usize> {
        memory::states(self.0.memories())
    }

    fn first_branches(&self) -> Vec<bool> {
        self.0.first_branches().to_vec()
    }

    fn project(&self, t: S, negative: &[S::Switch], x: &mut [S]) {
        let mut state = whole(x);
        self.0.project(t, &each(negative), &mut state);
        x.copy_from_slice(state.as_slice());
    }

    fn next_break(&self, t: f64) -> f64 {
        self.0.next_break(t)
    }

    fn state_name(&self, index: usize) -> &'static str {
        self.0.named().map_or(UNNAMED, |named| named.state_name(index))
    }

    fn switch_name(&self, index: usize) -> Option<&'static str> {
        self.0.named()?.switch_name(index)
    }

    fn held(&self) -> Option<Held> {
        self.0.joints().map(Joints::held)
    }

    fn kept(&self) -> &[f64] {
        self.0.joints().map_or(&[], Joints::kept)
    }

    fn hold(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(joints) = self.0.joints() {
            joints.hold(t, &whole(x), &each(negative), entries);
        }
    }

    fn stops(&self) -> Option<Stops> {
        self.0.impacts().map(Impacts::stops)
    }

    fn kept_of_stops(&self) -> &[f64] {
        self.0.impacts().map_or(&[], Impacts::kept)
    }

    fn impact(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(impacts) = self.0.impacts() {
            impacts.impact(t, &whole(x), &each(negative), entries);
        }
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.0.storages().map(Storages::states)
    }

    fn energy(&self, t: S, x: &[S], negative: &[S::Switch], curvatures: &mut [S]) -> S {
        let Some(storages) = self.0.storages() else { return S::from_f64(0.0) };
        let mut values = whole(curvatures);
        let energy = storages.energy(t, &whole(x), &each(negative), &mut values);
        curvatures.copy_from_slice(values.as_slice());
        energy
    }
}

impl<S, H, const N: usize, const G: usize, const M: usize> Machine<S> for Over<H, N, G, M>
where
    S: Scalar,
    H: Deref,
    H::Target: Model<S, N, G, M> + Sized,
{
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn start(&self) -> Result<Vec<S>, AssemblyError> {
        let mut x = vec![S::from_f64(0.0); N];
        self.0.start_over(self, &mut x)?;
        Ok(x)
    }

    fn redundant(&self) -> Vec<Redundancy> {
        self.0.redundant_over(self)
    }

    fn decided(&self) -> Vec<f64> {
        self.0.decided()
    }

    fn impulse_energy(&self) -> Result<S, AssemblyError> {
        self.0.impulse_energy_over(self)
    }

    fn outputs(&self, t: S, x: &[S], negative: &[S::Switch], y: &mut [S]) {
        let mut outputs = whole(y);
        self.0.outputs(t, &whole(x), &each(negative), &mut outputs);
        y.copy_from_slice(outputs.as_slice());
    }

    fn stored_energy(&self, t: S, x: &[S], negative: &[S::Switch]) -> S {
        self.0.stored_energy(t, &whole(x), &each(negative))
    }

    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>) {
        self.0.shown(t, &whole(x), &each(negative), shown);
    }

    fn powers(&self, t: S, x: &[S], negative: &[S::Switch]) -> Powers<S> {
        self.0.powers(t, &whole(x), &each(negative))
    }

    fn constants(&self) -> &[S] {
        self.0.reversed().map_or(&[], Reversed::constants)
    }
}

/// The numbers as a system takes them, a copy.
fn whole<S: Copy, const N: usize>(of: &[S]) -> SVector<S, N> {
    SVector::from_array_storage(ArrayStorage([*of.first_chunk().expect("there is a number for each")]))
}

/// The branches in an array.
fn each<T: Copy, const G: usize>(negative: &[T]) -> [T; G] {
    negative.try_into().expect("there is a branch for each switch")
}
