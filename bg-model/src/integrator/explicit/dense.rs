//! The dense output: the polynomial through the states and rates at both ends of the step that the tableau gives.
//!
//! With theta the part of the step and p the coefficients, of which the first three follow from the ends, the state is
//! x + theta (p0 + (1 - theta) (p1 + theta (p2 + (1 - theta) (p3 + theta (p4 + ...))))).
//! Source: Hairer, Norsett, Wanner, section II.6, and the function CONTD8 of `dop853.f`.

use nalgebra::SVector;

use super::{COEFFICIENTS, Explicit, Point, Tableau, combine};

/// The coefficients that follow from the states and rates at both ends.
pub(super) const FROM_ENDS: usize = 3;

impl<T: Tableau, const N: usize> Explicit<T, N> {
    /// Collects the coefficients of the polynomial.
    pub(super) fn collect_polynomial(&mut self, start: &Point<N>, h: f64, end: &Point<N>) {
        for i in 0..N {
            let chord = end.x.data.0[0][i] - start.x.data.0[0][i];
            let first = h * start.rate.data.0[0][i] - chord;
            self.polynomial[0].data.0[0][i] = chord;
            self.polynomial[1].data.0[0][i] = first;
            self.polynomial[2].data.0[0][i] = chord - h * end.rate.data.0[0][i] - first;
        }
        for (coefficient, row) in self.polynomial[FROM_ENDS..].iter_mut().zip(T::DENSE) {
            for i in 0..N {
                coefficient.data.0[0][i] = h * combine(row, &self.k, i);
            }
        }
    }

    /// Writes the state at the part `theta` of the step into `x`.
    pub(super) fn evaluate_polynomial(&self, start: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        const { assert!(FROM_ENDS + T::DENSE.len() <= COEFFICIENTS) };
        let factors = [theta, 1.0 - theta];
        let last = FROM_ENDS + T::DENSE.len() - 1;
        for i in 0..N {
            let at = |m: usize| self.polynomial[m].data.0[0][i];
            let sum = (0..last).rev().fold(at(last), |sum, m| at(m) + factors[(m + 1) % 2] * sum);
            x.data.0[0][i] = start.x.data.0[0][i] + theta * sum;
        }
    }
}
