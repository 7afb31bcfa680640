//! Numbers with their derivatives along several directions at once. Exact first derivatives by many parameters in one pass.
//!
//! As [`Dual`](super::Dual) with [`Gradient::WIDTH`] slopes: the value is calculated once, the slopes side by side in vectors that
//! every machine of its kind has. The values are those of `f64`, to the bit.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use wide::f64x2;

use super::{Both, Scalar};

/// A value and its derivatives along some directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// The value.
    pub value: f64,
    slopes: [f64x2; 2],
}

impl Gradient {
    /// The number of directions.
    pub const WIDTH: usize = 4;

    /// `value` that changes by `slopes` along the directions.
    #[must_use]
    #[inline(always)]
    pub fn new(value: f64, [a, b, c, d]: [f64; Self::WIDTH]) -> Self {
        Self { value, slopes: [f64x2::new([a, b]), f64x2::new([c, d])] }
    }

    /// The derivative along each direction.
    #[must_use]
    #[inline(always)]
    pub fn slopes(self) -> [f64; Self::WIDTH] {
        let [[a, b], [c, d]] = self.slopes.map(f64x2::to_array);
        [a, b, c, d]
    }

    /// The number plus `weight` times another one: what sums of stages consist of.
    #[must_use]
    #[inline(always)]
    pub fn plus(self, weight: f64, other: &Self) -> Self {
        let ([a, b], [c, d], w) = (self.slopes, other.slopes, f64x2::splat(weight));
        Self { value: self.value + weight * other.value, slopes: [a + w * c, b + w * d] }
    }

    /// A function of this number from its value and its derivative here.
    #[inline(always)]
    fn of(self, value: f64, derivative: f64) -> Self {
        let ([a, b], d) = (self.slopes, f64x2::splat(derivative));
        Self { value, slopes: [d * a, d * b] }
    }

    /// A function of two numbers from its value and its derivatives here.
    #[inline(always)]
    fn of_both(value: f64, (of_a, a): (f64, Self), (of_b, b): (f64, Self)) -> Self {
        let ([a, b], [c, d]) = (a.slopes, b.slopes);
        let (of_a, of_b) = (f64x2::splat(of_a), f64x2::splat(of_b));
        Self { value, slopes: [a * of_a + of_b * c, b * of_a + of_b * d] }
    }
}

impl PartialOrd for Gradient {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl Add for Gradient {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        Self { value: self.value + other.value, slopes: [a + c, b + d] }
    }
}
impl Sub for Gradient {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b], [c, d]) = (self.slopes, other.slopes);
        Self { value: self.value - other.value, slopes: [a - c, b - d] }
    }
}
impl Mul for Gradient {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self::of_both(self.value * b.value, (b.value, self), (self.value, b))
    }
}
impl Div for Gradient {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let (value, part) = (self.value / b.value, 1.0 / b.value);
        Self::of_both(value, (part, self), (-value * part, b))
    }
}
impl Neg for Gradient {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.of(-self.value, -1.0)
    }
}

impl Scalar for Gradient {
    type Pair = Both<Self>;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self { value, slopes: [f64x2::splat(0.0); 2] }
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value
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
        if exponent.slopes() == [0.0; Self::WIDTH] {
            return self.of(value, by_base);
        }
        Self::of_both(value, (by_base, self), (value * Scalar::ln(self.value), exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::Dual;
    use crate::model::scalar::tests::everything;

    #[test]
    fn each_slope_is_that_of_a_dual_number_along_its_direction() {
        for (x, y) in [(0.3, 0.9), (1.1, 0.4), (0.7, 1.3)] {
            let along = [[1.0, 0.0], [0.0, 1.0], [0.6, -0.8], [0.0, 0.0]];
            let gradient = everything(Gradient::new(x, along.map(|d| d[0])), Gradient::new(y, along.map(|d| d[1])));
            assert_eq!(gradient.value.to_bits(), everything(x, y).to_bits());
            for (slope, [by_x, by_y]) in gradient.slopes().into_iter().zip(along) {
                let dual = everything(Dual::new(x, by_x), Dual::new(y, by_y)).slope;
                assert!((slope - dual).abs() < 1e-14 * (1.0 + dual.abs()), "{slope} {dual}");
            }
        }
    }
}
