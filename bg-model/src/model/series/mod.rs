//! Taylor series of what a rate is made of: the arithmetic of the generated [`System::series`](crate::system::System::series).
//!
//! In: the coefficients of the operands up to an order `k`. Out: the coefficient of order `k` of a product, a quotient or a
//! function. Sums, and products with numbers, need none of this: they act on each order alone.
//! Method: the recurrences of power series (Moore 1966, Interval Analysis, chapter 11; Griewank & Walther 2008, Evaluating
//! Derivatives, section 13.2; Knuth, The Art of Computer Programming 2, section 4.7). What later orders ask for is kept in
//! rows, one for each order: each operation has places of its own in them, from `at` on.

mod functions;
#[cfg(test)]
mod tests;

pub use functions::{acos, asin, atan2, cos, exp, ln, power, powf, sin, sqrt, tan, tanh};

use crate::model::scalar::Scalar;

/// A number's coefficients: itself, and zeros.
#[inline(always)]
pub fn constant<S: Scalar>(k: usize, value: S) -> S {
    if k == 0 { value } else { S::from_f64(0.0) }
}

/// Writes numbers side by side, from `at` on.
#[inline(always)]
pub fn store<S: Scalar, const K: usize>(to: &mut [S], at: usize, values: [S; K]) {
    *to[at..].first_chunk_mut().expect("generated code has the places that it writes") = values;
}

/// The product of `left` and `right`. Places: 2.
#[inline(always)]
pub fn product<S: Scalar, const W: usize>(rows: &mut [[S; W]], k: usize, at: usize, left: S, right: S) -> S {
    (rows[k][at], rows[k][at + 1]) = (left, right);
    sum(rows, 0, k + 1, k, at, at + 1)
}

/// The first coefficient of a product. Its factors are kept at the places `left` and `right`.
#[inline(always)]
pub fn first_product<S: Scalar, const W: usize>(rows: &mut [[S; W]], left: usize, right: usize, a: S, b: S) -> S {
    (rows[0][left], rows[0][right]) = (a, b);
    a * b
}

/// The coefficient of order `k` of one of `P` products, from that of the factors and what [`inner_products`] gave for it.
#[inline(always)]
pub fn next_product<S: Scalar, const P: usize, const W: usize>(
    inner: &[S; P],
    rows: &mut [[S; W]],
    k: usize,
    at: usize,
    a: S,
    b: S,
) -> S {
    (rows[k][at], rows[k][P + at]) = (a, b);
    inner[at] + (a * rows[0][P + at] + rows[0][at] * b)
}

/// The parts of `P` products at the next order, `k`, that only need the orders from 1 to `k` - 1 of their factors: what is
/// added to them is left of order 0 times right of order `k` and the other way round. In `rows`, of orders 0 to `k` - 1, the
/// left factors have the first places, the right ones the next.
///
/// Many products in one loop do not wait for each other; nor do they wait for the factors of order `k`.
#[inline(always)]
pub fn inner_products<S: Scalar, const P: usize, const W: usize>(rows: &[[S; W]]) -> [S; P] {
    let inner = &rows[1..];
    let mut sums = [S::from_f64(0.0); P];
    let mut at = 0;
    // As many sums at once as fit the registers of any machine, then what remains in halves.
    at = passes::<S, 16, P, W>(inner, at, &mut sums);
    at = passes::<S, 8, P, W>(inner, at, &mut sums);
    at = passes::<S, 4, P, W>(inner, at, &mut sums);
    at = passes::<S, 2, P, W>(inner, at, &mut sums);
    passes::<S, 1, P, W>(inner, at, &mut sums);
    // Else the sums stand side by side in the order in which they are read, and what they are made of has to be put in that order.
    core::hint::black_box(&mut sums);
    sums
}

/// Passes of `M` of the `P` sums side by side, from the sum `at` on, as long as there are so many. Gives the next one.
#[inline(always)]
fn passes<S: Scalar, const M: usize, const P: usize, const W: usize>(
    inner: &[[S; W]],
    mut at: usize,
    sums: &mut [S; P],
) -> usize {
    while at + M <= P {
        let mut some = [S::from_f64(0.0); M];
        for (ascending, descending) in inner.iter().zip(inner.iter().rev()) {
            for (i, sum) in some.iter_mut().enumerate() {
                *sum = *sum + ascending[at + i] * descending[at + P + i];
            }
        }
        sums[at..at + M].copy_from_slice(&some);
        at += M;
    }
    at
}

/// The quotient of `dividend` and `divisor`. Places: 2.
#[inline(always)]
pub fn quotient<S: Scalar, const W: usize>(rows: &mut [[S; W]], k: usize, at: usize, dividend: S, divisor: S) -> S {
    rows[k][at] = divisor;
    let known = sum(rows, 0, k, k, at + 1, at);
    let quotient = (dividend - known) / rows[0][at];
    rows[k][at + 1] = quotient;
    quotient
}

/// The absolute value: the operand or its opposite, by the sign at the start. Places: 1.
#[inline(always)]
pub fn abs<S: Scalar, const W: usize>(rows: &mut [[S; W]], k: usize, at: usize, u: S) -> S {
    rows[k][at] = u;
    if rows[0][at] < S::from_f64(0.0) { -u } else { u }
}

/// The sum of the products of `a` at order j and `b` at order `k` - j, for j from `from` to before `to`.
#[inline(always)]
fn sum<S: Scalar, const W: usize>(rows: &[[S; W]], from: usize, to: usize, k: usize, a: usize, b: usize) -> S {
    (from..to).fold(S::from_f64(0.0), |sum, j| sum + rows[j][a] * rows[k - j][b])
}

/// The same, each product times j.
#[inline(always)]
fn slope<S: Scalar, const W: usize>(rows: &[[S; W]], from: usize, to: usize, k: usize, a: usize, b: usize) -> S {
    (from..to).fold(S::from_f64(0.0), |sum, j| sum + order::<S>(j) * rows[j][a] * rows[k - j][b])
}

/// The order as a number.
#[inline(always)]
fn order<S: Scalar>(k: usize) -> S {
    S::from_f64(k as f64)
}
