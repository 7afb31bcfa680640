//! The polynomial of a dense output through the states and rates at both ends of a step.
//!
//! With theta the part of the step and p the coefficients, of which the first three follow from the ends, the state is
//! x + theta (p0 + (1 - theta) (p1 + theta (p2 + (1 - theta) (p3 + theta (p4 + ...))))).
//! Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.6, and the function
//! CONTD8 of `dop853.f`.
//!
//! Numbers of states are slices in here: what calculates is compiled once, for all models and methods.

use nalgebra::SVector;

use super::Point;

/// The coefficients that follow from the states and rates at both ends.
pub(super) const FROM_ENDS: usize = 3;

/// The polynomials of all states, with `C` coefficients each.
#[derive(Clone, Debug)]
pub(super) struct Polynomial<const N: usize, const C: usize> {
    coefficients: [[f64; N]; C],
}

impl<const N: usize, const C: usize> Polynomial<N, C> {
    pub fn zero() -> Self {
        Self { coefficients: [[0.0; N]; C] }
    }

    /// Sets the coefficients that follow from the ends of the step, and those behind them to what `write` writes: it gets the
    /// coefficients of the ends and the count of the one to be written, from the first behind them.
    pub fn set(
        &mut self,
        start: &Point<N>,
        h: f64,
        end: &Point<N>,
        write: impl Fn(usize, &[[f64; N]; FROM_ENDS], &mut [f64; N]),
    ) {
        let (ends, behind) = self.coefficients.split_first_chunk_mut().expect("coefficients of the ends");
        let [chord, at_start, at_end] = &mut *ends;
        chord.copy_from_slice(start.x.as_slice());
        at_start.copy_from_slice(start.rate.as_slice());
        at_end.copy_from_slice(end.rate.as_slice());
        follow_from_ends(h, end.x.as_slice(), chord, at_start, at_end);
        for (m, coefficient) in behind.iter_mut().enumerate() {
            write(m, ends, coefficient);
        }
    }

    /// Writes the state at the part `theta` of the step, of the first `count` coefficients, into `x`.
    pub fn evaluate(&self, count: usize, start: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        evaluate(self.coefficients[..count].as_flattened(), start.x.as_slice(), theta, x.as_mut_slice());
    }
}

/// Replaces the state at the start, its rate and the rate at the end `end` of a step of size `h` (s) by the coefficients that follow.
#[inline(never)]
fn follow_from_ends(h: f64, end: &[f64], chord: &mut [f64], at_start: &mut [f64], at_end: &mut [f64]) {
    for (((end, chord), at_start), at_end) in end.iter().zip(chord).zip(at_start).zip(at_end) {
        let whole = end - *chord;
        let first = h * *at_start - whole;
        (*chord, *at_start, *at_end) = (whole, first, whole - h * *at_end - first);
    }
}

/// Writes the polynomials with these coefficients, those of all states one after the other, into `x`.
#[inline(never)]
fn evaluate(coefficients: &[f64], start: &[f64], theta: f64, x: &mut [f64]) {
    let factors = [theta, 1.0 - theta];
    let mut lower = coefficients.chunks_exact(x.len().max(1)).enumerate();
    let Some((_, last)) = lower.next_back() else { return };
    x.copy_from_slice(last);
    for (m, coefficient) in lower.rev() {
        let factor = factors[(m + 1) % 2];
        x.iter_mut().zip(coefficient).for_each(|(sum, at)| *sum = at + factor * *sum);
    }
    x.iter_mut().zip(start).for_each(|(sum, start)| *sum = start + theta * *sum);
}

/// Writes `h` times a sum of rates, each with its weight, in their order.
pub(super) fn write_sum<'a, const N: usize>(
    h: f64,
    terms: impl Iterator<Item = (f64, &'a SVector<f64, N>)>,
    out: &mut [f64; N],
) {
    // Adding to -0 changes nothing, not even the sign of a zero.
    out.fill(-0.0);
    terms.for_each(|(weight, rate)| add_times(weight, rate.as_slice(), out));
    scale(h, out);
}

/// Adds `weight` times a rate.
#[inline(never)]
fn add_times(weight: f64, rate: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(rate).for_each(|(out, rate)| *out += weight * rate);
}

#[inline(never)]
fn scale(h: f64, out: &mut [f64]) {
    out.iter_mut().for_each(|out| *out *= h);
}
