//! An explicit Runge-Kutta-Nystrom method for mechanisms with stiff, lightly damped joints.
//!
//! In: a flow that gives second derivatives. Out: steps with an error estimate, and the states in between. Positions and
//! orientations, q, follow from the momenta, p: q' = G(q, p), p' = F(q, p). A Runge-Kutta method lets each stage's q follow from
//! the stages' q'. Here it follows from their q'', so that a force reaches the q of the next stage at once: with as many rates a
//! step may be almost twice as long before a stiff joint makes it unstable. Without states of second order it is a
//! Runge-Kutta method. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.14.

#[cfg(test)]
mod order;
mod ring;
mod tableau;
#[cfg(test)]
mod trees;

use core::ops::Range;

use nalgebra::SVector;
use pulp::Arch;

use super::dense::{FROM_ENDS, Polynomial};
use super::tolerances::{index_of_largest, largest};
use super::vectors::{Vectorised, attempt_in};
use super::{Flow, Method, Point, Scale, StepControl};
use crate::model::capability::SecondOrder;
#[cfg(test)]
use crate::model::scalar::Scalar;
use crate::model::scalar::double::power;
use ring::Ring;
use tableau::{DENSE, FIRST, INSTANTS, SECOND, STAGES};

/// Behind the rows of the stages: those of the state at the end, and of the error estimate.
const END: usize = STAGES;
const ERROR: usize = STAGES + 1;
/// The coefficients of the dense output: it has degree 5 in the part of the step.
const COEFFICIENTS: usize = FROM_ENDS + DENSE.len();

/// Numbers of all states where vectors of the machine begin, so that none lies across two lines of its cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
struct Aligned<const N: usize>(SVector<f64, N>);

/// The Runge-Kutta-Nystrom method for stiff, lightly damped joints, of order 5, and 6 where no force depends on momenta.
///
/// Nine rates a step, none more for its dense output, and one in four steps for the stiffest joint's frequency. Steps are held
/// to where that joint is stable, whatever the tolerance: a loose one has no effect there. Where no joint is stiff, and without states
/// of second order, the tolerance alone decides.
#[derive(Clone, Debug)]
pub struct Nystrom<const N: usize> {
    /// The second derivatives of the states of second order and the rates of the others, at the stages and at the end.
    k: [Aligned<N>; STAGES + 1],
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
            k: [Aligned(SVector::zeros()); STAGES + 1],
            second: 0..0,
            errors: [0.0; N],
            ring: Ring::new(),
            polynomial: Polynomial::zero(),
            arch: Arch::new(),
        }
    }

    /// The sum of the stages for state `i`.
    #[inline(always)]
    fn combine(&self, weights: &[f64], i: usize) -> f64 {
        // Adding to -0 changes nothing, not even the sign of a zero.
        (0..weights.len()).fold(-0.0, |sum, j| sum + weights[j] * self.k[j].0.data.0[0][i])
    }

    /// Writes the state of a row at the instant `c` of the step.
    #[inline(always)]
    fn reach<const ROW: usize>(
        &self,
        second: &Range<usize>,
        c: f64,
        start: &Point<N>,
        h: f64,
        x: &mut SVector<f64, N>,
    ) {
        let (from, rate, x) = (&start.x.data.0[0], &start.rate.data.0[0], &mut x.data.0[0]);
        for i in 0..second.start {
            x[i] = from[i] + h * self.combine(FIRST[ROW], i);
        }
        for i in second.clone() {
            x[i] = from[i] + h * (c * rate[i] + h * self.combine(SECOND[ROW], i));
        }
        for i in second.end..N {
            x[i] = from[i] + h * self.combine(FIRST[ROW], i);
        }
    }

    /// Evaluates the stages. Their sums are written out, so that each finds its weights as constants.
    #[inline(always)]
    fn evaluate(&mut self, flow: &impl Flow<N>, states: &Range<usize>, start: &Point<N>, h: f64) {
        let second = flow.second_order();
        let mut x = start.x;
        self.k[0].0 = start.rate;
        if let Some(second) = &second {
            second.second_derivatives(&x, &mut self.k[0].0);
        }
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => self.reach::<$stage>(states, *c, start, h, &mut x), )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            let (t, k) = (start.t + c * h, &mut self.k[stage].0);
            match &second {
                Some(second) => second.forces(t, &x, &[], k),
                None => flow.inlined_rate(t, &x, k),
            }
        }
    }

    /// Sets the errors of a step.
    #[inline(always)]
    fn compare(&mut self, second: &Range<usize>, start: &Point<N>, h: f64, scale: &Scale<N>, end: &SVector<f64, N>) {
        let mut errors = [0.0; N];
        for (i, error) in errors.iter_mut().enumerate() {
            let sum =
                if second.contains(&i) { h * self.combine(SECOND[ERROR], i) } else { self.combine(FIRST[ERROR], i) };
            *error = (h * sum / scale.allowed(i, start.x.data.0[0][i], end.data.0[0][i])).abs();
        }
        self.errors = errors;
    }
}

/// The states of second order of a flow; an empty range where there are none.
#[inline(always)]
fn states_of_second_order<const N: usize>(flow: &impl Flow<N>) -> Range<usize> {
    flow.second_order().map_or(0..0, |second| second.states())
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
        let states = states_of_second_order(flow);
        self.evaluate(flow, &states, start, h);
        self.reach::<END>(&states, 1.0, start, h, end);
        self.compare(&states, start, h, scale, end);
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
        self.second = states_of_second_order(flow);
        self.ring.follow(flow, start, &self.second);
        let reach = power(h * self.ring.frequency / tableau::REACH, tableau::ERROR_ORDER as u32);
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
        let forces_first = || (0..N).filter(|i| !self.second.contains(i)).chain(self.second.clone());
        self.k[..STAGES].iter().find_map(|k| forces_first().map(|i| (i, k.0[i])).find(|(_, rate)| !rate.is_finite()))
    }

    fn prepare_dense(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.k[END].0 = end.rate;
        if let Some(second) = flow.second_order() {
            second.second_derivatives(&end.x, &mut self.k[END].0);
        }
        let Self { k, second, polynomial, .. } = self;
        polynomial.set(start, h, end, |m, i, [_, first, third]| {
            if second.contains(&i) {
                // The polynomial of degree 5 through the second derivatives at both ends, too.
                let [before, behind] = [k[0].0[i], k[END].0[i]].map(|second| 0.5 * h * h * second);
                let at_start = before + first - third;
                if m == 0 { at_start } else { behind + first + 2.0 * third - at_start }
            } else {
                h * DENSE[m].iter().zip(k.iter()).map(|(weight, k)| weight * k.0[i]).sum::<f64>()
            }
        });
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        self.polynomial.evaluate(COEFFICIENTS, start, theta, x);
    }
}
