//! A rate that is too long to be inlined, in the vectors of the machine at hand.

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use crate::model::capability::Inlined;
use crate::model::scalar::Scalar;

struct Rate<'a, S: Scalar, C, const N: usize, const G: usize> {
    inlined: &'a C,
    t: S,
    x: &'a SVector<S, N>,
    negative: &'a [S::Switch; G],
    dx: &'a mut SVector<S, N>,
}

impl<S: Scalar, C: Inlined<S, N, G>, const N: usize, const G: usize> NullaryFnOnce for Rate<'_, S, C, N, G> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { inlined, t, x, negative, dx } = self;
        inlined.paired_rate(t, x, negative, dx);
    }
}

/// Writes the rate: see [`System::rate`](crate::system::System::rate).
#[inline(always)]
pub fn vectorised_rate<S: Scalar, const N: usize, const G: usize>(
    inlined: &impl Inlined<S, N, G>,
    t: S,
    x: &SVector<S, N>,
    negative: &[S::Switch; G],
    dx: &mut SVector<S, N>,
) {
    S::in_vectors(Rate { inlined, t, x, negative, dx });
}
