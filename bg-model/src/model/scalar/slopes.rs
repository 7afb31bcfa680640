//! Four derivatives side by side, in vectors of a machine.
//!
//! In: nothing. Out: the operations on them that numbers with slopes need, in the vectors that every machine of its kind has and in
//! those of AVX2. Each product and each sum is rounded alone, in the same order: the results are the same to the bit.

use core::fmt::Debug;

use pulp::NullaryFnOnce;
use wide::f64x2;

/// The number of derivatives.
pub const WIDTH: usize = 4;

/// Four derivatives.
pub trait Slopes: Copy + Debug + 'static {
    /// Whether operations are instructions only where they are inlined into code compiled for them, by [`vectorized`](Slopes::vectorized).
    const MUST_BE_INLINED: bool;

    /// These.
    fn new(slopes: [f64; WIDTH]) -> Self;
    /// As numbers.
    fn numbers(self) -> [f64; WIDTH];
    /// All of them `value`.
    #[must_use]
    fn filled(self, value: f64) -> Self;
    /// The sum.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// The difference.
    #[must_use]
    fn minus(self, other: Self) -> Self;
    /// `factor` times these.
    #[must_use]
    fn times(self, factor: f64) -> Self;
    /// Each times that of `factors`.
    #[must_use]
    fn times_each(self, factors: Self) -> Self;
    /// Each over that of `divisors`.
    #[must_use]
    fn over_each(self, divisors: Self) -> Self;
    /// The magnitudes.
    #[must_use]
    fn abs(self) -> Self;
    /// The larger one of each; what is not a number may be lost.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Whether the machine at hand has such vectors; if not, no such numbers can be made.
    fn is_at_hand() -> bool;
    /// Calls `of`, compiled for these vectors where it is inlined.
    fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output;
}

/// In the vectors that every machine of its kind has.
pub type Everywhere = [f64x2; WIDTH / 2];

impl Slopes for Everywhere {
    const MUST_BE_INLINED: bool = false;

    #[inline(always)]
    fn new([a, b, c, d]: [f64; WIDTH]) -> Self {
        [f64x2::new([a, b]), f64x2::new([c, d])]
    }
    #[inline(always)]
    fn numbers(self) -> [f64; WIDTH] {
        let [[a, b], [c, d]] = self.map(f64x2::to_array);
        [a, b, c, d]
    }
    #[inline(always)]
    fn filled(self, value: f64) -> Self {
        [f64x2::splat(value); WIDTH / 2]
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        [self[0] + other[0], self[1] + other[1]]
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        [self[0] - other[0], self[1] - other[1]]
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self.times_each(self.filled(factor))
    }
    #[inline(always)]
    fn times_each(self, factors: Self) -> Self {
        [self[0] * factors[0], self[1] * factors[1]]
    }
    #[inline(always)]
    fn over_each(self, divisors: Self) -> Self {
        [self[0] / divisors[0], self[1] / divisors[1]]
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64x2::abs)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        [self[0].fast_max(other[0]), self[1].fast_max(other[1])]
    }
    fn is_at_hand() -> bool {
        true
    }
    #[inline(always)]
    fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output {
        of.call()
    }
}

#[cfg(all(feature = "std", target_arch = "x86_64"))]
pub use avx2::Avx2;

#[cfg(all(feature = "std", target_arch = "x86_64"))]
mod avx2 {
    use core::arch::x86_64::__m256d;
    use core::fmt;

    use pulp::NullaryFnOnce;
    use pulp::x86::V3;

    use super::{Slopes, WIDTH};

    /// In a vector of AVX2.
    #[derive(Clone, Copy)]
    pub struct Avx2 {
        all: __m256d,
        machine: V3,
    }

    impl Avx2 {
        #[inline(always)]
        fn machine() -> V3 {
            V3::try_new().expect("slopes are kept in such vectors where the machine has them")
        }

        #[inline(always)]
        fn with(self, all: __m256d) -> Self {
            Self { all, ..self }
        }
    }

    impl fmt::Debug for Avx2 {
        fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
            self.numbers().fmt(formatter)
        }
    }

    impl Slopes for Avx2 {
        const MUST_BE_INLINED: bool = true;

        #[inline(always)]
        fn new(slopes: [f64; WIDTH]) -> Self {
            Self { all: pulp::cast(slopes), machine: Self::machine() }
        }
        #[inline(always)]
        fn numbers(self) -> [f64; WIDTH] {
            pulp::cast(self.all)
        }
        #[inline(always)]
        fn filled(self, value: f64) -> Self {
            self.with(self.machine.avx._mm256_set1_pd(value))
        }
        #[inline(always)]
        fn plus(self, other: Self) -> Self {
            self.with(self.machine.avx._mm256_add_pd(self.all, other.all))
        }
        #[inline(always)]
        fn minus(self, other: Self) -> Self {
            self.with(self.machine.avx._mm256_sub_pd(self.all, other.all))
        }
        #[inline(always)]
        fn times(self, factor: f64) -> Self {
            self.times_each(self.filled(factor))
        }
        #[inline(always)]
        fn times_each(self, factors: Self) -> Self {
            self.with(self.machine.avx._mm256_mul_pd(self.all, factors.all))
        }
        #[inline(always)]
        fn over_each(self, divisors: Self) -> Self {
            self.with(self.machine.avx._mm256_div_pd(self.all, divisors.all))
        }
        #[inline(always)]
        fn abs(self) -> Self {
            self.with(self.machine.avx._mm256_andnot_pd(self.filled(-0.0).all, self.all))
        }
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            self.with(self.machine.avx._mm256_max_pd(self.all, other.all))
        }
        fn is_at_hand() -> bool {
            V3::is_available()
        }
        #[inline(always)]
        fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output {
            Self::machine().vectorize(of)
        }
    }
}
