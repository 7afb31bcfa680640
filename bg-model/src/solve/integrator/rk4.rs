//! The classical Runge-Kutta method of order 4 with a fixed step.
//!
//! In: the step. Out: the state after it; in between the cubic Hermite polynomial, whose error is of the same order as
//! the method's. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, table II.1.2.

use nalgebra::SVector;

use super::{Flow, Method, Point, Scale, StepControl, first_not_finite, hermite};
use crate::model::description::OperationCount;
use crate::model::scalar::Scalar;

/// The rates of a step, that at its start included.
pub(crate) const RATES: usize = 4;

/// Kutta's method of order 4; four rates a step, no error estimate.
#[derive(Clone, Debug)]
pub struct Rk4<const N: usize> {
    step: f64,
    /// The rates of the last attempt.
    rates: [SVector<f64, N>; RATES],
}

/// Instants of the second to the fourth stage and the weight of the stage before in each.
const C: [f64; RATES - 1] = [0.5, 0.5, 1.0];
/// Weights of the four stages.
const B: [f64; RATES] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// Writes the state after a step of size `h` (s) from time `t` (s) and state `x` into `end`, where the first of `rates` is the rate
/// at the start; writes the others.
#[inline(always)]
pub(crate) fn step<S: Scalar, const N: usize>(
    mut rate: impl FnMut(S, &SVector<S, N>, &mut SVector<S, N>),
    t: S,
    x: &SVector<S, N>,
    h: S,
    rates: &mut [SVector<S, N>; RATES],
    end: &mut SVector<S, N>,
) {
    let [x] = &x.data.0;
    for (stage, c) in C.into_iter().enumerate() {
        let before = rates[stage].data.0[0];
        let moved = core::array::from_fn(|i| x[i] + h * before[i].times(c));
        rate(t + h.times(c), &SVector::from(moved), &mut rates[stage + 1]);
    }
    let [k0, k1, k2, k3] = rates.each_ref().map(|rate| &rate.data.0[0]);
    for (i, end) in end.data.0[0].iter_mut().enumerate() {
        *end = x[i] + h * (k0[i].times(B[0]) + k1[i].times(B[1]) + k2[i].times(B[2]) + k3[i].times(B[3]));
    }
}

/// The operations of [`step`] with so many states, without those of the rates.
pub(crate) const fn sums(states: usize) -> OperationCount {
    let before_each_stage =
        OperationCount { additions: states + 1, multiplications: 2 * states + 1, ..OperationCount::NONE };
    let at_the_end = OperationCount { additions: 4 * states, multiplications: 5 * states, ..OperationCount::NONE };
    before_each_stage.times(C.len()).plus(at_the_end)
}

impl<const N: usize> Rk4<N> {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self { step, rates: [SVector::zeros(); RATES] }
    }
}

impl<const N: usize> Method<N> for Rk4<N> {
    fn name(&self) -> &'static str {
        "RK4"
    }

    fn control(&self) -> StepControl {
        StepControl::Fixed { step: self.step }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        _scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        self.rates[0] = start.rate;
        let rate = |t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>| flow.rate(t, x, dx);
        step(rate, start.t, &start.x, h, &mut self.rates, end);
        0.0
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.rates[1..].iter().find_map(first_not_finite)
    }

    fn dense(&self, start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        hermite(start, h, end, theta, x);
    }
}
