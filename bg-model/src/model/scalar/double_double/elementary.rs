//! Elementary functions of double-double numbers: series on a reduced argument, or a Newton step from the value of
//! `libm`.
//!
//! After Hida, Li, Bailey: Library for double-double and quad-double arithmetic (QD), 2007, with relative accuracy also
//! near the zeros of the functions. Right rather than fast. Relative errors: below 1e-30, of `exp` and `powf` times the
//! magnitude of the exponent where that is above 10.

use super::{DoubleDouble, two_product};
use crate::model::scalar::Scalar;
use crate::model::scalar::double::modulo;

/// pi/2 as a sum of four.
const HALF_PI: [f64; 4] =
    [core::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591698e-33, 5.562271104316826e-50];
/// ln 2 as a sum of three.
const LN_2: [f64; 3] = [core::f64::consts::LN_2, 2.3190468138462996e-17, 5.707708438416212e-34];
/// Terms of a series below this part of its sum are left out.
const NEGLIGIBLE: f64 = 1e-34;
/// More terms than any series here takes.
const TERMS: u32 = 200;

const ONE: DoubleDouble = DoubleDouble { high: 1.0, low: 0.0 };

/// `x` less the nearest multiple of `modulus`, and the multiple.
fn reduced(x: DoubleDouble, modulus: &[f64]) -> (DoubleDouble, f64) {
    let multiple = libm::round(x.high / modulus[0]);
    (modulus.iter().fold(x, |rest, part| rest - two_product(multiple, *part)), multiple)
}

/// `first (1 + r_1 + r_1 r_2 + ...)`, where `ratio(k)` is r_k.
fn series(first: DoubleDouble, ratio: impl Fn(f64) -> DoubleDouble) -> DoubleDouble {
    let (mut term, mut sum) = (first, first);
    for k in 1..TERMS {
        term = term * ratio(f64::from(k));
        sum = sum + term;
        if term.high.abs() <= NEGLIGIBLE * sum.high.abs() {
            break;
        }
    }
    sum
}

/// Sine and cosine; the argument reduced modulo pi/2 with 210 bits, good for |x| < 1e8.
pub fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (angle, quarters) = reduced(x, &HALF_PI);
    let square = -(angle * angle);
    let sin = series(angle, |k| square / DoubleDouble::from(2.0 * k * (2.0 * k + 1.0)));
    let cos = series(ONE, |k| square / DoubleDouble::from((2.0 * k - 1.0) * 2.0 * k));
    match modulo(quarters, 4.0) {
        1.0 => (cos, -sin),
        2.0 => (-sin, -cos),
        3.0 => (-cos, sin),
        _ => (sin, cos),
    }
}

/// The other leg of a right triangle with hypotenuse 1: sqrt((1 - x)(1 + x)).
pub fn other_leg(x: DoubleDouble) -> DoubleDouble {
    ((ONE - x) * (ONE + x)).sqrt()
}

/// The angle of the point (x, y): that of `libm`, turned by what is left.
pub fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    let near = DoubleDouble::from(libm::atan2(y.high, x.high));
    if (y.high == 0.0 && x.high >= 0.0) || near.high.is_nan() {
        return near;
    }
    let (sin, cos) = sin_cos(near);
    // The tangent of an angle of 1e-16 is the angle.
    near + (y * cos - x * sin) / (x * cos + y * sin)
}

/// e^x - 1 for |x| < 1: the series at x / 512, squared nine times.
fn small_exp_minus_one(x: DoubleDouble) -> DoubleDouble {
    const SQUARINGS: u32 = 9;
    let part = x.scaled(1.0 / f64::from(1_u32 << SQUARINGS));
    let first = series(part, |k| part / DoubleDouble::from(k + 1.0));
    (0..SQUARINGS).fold(first, |value, _| value.scaled(2.0) + value * value)
}

pub fn exp(x: DoubleDouble) -> DoubleDouble {
    const OVERFLOW: f64 = 709.0;
    if x.high.abs() >= OVERFLOW || x.high.is_nan() {
        return DoubleDouble::from(libm::exp(x.high));
    }
    let (rest, doublings) = reduced(x, &LN_2);
    let value = ONE + small_exp_minus_one(rest);
    // In two halves: 2^doublings alone may leave the range of `f64`.
    let half = libm::floor(doublings / 2.0);
    value.scaled(libm::exp2(half)).scaled(libm::exp2(doublings - half))
}

pub fn ln(x: DoubleDouble) -> DoubleDouble {
    let near = libm::log(x.high);
    if near.abs() < 0.25 {
        // 2 artanh s keeps the relative accuracy near 1.
        let s = (x - ONE) / (x + ONE);
        if s.high == 0.0 {
            return s;
        }
        let square = s * s;
        let odd = |k: f64| DoubleDouble::from(2.0 * k + 1.0);
        return series(s, |k| square * odd(k - 1.0) / odd(k)).scaled(2.0);
    }
    if !near.is_finite() {
        return DoubleDouble::from(near);
    }
    // Newton's step for e^y = x, with x in the middle of its range.
    let exponent = libm::round(near / LN_2[0]);
    let half = libm::floor(exponent / 2.0);
    let mantissa = x.scaled(libm::exp2(-half)).scaled(libm::exp2(half - exponent));
    let near = DoubleDouble::from(libm::log(mantissa.high));
    let of_mantissa = near + (mantissa * exp(-near) - ONE);
    LN_2.iter().rev().fold(DoubleDouble::default(), |sum, part| sum + two_product(exponent, *part)) + of_mantissa
}

pub fn tanh(x: DoubleDouble) -> DoubleDouble {
    // e^-2x is below the last digit of 1.
    const SATURATED: f64 = 40.0;
    let size = x.abs();
    let tanh = if size.high > SATURATED {
        ONE
    } else if size.high < 0.25 {
        let grown = small_exp_minus_one(size.scaled(2.0));
        grown / (grown + DoubleDouble::from(2.0))
    } else {
        ONE - DoubleDouble::from(2.0) / (exp(size.scaled(2.0)) + ONE)
    };
    if x.high < 0.0 { -tanh } else { tanh }
}

/// `x` to the power `y`: whole powers up to 64 by multiplication, others of a positive `x` by e^(y ln x).
pub fn powf(x: DoubleDouble, y: DoubleDouble) -> DoubleDouble {
    const WHOLE: f64 = 64.0;
    let is_whole = y.low == 0.0 && y.high == libm::trunc(y.high);
    if is_whole && y.high.abs() <= WHOLE {
        let power = (0..y.high.abs() as u32).fold(ONE, |power, _| power * x);
        return if y.high < 0.0 { ONE / power } else { power };
    }
    if x.high == 0.0 {
        return DoubleDouble::from(libm::pow(x.high, y.high));
    }
    let size = if is_whole { x.abs() } else { x };
    let power = exp(y * ln(size));
    if x.high < 0.0 && modulo(y.high, 2.0) == 1.0 { -power } else { power }
}
