//! A rate that is too long to be inlined, in the vectors of the machine at hand.

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use crate::model::scalar::Scalar;
use crate::model::system::System;

struct Rate<'a, S: Scalar, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: S,
    x: &'a SVector<S, N>,
    negative: &'a [S::Switch; G],
    dx: &'a mut SVector<S, N>,
}

impl<S: Scalar, Sys: System<S, N, G>, const N: usize, const G: usize> NullaryFnOnce for Rate<'_, S, Sys, N, G> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { system, t, x, negative, dx } = self;
        system.paired_rate(t, x, negative, dx);
    }
}

/// Writes the rate of `system`: see [`System::rate`].
#[inline(always)]
pub fn vectorised_rate<S: Scalar, const N: usize, const G: usize>(
    system: &impl System<S, N, G>,
    t: S,
    x: &SVector<S, N>,
    negative: &[S::Switch; G],
    dx: &mut SVector<S, N>,
) {
    S::in_vectors(Rate { system, t, x, negative, dx });
}
