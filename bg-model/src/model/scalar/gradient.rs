//! Numbers with their derivatives along several directions at once. Exact first derivatives by many parameters in one
//! pass.
//!
//! As [`Dual`](super::Dual) with more slopes, of [`Gradient`] [`Gradient::WIDTH`] of them: the value is calculated
//! once, the slopes side by side in vectors. The values are those of `f64`, to the bit, whatever the vectors.

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::slopes::{Everywhere, Slopes, WIDTH};
use super::{Both, KnownAs, Scalar};

/// A value and its derivatives along some directions, in vectors `V`.
#[derive(Clone, Copy, Debug)]
pub struct GradientIn<V> {
    /// The value.
    pub value: f64,
    /// The derivatives in their vectors.
    pub(crate) slopes: V,
}

/// A value and its derivatives along some directions.
pub type Gradient = GradientIn<Everywhere>;

impl<V: Slopes> GradientIn<V> {
    /// The number of directions.
    pub const WIDTH: usize = V::LANES;

    /// `value` that changes by `slopes` along the directions.
    #[must_use]
    #[inline(always)]
    pub fn new(value: f64, slopes: V::Numbers) -> Self {
        Self { value, slopes: V::new(slopes) }
    }

    /// The derivative along each direction.
    #[must_use]
    #[inline(always)]
    pub fn slopes(self) -> V::Numbers {
        self.slopes.numbers()
    }

    /// The value of some numbers with the slopes of all of them side by side.
    #[must_use]
    pub fn joined(numbers: &[Gradient]) -> Self {
        let mut slopes = V::filled(0.0).numbers();
        let places = slopes.as_mut().chunks_exact_mut(WIDTH);
        places.zip(numbers).for_each(|(place, number)| place.copy_from_slice(&number.slopes()));
        Self::new(numbers[0].value, slopes)
    }

    /// A function of this number from its value and its derivative here.
    #[inline(always)]
    fn of(self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: self.slopes.scaled(derivative) }
    }

    /// A function of two numbers from its value and its derivatives here.
    #[inline(always)]
    fn of_both(value: f64, (of_a, a): (f64, Self), (of_b, b): (f64, Self)) -> Self {
        Self { value, slopes: a.slopes.scaled(of_a).plus(b.slopes.scaled(of_b)) }
    }
}

impl<V: Slopes> PartialEq for GradientIn<V> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value && self.slopes().as_ref() == other.slopes().as_ref()
    }
}
impl<V: Slopes> PartialOrd for GradientIn<V> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl<V: Slopes> Add for GradientIn<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, slopes: self.slopes.plus(other.slopes) }
    }
}
impl<V: Slopes> Sub for GradientIn<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.value - other.value, slopes: self.slopes.minus(other.slopes) }
    }
}
impl<V: Slopes> Mul for GradientIn<V> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::of_both(self.value * b.value, (b.value, self), (self.value, b))
    }
}
impl<V: Slopes> Div for GradientIn<V> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let (value, part) = (self.value / b.value, 1.0 / b.value);
        Self::of_both(value, (part, self), (-value * part, b))
    }
}
impl<V: Slopes> Neg for GradientIn<V> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.of(-self.value, -1.0)
    }
}

impl<V: Slopes> Scalar for GradientIn<V> {
    type Pair = Both<Self>;
    type Switch = bool;
    const KNOWN_AS: KnownAs = if V::ARE_EVERYWHERE { KnownAs::Gradients } else { KnownAs::Other };

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self { value, slopes: V::filled(0.0) }
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value
    }
    #[inline(always)]
    fn times(self, factor: f64) -> Self {
        self.of(self.value * factor, factor)
    }
    #[inline(always)]
    fn select(switch: bool, negative: Self, positive: Self) -> Self {
        if switch { negative } else { positive }
    }
    fn sqrt(self) -> Self {
        let root = Scalar::sqrt(self.value);
        self.of(root, 0.5 / root)
    }
    fn sin(self) -> Self {
        self.of(Scalar::sin(self.value), Scalar::cos(self.value))
    }
    fn cos(self) -> Self {
        self.of(Scalar::cos(self.value), -Scalar::sin(self.value))
    }
    fn tan(self) -> Self {
        let tan = Scalar::tan(self.value);
        self.of(tan, 1.0 + tan * tan)
    }
    fn asin(self) -> Self {
        self.of(Scalar::asin(self.value), 1.0 / Scalar::sqrt(1.0 - self.value * self.value))
    }
    fn acos(self) -> Self {
        self.of(Scalar::acos(self.value), -1.0 / Scalar::sqrt(1.0 - self.value * self.value))
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let value = Scalar::atan2(self.value, x.value);
        Self::of_both(value, (x.value / square, self), (-self.value / square, x))
    }
    fn exp(self) -> Self {
        let exp = Scalar::exp(self.value);
        self.of(exp, exp)
    }
    fn ln(self) -> Self {
        self.of(Scalar::ln(self.value), 1.0 / self.value)
    }
    fn tanh(self) -> Self {
        let tanh = Scalar::tanh(self.value);
        self.of(tanh, 1.0 - tanh * tanh)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { self }
    }
    fn powf(self, exponent: Self) -> Self {
        let value = Scalar::powf(self.value, exponent.value);
        let by_base = exponent.value * Scalar::powf(self.value, exponent.value - 1.0);
        // A logarithm only where it counts: of a base below zero there is none.
        if exponent.slopes().as_ref().iter().all(|&slope| slope == 0.0) {
            return self.of(value, by_base);
        }
        Self::of_both(value, (by_base, self), (value * Scalar::ln(self.value), exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::Dual;
    #[cfg(target_arch = "x86_64")]
    use crate::model::scalar::lanes::{Avx2, Avx512};
    use crate::model::scalar::slopes::Eight;
    use crate::model::scalar::tests::everything;

    /// The value and the slopes of a function of three pairs of numbers, which have up to four slopes.
    fn agrees<V: Slopes>() -> Vec<Vec<u64>> {
        let mut bits = Vec::new();
        for (x, y) in [(0.3, 0.9), (1.1, 0.4), (0.7, 1.3)] {
            let along = [[1.0, 0.0], [0.0, 1.0], [0.6, -0.8], [0.0, 0.0]];
            let number = |value: f64, of: usize| {
                let mut slopes = V::filled(0.0).numbers();
                slopes.as_mut().iter_mut().zip(along).for_each(|(slope, along)| *slope = along[of]);
                GradientIn::<V>::new(value, slopes)
            };
            let gradient = everything(number(x, 0), number(y, 1));
            assert_eq!(gradient.value.to_bits(), everything(x, y).to_bits());
            let slopes = gradient.slopes();
            for (&slope, [by_x, by_y]) in slopes.as_ref().iter().zip(along) {
                let dual = everything(Dual::new(x, by_x), Dual::new(y, by_y)).slope;
                assert!((slope - dual).abs() < 1e-14 * (1.0 + dual.abs()), "{slope} {dual}");
            }
            assert!(slopes.as_ref().iter().skip(4).all(|&slope| slope == 0.0));
            let numbers = std::iter::once(&gradient.value).chain(slopes.as_ref().iter().take(4));
            bits.push(numbers.map(|number| number.to_bits()).collect());
        }
        bits
    }

    #[test]
    fn each_slope_is_that_of_a_dual_number_along_its_direction_on_every_machine() {
        let eight = agrees::<Eight>();
        #[cfg(target_arch = "x86_64")]
        {
            assert!(!Avx2::is_at_hand() || eight == agrees::<Avx2>());
            assert!(!Avx512::is_at_hand() || eight == agrees::<Avx512>());
        }
        let front: Vec<Vec<u64>> = eight.iter().map(|bits| bits[..=WIDTH].to_vec()).collect();
        assert_eq!((front.len(), front), (3, agrees::<Everywhere>()));
    }
}
