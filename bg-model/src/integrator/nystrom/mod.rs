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

use nalgebra::SVector;
use pulp::Arch;

use super::dense::{FROM_ENDS, Polynomial};
use super::tolerances::{index_of_largest, largest};
use super::vectors::{Vectorised, attempt_in};
use super::{Flow, Method, Point, Scale, StepControl, first_not_finite};
use ring::Ring;
use tableau::{DENSE, FIRST, INSTANTS, SECOND, STAGES, Weights};

/// The method's rows: those of the stages, of the state at the end, and of the error estimate.
const ROWS: usize = STAGES + 2;
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
/// to where that joint is stable, whatever the tolerance.
#[derive(Clone, Debug)]
pub struct Nystrom<const N: usize> {
    /// The second derivatives of the states of second order and the rates of the others, at the stages and at the end.
    k: [Aligned<N>; STAGES + 1],
    /// The weights of each row, state by state.
    weights: [[Aligned<N>; STAGES]; ROWS],
    /// Which states are of second order.
    is_second: [bool; N],
    /// The changes of the states of second order in the step by the rate at its start; 0 for the others.
    drift: SVector<f64, N>,
    /// The square of the step for the states of second order, the step for the others.
    unit: SVector<f64, N>,
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
        let mut method = Self {
            k: [Aligned(SVector::zeros()); STAGES + 1],
            weights: [[Aligned(SVector::zeros()); STAGES]; ROWS],
            is_second: [false; N],
            drift: SVector::zeros(),
            unit: SVector::zeros(),
            ring: Ring::new(),
            polynomial: Polynomial::zero(),
            arch: Arch::new(),
        };
        method.lay_out([false; N]);
        method
    }

    /// Gives each state the weights of its order.
    fn lay_out(&mut self, is_second: [bool; N]) {
        for (row, weights) in self.weights.iter_mut().enumerate() {
            for (stage, weights) in weights.iter_mut().enumerate() {
                let of = |table: &Weights| table[row].get(stage).copied().unwrap_or(0.0);
                weights.0 = SVector::from_fn(|i, _| of(if is_second[i] { &SECOND } else { &FIRST }));
            }
        }
        self.is_second = is_second;
    }

    /// Sets what the step's size and its start determine.
    #[inline(always)]
    fn begin(&mut self, start: &Point<N>, h: f64) {
        for i in 0..N {
            let is_second = self.is_second[i];
            self.unit.data.0[0][i] = if is_second { h * h } else { h };
            self.drift.data.0[0][i] = if is_second { h * start.rate.data.0[0][i] } else { 0.0 };
        }
    }

    /// The sum of the stages before `behind` for state `i`, with the weights of a row.
    #[inline(always)]
    fn combine(&self, row: usize, behind: usize, i: usize) -> f64 {
        let weights = &self.weights[row];
        // Adding to -0 changes nothing, not even the sign of a zero.
        let sum = (0..behind).fold(-0.0, |sum, j| sum + weights[j].0.data.0[0][i] * self.k[j].0.data.0[0][i]);
        self.unit.data.0[0][i] * sum
    }

    /// Writes the state of a row at the instant `c` of the step, whose weights are those of the stages before `behind`.
    #[inline(always)]
    fn reach(&self, row: usize, behind: usize, c: f64, start: &Point<N>, x: &mut SVector<f64, N>) {
        for (i, x) in x.data.0[0].iter_mut().enumerate() {
            *x = start.x.data.0[0][i] + (c * self.drift.data.0[0][i] + self.combine(row, behind, i));
        }
    }

    /// Evaluates the stages. Their sums are written out, so that each takes what it needs in one go.
    #[inline(always)]
    fn evaluate(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64) {
        let mut x = start.x;
        self.k[0].0 = start.rate;
        flow.second_derivatives(&x, &mut self.k[0].0);
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => self.reach($stage, $stage, *c, start, &mut x), )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            flow.forces(start.t + c * h, &x, &mut self.k[stage].0);
        }
    }

    /// The magnitudes of the differences to the embedded method, in parts of what is allowed.
    #[inline(always)]
    fn errors(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> [f64; N] {
        let mut errors = [0.0; N];
        for (i, error) in errors.iter_mut().enumerate() {
            let allowed = scale.allowed(i, start.x.data.0[0][i], end.data.0[0][i]);
            *error = (self.combine(ERROR, STAGES, i) / allowed).abs();
        }
        errors
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
        flow: &mut impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        self.begin(start, h);
        self.evaluate(flow, start, h);
        self.reach(END, STAGES, 1.0, start, end);
        largest(&self.errors(start, scale, end))
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
        flow: &mut impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let is_second = flow.second_order();
        if is_second != self.is_second {
            self.lay_out(is_second);
        }
        self.ring.follow(flow, start, &self.is_second);
        let reach = (h * self.ring.frequency / tableau::REACH).powi(tableau::ERROR_ORDER as i32);
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

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        let errors = self.errors(start, scale, end);
        index_of_largest::<N>(|i| errors[i])
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.k[..STAGES].iter().find_map(|k| first_not_finite(&k.0))
    }

    fn prepare_dense(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.k[END].0 = end.rate;
        flow.second_derivatives(&end.x, &mut self.k[END].0);
        let Self { k, unit, is_second, polynomial, .. } = self;
        polynomial.set(start, h, end, |m, i, [_, first, third]| {
            if is_second[i] {
                // The polynomial of degree 5 through the second derivatives at both ends, too.
                let [before, behind] = [k[0].0[i], k[END].0[i]].map(|second| 0.5 * unit[i] * second);
                let at_start = before + first - third;
                if m == 0 { at_start } else { behind + first + 2.0 * third - at_start }
            } else {
                unit[i] * DENSE[m].iter().zip(k.iter()).map(|(weight, k)| weight * k.0[i]).sum::<f64>()
            }
        });
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        self.polynomial.evaluate(COEFFICIENTS, start, theta, x);
    }
}
