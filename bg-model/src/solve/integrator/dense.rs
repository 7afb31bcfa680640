//! The polynomial of a dense output through the states and rates at both ends of a step.
//!
//! With theta the part of the step and p the coefficients, of which the first three follow from the ends, the state is
//! x + theta (p0 + (1 - theta) (p1 + theta (p2 + (1 - theta) (p3 + theta (p4 + ...))))).
//! Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.6, and the
//! function CONTD8 of `dop853.f`.
//!
//! Numbers of states are slices in here: what calculates is compiled once, for all models and methods, in the machine's
//! vectors.

use pulp::NullaryFnOnce;

use super::PointRef;
use super::side_by_side::{OfEach, Padded, SIDE_BY_SIDE, for_each, put, some};
use crate::model::scalar::machine::Arch;

/// The coefficients that follow from the states and rates at both ends.
pub(super) const FROM_ENDS: usize = 3;

/// A coefficient of each state.
pub(super) type Coefficient = Padded<f64, SIDE_BY_SIDE>;

/// The polynomials of all states, with `C` coefficients each.
#[derive(Clone, Debug)]
pub(super) struct Polynomial<const C: usize> {
    coefficients: [Coefficient; C],
}

impl<const C: usize> Polynomial<C> {
    /// Of so many states.
    pub fn new(states: usize) -> Self {
        Self { coefficients: core::array::from_fn(|_| Padded::new(states, 0.0)) }
    }

    /// Sets the coefficients that follow from the ends of the step, and those after them to what `write` writes: it
    /// gets the coefficients of the ends and the count of the one to be written, from the first after them.
    pub fn set(
        &mut self,
        start: PointRef<'_>,
        h: f64,
        end: PointRef<'_>,
        write: impl Fn(usize, &[Coefficient; FROM_ENDS], &mut Coefficient),
    ) {
        let (ends, behind) = self.coefficients.split_first_chunk_mut().expect("coefficients of the ends");
        let [chord, at_start, at_end] = &mut *ends;
        chord.copy_from_slice(start.x);
        at_start.copy_from_slice(start.rate);
        at_end.copy_from_slice(end.rate);
        follow_from_ends(h, end.x, chord, at_start, at_end);
        for (m, coefficient) in behind.iter_mut().enumerate() {
            write(m, ends, coefficient);
        }
    }

    /// Writes the state at the part `theta` of the step, of the first `count` coefficients, into `x`: in the vectors
    /// `arch`.
    pub fn evaluate(&self, arch: Arch, count: usize, start: PointRef<'_>, theta: f64, x: &mut [f64]) {
        let coefficients = self.coefficients.each_ref().map(|coefficient| &coefficient[..]);
        arch.dispatch(Polynomials { coefficients: &coefficients[..count], start: start.x, theta, x });
    }
}

/// Replaces the state at the start, its rate and the rate at the end `end` of a step of size `h` (s) by the
/// coefficients that follow.
#[inline(never)]
fn follow_from_ends(h: f64, end: &[f64], chord: &mut [f64], at_start: &mut [f64], at_end: &mut [f64]) {
    for (((end, chord), at_start), at_end) in end.iter().zip(chord).zip(at_start).zip(at_end) {
        let whole = end - *chord;
        let first = h * *at_start - whole;
        (*chord, *at_start, *at_end) = (whole, first, whole - h * *at_end - first);
    }
}

/// The polynomials of all states at the part `theta` of the step, to be written into `x`.
struct Polynomials<'a> {
    coefficients: &'a [&'a [f64]],
    start: &'a [f64],
    theta: f64,
    x: &'a mut [f64],
}

impl NullaryFnOnce for Polynomials<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for_each(self.x.len(), &mut self);
    }
}

impl OfEach for Polynomials<'_> {
    const CAN_REPEAT: bool = true;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { coefficients, start, theta, x } = self;
        let factors = [*theta, 1.0 - *theta];
        let start: [f64; W] = some(start, first);
        let Some((last, lower)) = coefficients.split_last() else { return put(x, first, start) };
        let mut sums: [f64; W] = some(last, first);
        for (m, coefficient) in lower.iter().enumerate().rev() {
            let (at, factor): ([f64; W], f64) = (some(coefficient, first), factors[(m + 1) % 2]);
            for k in 0..W {
                sums[k] = at[k] + factor * sums[k];
            }
        }
        for k in 0..W {
            sums[k] = start[k] + *theta * sums[k];
        }
        put(x, first, sums);
    }
}
