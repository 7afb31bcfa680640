//! The classical Runge-Kutta method of order 4 with a fixed step.
//!
//! In: the step. Out: the state after it; in between the cubic Hermite polynomial, whose error is of the same order as
//! the method's. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, table II.1.2.

use alloc::vec::Vec;

use nalgebra::SVector;

use super::{Flow, Method, PointRef, Scale, StepControl, first_not_finite, hermite};
use crate::model::description::OperationCount;
use crate::model::scalar::Scalar;

/// The rates of a step, that at its start included.
pub(crate) const RATES: usize = 4;

/// Kutta's method of order 4; four rates a step, no error estimate.
#[derive(Clone, Debug)]
pub struct Rk4 {
    step: f64,
    /// The rates of the last attempt.
    rates: [Vec<f64>; RATES],
    /// The state of a stage.
    x: Vec<f64>,
}

/// Instants of the second to the fourth stage and the weight of the stage before in each.
const C: [f64; RATES - 1] = [0.5, 0.5, 1.0];
/// Weights of the four stages.
const B: [f64; RATES] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// Writes the state after a step of size `h` (s) from time `t` (s) and state `x` into `end`, where the first of `rates`
/// is the rate at the start; writes the others.
#[inline(always)]
pub(crate) fn step<S: Scalar, const N: usize>(
    mut rate: impl FnMut(S, &SVector<S, N>, &mut SVector<S, N>),
    t: S,
    x: &SVector<S, N>,
    h: S,
    rates: &mut [SVector<S, N>; RATES],
    end: &mut SVector<S, N>,
) {
    let mut moved = *x;
    for (stage, c) in C.into_iter().enumerate() {
        reach(c, x.as_slice(), h, rates[stage].as_slice(), moved.as_mut_slice());
        rate(t + h.times(c), &moved, &mut rates[stage + 1]);
    }
    arrive(x.as_slice(), h, rates.each_ref().map(|rate| rate.as_slice()), end.as_mut_slice());
}

/// Writes the state of a stage from the rate of the one before.
#[inline(always)]
fn reach<S: Scalar>(c: f64, start: &[S], h: S, before: &[S], x: &mut [S]) {
    for ((x, start), before) in x.iter_mut().zip(start).zip(before) {
        *x = *start + h * before.times(c);
    }
}

/// Writes the state at the end of a step.
#[inline(always)]
fn arrive<S: Scalar>(start: &[S], h: S, [k0, k1, k2, k3]: [&[S]; RATES], end: &mut [S]) {
    for (i, end) in end.iter_mut().enumerate() {
        *end = start[i] + h * (k0[i].times(B[0]) + k1[i].times(B[1]) + k2[i].times(B[2]) + k3[i].times(B[3]));
    }
}

/// The operations of [`step`] with so many states, without those of the rates.
pub(crate) const fn sums(states: usize) -> OperationCount {
    let before_each_stage =
        OperationCount { additions: states + 1, multiplications: 2 * states + 1, ..OperationCount::NONE };
    let at_the_end = OperationCount { additions: 4 * states, multiplications: 5 * states, ..OperationCount::NONE };
    before_each_stage.times(C.len()).plus(at_the_end)
}

impl Rk4 {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, rates: [const { Vec::new() }; RATES], x: Vec::new() }
    }
}

impl Method for Rk4 {
    fn name(&self) -> &'static str {
        "RK4"
    }

    fn control(&self) -> StepControl {
        StepControl::Fixed { step: self.step }
    }

    fn fit(&mut self, states: usize) {
        self.rates.iter_mut().chain([&mut self.x]).for_each(|room| room.resize(states, 0.0));
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, _scale: &Scale, end: &mut [f64]) -> f64 {
        let Self { rates, x, .. } = self;
        rates[0].copy_from_slice(start.rate);
        for (stage, c) in C.into_iter().enumerate() {
            reach(c, start.x, h, &rates[stage], x);
            flow.rate(start.t + h * c, x, &mut rates[stage + 1]);
        }
        arrive(start.x, h, rates.each_ref().map(|rate| &rate[..]), end);
        0.0
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.rates[1..].iter().find_map(|rate| first_not_finite(rate))
    }

    fn dense(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        hermite(start, h, end, theta, x);
    }
}
