//! Dual numbers: a value and its derivative along one direction. Exact first derivatives of generated code.

use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use bg_model::scalar::Scalar;

/// `value + slope e` with e^2 = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// The derivative along the direction.
    pub slope: f64,
}

impl Dual {
    /// `value` that changes by `slope` along the direction.
    #[must_use]
    pub const fn new(value: f64, slope: f64) -> Self {
        Self { value, slope }
    }

    /// A function of this number from its value and its derivative here.
    fn of(self, value: f64, derivative: f64) -> Self {
        Self { value, slope: derivative * self.slope }
    }
}

impl PartialOrd for Dual {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.value.partial_cmp(&other.value)
    }
}
impl Add for Dual {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::new(self.value + b.value, self.slope + b.slope)
    }
}
impl Sub for Dual {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::new(self.value - b.value, self.slope - b.slope)
    }
}
impl Mul for Dual {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::new(self.value * b.value, self.slope * b.value + self.value * b.slope)
    }
}
impl Div for Dual {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Self::new(value, (self.slope - value * b.slope) / b.value)
    }
}
impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Self::new(value, 0.0)
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.of(root, 0.5 / root)
    }
    fn sin(self) -> Self {
        self.of(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.of(self.value.cos(), -self.value.sin())
    }
    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.of(tan, 1.0 + tan * tan)
    }
    fn asin(self) -> Self {
        self.of(self.value.asin(), 1.0 / (1.0 - self.value * self.value).sqrt())
    }
    fn acos(self) -> Self {
        self.of(self.value.acos(), -1.0 / (1.0 - self.value * self.value).sqrt())
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        Self::new(self.value.atan2(x.value), (x.value * self.slope - self.value * x.slope) / square)
    }
    fn exp(self) -> Self {
        self.of(self.value.exp(), self.value.exp())
    }
    fn ln(self) -> Self {
        self.of(self.value.ln(), 1.0 / self.value)
    }
    fn tanh(self) -> Self {
        let tanh = self.value.tanh();
        self.of(tanh, 1.0 - tanh * tanh)
    }
    fn abs(self) -> Self {
        self.of(self.value.abs(), self.value.signum())
    }
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let base = exponent.value * self.value.powf(exponent.value - 1.0) * self.slope;
        let power = if exponent.slope == 0.0 { 0.0 } else { value * self.value.ln() * exponent.slope };
        Self::new(value, base + power)
    }
}
