//! The reverse sweeps of a model, over slices.
//!
//! In: a [`Model`] that knows its sweeps. Out: [`Swept`].

use core::ops::Deref;

use super::Typed;
use crate::model::capability::Reversed;
use crate::model::system::{Model, switches, values, values_mut};

/// The reverse sweeps of a model: [`Reversed`], over slices.
///
/// # Panics
/// Each function, where a slice is shorter than there are states, switches, outputs or constants.
pub trait Swept {
    /// [`Reversed::reverse_rate`].
    fn reverse_rate(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    );

    /// [`Reversed::reverse_project`].
    fn reverse_project(&self, t: f64, x: &[f64], negative: &[bool], weights: &mut [f64], by_constants: &mut [f64]);

    /// [`Reversed::reverse_outputs`].
    fn reverse_outputs(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) -> bool;
}

impl<H: Deref, const N: usize, const G: usize, const M: usize> Swept for Typed<H, N, G, M>
where
    H::Target: Model<f64, N, G, M> + Sized,
{
    fn reverse_rate(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) {
        let (x, negative, weights, by_state) = (values(x), switches(negative), values(weights), values_mut(by_state));
        if let Some(sweeps) = self.of.reversed() {
            sweeps.reverse_rate(t, x, negative, weights, by_state, by_constants);
        }
    }

    fn reverse_project(&self, t: f64, x: &[f64], negative: &[bool], weights: &mut [f64], by_constants: &mut [f64]) {
        if let Some(sweeps) = self.of.reversed() {
            sweeps.reverse_project(t, values(x), switches(negative), values_mut(weights), by_constants);
        }
    }

    fn reverse_outputs(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) -> bool {
        let (x, negative, weights, by_state) = (values(x), switches(negative), values(weights), values_mut(by_state));
        let sweep = |sweeps: &_| Reversed::reverse_outputs(sweeps, t, x, negative, weights, by_state, by_constants);
        self.of.reversed().is_some_and(sweep)
    }
}
