//! Rates and projections that are inlined where the system has them so.
//!
//! In: a [`System`], its [`Inlined`] functions if it has them, a time and a state in branches. Out: the rate, the state
//! moved.

use nalgebra::SVector;

use crate::model::capability::Inlined;
use crate::model::scalar::Scalar;
use crate::model::system::System;

/// The rate: inlined, in pairs of operations where that pays, if it is short; else called.
#[inline(always)]
pub(super) fn where_short<S: Scalar, C: Inlined<S, N, G>, const N: usize, const G: usize>(
    system: &impl System<S, N, G>,
    inlined: Option<&C>,
    t: S,
    x: &SVector<S, N>,
    negative: &[S::Switch; G],
    dx: &mut SVector<S, N>,
) {
    match inlined {
        Some(inlined) if const { C::IS_SHORT } => inlined.paired_rate(t, x, negative, dx),
        _ => system.rate(t, x, negative, dx),
    }
}

/// The rate, inlined whatever its length.
#[inline(always)]
pub(super) fn rate<S: Scalar, const N: usize, const G: usize>(
    system: &impl System<S, N, G>,
    t: S,
    x: &SVector<S, N>,
    negative: &[S::Switch; G],
    dx: &mut SVector<S, N>,
) {
    match system.inlined() {
        Some(inlined) => inlined.rate(t, x, negative, dx),
        None => system.rate(t, x, negative, dx),
    }
}

/// The projection, inlined whatever its length.
#[inline(always)]
pub(super) fn project<S: Scalar, const N: usize, const G: usize>(
    system: &impl System<S, N, G>,
    t: S,
    negative: &[S::Switch; G],
    x: &mut SVector<S, N>,
) {
    match system.inlined() {
        Some(inlined) => inlined.project(t, negative, x),
        None => system.project(t, negative, x),
    }
}
