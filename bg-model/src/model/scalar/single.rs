//! `f32` as a scalar: what the floating-point units of small controllers calculate with.
//!
//! Elementary functions come from `libm`, so the same input gives the same bits on every machine here too. Values have
//! seven digits: enough for the steps of a controller's clock, too few for tight tolerances, which no method of this
//! crate has in `f32`.

use super::{Both, Scalar};

impl Scalar for f32 {
    type Pair = Both<f32>;
    type Switch = bool;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn select(switch: bool, negative: Self, positive: Self) -> Self {
        if switch { negative } else { positive }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }
    #[inline]
    fn sin(self) -> Self {
        libm::sinf(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cosf(self)
    }
    #[inline]
    fn tan(self) -> Self {
        libm::tanf(self)
    }
    #[inline]
    fn asin(self) -> Self {
        libm::asinf(self)
    }
    #[inline]
    fn acos(self) -> Self {
        libm::acosf(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2f(self, x)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::expf(self)
    }
    #[inline]
    fn ln(self) -> Self {
        libm::logf(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanhf(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::powf(self, exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::everything;

    #[test]
    fn every_function_is_that_of_doubles() {
        for (x, y) in [(0.3, 1.2), (0.9, 0.4), (0.05, 2.0)] {
            let (single, double) = (everything(x as f32, y as f32), everything(x, y));
            assert!((f64::from(single) - double).abs() < 3e-5 * double.abs().max(1.0), "{single} {double}");
        }
    }
}
