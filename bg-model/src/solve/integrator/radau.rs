//! Radau IIA: implicit methods for stiff systems, of order 5 and 9.
//!
//! In: a step. Out: the state after it with an error estimate, in between the collocation polynomial. L-stable and
//! stiffly accurate: the last stage is the end of the step. For systems whose Jacobian is cheap beside the steps that
//! an explicit method would need. Source: see `collocation`.

use super::collocation::{Collocation, RADAU5, RADAU9};
use super::{Flow, Method, PointRef, Scale, StepControl};

/// Radau IIA with `S` stages and `P` = (S - 1) / 2 complex systems in each correction.
#[derive(Clone, Debug)]
pub struct Radau<const S: usize, const P: usize> {
    pub(super) core: Collocation<S, P>,
}

/// Radau IIA of order 5.
pub type Radau5 = Radau<3, 1>;
/// Radau IIA of order 9: on the hacksaw with the rod off cheaper than order 5 from a pose error of 1e-5 down.
pub type Radau9 = Radau<5, 2>;

impl Radau<3, 1> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { core: Collocation::new(&RADAU5, false) }
    }
}

impl Radau<5, 2> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { core: Collocation::new(&RADAU9, false) }
    }
}

impl Default for Radau<3, 1> {
    fn default() -> Self {
        Self::new()
    }
}

impl Default for Radau<5, 2> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const S: usize, const P: usize> Method for Radau<S, P> {
    fn name(&self) -> &'static str {
        if S == 3 { "Radau IIA 5" } else { "Radau IIA 9" }
    }

    fn control(&self) -> StepControl {
        StepControl::Predictive { order: (S + 1) as f64 }
    }

    fn fit(&mut self, states: usize) {
        self.core.fit(states);
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        let error = match self.core.solve(flow, start, h, scale) {
            Ok(()) => {
                let increments = self.core.last_increment();
                for ((end, from), increment) in end.iter_mut().zip(start.x).zip(increments) {
                    *end = from + increment;
                }
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

    fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
        self.core.largest_error(start, scale, end)
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.core.faulty_rate()
    }

    fn dense(&self, start: PointRef<'_>, _h: f64, _end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        self.core.dense(start, theta, x);
    }
}
