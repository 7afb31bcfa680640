//! The elementary functions of a series, each through the differential equation that it satisfies.

use super::{Rows, constant, order, product, slope, sum};
use crate::model::scalar::Scalar;

/// The coefficient of order `k` > 0 of the w with w' = d u': the mean of the products of u's slopes and d.
#[inline(always)]
fn integral<S: Scalar>(rows: &(impl Rows<S> + ?Sized), k: usize, u: usize, d: usize) -> S {
    slope(rows, 1, k + 1, k, u, d) / order(k)
}

/// The square root: w w = u. Places: 1.
#[inline(always)]
pub fn sqrt<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    let w = if k == 0 { u.sqrt() } else { (u - sum(rows, 1, k, k, at, at)) / (rows[0][at] + rows[0][at]) };
    rows[k][at] = w;
    w
}

/// The exponential: w' = w u'. Places: 2.
#[inline(always)]
pub fn exp<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    rows[k][at] = u;
    let w = if k == 0 { u.exp() } else { integral(rows, k, at, at + 1) };
    rows[k][at + 1] = w;
    w
}

/// The natural logarithm: u w' = u'. Places: 2.
#[inline(always)]
pub fn ln<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    rows[k][at] = u;
    let w = if k == 0 { u.ln() } else { (u - slope(rows, 1, k, k, at + 1, at) / order(k)) / rows[0][at] };
    rows[k][at + 1] = w;
    w
}

/// Sine and cosine of `u`, which they need of each other. Places: 3.
#[inline(always)]
fn sin_cos<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> (S, S) {
    rows[k][at] = u;
    let (sine, cosine) =
        if k == 0 { (u.sin(), u.cos()) } else { (integral(rows, k, at, at + 2), -integral(rows, k, at, at + 1)) };
    (rows[k][at + 1], rows[k][at + 2]) = (sine, cosine);
    (sine, cosine)
}

/// The sine: s' = c u', c' = -s u'. Places: 3.
#[inline(always)]
pub fn sin<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    sin_cos(rows, k, at, u).0
}

/// The cosine. Places: 3.
#[inline(always)]
pub fn cos<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    sin_cos(rows, k, at, u).1
}

/// The w of value `start` with w' = (1 + `sign` w w) u'. Places: 3.
#[inline(always)]
fn tangent<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S, start: S, sign: S) -> S {
    rows[k][at] = u;
    let w = if k == 0 { start } else { integral(rows, k, at, at + 2) };
    rows[k][at + 1] = w;
    let square = sum(rows, 0, k + 1, k, at + 1, at + 1);
    rows[k][at + 2] = constant(k, S::from_f64(1.0)) + sign * square;
    w
}

/// The tangent: w' = (1 + w w) u'. Places: 3.
#[inline(always)]
pub fn tan<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    let start = if k == 0 { u.tan() } else { u };
    tangent(rows, k, at, u, start, S::from_f64(1.0))
}

/// The hyperbolic tangent: w' = (1 - w w) u'. Places: 3.
#[inline(always)]
pub fn tanh<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    let start = if k == 0 { u.tanh() } else { u };
    tangent(rows, k, at, u, start, S::from_f64(-1.0))
}

/// The arc sine: r w' = u' with r r = 1 - u u. Places: 3.
#[inline(always)]
pub fn asin<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    rows[k][at] = u;
    let square = sum(rows, 0, k + 1, k, at, at);
    let radicand = constant(k, S::from_f64(1.0)) - square;
    sqrt(rows, k, at + 1, radicand);
    let w = if k == 0 { u.asin() } else { (u - slope(rows, 1, k, k, at + 2, at + 1) / order(k)) / rows[0][at + 1] };
    rows[k][at + 2] = w;
    w
}

/// The arc cosine, which changes as the arc sine does, the other way. Places: 3.
#[inline(always)]
pub fn acos<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    let sine = asin(rows, k, at, u);
    if k == 0 { u.acos() } else { -sine }
}

/// The angle of the point (`x`, `y`): (x x + y y) w' = x y' - y x'. Places: 4.
#[inline(always)]
pub fn atan2<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, y: S, x: S) -> S {
    (rows[k][at], rows[k][at + 1]) = (y, x);
    rows[k][at + 2] = sum(rows, 0, k + 1, k, at, at) + sum(rows, 0, k + 1, k, at + 1, at + 1);
    let w = if k == 0 {
        y.atan2(x)
    } else {
        let turned = slope(rows, 1, k + 1, k, at, at + 1) - slope(rows, 1, k + 1, k, at + 1, at);
        (turned - slope(rows, 1, k, k, at + 3, at + 2)) / (order::<S>(k) * rows[0][at + 2])
    };
    rows[k][at + 3] = w;
    w
}

/// The power `u` to a constant `exponent`: u w' = exponent w u'. Places: 2.
#[inline(always)]
pub fn powf<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S, exponent: S) -> S {
    rows[k][at] = u;
    let w = if k == 0 {
        u.powf(exponent)
    } else {
        let grown = exponent * slope(rows, 1, k + 1, k, at, at + 1) - slope(rows, 1, k, k, at + 1, at);
        grown / (order::<S>(k) * rows[0][at])
    };
    rows[k][at + 1] = w;
    w
}

/// The power `u` to an `exponent` that changes: w' = w p' with p = exponent ln u. Places: 6.
#[inline(always)]
pub fn power<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S, exponent: S) -> S {
    let logarithm = ln(rows, k, at, u);
    rows[k][at + 4] = product(rows, k, at + 2, exponent, logarithm);
    let w = if k == 0 { u.powf(exponent) } else { integral(rows, k, at + 4, at + 5) };
    rows[k][at + 5] = w;
    w
}
