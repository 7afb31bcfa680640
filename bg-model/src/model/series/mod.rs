//! Taylor series of what a rate is made of: the arithmetic of the generated
//! [`System::series`](crate::system::System::series).
//!
//! In: the coefficients of the operands up to an order `k`. Out: the coefficient of order `k` of a product, a quotient
//! or a function. Sums, and products with numbers, need none of this: they act on each order alone.
//! Method: the recurrences of power series (Moore 1966, Interval Analysis, chapter 11; Griewank & Walther 2008,
//! Evaluating Derivatives, section 13.2; Knuth, The Art of Computer Programming 2, section 4.7). What later orders ask
//! for is kept in rows, one for each order: each operation has places of its own in them, from `at` on.

mod functions;
#[cfg(test)]
mod tests;

pub use functions::{acos, asin, atan2, cos, exp, ln, power, powf, sin, sqrt, tan, tanh};

use core::ops::IndexMut;

use pulp::NullaryFnOnce;

use crate::model::scalar::{Pair, Scalar};

/// Rows of numbers, one for each order.
pub trait Rows<S>: IndexMut<usize, Output: IndexMut<usize, Output = S>> {}

impl<S, R: IndexMut<usize, Output: IndexMut<usize, Output = S>> + ?Sized> Rows<S> for R {}

/// Rows side by side in one list, of a width known at run time.
#[derive(Debug)]
pub struct Flat<'a, S> {
    /// The numbers.
    pub numbers: &'a mut [S],
    /// How many a row has.
    pub width: usize,
}

impl<S> core::ops::Index<usize> for Flat<'_, S> {
    type Output = [S];

    fn index(&self, k: usize) -> &[S] {
        &self.numbers[k * self.width..][..self.width]
    }
}

impl<S> IndexMut<usize> for Flat<'_, S> {
    fn index_mut(&mut self, k: usize) -> &mut [S] {
        &mut self.numbers[k * self.width..][..self.width]
    }
}

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

/// Numbers side by side, from `at` on.
#[inline(always)]
pub fn window<S, const K: usize>(from: &[S], at: usize) -> &[S; K] {
    from[at..].first_chunk().expect("generated code has the places that it reads")
}

/// What [`InnerProducts`] gives at order `k` for one product, whose factors stand at the places `left` and `right` of
/// `rows`, in the same order of additions.
pub fn inner_product<S: Scalar>(rows: &(impl Rows<S> + ?Sized), k: usize, left: usize, right: usize) -> S {
    let ascending =
        |from: usize, to: usize| (from..to).fold(S::from_f64(0.0), |sum, j| sum + rows[j][left] * rows[k - j][right]);
    match k {
        0 | 1 => S::from_f64(0.0),
        2 => rows[1][left] * rows[1][right],
        _ if k.is_multiple_of(2) => ascending(1, k),
        _ => ascending(2, k - 1) + (rows[1][left] * rows[k - 1][right] + rows[k - 1][left] * rows[1][right]),
    }
}

/// What [`inner_product`] gives at order `k` for products side by side: the left factors of as many as there are `sums`
/// have the first places of `rows`, the right ones the next. Both are a multiple of 4.
pub fn inner_products<S: Scalar>(rows: &Flat<'_, S>, k: usize, sums: &mut [S]) {
    S::in_vectors(SideBySide { rows, k, sums });
}

/// Inner products, in the vectors of the machine.
struct SideBySide<'a, S> {
    rows: &'a Flat<'a, S>,
    k: usize,
    sums: &'a mut [S],
}

impl<S: Scalar> NullaryFnOnce for SideBySide<'_, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let count = self.sums.len();
        let (wide, narrow) = self.sums.as_chunks_mut::<16>();
        for (sums, at) in wide.iter_mut().zip((0..).step_by(16)) {
            some_inner_products(self.rows, self.k, at, count, sums);
        }
        let first = 16 * wide.len();
        for (sums, at) in narrow.as_chunks_mut::<4>().0.iter_mut().zip((first..).step_by(4)) {
            some_inner_products(self.rows, self.k, at, count, sums);
        }
    }
}

/// Some of `count` inner products, from the place `at` on.
#[inline(always)]
fn some_inner_products<S: Scalar, const M: usize>(
    rows: &Flat<'_, S>,
    k: usize,
    at: usize,
    count: usize,
    to: &mut [S; M],
) {
    let row = |j: usize| &rows.numbers[j * rows.width..][..rows.width];
    let mut sums = [S::from_f64(0.0); M];
    if k == 2 {
        sums = multiplied(window(row(1), at), window(row(1), count + at));
    } else if k > 2 {
        let ascending = if k.is_multiple_of(2) { 1..k } else { 2..k - 1 };
        for j in ascending {
            let (left, right): (&[S; M], &[S; M]) = (window(row(j), at), window(row(k - j), count + at));
            for i in 0..M {
                sums[i] = sums[i] + left[i] * right[i];
            }
        }
        if !k.is_multiple_of(2) {
            let (first, last) = (row(1), row(k - 1));
            let begin: [S; M] = multiplied(window(first, at), window(last, count + at));
            let end: [S; M] = multiplied(window(last, at), window(first, count + at));
            for i in 0..M {
                sums[i] = sums[i] + (begin[i] + end[i]);
            }
        }
    }
    *to = sums;
}

/// The products of numbers side by side.
#[inline(always)]
fn multiplied<S: Scalar, const M: usize>(left: &[S; M], right: &[S; M]) -> [S; M] {
    let mut products = *left;
    for (product, &right) in products.iter_mut().zip(right) {
        *product = *product * right;
    }
    products
}

/// The product of `left` and `right`. Places: 2.
#[inline(always)]
pub fn product<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, left: S, right: S) -> S {
    (rows[k][at], rows[k][at + 1]) = (left, right);
    sum(rows, 0, k + 1, k, at, at + 1)
}

/// The first coefficient of a product. Its factors are kept at the places `left` and `right`.
#[inline(always)]
pub fn first_product<S: Scalar, const W: usize>(rows: &mut [[S; W]], left: usize, right: usize, a: S, b: S) -> S {
    (rows[0][left], rows[0][right]) = (a, b);
    a * b
}

/// The coefficient of order `k` of one of `P` products, from that of the factors and what [`InnerProducts`] gives for
/// it.
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

/// The first coefficients of two products side by side: their left factors are kept from the place `left` on, the right
/// ones from `right` on.
#[inline(always)]
pub fn first_products<S: Scalar, const W: usize>(
    rows: &mut [[S; W]],
    left: usize,
    right: usize,
    a: S::Pair,
    b: S::Pair,
) -> S::Pair {
    put::<S>(&mut rows[0], left, a);
    put::<S>(&mut rows[0], right, b);
    a * b
}

/// The coefficients of order `k` of two products side by side, as by [`next_product`].
#[inline(always)]
pub fn next_products<S: Scalar, const P: usize, const W: usize>(
    inner: &[S; P],
    rows: &mut [[S; W]],
    k: usize,
    at: usize,
    a: S::Pair,
    b: S::Pair,
) -> S::Pair {
    put::<S>(&mut rows[k], at, a);
    put::<S>(&mut rows[k], P + at, b);
    let (left, right) = (get::<S>(&rows[0], at), get::<S>(&rows[0], P + at));
    get::<S>(inner, at) + (a * right + left * b)
}

/// The pair at the places from `at` on.
#[inline(always)]
fn get<S: Scalar>(from: &[S], at: usize) -> S::Pair {
    S::Pair::new(from[at], from[at + 1])
}

/// Writes a pair to the places from `at` on.
#[inline(always)]
fn put<S: Scalar>(to: &mut [S], at: usize, pair: S::Pair) {
    store(to, at, [pair.first(), pair.second()]);
}

/// The parts of `P` products at an order `k` that only need the orders from 1 to `k` - 1 of their factors: what is
/// added to them is left of order 0 times right of order `k` and the other way round. `P` is a multiple of 4.
///
/// Many products in one loop do not wait for each other; nor do they wait for the factors of order `k`. What is read
/// for one order serves the next one, too: its sums are made at the same time, but for the products with the factors of
/// order `k`.
#[derive(Debug)]
pub struct InnerProducts<S, const P: usize> {
    sums: [S; P],
    /// Those of the next order as far as they are known.
    next: [S; P],
}

impl<S: Scalar, const P: usize> InnerProducts<S, P> {
    /// Those of order 1, which are 0.
    #[inline(always)]
    pub fn first() -> Self {
        const { assert!(P.is_multiple_of(4)) }
        let zeros = [S::from_f64(0.0); P];
        Self { sums: zeros, next: zeros }
    }

    /// The sums of the order `k`, after those of the order before it. In `rows`, of orders 0 to `k` - 1, the left
    /// factors have the first places, the right ones the next.
    #[inline(always)]
    pub fn at_next_order<const W: usize>(&mut self, rows: &[[S; W]]) -> &[S; P] {
        if let [_, first, .., last] = rows {
            if rows.len().is_multiple_of(2) {
                self.begin_two(&rows[1..]);
            } else {
                for (i, sum) in self.sums.iter_mut().enumerate() {
                    *sum = self.next[i] + (first[i] * last[P + i] + last[i] * first[P + i]);
                }
            }
        } else if let [_, only] = rows {
            for (i, sum) in self.sums.iter_mut().enumerate() {
                *sum = only[i] * only[P + i];
            }
        }
        // Else the sums stand side by side in the order in which they are read, and what they are made of has to be put
        // in that order.
        core::hint::black_box(&mut *self);
        &self.sums
    }

    /// The same, compiled for the vectors of the machine where what calls it is not.
    #[inline(never)]
    pub fn called_at_next_order<const W: usize>(&mut self, rows: &[[S; W]]) -> &[S; P] {
        S::in_vectors(NextOrder { inner: &mut *self, rows });
        &self.sums
    }

    /// The sums of an order, and of the next one as far as these `rows` go, which begin with order 1.
    #[inline(always)]
    fn begin_two<const W: usize>(&mut self, rows: &[[S; W]]) {
        let mut at = 0;
        // As many at once as fit the registers of a machine with AVX2, then what remains.
        while at + 12 <= P {
            self.pass::<12, W>(rows, at);
            at += 12;
        }
        if at + 8 <= P {
            self.pass::<8, W>(rows, at);
            at += 8;
        }
        if at < P {
            self.pass::<4, W>(rows, at);
        }
    }

    /// `M` of the sums side by side, from the sum `at` on.
    #[inline(always)]
    fn pass<const M: usize, const W: usize>(&mut self, rows: &[[S; W]], at: usize) {
        let zeros = [S::from_f64(0.0); M];
        let (mut sums, mut next) = (zeros, zeros);
        add_products(&mut sums, &rows[0], at, &rows[rows.len() - 1], at + P);
        // Two left factors at a time: what they are multiplied by is read once for both and for both orders.
        let ascending = rows[1..].as_chunks::<2>().0;
        let descending = rows.array_windows::<3>().rev().step_by(2);
        for ([left, then_left], [then_below, below, right]) in ascending.iter().zip(descending) {
            add_products(&mut next, left, at, right, at + P);
            add_products(&mut sums, left, at, below, at + P);
            add_products(&mut next, then_left, at, below, at + P);
            add_products(&mut sums, then_left, at, then_below, at + P);
        }
        self.sums[at..at + M].copy_from_slice(&sums);
        self.next[at..at + M].copy_from_slice(&next);
    }
}

/// The sums of the next order, in the vectors of the machine.
struct NextOrder<'a, S, const P: usize, const W: usize> {
    inner: &'a mut InnerProducts<S, P>,
    rows: &'a [[S; W]],
}

impl<S: Scalar, const P: usize, const W: usize> NullaryFnOnce for NextOrder<'_, S, P, W> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.inner.at_next_order(self.rows);
    }
}

/// Adds products of the factors side by side in `left`, from its place `at` on, and in `right`, from `to` on.
#[inline(always)]
fn add_products<S: Scalar, const M: usize>(sums: &mut [S; M], left: &[S], at: usize, right: &[S], to: usize) {
    for (i, sum) in sums.iter_mut().enumerate() {
        *sum = *sum + left[at + i] * right[to + i];
    }
}

/// The quotient of `dividend` and `divisor`. Places: 2.
#[inline(always)]
pub fn quotient<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, dividend: S, divisor: S) -> S {
    rows[k][at] = divisor;
    let known = sum(rows, 0, k, k, at + 1, at);
    let quotient = (dividend - known) / rows[0][at];
    rows[k][at + 1] = quotient;
    quotient
}

/// The absolute value: the operand or its opposite, by the sign at the start. Places: 1.
#[inline(always)]
pub fn abs<S: Scalar>(rows: &mut (impl Rows<S> + ?Sized), k: usize, at: usize, u: S) -> S {
    rows[k][at] = u;
    if rows[0][at] < S::from_f64(0.0) { -u } else { u }
}

/// The sum of the products of `a` at order j and `b` at order `k` - j, for j from `from` to before `to`.
#[inline(always)]
fn sum<S: Scalar>(rows: &(impl Rows<S> + ?Sized), from: usize, to: usize, k: usize, a: usize, b: usize) -> S {
    (from..to).fold(S::from_f64(0.0), |sum, j| sum + rows[j][a] * rows[k - j][b])
}

/// The same, each product times j.
#[inline(always)]
fn slope<S: Scalar>(rows: &(impl Rows<S> + ?Sized), from: usize, to: usize, k: usize, a: usize, b: usize) -> S {
    (from..to).fold(S::from_f64(0.0), |sum, j| sum + order::<S>(j) * rows[j][a] * rows[k - j][b])
}

/// The order as a number.
#[inline(always)]
fn order<S: Scalar>(k: usize) -> S {
    S::from_f64(k as f64)
}
