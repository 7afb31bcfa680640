//! Gauss: the implicit method of order 6 that keeps energies, for long runs of conservative systems.
//!
//! In: the step, or none. Out: the state after it, in between the collocation polynomial, whose error falls with the
//! fourth power of the step. Symmetric and symplectic: it keeps every quadratic invariant, such as momentum, angular
//! momentum and the energy of a linear system, to rounding, and other energies without drift as long as the step is
//! fixed. Every step is solved to rounding for that. Source: see `collocation`; Hairer, Lubich, Wanner, Geometric
//! Numerical Integration, 2nd edition, sections IV.2 and VIII.6.

use alloc::vec::Vec;

use super::collocation::{Collocation, GAUSS6};
use super::{Flow, Method, PointRef, Scale, StepControl};

/// What corrections of a fixed step are measured by in place of tolerances, which it has none of: a part of the sizes
/// of the states, and this number in SI units where nothing is known of these.
const OF_FIXED: f64 = 1e-8;
const UNKNOWN: f64 = 1e-10;
/// A disagreement of this part of a state shows that a step's equations were not solved.
const LOST: f64 = 1e-3;

/// Gauss with three stages, of order 6 at the ends of steps. Samples between them are of order 4 only: to watch an
/// energy take [`Samples::Steps`](crate::simulation::Samples::Steps), or instants that are ends of steps.
#[derive(Clone, Debug)]
pub struct Gauss6 {
    pub(super) core: Collocation<3, 1>,
    control: StepControl,
    /// What a fixed step is measured by.
    own: Scale,
    /// The state at the end of the step by the polynomial.
    by_polynomial: Vec<f64>,
}

impl Gauss6 {
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
        Self {
            core: Collocation::new(&GAUSS6, true),
            control,
            own: Scale::of_nothing(OF_FIXED),
            by_polynomial: Vec::new(),
        }
    }

    /// Whether the quadrature disagrees with the polynomial, by a thousandth of the state and more than the tolerances:
    /// where h J is so large that the rates at the stages are rounding errors, the equations have no solution in `f64`.
    fn is_lost(&mut self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> bool {
        let polynomial = &mut self.by_polynomial;
        self.core.dense(start, 1.0, polynomial);
        let size = |i: usize| if end[i].abs() > start.x[i].abs() { end[i].abs() } else { start.x[i].abs() };
        let is_off = |i: usize| (end[i] - polynomial[i]).abs() > scale.allowed(i, start.x[i]) + LOST * size(i);
        (0..end.len()).any(is_off)
    }

    /// Tries a step as [`Method::attempt`] does, by this scale.
    fn step(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if let Err(error) = self.core.solve(flow, start, h, scale) {
            return error;
        }
        for (i, end) in end.iter_mut().enumerate() {
            *end = start.x[i] + self.core.quadrature(i, h);
        }
        if self.is_lost(start, scale, end) {
            return f64::INFINITY;
        }
        match self.control {
            StepControl::Fixed { .. } => 0.0,
            _ => self.core.estimate(flow, start, h, scale, end),
        }
    }
}

impl Method for Gauss6 {
    fn name(&self) -> &'static str {
        "Gauss 6"
    }

    fn control(&self) -> StepControl {
        self.control
    }

    fn measures(&self) -> bool {
        true
    }

    fn fit(&mut self, states: usize) {
        self.core.fit(states);
        self.by_polynomial.resize(states, 0.0);
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        let error = if let StepControl::Fixed { .. } = self.control {
            let mut own = core::mem::replace(&mut self.own, Scale::of_nothing(OF_FIXED));
            of_fixed(scale, &mut own);
            let error = self.step(flow, start, h, &own, end);
            self.own = own;
            error
        } else {
            self.step(flow, start, h, scale, end)
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

/// Makes `own` the scale of a fixed step, whatever the tolerances.
fn of_fixed(scale: &Scale, own: &mut Scale) {
    let part = OF_FIXED / scale.relative;
    own.growth = scale.growth;
    own.weights.clone_from(&scale.weights);
    own.absolute.clear();
    own.absolute.extend(scale.absolute.iter().map(|&absolute| {
        let absolute = if absolute > f64::MIN_POSITIVE { absolute * part } else { 0.0 };
        if absolute > f64::MIN_POSITIVE { absolute } else { UNKNOWN }
    }));
}
