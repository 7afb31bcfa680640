//! The step of a Rosenbrock method: one Jacobian, one factorisation, a linear solve for each stage.
//!
//! In: a flow, a step, a tableau. Out: the stages' increments, the state at the end, the error estimate. Source: see
//! `tableau`. The equations are multiplied by h gamma, so that the matrix is I - h gamma J.

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::tableau::Tableau;
use crate::solve::integrator::linear::{Factors, Jacobian};
use crate::solve::integrator::tolerances::largest;
use crate::solve::integrator::{Flow, Point, Scale, first_not_finite, is_finite};

/// The work space of a method of `S` stages.
#[derive(Clone, Debug)]
pub(super) struct Stages<const S: usize, const N: usize> {
    /// The stages' increments.
    pub u: [SVector<f64, N>; S],
    jacobian: Jacobian<N>,
    /// Whether the Jacobian is that of the start.
    is_current: bool,
    factors: Factors<f64, N>,
    /// A rate of the last attempt that was not finite.
    pub fault: Option<(usize, f64)>,
}

impl<const S: usize, const N: usize> Stages<S, N> {
    pub fn new() -> Self {
        let (jacobian, factors) = (Jacobian::new(), Factors::new());
        Self { u: [SVector::zeros(); S], jacobian, is_current: false, factors, fault: None }
    }

    /// The next attempt has another start.
    pub fn forget(&mut self) {
        self.is_current = false;
    }

    /// Evaluates all stages, linear systems in the vectors `arch`; gives whether they are numbers, or nothing where the matrix is singular or a derivative is no
    /// number.
    pub fn evaluate(
        &mut self,
        arch: Arch,
        tableau: &Tableau<S>,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
    ) -> Option<bool> {
        self.fault = None;
        if !self.is_current {
            self.jacobian.evaluate(flow, start, h, scale);
            self.is_current = true;
        }
        if !self.jacobian.is_finite() {
            return None;
        }
        let hg = h * tableau.gamma;
        if !self.factors.factor(arch, flow, hg, &self.jacobian) {
            return None;
        }
        let mut rate = start.rate;
        for i in 0..S {
            if i > 0 {
                let mut x = start.x;
                add(&mut x, &tableau.a[i][..i], &self.u, 1.0);
                flow.inlined_rate(start.t + tableau.c[i] * h, &x, &mut rate);
                if !is_finite(&rate) {
                    self.fault = first_not_finite(&rate);
                    return Some(false);
                }
            }
            let slope = h * tableau.d[i];
            let mut b = SVector::<f64, N>::zeros();
            for n in 0..N {
                b.data.0[0][n] = hg * (rate.data.0[0][n] + slope * self.jacobian.slope.data.0[0][n]);
            }
            add(&mut b, &tableau.cc[i][..i], &self.u, tableau.gamma);
            self.factors.solve(arch, flow, &mut b.data.0[0]);
            self.u[i] = b;
        }
        Some(true)
    }

    /// The state at the end of the step.
    pub fn end(&self, tableau: &Tableau<S>, start: &Point<N>) -> SVector<f64, N> {
        let mut x = start.x;
        add(&mut x, &tableau.b, &self.u, 1.0);
        x
    }

    /// The scaled error estimate of each state.
    pub fn errors(&self, tableau: &Tableau<S>, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> [f64; N] {
        let mut error = SVector::<f64, N>::zeros();
        add(&mut error, &tableau.e, &self.u, 1.0);
        core::array::from_fn(|n| {
            error.data.0[0][n].abs() / scale.allowed_between(n, start.x.data.0[0][n], end.data.0[0][n])
        })
    }

    /// The norm of the error estimate.
    pub fn error(&self, tableau: &Tableau<S>, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> f64 {
        let errors = self.errors(tableau, start, scale, end);
        if is_finite(end) { largest(&errors) } else { f64::NAN }
    }
}

/// Adds the increments `u` with `weights` times `factor` to `x`.
#[inline(always)]
pub(super) fn add<const N: usize>(x: &mut SVector<f64, N>, weights: &[f64], u: &[SVector<f64, N>], factor: f64) {
    for (weight, u) in weights.iter().zip(u).filter(|(weight, _)| **weight != 0.0) {
        let weight = weight * factor;
        for n in 0..N {
            x.data.0[0][n] += weight * u.data.0[0][n];
        }
    }
}
