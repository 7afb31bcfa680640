//! Steps in the vectors of the machine at hand.
//!
//! In: a step to be tried. Out: what it gives, compiled twice: for the vectors of every machine of its kind, and for
//! AVX2. The results are the same to the bit, as nothing is fused.

#[cfg(test)]
mod tests;

use pulp::NullaryFnOnce;

use super::{Flow, PointRef, Scale};
pub(crate) use crate::model::scalar::machine::Arch;

/// A method whose attempts are all sums, rates and series.
pub(super) trait Vectorised {
    /// As [`Method::attempt`](super::Method::attempt); to be inlined.
    fn attempt_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64;
}

struct Attempt<'a, M> {
    method: &'a mut M,
    flow: &'a Flow<'a>,
    start: PointRef<'a>,
    h: f64,
    scale: &'a Scale,
    end: &'a mut [f64],
}

impl<M: Vectorised> NullaryFnOnce for Attempt<'_, M> {
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
    flow: &Flow<'_>,
    start: PointRef<'_>,
    h: f64,
    scale: &Scale,
    end: &mut [f64],
) -> f64 {
    arch.dispatch(Attempt { method, flow, start, h, scale, end })
}
