//! What the elimination calculates with: real numbers, and complex ones for the methods of Radau and Gauss.

use core::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::Complex;

use crate::model::scalar::Scalar;

/// A number that generated eliminations can calculate with: a field that contains the reals `S`.
pub trait Field<S>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The real number `value`.
    fn real(value: S) -> Self;
    /// The product with a real number.
    fn scaled(self, by: S) -> Self;
    /// A measure of size within a factor of two of the absolute value; not a number where the number is none.
    fn size(self) -> f64;
}

impl<S: Scalar> Field<S> for S {
    #[inline(always)]
    fn real(value: S) -> Self {
        value
    }
    #[inline(always)]
    fn scaled(self, by: S) -> Self {
        self * by
    }
    #[inline(always)]
    fn size(self) -> f64 {
        self.to_f64().abs()
    }
}

impl Field<f64> for Complex<f64> {
    #[inline(always)]
    fn real(value: f64) -> Self {
        Self::new(value, 0.0)
    }
    #[inline(always)]
    fn scaled(self, by: f64) -> Self {
        Self::new(self.re * by, self.im * by)
    }
    #[inline(always)]
    fn size(self) -> f64 {
        self.re.abs() + self.im.abs()
    }
}
