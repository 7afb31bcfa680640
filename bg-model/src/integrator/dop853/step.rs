//! The step of DOP853: its stages, the state at the end and the error estimate.
//!
//! Source: the subroutine DP86CO of Hairer's `dop853.f`.

use nalgebra::SVector;

use super::tableau::{A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, B, B3, C, E5, Row};
use super::{Dop853, STAGES};
use crate::integrator::tolerances::largest;
use crate::integrator::{Flow, Point, Scale};

/// The rates of all stages.
type Stages<const N: usize> = [SVector<f64, N>; STAGES];

impl<const K: usize> Row<K> {
    /// Entry `i` of the linear combination of the stages `k`, summed in the order of the stages.
    #[inline(always)]
    pub(super) fn combine<const N: usize>(&self, k: &Stages<N>, i: usize) -> f64 {
        let mut sum = self.weight[0] * k[self.stage[0]].data.0[0][i];
        for j in 1..K {
            sum += self.weight[j] * k[self.stage[j]].data.0[0][i];
        }
        sum
    }
}

impl<const N: usize> Dop853<N> {
    /// Evaluates stages 0 to 11.
    pub(super) fn evaluate_stages(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64) {
        self.k[0] = start.rate;
        self.evaluate(flow, start, h, 1, &A1);
        self.evaluate(flow, start, h, 2, &A2);
        self.evaluate(flow, start, h, 3, &A3);
        self.evaluate(flow, start, h, 4, &A4);
        self.evaluate(flow, start, h, 5, &A5);
        self.evaluate(flow, start, h, 6, &A6);
        self.evaluate(flow, start, h, 7, &A7);
        self.evaluate(flow, start, h, 8, &A8);
        self.evaluate(flow, start, h, 9, &A9);
        self.evaluate(flow, start, h, 10, &A10);
        self.evaluate(flow, start, h, 11, &A11);
    }

    /// Evaluates one stage at the state that `row` gives.
    #[inline(always)]
    pub(super) fn evaluate<const K: usize>(
        &mut self,
        flow: &mut impl Flow<N>,
        start: &Point<N>,
        h: f64,
        stage: usize,
        row: &Row<K>,
    ) {
        let mut x = [0.0; N];
        for (i, x) in x.iter_mut().enumerate() {
            *x = start.x.data.0[0][i] + h * row.combine(&self.k, i);
        }
        flow.rate(start.t + C[stage] * h, &SVector::from(x), &mut self.k[stage]);
    }

    /// Writes the state at the end of the step and gives the norm of its error.
    ///
    /// The norm: with the largest e5 and e3 of the scaled differences to the methods of orders 5 and 3,
    /// h e5 e5 / sqrt(e5 e5 + e3 e3 / 100) (Hairer, Norsett, Wanner, section II.10).
    pub(super) fn finish_step(&self, start: &Point<N>, h: f64, scale: &Scale<N>, end: &mut SVector<f64, N>) -> f64 {
        let (mut errors5, mut errors3) = ([0.0; N], [0.0; N]);
        for i in 0..N {
            let from = start.x.data.0[0][i];
            let slope = B.combine(&self.k, i);
            let to = from + h * slope;
            let allowed = scale.allowed(i, from, to);
            end.data.0[0][i] = to;
            errors5[i] = (E5.combine(&self.k, i) / allowed).abs();
            errors3[i] = ((slope - B3.combine(&self.k, i)) / allowed).abs();
        }
        let (error5, error3) = (largest(&errors5), largest(&errors3));
        let both = error5 * error5 + 0.01 * error3 * error3;
        // Both differences vanish exactly at a state of rest.
        if both == 0.0 { 0.0 } else { h.abs() * error5 * error5 / both.sqrt() }
    }

    /// The scaled difference to the method of order 5, for each state.
    pub(super) fn scaled_errors(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|i, _| (E5.combine(&self.k, i) / scale.allowed(i, start.x[i], end[i])).abs())
    }
}
