//! An explicit Runge-Kutta-Nystrom method for mechanisms with stiff, lightly damped joints.
//!
//! In: a flow that gives second derivatives. Out: steps with an error estimate, and the states in between. Positions
//! and orientations, q, follow from the momenta, p: q' = G(q, p), p' = F(q, p). A Runge-Kutta method lets each stage's
//! q follow from the stages' q'. Here it follows from their q'', so that a force reaches the q of the next stage at
//! once: with as many rates a step may be almost twice as long before a stiff joint makes it unstable. Without states
//! of second order it is a Runge-Kutta method. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations
//! I, 2nd edition, section II.14.

#[cfg(feature = "std")]
mod lanes;
#[cfg(test)]
mod order;
mod ring;
mod stages;
mod tableau;
#[cfg(test)]
mod trees;

use super::dense::{FROM_ENDS, Polynomial};
use super::side_by_side::SIDE_BY_SIDE;
use super::steps::{Begin, Forces};
use super::tolerances::index_of_largest;
use super::vectors::{Vectorised, attempt_in};
use super::{Arch, Flow, Method, PointRef, Scale, StepControl};
#[cfg(test)]
use crate::model::scalar::Scalar;
#[cfg(feature = "std")]
pub(super) use lanes::NystromInLanes;
use ring::Ring;
use stages::{END, Stages};
use tableau::{DENSE, STAGES};

/// The coefficients of the dense output: it has degree 5 in the part of the step.
const COEFFICIENTS: usize = FROM_ENDS + DENSE.len();

/// The Runge-Kutta-Nystrom method for stiff, lightly damped joints, of order 5, and 6 where no force depends on
/// momenta.
///
/// Nine rates a step, none more for its dense output, and one in four steps for the stiffest joint's frequency. Steps
/// are held to where that joint is stable, whatever the tolerance: a loose one has no effect there. Where no joint is
/// stiff, and without states of second order, the tolerance alone decides.
#[derive(Clone, Debug)]
pub struct Nystrom {
    stages: Stages<f64, SIDE_BY_SIDE>,
    /// The fastest oscillation.
    ring: Ring,
    polynomial: Polynomial<COEFFICIENTS>,
    /// The machine's vectors.
    arch: Arch,
    /// The part of an error that counts.
    counted: f64,
}

impl Nystrom {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        let (stages, ring, polynomial) = (Stages::new(0), Ring::new(0), Polynomial::new(0));
        Self { stages, ring, polynomial, arch: Arch::new(), counted: 1.0 }
    }

    /// The method that errs by `1 / counted` times what the tolerances allow.
    pub(super) fn with_errors_counted(counted: f64) -> Self {
        Self { counted, ..Self::new() }
    }
}

impl Default for Nystrom {
    fn default() -> Self {
        Self::new()
    }
}

impl Vectorised for Nystrom {
    #[inline(always)]
    fn attempt_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        self.stages.step(flow, &Begin::of(start, h), scale, end)
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
            self.polynomial = Polynomial::new(states);
        }
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        self.stages.arrange(Forces::second(flow));
        self.ring.follow(flow, start, &self.stages.second, &scale.weights);
        let reach = self.ring.reach(h);
        if reach > 1.0 {
            return reach;
        }
        let norm = self.counted * attempt_in(self.arch, self, flow, start, h, scale, end);
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
        (0..STAGES).find_map(|stage| {
            let faulty = || self.stages.stage(stage).filter(|(_, rate)| !rate.is_finite());
            faulty().find(|(state, _)| !self.stages.second.contains(state)).or_else(|| faulty().next())
        })
    }

    fn prepare_dense(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>) {
        self.stages.set_stage(END, |rate| {
            rate.copy_from_slice(end.rate);
            flow.second_derivatives(end.x, rate);
        });
        let Self { stages, polynomial, .. } = self;
        polynomial.set(start, h, end, |m, ends, out| stages.write_dense(m, h, ends, out));
    }

    fn dense(&self, start: PointRef<'_>, _h: f64, _end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        self.polynomial.evaluate(self.arch, COEFFICIENTS, start, theta, x);
    }
}
