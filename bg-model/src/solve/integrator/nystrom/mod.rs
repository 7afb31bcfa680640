//! An explicit Runge-Kutta-Nystrom method for mechanisms with stiff, lightly damped joints.
//!
//! In: a flow that gives second derivatives. Out: steps with an error estimate, and the states in between. Positions and
//! orientations, q, follow from the momenta, p: q' = G(q, p), p' = F(q, p). A Runge-Kutta method lets each stage's q follow from
//! the stages' q'. Here it follows from their q'', so that a force reaches the q of the next stage at once: with as many rates a
//! step may be almost twice as long before a stiff joint makes it unstable. Without states of second order it is a
//! Runge-Kutta method. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.14.

#[cfg(feature = "std")]
mod lanes;
#[cfg(test)]
mod order;
mod ring;
mod stages;
mod tableau;
#[cfg(test)]
mod trees;

use core::ops::Range;

use super::dense::{FROM_ENDS, Polynomial, write_sum};
use super::steps::{Begin, OfFlow};
use super::tolerances::index_of_largest;
use super::vectors::{Vectorised, attempt_in};
use super::{Arch, Flow, Method, PointRef, Scale, StepControl, first_not_finite};
#[cfg(test)]
use crate::model::scalar::Scalar;
#[cfg(feature = "std")]
pub(super) use lanes::NystromInLanes;
use ring::Ring;
use stages::{END, Stages};
use tableau::{DENSE, STAGES};

/// The coefficients of the dense output: it has degree 5 in the part of the step.
const COEFFICIENTS: usize = FROM_ENDS + DENSE.len();

/// The Runge-Kutta-Nystrom method for stiff, lightly damped joints, of order 5, and 6 where no force depends on momenta.
///
/// Nine rates a step, none more for its dense output, and one in four steps for the stiffest joint's frequency. Steps are held
/// to where that joint is stable, whatever the tolerance: a loose one has no effect there. Where no joint is stiff, and without states
/// of second order, the tolerance alone decides.
#[derive(Clone, Debug)]
pub struct Nystrom {
    stages: Stages<f64>,
    /// The states of second order.
    second: Range<usize>,
    /// The fastest oscillation.
    ring: Ring,
    polynomial: Polynomial<COEFFICIENTS>,
    /// The machine's vectors.
    arch: Arch,
}

impl Nystrom {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        let (stages, ring, polynomial) = (Stages::new(0), Ring::new(0), Polynomial::new());
        Self { stages, second: 0..0, ring, polynomial, arch: Arch::new() }
    }
}

impl Default for Nystrom {
    fn default() -> Self {
        Self::new()
    }
}

impl Vectorised for Nystrom {
    #[inline(always)]
    fn attempt_inlined(
        &mut self,
        flow: &(impl Flow + ?Sized),
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &mut [f64],
    ) -> f64 {
        self.stages.step(&OfFlow(flow), &Begin::of(start, h), scale, end)
    }
}

impl Method for Nystrom {
    fn name(&self) -> &'static str {
        tableau::NAME
    }

    fn control(&self) -> StepControl {
        StepControl::Stabilised { order: tableau::ERROR_ORDER }
    }

    fn fit(&mut self, states: usize) {
        if self.stages.states() != states {
            (self.stages, self.ring) = (Stages::new(states), Ring::new(states));
            self.polynomial.fit(states);
        }
    }

    fn attempt(
        &mut self,
        flow: &(impl Flow + ?Sized),
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &mut [f64],
    ) -> f64 {
        self.second = flow.second();
        self.ring.follow(&OfFlow(flow), start, &self.second);
        let reach = self.ring.reach(h);
        if reach > 1.0 {
            return reach;
        }
        let norm = attempt_in(self.arch, self, flow, start, h, scale, end);
        if norm < reach { reach } else { norm }
    }

    fn advance(&mut self) {
        self.ring.advance();
    }

    fn restart(&mut self) {
        self.ring.restart();
    }

    fn largest_error(&self, _start: PointRef<'_>, _scale: &Scale, end: &[f64]) -> usize {
        index_of_largest(end.len(), |i| self.stages.errors[i])
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        // A force that is no number makes the second derivatives none that follow from it.
        let Range { start, end } = self.second;
        self.stages.k[..STAGES].iter().find_map(|k| {
            let of = |states: Range<usize>| {
                let first = states.start;
                first_not_finite(&k[states]).map(|(i, rate)| (first + i, rate))
            };
            of(0..start).or_else(|| of(end..k.len())).or_else(|| of(start..end))
        })
    }

    fn prepare_dense(&mut self, flow: &(impl Flow + ?Sized), start: PointRef<'_>, h: f64, end: PointRef<'_>) {
        self.stages.k[END].copy_from_slice(end.rate);
        flow.second_derivatives(end.x, &mut self.stages.k[END]);
        let Self { stages: Stages { k, .. }, second, polynomial, arch, .. } = self;
        polynomial.set(start, h, end, |m, ends, out| {
            write_sum(*arch, h, DENSE[m].iter().copied().zip(k.iter().map(|k| &k[..])), out);
            for i in second.clone() {
                let [first, third] = [1, 2].map(|m| ends[m][i]);
                // The polynomial of degree 5 through the second derivatives at both ends, too.
                let [before, behind] = [k[0][i], k[END][i]].map(|second| 0.5 * h * h * second);
                let at_start = before + first - third;
                out[i] = if m == 0 { at_start } else { behind + first + 2.0 * third - at_start };
            }
        });
    }

    fn dense(&self, start: PointRef<'_>, _h: f64, _end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        self.polynomial.evaluate(self.arch, COEFFICIENTS, start, theta, x);
    }
}
