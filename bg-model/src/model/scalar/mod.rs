//! The number type of generated code: one source of rate functions for f64 and for anything that calculates like it.
//!
//! | type | for |
//! |---|---|
//! | `f64` | runs |
//! | `f32` | controllers whose floating-point unit has no more |
//! | [`DoubleDouble`] | reference solutions, about 31 digits |
//! | [`Dual`] | exact first derivatives along one direction |
//! | [`Gradient`] | the same along several at once |

pub(crate) mod double;
mod double_double;
mod dual;
pub(crate) mod gradient;
#[cfg(feature = "std")]
pub(crate) mod lanes;
pub(crate) mod machine;
mod pair;
mod single;
pub(crate) mod slopes;

use core::any::Any;
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use pulp::NullaryFnOnce;

pub use double_double::DoubleDouble;
pub use dual::Dual;
pub use gradient::{Gradient, GradientIn};
pub use pair::{Both, Pair, PairOfDoubles};
#[doc(hidden)]
pub use slopes::Slopes;

/// A real number that generated code can calculate with.
///
/// The elementary functions of `f64` come from `libm`, so that the same input gives the same bytes on every machine and
/// at every optimisation level.
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// Two such numbers, calculated with at once.
    type Pair: Pair<Self>;
    /// Whether the guard of a switch is negative: for numbers side by side, of each.
    type Switch: Copy + Debug + From<bool>;
    /// What these numbers are known as, where this crate compiles what starts a model in them.
    #[doc(hidden)]
    const KNOWN_AS: KnownAs = KnownAs::Other;

    /// The number nearest to `value`.
    fn from_f64(value: f64) -> Self;
    /// The nearest `f64`.
    fn to_f64(self) -> f64;
    /// The number nearest to `value`, where there is a number already: for numbers in vectors of a machine that is
    /// cheaper.
    #[must_use]
    #[inline(always)]
    fn alike(self, value: f64) -> Self {
        Self::from_f64(value)
    }
    /// The number times `factor`.
    #[must_use]
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self * Self::from_f64(factor)
    }
    /// `negative` where `switch` is, else `positive`.
    #[must_use]
    fn select(switch: Self::Switch, negative: Self, positive: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine of an angle in rad.
    fn sin(self) -> Self;
    /// Cosine of an angle in rad.
    fn cos(self) -> Self;
    /// Tangent of an angle in rad.
    fn tan(self) -> Self;
    /// Arc sine, rad, in -pi/2..=pi/2.
    fn asin(self) -> Self;
    /// Arc cosine, rad, in 0..=pi.
    fn acos(self) -> Self;
    /// Arc tangent of `self / x` in the right quadrant, rad, in -pi..=pi.
    fn atan2(self, x: Self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The larger number; `other` where one of them is none.
    #[must_use]
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// `self` to the real power `exponent`.
    fn powf(self, exponent: Self) -> Self;

    /// Calls `of`, in the machine's vectors where long calculations with these numbers gain by it.
    #[doc(hidden)]
    #[inline(always)]
    fn in_vectors<F: NullaryFnOnce>(of: F) -> F::Output {
        of.call()
    }
}

/// Numbers for which this crate compiles what starts a model, so that no crate with a model compiles that again.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnownAs {
    /// `f64`.
    Doubles,
    /// [`DoubleDouble`].
    DoubleDoubles,
    /// [`Gradient`].
    Gradients,
    /// Any others: compiled with who starts a model in them.
    Other,
}

/// Of what this crate compiles for the numbers that it knows, a static for doubles, double-doubles and gradients each,
/// that of the numbers `$scalar`, which is a `$kind`; for other numbers `$other`, compiled with the caller. Only one
/// branch is ever compiled: each asks a constant.
macro_rules! compiled_for {
    ($scalar:ty => $kind:ty, [$doubles:expr, $double_doubles:expr, $gradients:expr], $other:expr) => {{
        use $crate::model::scalar::{KnownAs, Scalar, known};
        if const { matches!(<$scalar as Scalar>::KNOWN_AS, KnownAs::Doubles) } {
            known::<$kind>($doubles)
        } else if const { matches!(<$scalar as Scalar>::KNOWN_AS, KnownAs::DoubleDoubles) } {
            known::<$kind>($double_doubles)
        } else if const { matches!(<$scalar as Scalar>::KNOWN_AS, KnownAs::Gradients) } {
            known::<$kind>($gradients)
        } else {
            $other
        }
    }};
}
pub(crate) use compiled_for;

/// The same static in numbers that are what they are known as.
pub(crate) fn known<T: Any>(compiled: &'static dyn Any) -> &'static T {
    compiled.downcast_ref().expect("numbers are what they are known as")
}

impl Scalar for f64 {
    type Pair = PairOfDoubles;
    type Switch = bool;
    const KNOWN_AS: KnownAs = KnownAs::Doubles;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline(always)]
    fn select(switch: bool, negative: Self, positive: Self) -> Self {
        if switch { negative } else { positive }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        double::root(self)
    }
    #[inline]
    fn sin(self) -> Self {
        libm::sin(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cos(self)
    }
    #[inline]
    fn tan(self) -> Self {
        libm::tan(self)
    }
    #[inline]
    fn asin(self) -> Self {
        libm::asin(self)
    }
    #[inline]
    fn acos(self) -> Self {
        libm::acos(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::log(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
    #[inline(always)]
    fn in_vectors<F: NullaryFnOnce>(of: F) -> F::Output {
        machine::Arch::new().dispatch(of)
    }
}

#[cfg(test)]
mod tests {
    use super::Scalar;

    /// A function of two numbers that takes every operation.
    pub fn everything<S: Scalar>(x: S, y: S) -> S {
        let number = S::from_f64;
        let trigonometry = x.sin() * y.cos() + (x * y).tan() - (x * number(0.5)).asin() / (y * number(0.25)).acos();
        let growth = (x * y).exp() + (x + y).ln() * y.tanh() - x.powf(y) * x.powf(number(1.5)) + (-x).abs();
        trigonometry + growth * x.atan2(y) + (x / y).sqrt().times(0.75)
    }
}
