//! Numbers with their derivatives along several directions at once. Exact first derivatives by many parameters in one pass.
//!
//! As [`Dual`](super::Dual) with `W` slopes: the value is calculated once, the slopes side by side in the machine's vectors. The
//! values are those of `f64`, to the bit.

use std::array::from_fn;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Both, Scalar};

/// A value and its derivatives along `W` directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<const W: usize> {
    /// The value.
    pub value: f64,
    /// The derivative along each direction.
    pub slopes: [f64; W],
}

impl<const W: usize> Gradient<W> {
    /// `value` that changes by `slopes` along the directions.
    #[must_use]
    pub const fn new(value: f64, slopes: [f64; W]) -> Self {
        Self { value, slopes }
    }

    /// A function of this number from its value and its derivative here.
    #[inline(always)]
    fn of(self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: from_fn(|k| derivative * self.slopes[k]) }
    }
}

/// The slopes of `a` and of `b`, each with its weight.
#[inline(always)]
fn weighted<const W: usize>(a: &Gradient<W>, of_a: f64, b: &Gradient<W>, of_b: f64) -> [f64; W] {
    from_fn(|k| a.slopes[k] * of_a + of_b * b.slopes[k])
}

impl<const W: usize> PartialOrd for Gradient<W> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl<const W: usize> Add for Gradient<W> {
    type Output = Self;
    #[inline(always)]
    fn add(self, b: Self) -> Self {
        Self { value: self.value + b.value, slopes: from_fn(|k| self.slopes[k] + b.slopes[k]) }
    }
}
impl<const W: usize> Sub for Gradient<W> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        Self { value: self.value - b.value, slopes: from_fn(|k| self.slopes[k] - b.slopes[k]) }
    }
}
impl<const W: usize> Mul for Gradient<W> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, b: Self) -> Self {
        Self { value: self.value * b.value, slopes: weighted(&self, b.value, &b, self.value) }
    }
}
impl<const W: usize> Div for Gradient<W> {
    type Output = Self;
    #[inline(always)]
    fn div(self, b: Self) -> Self {
        let (value, part) = (self.value / b.value, 1.0 / b.value);
        Self { value, slopes: weighted(&self, part, &b, -value * part) }
    }
}
impl<const W: usize> Neg for Gradient<W> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, slopes: from_fn(|k| -self.slopes[k]) }
    }
}

impl<const W: usize> Scalar for Gradient<W> {
    type Pair = Both<Self>;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self { value, slopes: [0.0; W] }
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
        let slopes = from_fn(|k| (x.value * self.slopes[k] - self.value * x.slopes[k]) / square);
        Self { value: Scalar::atan2(self.value, x.value), slopes }
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
        let base = self.of(value, exponent.value * Scalar::powf(self.value, exponent.value - 1.0));
        // A logarithm only where it counts: of a base below zero there is none.
        if exponent.slopes == [0.0; W] {
            return base;
        }
        let by_exponent = value * Scalar::ln(self.value);
        Self { value, slopes: from_fn(|k| base.slopes[k] + by_exponent * exponent.slopes[k]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::Dual;

    /// A function of two numbers that takes every operation.
    fn everything<S: Scalar>(x: S, y: S) -> S {
        let number = S::from_f64;
        let trigonometry = x.sin() * y.cos() + (x * y).tan() - (x * number(0.5)).asin() / (y * number(0.25)).acos();
        let growth = (x * y).exp() + (x + y).ln() * y.tanh() - x.powf(y) * x.powf(number(1.5)) + (-x).abs();
        trigonometry + growth * x.atan2(y) + (x / y).sqrt()
    }

    #[test]
    fn each_slope_is_that_of_a_dual_number_along_its_direction() {
        for (x, y) in [(0.3, 0.9), (1.1, 0.4), (0.7, 1.3)] {
            let along = [[1.0, 0.0], [0.0, 1.0], [0.6, -0.8]];
            let gradient = everything(Gradient::new(x, along.map(|d| d[0])), Gradient::new(y, along.map(|d| d[1])));
            assert_eq!(gradient.value.to_bits(), everything(x, y).to_bits());
            for (slope, [by_x, by_y]) in gradient.slopes.into_iter().zip(along) {
                let dual = everything(Dual::new(x, by_x), Dual::new(y, by_y)).slope;
                assert!((slope - dual).abs() < 1e-14 * (1.0 + dual.abs()), "{slope} {dual}");
            }
        }
    }
}
