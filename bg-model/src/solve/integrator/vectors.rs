//! Attempts in the vectors of the machine at hand.
//!
//! In: a step to be tried. Out: its attempt, compiled twice: for the vectors of every machine of its kind, and for AVX2. The results are
//! the same to the bit, as nothing is fused.

use nalgebra::SVector;
use pulp::{Arch, NullaryFnOnce};

use super::{Flow, Point, Scale};

/// A method whose attempts are all sums and rates.
pub(super) trait Vectorised<const N: usize> {
    /// As [`Method::attempt`](super::Method::attempt); to be inlined.
    fn attempt_inlined(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64;
}

struct Attempt<'a, M, F, const N: usize> {
    method: &'a mut M,
    flow: &'a F,
    start: &'a Point<N>,
    h: f64,
    scale: &'a Scale<N>,
    end: &'a mut SVector<f64, N>,
}

impl<M: Vectorised<N>, F: Flow<N>, const N: usize> NullaryFnOnce for Attempt<'_, M, F, N> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { method, flow, start, h, scale, end } = self;
        method.attempt_inlined(flow, start, h, scale, end)
    }
}

/// Attempts a step in the vectors `arch`.
pub(super) fn attempt_in<const N: usize>(
    arch: Arch,
    method: &mut impl Vectorised<N>,
    flow: &impl Flow<N>,
    start: &Point<N>,
    h: f64,
    scale: &Scale<N>,
    end: &mut SVector<f64, N>,
) -> f64 {
    arch.dispatch(Attempt { method, flow, start, h, scale, end })
}
