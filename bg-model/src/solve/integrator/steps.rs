//! What steps of explicit methods are made of, of one run or of several side by side.
//!
//! In: a flow. Out: its rates, and its second derivatives, for stages in any numbers. The numbers of runs side by side
//! are those of each by itself, to the bit.

use core::ops::Range;

use super::{Flow, PointRef};

/// The start of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Begin<'a, S> {
    /// Time, s.
    pub t: S,
    /// The step, s.
    pub h: S,
    /// State.
    pub x: &'a [S],
    /// Its rate.
    pub rate: &'a [S],
}

/// What stages of first order are evaluated of.
pub(crate) trait Rates<S> {
    /// Writes the rates at time `t` (s) and state `x` into `dx`. Compiled once.
    fn rate(&self, t: S, x: &[S], dx: &mut [S]);

    /// The same, to be inlined into the stages of a step.
    fn inlined_rate(&self, t: S, x: &[S], dx: &mut [S]);
}

/// What stages of second order are evaluated of.
pub(crate) trait Forces<S>: Rates<S> {
    /// The states of second order; an empty range where there are none.
    fn second(&self) -> Range<usize>;

    /// Replaces the rates `dx` of the states of second order at state `x` by their second derivatives.
    fn at_start(&self, x: &[S], dx: &mut [S]);

    /// Writes the rates at time `t` (s) and state `x` into `dx`, of the states of second order their second
    /// derivatives.
    fn at_stage(&self, t: S, x: &[S], dx: &mut [S]);
}

impl<'a> Begin<'a, f64> {
    /// The start of a step of size `h` (s).
    pub fn of(start: PointRef<'a>, h: f64) -> Self {
        let PointRef { t, x, rate } = start;
        Self { t, h, x, rate }
    }
}

impl Rates<f64> for Flow<'_> {
    #[inline(always)]
    fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        Flow::rate(self, t, x, dx);
    }

    #[inline(always)]
    fn inlined_rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        Flow::rate(self, t, x, dx);
    }
}

impl Forces<f64> for Flow<'_> {
    #[inline(always)]
    fn second(&self) -> Range<usize> {
        Flow::second(self)
    }

    #[inline(always)]
    fn at_start(&self, x: &[f64], dx: &mut [f64]) {
        self.second_derivatives(x, dx);
    }

    #[inline(always)]
    fn at_stage(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        self.forces(t, x, dx);
    }
}
