//! The dense output of DOP853, of order 7.
//!
//! Source: Hairer, Norsett, Wanner, section II.6, and the function CONTD8 of `dop853.f`.

use nalgebra::SVector;

use super::Dop853;
use super::tableau::{A13, A14, A15, D3, D4, D5, D6, Row};
use crate::integrator::{Flow, Point};

impl<const N: usize> Dop853<N> {
    /// Evaluates the stages that serve the dense output only.
    pub(super) fn evaluate_dense_stages(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.k[12] = end.rate;
        self.evaluate(flow, start, h, 13, &A13);
        self.evaluate(flow, start, h, 14, &A14);
        self.evaluate(flow, start, h, 15, &A15);
    }

    /// Collects the coefficients of the polynomial.
    pub(super) fn collect_polynomial(&mut self, start: &Point<N>, h: f64, end: &Point<N>) {
        for i in 0..N {
            let chord = end.x.data.0[0][i] - start.x.data.0[0][i];
            let first = h * start.rate.data.0[0][i] - chord;
            self.polynomial[0].data.0[0][i] = chord;
            self.polynomial[1].data.0[0][i] = first;
            self.polynomial[2].data.0[0][i] = chord - h * end.rate.data.0[0][i] - first;
        }
        self.collect(3, h, &D3);
        self.collect(4, h, &D4);
        self.collect(5, h, &D5);
        self.collect(6, h, &D6);
    }

    #[inline(always)]
    fn collect<const K: usize>(&mut self, coefficient: usize, h: f64, row: &Row<K>) {
        for i in 0..N {
            self.polynomial[coefficient].data.0[0][i] = h * row.combine(&self.k, i);
        }
    }

    /// Writes the state at the part `theta` of the step into `x`.
    pub(super) fn evaluate_polynomial(&self, start: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        let rest = 1.0 - theta;
        let [p0, p1, p2, p3, p4, p5, p6] = &self.polynomial;
        for i in 0..N {
            let at = |p: &SVector<f64, N>| p.data.0[0][i];
            let upper = at(p3) + theta * (at(p4) + rest * (at(p5) + theta * at(p6)));
            let lower = at(p0) + rest * (at(p1) + theta * (at(p2) + rest * upper));
            x.data.0[0][i] = start.x.data.0[0][i] + theta * lower;
        }
    }
}
