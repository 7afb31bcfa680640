//! What steps of explicit methods are made of, of one run or of several side by side.
//!
//! In: a flow. Out: its rates, and its second derivatives, for stages in any numbers. The numbers of runs side by side are those of each by
//! itself, to the bit.

use core::ops::Range;

use nalgebra::SVector;

use super::Flow;
use crate::model::capability::SecondOrder;

/// The start of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begin<'a, S, const N: usize> {
    /// Time, s.
    pub t: S,
    /// The step, s.
    pub h: S,
    /// State.
    pub x: &'a SVector<S, N>,
    /// Its rate.
    pub rate: &'a SVector<S, N>,
}

/// What stages of first order are evaluated of.
pub(crate) trait Rates<S, const N: usize> {
    /// Writes the rates at time `t` (s) and state `x` into `dx`. Compiled once.
    fn rate(&self, t: S, x: &SVector<S, N>, dx: &mut SVector<S, N>);

    /// The same, to be inlined into the stages of a step.
    fn inlined_rate(&self, t: S, x: &SVector<S, N>, dx: &mut SVector<S, N>);
}

/// What stages of second order are evaluated of.
pub(crate) trait Forces<S, const N: usize>: Rates<S, N> {
    /// The states of second order; an empty range where there are none.
    fn second(&self) -> Range<usize>;

    /// Replaces the rates `dx` of the states of second order at state `x` by their second derivatives.
    fn at_start(&self, x: &SVector<S, N>, dx: &mut SVector<S, N>);

    /// Writes the rates at time `t` (s) and state `x` into `dx`, of the states of second order their second derivatives.
    fn at_stage(&self, t: S, x: &SVector<S, N>, dx: &mut SVector<S, N>);
}

/// Those of a flow.
pub(super) struct OfFlow<'a, F>(pub &'a F);

impl<F: Flow<N>, const N: usize> Rates<f64, N> for OfFlow<'_, F> {
    #[inline(always)]
    fn rate(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        self.0.rate(t, x, dx);
    }

    #[inline(always)]
    fn inlined_rate(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        self.0.inlined_rate(t, x, dx);
    }
}

impl<F: Flow<N>, const N: usize> Forces<f64, N> for OfFlow<'_, F> {
    #[inline(always)]
    fn second(&self) -> Range<usize> {
        self.0.second_order().map_or(0..0, |second| second.states())
    }

    #[inline(always)]
    fn at_start(&self, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        if let Some(second) = self.0.second_order() {
            second.second_derivatives(x, dx);
        }
    }

    #[inline(always)]
    fn at_stage(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        match self.0.second_order() {
            Some(second) => second.forces(t, x, &[], dx),
            None => self.0.inlined_rate(t, x, dx),
        }
    }
}
