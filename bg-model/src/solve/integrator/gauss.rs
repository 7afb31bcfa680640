//! Gauss: the implicit method of order 6 that keeps energies, for long runs of conservative systems.
//!
//! In: the step, or none. Out: the state after it, in between the collocation polynomial, whose error falls with the
//! fourth power of the step. Symmetric and symplectic: it keeps every quadratic invariant, such as momentum, angular
//! momentum and the energy of a linear system, to rounding, and other energies without drift as long as the step is
//! fixed. Every step is solved to rounding for that. Source: see `collocation`; Hairer, Lubich, Wanner, Geometric
//! Numerical Integration, 2nd edition, sections IV.2 and VIII.6.

use nalgebra::SVector;

use super::collocation::{Collocation, GAUSS6};
use super::{Flow, Method, Point, Scale, StepControl};

/// What corrections of a fixed step are measured by in place of tolerances, which it has none of: a part of the sizes of the states, and
/// this number in SI units where nothing is known of these.
const OF_FIXED: f64 = 1e-8;
const UNKNOWN: f64 = 1e-10;
/// A disagreement of this part of a state shows that a step's equations were not solved.
const LOST: f64 = 1e-3;

/// Gauss with three stages, of order 6 at the ends of steps. Samples between them are of order 4 only: to watch an energy take
/// [`Samples::Steps`](crate::simulation::Samples::Steps), or instants that are ends of steps.
#[derive(Clone, Debug)]
pub struct Gauss6<const N: usize> {
    pub(super) core: Collocation<N, 3, 1>,
    control: StepControl,
}

impl<const N: usize> Gauss6<N> {
    /// The method with steps of `step` (s); the driver refuses a step that is not positive and finite.
    #[must_use]
    pub fn new(step: f64) -> Self {
        Self::with(StepControl::Fixed { step })
    }

    /// The method with steps by the error estimate. Quadratic invariants are kept, other energies drift.
    #[must_use]
    pub fn adaptive() -> Self {
        Self::with(StepControl::Predictive { order: 4.0 })
    }

    fn with(control: StepControl) -> Self {
        Self { core: Collocation::new(&GAUSS6, true), control }
    }

    /// Whether the quadrature disagrees with the polynomial, by a thousandth of the state and more than the tolerances: where
    /// h J is so large that the rates at the stages are rounding errors, the equations have no solution in `f64`.
    fn is_lost(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> bool {
        let mut polynomial = SVector::zeros();
        self.core.dense(start, 1.0, &mut polynomial);
        let size = |i: usize| if end[i].abs() > start.x[i].abs() { end[i].abs() } else { start.x[i].abs() };
        (0..N).any(|i| (end[i] - polynomial[i]).abs() > scale.allowed(i, start.x[i]) + LOST * size(i))
    }
}

impl<const N: usize> Method<N> for Gauss6<N> {
    fn name(&self) -> &'static str {
        "Gauss 6"
    }

    fn control(&self) -> StepControl {
        self.control
    }

    fn measures(&self) -> bool {
        true
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let own;
        let scale = if let StepControl::Fixed { .. } = self.control {
            own = of_fixed(scale);
            &own
        } else {
            scale
        };
        let error = match self.core.solve(flow, start, h, scale) {
            Ok(()) => {
                *end = SVector::from_fn(|i, _| start.x[i] + self.core.quadrature(i, h));
                match self.control {
                    _ if self.is_lost(start, scale, end) => f64::INFINITY,
                    StepControl::Fixed { .. } => 0.0,
                    _ => self.core.estimate(flow, start, h, scale, end),
                }
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

/// The scale of a fixed step, whatever the tolerances.
fn of_fixed<const N: usize>(scale: &Scale<N>) -> Scale<N> {
    let part = OF_FIXED / scale.relative;
    let absolute = scale.absolute.map(|absolute| {
        let absolute = if absolute > f64::MIN_POSITIVE { absolute * part } else { 0.0 };
        if absolute > f64::MIN_POSITIVE { absolute } else { UNKNOWN }
    });
    Scale { relative: OF_FIXED, absolute, coarsest: OF_FIXED, ..*scale }
}
