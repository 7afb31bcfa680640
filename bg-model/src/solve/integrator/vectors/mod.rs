//! Steps, and what they are made of, in the vectors of the machine at hand.
//!
//! In: a step to be tried, or the rate or a linear system of one. Out: what it gives, compiled twice: for the vectors of every machine
//! of its kind, and for AVX2. The results are the same to the bit, as nothing is fused. What several methods call is compiled once for
//! each flow.

#[cfg(test)]
mod tests;

use pulp::NullaryFnOnce;

use super::{Flow, PointRef, Scale};
pub(crate) use crate::model::scalar::machine::Arch;

/// A method whose attempts are all sums, rates and series.
pub(super) trait Vectorised {
    /// As [`Method::attempt`](super::Method::attempt); to be inlined.
    fn attempt_inlined(
        &mut self,
        flow: &(impl Flow + ?Sized),
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &mut [f64],
    ) -> f64;
}

struct Attempt<'a, M, F: ?Sized> {
    method: &'a mut M,
    flow: &'a F,
    start: PointRef<'a>,
    h: f64,
    scale: &'a Scale,
    end: &'a mut [f64],
}

impl<M: Vectorised, F: Flow + ?Sized> NullaryFnOnce for Attempt<'_, M, F> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { method, flow, start, h, scale, end } = self;
        method.attempt_inlined(flow, start, h, scale, end)
    }
}

/// Attempts a step in the vectors `arch`.
pub(super) fn attempt_in(
    arch: Arch,
    method: &mut impl Vectorised,
    flow: &(impl Flow + ?Sized),
    start: PointRef<'_>,
    h: f64,
    scale: &Scale,
    end: &mut [f64],
) -> f64 {
    arch.dispatch(Attempt { method, flow, start, h, scale, end })
}

struct Rate<'a, F: ?Sized> {
    flow: &'a F,
    t: f64,
    x: &'a [f64],
    dx: &'a mut [f64],
}

impl<F: Flow + ?Sized> NullaryFnOnce for Rate<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { flow, t, x, dx } = self;
        flow.inlined_rate(t, x, dx);
    }
}

/// Evaluates a rate in the vectors `arch`.
#[inline(never)]
pub(crate) fn rate_in(arch: Arch, flow: &(impl Flow + ?Sized), t: f64, x: &[f64], dx: &mut [f64]) {
    if matches!(arch, Arch::Scalar) {
        // The function that there is anyway.
        flow.rate(t, x, dx);
    } else {
        arch.dispatch(Rate { flow, t, x, dx });
    }
}
