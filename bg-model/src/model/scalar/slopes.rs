//! Derivatives side by side, in vectors of a machine.
//!
//! In: nothing. Out: the operations on them that numbers with slopes need, and the vectors that every machine of its kind has; those of
//! AVX2 and AVX-512 are [`super::lanes`]'s. Each product and each sum is rounded alone, in the same order: the results are the
//! same to the bit.

use core::fmt::Debug;

use pulp::NullaryFnOnce;
use wide::f64x2;

/// The number of derivatives in the vectors of every machine.
pub const WIDTH: usize = 8;

/// Derivatives side by side.
pub trait Slopes: Copy + Debug + 'static {
    /// Their numbers.
    type Numbers: Copy + Debug + AsRef<[f64]> + AsMut<[f64]>;

    /// How many there are.
    const LANES: usize;
    /// Whether operations are instructions only where they are inlined into code compiled for them, by [`vectorized`](Slopes::vectorized).
    const MUST_BE_INLINED: bool;

    /// Whether the machine at hand has such vectors: to be asked before there is one.
    fn is_at_hand() -> bool;
    /// Calls `of`, compiled for these vectors where it is inlined.
    fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output;

    /// The vector of these.
    fn new(numbers: Self::Numbers) -> Self;
    /// Its numbers.
    fn numbers(self) -> Self::Numbers;
    /// All of them `value`.
    fn filled(value: f64) -> Self;
    /// The same where there is a vector already, which spares the look at the machine.
    #[must_use]
    fn alike(self, value: f64) -> Self;
    /// The sum.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// The difference.
    #[must_use]
    fn minus(self, other: Self) -> Self;
    /// The product.
    #[must_use]
    fn times(self, other: Self) -> Self;
    /// The quotient.
    #[must_use]
    fn over(self, other: Self) -> Self;
    /// The magnitudes.
    #[must_use]
    fn abs(self) -> Self;
    /// The larger one of each; where one of them is none, in the vectors of AVX2 and AVX-512 that of `other`, elsewhere either.
    #[must_use]
    fn larger(self, other: Self) -> Self;

    /// `factor` times these.
    #[must_use]
    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self.times(self.alike(factor))
    }
}

/// In the vectors that every machine of its kind has.
pub type Everywhere = [f64x2; WIDTH / 2];

/// An operation on each pair of two.
#[inline(always)]
fn each(a: Everywhere, b: Everywhere, of: impl Fn(f64x2, f64x2) -> f64x2) -> Everywhere {
    [of(a[0], b[0]), of(a[1], b[1]), of(a[2], b[2]), of(a[3], b[3])]
}

impl Slopes for Everywhere {
    type Numbers = [f64; WIDTH];

    const LANES: usize = WIDTH;
    const MUST_BE_INLINED: bool = false;

    fn is_at_hand() -> bool {
        true
    }
    #[inline(always)]
    fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output {
        of.call()
    }
    #[inline(always)]
    fn new([a, b, c, d, e, f, g, h]: [f64; WIDTH]) -> Self {
        [f64x2::new([a, b]), f64x2::new([c, d]), f64x2::new([e, f]), f64x2::new([g, h])]
    }
    #[inline(always)]
    fn numbers(self) -> [f64; WIDTH] {
        let [[a, b], [c, d], [e, f], [g, h]] = self.map(f64x2::to_array);
        [a, b, c, d, e, f, g, h]
    }
    #[inline(always)]
    fn filled(value: f64) -> Self {
        [f64x2::splat(value); WIDTH / 2]
    }
    #[inline(always)]
    fn alike(self, value: f64) -> Self {
        Self::filled(value)
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        each(self, other, |a, b| a + b)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        each(self, other, |a, b| a - b)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        each(self, other, |a, b| a * b)
    }
    #[inline(always)]
    fn over(self, other: Self) -> Self {
        each(self, other, |a, b| a / b)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64x2::abs)
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        each(self, other, f64x2::fast_max)
    }
}
