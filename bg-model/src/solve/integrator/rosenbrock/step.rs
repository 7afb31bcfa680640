//! The step of a Rosenbrock method: one Jacobian, one factorisation, a linear solve for each stage.
//!
//! In: a flow, a step, a tableau. Out: the stages' increments, the state at the end, the error estimate. Source: see
//! `tableau`. The equations are multiplied by h gamma, so that the matrix is I - h gamma J.

use alloc::vec::Vec;

use super::tableau::Tableau;
use crate::solve::integrator::linear::{Factors, Jacobian};
use crate::solve::integrator::tolerances::largest_of;
use crate::solve::integrator::{Flow, PointRef, Scale, first_not_finite, is_finite};

/// The work space of a method of `S` stages.
#[derive(Clone, Debug)]
pub(super) struct Stages<const S: usize> {
    /// The stages' increments.
    pub u: [Vec<f64>; S],
    /// The state of a stage and its rate; the error of a step.
    room: [Vec<f64>; 3],
    jacobian: Jacobian,
    /// Whether the Jacobian is that of the start.
    is_current: bool,
    factors: Factors<f64>,
    /// A rate of the last attempt that was not finite.
    pub fault: Option<(usize, f64)>,
}

impl<const S: usize> Stages<S> {
    pub fn new() -> Self {
        let (u, room) = ([const { Vec::new() }; S], [const { Vec::new() }; 3]);
        Self { u, room, jacobian: Jacobian::new(), is_current: false, factors: Factors::new(), fault: None }
    }

    /// Makes room for so many states. Nothing is left of what was known of another number of them.
    pub fn fit(&mut self, states: usize) {
        if self.u[0].len() == states {
            return;
        }
        *self = Self::new();
        self.u.iter_mut().chain(&mut self.room).for_each(|room| room.resize(states, 0.0));
    }

    /// The next attempt has another start.
    pub fn forget(&mut self) {
        self.is_current = false;
    }

    /// Evaluates all stages; gives whether they are numbers, or nothing where the matrix is singular or a derivative is
    /// no number.
    pub fn evaluate(
        &mut self,
        tableau: &Tableau<S>,
        flow: &Flow<'_>,
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
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
        if !self.factors.factor(flow, hg, &self.jacobian) {
            return None;
        }
        let Self { u, room: [x, rate, _], jacobian, factors, fault, .. } = self;
        rate.copy_from_slice(start.rate);
        for i in 0..S {
            if i > 0 {
                x.copy_from_slice(start.x);
                add(x, &tableau.a[i][..i], u, 1.0);
                flow.rate(start.t + tableau.c[i] * h, x, rate);
                if !is_finite(rate) {
                    *fault = first_not_finite(rate);
                    return Some(false);
                }
            }
            let slope = h * tableau.d[i];
            // The state has been read: the right-hand side takes its place.
            for ((b, rate), by_time) in x.iter_mut().zip(&*rate).zip(&jacobian.slope) {
                *b = hg * (rate + slope * by_time);
            }
            add(x, &tableau.cc[i][..i], u, tableau.gamma);
            factors.solve(flow, x);
            u[i].copy_from_slice(x);
        }
        Some(true)
    }

    /// Writes the state at the end of the step.
    pub fn write_end(&mut self, tableau: &Tableau<S>, start: PointRef<'_>, end: &mut [f64]) {
        end.copy_from_slice(start.x);
        add(end, &tableau.b, &self.u, 1.0);
        let error = &mut self.room[2];
        error.fill(0.0);
        add(error, &tableau.e, &self.u, 1.0);
    }

    /// The error of state `i` in the last step in parts of what is allowed.
    pub fn part(&self, i: usize, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> f64 {
        self.room[2][i].abs() / scale.allowed_between(i, start.x[i], end[i])
    }

    /// The norm of the error estimate.
    pub fn error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> f64 {
        if is_finite(end) { largest_of(end.len(), |i| self.part(i, start, scale, end)) } else { f64::NAN }
    }
}

/// Adds the increments `u` with `weights` times `factor` to `x`.
#[inline(always)]
pub(super) fn add(x: &mut [f64], weights: &[f64], u: &[Vec<f64>], factor: f64) {
    for (weight, u) in weights.iter().zip(u).filter(|(weight, _)| **weight != 0.0) {
        let weight = weight * factor;
        x.iter_mut().zip(u).for_each(|(x, u)| *x += weight * u);
    }
}
