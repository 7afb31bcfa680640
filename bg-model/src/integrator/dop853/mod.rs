//! DOP853: the explicit Runge-Kutta method of order 8 of Dormand and Prince for non-stiff systems.
//!
//! In: a step. Out: the state after it with an error estimate from embedded methods of orders 5 and 3, and on request a
//! dense output of order 7. Source: see `tableau`.

mod dense;
#[cfg(test)]
mod order;
mod step;
mod tableau;

use nalgebra::SVector;

use super::{Flow, Method, Point, Scale, StepControl, first_not_finite};

/// The number of stages, those of the dense output included.
const STAGES: usize = 16;

/// The method of order 8(5,3): eleven rates for an attempt and one at the end of an accepted step; three more if its
/// dense output is asked for.
#[derive(Clone, Debug)]
pub struct Dop853<const N: usize> {
    /// The stages' rates.
    k: [SVector<f64, N>; STAGES],
    /// The dense output's coefficients.
    polynomial: [SVector<f64, N>; 7],
}

impl<const N: usize> Dop853<N> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { k: [SVector::zeros(); STAGES], polynomial: [SVector::zeros(); 7] }
    }
}

impl<const N: usize> Default for Dop853<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Method<N> for Dop853<N> {
    fn name(&self) -> &'static str {
        "DOP853"
    }

    fn control(&self) -> StepControl {
        StepControl::Adaptive { order: 8.0 }
    }

    fn attempt(
        &mut self,
        flow: &mut impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        self.evaluate_stages(flow, start, h);
        self.finish_step(start, h, scale, end)
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        let error = self.scaled_errors(start, scale, end);
        (0..N).fold(0, |largest, i| if error[i] > error[largest] { i } else { largest })
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.k[1..12].iter().find_map(first_not_finite)
    }

    fn prepare_dense(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.evaluate_dense_stages(flow, start, h, end);
        self.collect_polynomial(start, h, end);
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        self.evaluate_polynomial(start, theta, x);
    }
}
