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

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::dense::{FROM_ENDS, Polynomial, write_sum};
use super::steps::{Begin, Forces, OfFlow};
use super::tolerances::{index_of_largest, largest};
use super::vectors::{Vectorised, attempt_in};
use super::{Flow, Method, Point, Scale, StepControl, first_in};
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
pub struct Nystrom<const N: usize> {
    stages: Stages<f64, N>,
    /// The states of second order.
    second: Range<usize>,
    /// The magnitudes of the differences to the embedded method, in parts of what is allowed.
    errors: [f64; N],
    /// The fastest oscillation.
    ring: Ring<N>,
    polynomial: Polynomial<N, COEFFICIENTS>,
    /// The machine's vectors.
    arch: Arch,
}

impl<const N: usize> Nystrom<N> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stages: Stages::new(),
            second: 0..0,
            errors: [0.0; N],
            ring: Ring::new(),
            polynomial: Polynomial::zero(),
            arch: Arch::new(),
        }
    }
}

impl<const N: usize> Default for Nystrom<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Vectorised<N> for Nystrom<N> {
    #[inline(always)]
    fn attempt_inlined(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let from = Begin { t: start.t, h, x: &start.x, rate: &start.rate };
        self.errors = self.stages.step(&OfFlow(flow), &from, scale, end);
        largest(&self.errors)
    }
}

impl<const N: usize> Method<N> for Nystrom<N> {
    fn name(&self) -> &'static str {
        tableau::NAME
    }

    fn control(&self) -> StepControl {
        StepControl::Stabilised { order: tableau::ERROR_ORDER }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        self.second = OfFlow(flow).second();
        self.ring.follow(&OfFlow(flow), start, &self.second, &scale.weights);
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

    fn largest_error(&self, _start: &Point<N>, _scale: &Scale<N>, _end: &SVector<f64, N>) -> usize {
        index_of_largest::<N>(|i| self.errors[i])
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        // A force that is no number makes the second derivatives none that follow from it.
        let Range { start, end } = self.second;
        self.stages.k[..STAGES].iter().find_map(|k| {
            let of = |first: usize, rates: &[f64]| first_in(rates).map(|(i, rate)| (first + i, rate));
            let (before, second, behind) =
                (&k.0.as_slice()[..start], &k.0.as_slice()[start..end], &k.0.as_slice()[end..]);
            of(0, before).or_else(|| of(end, behind)).or_else(|| of(start, second))
        })
    }

    fn prepare_dense(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.stages.k[END].0 = end.rate;
        OfFlow(flow).at_start(&end.x, &mut self.stages.k[END].0);
        let Self { stages: Stages { k }, second, polynomial, arch, .. } = self;
        polynomial.set(start, h, end, |m, ends, out| {
            write_sum(*arch, h, DENSE[m].iter().copied().zip(k.iter().map(|k| &k.0)), out);
            for i in second.clone() {
                let [first, third] = [1, 2].map(|m| ends[m][i]);
                // The polynomial of degree 5 through the second derivatives at both ends, too.
                let [before, behind] = [k[0].0[i], k[END].0[i]].map(|second| 0.5 * h * h * second);
                let at_start = before + first - third;
                out[i] = if m == 0 { at_start } else { behind + first + 2.0 * third - at_start };
            }
        });
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        self.polynomial.evaluate(self.arch, COEFFICIENTS, start, theta, x);
    }
}
