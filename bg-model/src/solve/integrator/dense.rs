//! The polynomial of a dense output through the states and rates at both ends of a step.
//!
//! With theta the part of the step and p the coefficients, of which the first three follow from the ends, the state is
//! x + theta (p0 + (1 - theta) (p1 + theta (p2 + (1 - theta) (p3 + theta (p4 + ...))))).
//! Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.6, and the function
//! CONTD8 of `dop853.f`.

use nalgebra::SVector;

use super::Point;

/// The coefficients that follow from the states and rates at both ends.
pub(super) const FROM_ENDS: usize = 3;

/// The polynomials of all states, with `C` coefficients each.
#[derive(Clone, Debug)]
pub(super) struct Polynomial<const N: usize, const C: usize> {
    coefficients: [SVector<f64, N>; C],
}

impl<const N: usize, const C: usize> Polynomial<N, C> {
    pub fn zero() -> Self {
        Self { coefficients: [SVector::zeros(); C] }
    }

    /// Sets the coefficients that follow from the ends of the step, and those behind them to what `write` writes: it gets the
    /// coefficients of the ends and the count of the one to be written, from the first behind them.
    pub fn set(
        &mut self,
        start: &Point<N>,
        h: f64,
        end: &Point<N>,
        write: impl Fn(usize, &[SVector<f64, N>], &mut [f64; N]),
    ) {
        let (ends, behind) = self.coefficients.split_at_mut(FROM_ENDS);
        for i in 0..N {
            let chord = end.x.data.0[0][i] - start.x.data.0[0][i];
            let first = h * start.rate.data.0[0][i] - chord;
            let of_ends = [chord, first, chord - h * end.rate.data.0[0][i] - first];
            for (coefficient, value) in ends.iter_mut().zip(of_ends) {
                coefficient.data.0[0][i] = value;
            }
        }
        for (m, coefficient) in behind.iter_mut().enumerate() {
            write(m, ends, &mut coefficient.data.0[0]);
        }
    }

    /// Writes the state at the part `theta` of the step, of the first `count` coefficients, into `x`.
    pub fn evaluate(&self, count: usize, start: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        let factors = [theta, 1.0 - theta];
        let last = count - 1;
        let mut sum = self.coefficients[last].data.0[0];
        for (m, coefficient) in self.coefficients[..last].iter().enumerate().rev() {
            let factor = factors[(m + 1) % 2];
            for (sum, at) in sum.iter_mut().zip(&coefficient.data.0[0]) {
                *sum = at + factor * *sum;
            }
        }
        for (i, sum) in sum.into_iter().enumerate() {
            x.data.0[0][i] = start.x.data.0[0][i] + theta * sum;
        }
    }
}

/// Writes `h` times a sum of rates, each with its weight, in their order.
pub(super) fn write_sum<'a, const N: usize>(
    h: f64,
    terms: impl Iterator<Item = (f64, &'a SVector<f64, N>)>,
    out: &mut [f64; N],
) {
    // Adding to -0 changes nothing, not even the sign of a zero.
    out.fill(-0.0);
    for (weight, rate) in terms {
        for (out, rate) in out.iter_mut().zip(&rate.data.0[0]) {
            *out += weight * rate;
        }
    }
    out.iter_mut().for_each(|out| *out *= h);
}
