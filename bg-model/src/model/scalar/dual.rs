//! Dual numbers: a value and its derivative along one direction. Exact first derivatives of generated code.

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Both, Scalar};

/// `value + slope e` with e^2 = 0, over any scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<S = f64> {
    /// The value.
    pub value: S,
    /// The derivative along the direction.
    pub slope: S,
}

impl<S: Scalar> Dual<S> {
    /// `value` that changes by `slope` along the direction.
    #[must_use]
    pub const fn new(value: S, slope: S) -> Self {
        Self { value, slope }
    }

    /// A function of this number from its value and its derivative here.
    fn of(self, value: S, derivative: S) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl<S: Scalar> PartialOrd for Dual<S> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::new(self.value + b.value, self.slope + b.slope)
    }
}
impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::new(self.value - b.value, self.slope - b.slope)
    }
}
impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::new(self.value * b.value, self.slope * b.value + self.value * b.slope)
    }
}
impl<S: Scalar> Div for Dual<S> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Self::new(value, (self.slope - value * b.slope) / b.value)
    }
}
impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}

impl<S: Scalar> Scalar for Dual<S> {
    type Pair = Both<Self>;
    type Switch = S::Switch;

    fn from_f64(value: f64) -> Self {
        Self::new(S::from_f64(value), S::from_f64(0.0))
    }
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }
    fn select(switch: S::Switch, negative: Self, positive: Self) -> Self {
        let select = |negative, positive| S::select(switch, negative, positive);
        Self::new(select(negative.value, positive.value), select(negative.slope, positive.slope))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.of(root, S::from_f64(0.5) / root)
    }
    fn sin(self) -> Self {
        self.of(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.of(self.value.cos(), -self.value.sin())
    }
    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.of(tan, S::from_f64(1.0) + tan * tan)
    }
    fn asin(self) -> Self {
        let one = S::from_f64(1.0);
        self.of(self.value.asin(), one / (one - self.value * self.value).sqrt())
    }
    fn acos(self) -> Self {
        let one = S::from_f64(1.0);
        self.of(self.value.acos(), -one / (one - self.value * self.value).sqrt())
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self::new(self.value.atan2(x.value), (x.value * self.slope - self.value * x.slope) / square)
    }
    fn exp(self) -> Self {
        let exp = self.value.exp();
        self.of(exp, exp)
    }
    fn ln(self) -> Self {
        self.of(self.value.ln(), S::from_f64(1.0) / self.value)
    }
    fn tanh(self) -> Self {
        let tanh = self.value.tanh();
        self.of(tanh, S::from_f64(1.0) - tanh * tanh)
    }
    fn abs(self) -> Self {
        if self.value < S::from_f64(0.0) { -self } else { self }
    }
    fn powf(self, exponent: Self) -> Self {
        let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
        let value = self.value.powf(exponent.value);
        let base = exponent.value * self.value.powf(exponent.value - one) * self.slope;
        let power = if exponent.slope == zero { zero } else { value * self.value.ln() * exponent.slope };
        Self::new(value, base + power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::scalar::DoubleDouble;
    use crate::model::scalar::tests::everything;

    #[test]
    fn slopes_are_difference_quotients() {
        let number = DoubleDouble::from;
        for (x, y) in [(0.3, 0.9), (1.1, 0.4), (0.7, 1.3)] {
            let (along_x, along_y) = (number(0.6), number(-0.8));
            let dual = everything(Dual::new(number(x), along_x), Dual::new(number(y), along_y));
            let at = |h: f64| everything(number(x) + along_x * number(h), number(y) + along_y * number(h));
            let quotient = (at(1e-11) - at(-1e-11)) / number(2e-11);
            let error = ((dual.slope - quotient) / dual.slope).to_f64().abs();
            assert!(dual.value == at(0.0) && error < 1e-18, "{error:e}");
            let plain = everything(Dual::new(x, 0.6), Dual::new(y, -0.8));
            assert!((plain.slope - dual.slope.to_f64()).abs() < 1e-13 * (1.0 + plain.slope.abs()), "{}", plain.slope);
        }
    }
}
