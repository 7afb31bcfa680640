//! Radau IIA: implicit methods for stiff systems, of order 5 and 9.
//!
//! In: a step. Out: the state after it with an error estimate, in between the collocation polynomial. L-stable and
//! stiffly accurate: the last stage is the end of the step. For systems whose Jacobian is cheap beside the steps that an
//! explicit method would need. Source: see `collocation`.

use nalgebra::SVector;

use super::collocation::{Collocation, RADAU5, RADAU9};
use super::{Flow, Method, Point, Scale, StepControl};

/// Radau IIA with `S` stages and `P` = (S - 1) / 2 complex systems in each correction.
#[derive(Clone, Debug)]
pub struct Radau<const N: usize, const S: usize, const P: usize> {
    pub(super) core: Collocation<N, S, P>,
}

/// Radau IIA of order 5.
pub type Radau5<const N: usize> = Radau<N, 3, 1>;
/// Radau IIA of order 9: on the hacksaw with the rod off cheaper than order 5 from a pose error of 1e-5 down.
pub type Radau9<const N: usize> = Radau<N, 5, 2>;

impl<const N: usize> Radau<N, 3, 1> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { core: Collocation::new(&RADAU5, false) }
    }
}

impl<const N: usize> Radau<N, 5, 2> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { core: Collocation::new(&RADAU9, false) }
    }
}

impl<const N: usize> Default for Radau<N, 3, 1> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Default for Radau<N, 5, 2> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, const S: usize, const P: usize> Method<N> for Radau<N, S, P> {
    fn name(&self) -> &'static str {
        if S == 3 { "Radau IIA 5" } else { "Radau IIA 9" }
    }

    fn control(&self) -> StepControl {
        StepControl::Predictive { order: (S + 1) as f64 }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let error = match self.core.solve(flow, start, h, scale) {
            Ok(()) => {
                *end = start.x + self.core.last_increment();
                self.core.estimate(flow, start, h, scale, end)
            }
            Err(error) => error,
        };
        self.core.conclude(error)
    }

    fn advance(&mut self) {
        self.core.advance();
    }

    fn restart(&mut self) {
        self.core.restart();
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        self.core.largest_error(start, scale, end)
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.core.faulty_rate()
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        self.core.dense(start, theta, x);
    }
}
