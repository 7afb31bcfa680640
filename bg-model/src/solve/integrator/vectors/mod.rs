//! Steps, and what they are made of, in the vectors of the machine at hand.
//!
//! In: a step to be tried, or the rate or a linear system of one. Out: what it gives, compiled twice: for the vectors of every machine
//! of its kind, and for AVX2. The results are the same to the bit, as nothing is fused. What several methods call is compiled once for
//! each flow.

#[cfg(test)]
mod tests;

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use super::{Flow, Point, Scale};
use crate::model::capability::Elimination;
use crate::model::linear::Field;
pub(crate) use crate::model::scalar::machine::Arch;

/// A method whose attempts are all sums, rates and series.
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

struct Rate<'a, F, const N: usize> {
    flow: &'a F,
    t: f64,
    x: &'a SVector<f64, N>,
    dx: &'a mut SVector<f64, N>,
}

impl<F: Flow<N>, const N: usize> NullaryFnOnce for Rate<'_, F, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { flow, t, x, dx } = self;
        flow.inlined_rate(t, x, dx);
    }
}

/// Evaluates a rate in the vectors `arch`.
#[inline(never)]
pub(crate) fn rate_in<const N: usize>(
    arch: Arch,
    flow: &impl Flow<N>,
    t: f64,
    x: &SVector<f64, N>,
    dx: &mut SVector<f64, N>,
) {
    if matches!(arch, Arch::Scalar) {
        // The function that there is anyway.
        flow.rate(t, x, dx);
    } else {
        arch.dispatch(Rate { flow, t, x, dx });
    }
}

struct Eliminate<'a, E, F, const N: usize> {
    elimination: &'a E,
    c: F,
    entries: &'a [f64],
    factors: &'a mut [F],
}

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> NullaryFnOnce for Eliminate<'_, E, F, N> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { elimination, c, entries, factors } = self;
        elimination.eliminate(c, entries, factors)
    }
}

/// Factors a matrix in the vectors `arch`: see [`Elimination::eliminate`].
#[inline(never)]
pub(super) fn eliminate_in<F: Field<f64>, const N: usize>(
    arch: Arch,
    elimination: &impl Elimination<f64, N>,
    c: F,
    entries: &[f64],
    factors: &mut [F],
) -> bool {
    arch.dispatch(Eliminate { elimination, c, entries, factors })
}

struct Substitute<'a, E, F, const N: usize> {
    elimination: &'a E,
    factors: &'a [F],
    b: &'a mut [F; N],
}

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> NullaryFnOnce for Substitute<'_, E, F, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { elimination, factors, b } = self;
        elimination.substitute(factors, b);
    }
}

/// Solves with the factors in the vectors `arch`: see [`Elimination::substitute`].
#[inline(never)]
pub(super) fn substitute_in<F: Field<f64>, const N: usize>(
    arch: Arch,
    elimination: &impl Elimination<f64, N>,
    factors: &[F],
    b: &mut [F; N],
) {
    arch.dispatch(Substitute { elimination, factors, b });
}
