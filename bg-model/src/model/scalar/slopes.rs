//! Derivatives side by side, in vectors of a machine.
//!
//! In: nothing. Out: the operations on them that numbers with slopes need, and the vectors that every machine of its
//! kind has; those of AVX2 and AVX-512 are [`super::lanes`]'s. Each product and each sum is rounded alone, in the same
//! order: the results are the same to the bit.

use core::fmt::Debug;

use pulp::NullaryFnOnce;
use wide::f64x2;

/// The number of derivatives of a [`Gradient`](super::Gradient): what one vector of every machine has. More would make
/// every function of a model so many times as long, for what is calculated seldom: steps, where the time goes, have
/// vectors of their own.
pub const WIDTH: usize = 2;

/// Derivatives side by side.
pub trait Slopes: Copy + Debug + 'static {
    /// Their numbers.
    type Numbers: Copy + Debug + AsRef<[f64]> + AsMut<[f64]>;

    /// How many there are.
    const LANES: usize;
    /// Whether operations are instructions only where they are inlined into code compiled for them, by
    /// [`vectorized`](Slopes::vectorized).
    const MUST_BE_INLINED: bool;
    /// Whether they are those of a [`Gradient`](super::Gradient).
    const ARE_EVERYWHERE: bool = false;

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
    /// The larger one of each; where one of them is none, in the vectors of AVX2 and AVX-512 that of `other`, elsewhere
    /// either.
    #[must_use]
    fn larger(self, other: Self) -> Self;

    /// `factor` times these.
    #[must_use]
    #[inline(always)]
    fn scaled(self, factor: f64) -> Self {
        self.times(self.alike(factor))
    }
}

/// In one vector that every machine of its kind has.
pub type Everywhere = [f64x2; WIDTH / 2];

/// Eight in such vectors, for steps where there are no wider ones.
#[cfg(any(test, all(feature = "std", not(target_arch = "x86_64"))))]
pub type Eight = [f64x2; 4];

/// Derivatives in so many vectors of every machine, at these places.
macro_rules! in_vectors {
    ($count:literal: $($place:literal)*) => {
        impl Slopes for [f64x2; $count] {
            type Numbers = [f64; 2 * $count];

            const LANES: usize = 2 * $count;
            const MUST_BE_INLINED: bool = false;
            const ARE_EVERYWHERE: bool = $count == WIDTH / 2;

            fn is_at_hand() -> bool {
                true
            }
            /// A function, as it is for other vectors: compiled once.
            #[inline(never)]
            fn vectorized<F: NullaryFnOnce>(of: F) -> F::Output {
                of.call()
            }
            #[inline(always)]
            fn new(numbers: Self::Numbers) -> Self {
                [$(f64x2::new([numbers[2 * $place], numbers[2 * $place + 1]])),*]
            }
            #[inline(always)]
            fn numbers(self) -> Self::Numbers {
                let mut numbers = [0.0; 2 * $count];
                $([numbers[2 * $place], numbers[2 * $place + 1]] = self[$place].to_array();)*
                numbers
            }
            #[inline(always)]
            fn filled(value: f64) -> Self {
                [f64x2::splat(value); $count]
            }
            #[inline(always)]
            fn alike(self, value: f64) -> Self {
                Self::filled(value)
            }
            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                [$(self[$place] + other[$place]),*]
            }
            #[inline(always)]
            fn minus(self, other: Self) -> Self {
                [$(self[$place] - other[$place]),*]
            }
            #[inline(always)]
            fn times(self, other: Self) -> Self {
                [$(self[$place] * other[$place]),*]
            }
            #[inline(always)]
            fn over(self, other: Self) -> Self {
                [$(self[$place] / other[$place]),*]
            }
            #[inline(always)]
            fn abs(self) -> Self {
                [$(self[$place].abs()),*]
            }
            #[inline(always)]
            fn larger(self, other: Self) -> Self {
                [$(self[$place].fast_max(other[$place])),*]
            }
        }
    };
}

in_vectors!(1: 0);
#[cfg(any(test, all(feature = "std", not(target_arch = "x86_64"))))]
in_vectors!(4: 0 1 2 3);
