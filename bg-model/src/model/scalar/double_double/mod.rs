//! Double-double numbers: the unevaluated sum of two `f64`, about 31 decimal digits.
//!
//! In: `f64`. Out: a [`Scalar`]. Arithmetic without fused multiply-add and in a fixed order, so that every build gives
//! the same bytes. With u = 2^-53 the relative errors are below
//!
//! | operation | bound | source |
//! |---|---|---|
//! | `+`, `-` | 3 u^2 + 13 u^3 | `AccurateDWPlusDW` in [1] |
//! | `*` | 7 u^2 | `DWTimesDW1` in [1] |
//! | `/` | 15 u^2 + 56 u^3 | `DWDivDW2` in [1] |
//! | `sqrt` | 25/8 u^2 | `SQRTDWtoDW` in [2] |
//!
//! [1] Joldes, Muller, Popescu: Tight and rigorous error bounds for basic building blocks of double-word arithmetic.
//! ACM Transactions on Mathematical Software 44(2), 2017. [2] Lefevre, Louvet, Muller, Picot, Rideau: Accurate
//! calculation of Euclidean norms using double-word arithmetic. ACM Transactions on Mathematical Software 49(1), 2023.
//! Exact sums: Knuth, The Art of Computer Programming 2; exact products: Dekker, Numerische Mathematik 18, 1971.

mod elementary;

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Both, KnownAs, Scalar, double};

/// The sum of two `f64`, the second at most half a unit in the last place of the first.
///
/// Good for magnitudes from 1e-250 to 1e+250 (and 0); what leaves them loses digits, and what overflows is no number.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    // Compared in this order.
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// The sum of two `f64`, exactly.
    #[must_use]
    pub fn new(a: f64, b: f64) -> Self {
        two_sum(a, b)
    }

    /// The nearest `f64`.
    #[must_use]
    pub const fn high(self) -> f64 {
        self.high
    }

    /// What the nearest `f64` leaves.
    #[must_use]
    pub const fn low(self) -> f64 {
        self.low
    }

    /// This times a power of two, exactly.
    fn scaled(self, power_of_two: f64) -> Self {
        Self { high: self.high * power_of_two, low: self.low * power_of_two }
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

/// `a + b` exactly (Knuth).
#[inline(always)]
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let a_part = high - b;
    let b_part = high - a_part;
    DoubleDouble { high, low: (a - a_part) + (b - b_part) }
}

/// `a + b` exactly, where a is zero or not smaller than b (Dekker).
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// Two halves of `a` with at most 26 bits each (Veltkamp).
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// `a b` exactly (Dekker).
#[inline(always)]
fn two_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    DoubleDouble { high, low: a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2) }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn add(self, b: Self) -> Self {
        let high = two_sum(self.high, b.high);
        let low = two_sum(self.low, b.low);
        let sum = fast_two_sum(high.high, high.low + low.high);
        fast_two_sum(sum.high, low.low + sum.low)
    }
}
impl Sub for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}
impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn mul(self, b: Self) -> Self {
        let product = two_product(self.high, b.high);
        let cross = self.high * b.low + self.low * b.high;
        fast_two_sum(product.high, product.low + cross)
    }
}
impl Div for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn div(self, b: Self) -> Self {
        let quotient = self.high / b.high;
        // b * quotient with the product by one word.
        let product = two_product(b.high, quotient);
        let product = fast_two_sum(product.high, product.low + b.low * quotient);
        let rest = (self.high - product.high) + (self.low - product.low);
        fast_two_sum(quotient, rest / b.high)
    }
}
impl Neg for DoubleDouble {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Scalar for DoubleDouble {
    type Pair = Both<Self>;
    type Switch = bool;
    const KNOWN_AS: KnownAs = KnownAs::DoubleDoubles;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::from(value)
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.high
    }
    #[inline(always)]
    fn select(switch: bool, negative: Self, positive: Self) -> Self {
        if switch { negative } else { positive }
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        if self.high == 0.0 {
            return self;
        }
        let root = double::root(self.high);
        let square = two_product(root, root);
        let rest = ((self.high - square.high) - square.low) + self.low;
        fast_two_sum(root, rest / (2.0 * root))
    }
    fn sin(self) -> Self {
        elementary::sin_cos(self).0
    }
    fn cos(self) -> Self {
        elementary::sin_cos(self).1
    }
    fn tan(self) -> Self {
        let (sin, cos) = elementary::sin_cos(self);
        sin / cos
    }
    fn asin(self) -> Self {
        elementary::atan2(self, elementary::other_leg(self))
    }
    fn acos(self) -> Self {
        elementary::atan2(elementary::other_leg(self), self)
    }
    fn atan2(self, x: Self) -> Self {
        elementary::atan2(self, x)
    }
    fn exp(self) -> Self {
        elementary::exp(self)
    }
    fn ln(self) -> Self {
        elementary::ln(self)
    }
    fn tanh(self) -> Self {
        elementary::tanh(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    fn powf(self, exponent: Self) -> Self {
        elementary::powf(self, exponent)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    /// Arguments and values with 40 digits and more: mpmath 1.3 with 120 digits, values as sums of three `f64`.
    const VALUES: &str = include_str!("values.csv");

    /// The largest relative errors allowed: the proven bounds of the arithmetic; elsewhere about twice what was
    /// measured.
    const ALLOWED: [(&str, f64); 14] = [
        ("add", 3.0 * U2),
        ("mul", 7.0 * U2),
        ("div", 15.0 * U2),
        ("sqrt", 3.125 * U2),
        ("sin", 4e-31),
        ("cos", 8e-32),
        ("tan", 4e-31),
        ("asin", 1.5e-31),
        ("acos", 5e-32),
        ("atan2", 5e-32),
        ("exp", 5e-32),
        ("ln", 8e-32),
        ("tanh", 8e-32),
        ("powf", 8e-31),
    ];
    const U2: f64 = 1.25e-32;

    fn calculate(function: &str, x: DoubleDouble, y: DoubleDouble) -> DoubleDouble {
        match function {
            "add" => x + y,
            "mul" => x * y,
            "div" => x / y,
            "sqrt" => x.sqrt(),
            "sin" => x.sin(),
            "cos" => x.cos(),
            "tan" => x.tan(),
            "asin" => x.asin(),
            "acos" => x.acos(),
            "atan2" => x.atan2(y),
            "exp" => x.exp(),
            "ln" => x.ln(),
            "tanh" => x.tanh(),
            "powf" => x.powf(y),
            other => panic!("no function {other}"),
        }
    }

    #[test]
    fn every_function_has_its_accuracy() {
        let mut largest: BTreeMap<&str, (f64, DoubleDouble)> = BTreeMap::new();
        for line in VALUES.lines().skip(1) {
            let (function, numbers) = line.split_once(',').unwrap();
            let numbers: Vec<f64> = numbers.split(',').map(|number| number.parse().unwrap()).collect();
            let [x, x_low, y, y_low, value, value_low, rest] = numbers[..] else { panic!("{line}") };
            let x = DoubleDouble { high: x, low: x_low };
            let result = calculate(function, x, DoubleDouble { high: y, low: y_low });
            let difference = (result.high - value) + ((result.low - value_low) - rest);
            let error = (difference / value).abs();
            let most = largest.entry(function).or_insert((0.0, x));
            if error > most.0 || error.is_nan() {
                *most = (error, x);
            }
        }
        for (function, allowed) in ALLOWED {
            let (error, at) = largest[function];
            println!("{function}: {error:.1e}");
            assert!(error <= allowed, "{function} is off by {error:e} at {at:?}");
        }
        assert_eq!(largest.len(), ALLOWED.len());
    }

    #[test]
    fn exact_results_are_exact() {
        let number = DoubleDouble::from;
        assert_eq!(DoubleDouble::new(1.0, 1e-20) - number(1.0), number(1e-20));
        assert_eq!(number(1.0) / number(3.0) * number(3.0), number(1.0));
        assert_eq!((number(2.0).sqrt() * number(2.0).sqrt()).high(), 2.0);
        assert_eq!(number(-49.0).abs().sqrt(), number(7.0));
        assert_eq!(number(0.0).sqrt(), number(0.0));
        assert_eq!((number(0.0).sin(), number(0.0).cos()), (number(0.0), number(1.0)));
        assert_eq!((number(0.0).exp(), number(1.0).ln(), number(0.0).tanh()), (number(1.0), number(0.0), number(0.0)));
        assert_eq!(number(-3.0).powf(number(3.0)), number(-27.0));
        assert_eq!(number(0.0).powf(number(0.5)), number(0.0));
        assert_eq!(number(0.0).atan2(number(1.0)), number(0.0));
        assert_eq!(number(1.0).acos(), number(0.0));
        assert_eq!(number(50.0).tanh(), number(1.0));
    }

    #[test]
    fn order_is_that_of_the_sum() {
        let (a, b) = (DoubleDouble::new(1.0, -1e-20), DoubleDouble::new(1.0, 1e-20));
        assert!(a < b && a < DoubleDouble::from(1.0) && b > DoubleDouble::from(1.0) && -b < -a);
    }

    #[test]
    fn what_is_no_number_stays_none() {
        let number = DoubleDouble::from;
        let none = [
            number(-1.0).sqrt(),
            number(f64::NAN) + number(1.0),
            number(f64::NAN).sin(),
            number(-1.0).ln(),
            number(-2.0).powf(number(0.5)),
            number(2.0).asin(),
            number(f64::NAN).exp(),
            number(f64::NAN).tanh(),
        ];
        assert!(none.iter().all(|value| value.to_f64().is_nan()), "{none:?}");
    }

    #[test]
    fn identities_hold() {
        let number = DoubleDouble::from;
        let small = |value: DoubleDouble| assert!(value.to_f64().abs() < 1e-30, "{value:?}");
        for k in 1..200 {
            let x = number(f64::from(k)) / number(17.0) - number(5.0);
            let (sin, cos) = (x.sin(), x.cos());
            small(sin * sin + cos * cos - number(1.0));
            small(sin.atan2(cos).sin() - sin);
            small(x.exp() * (-x).exp() - number(1.0));
            small((x.exp().ln() - x) / number(6.0));
            let squared = (x + x).exp();
            small((x.tanh() * (squared + number(1.0)) - (squared - number(1.0))) / (squared + number(1.0)));
            let positive = x * x + number(0.01);
            small((positive.powf(number(1.5)) / (positive * positive.sqrt())) - number(1.0));
        }
    }
}
