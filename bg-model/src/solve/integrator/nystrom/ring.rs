//! The fastest oscillation of a flow, by which stability limits the step.
//!
//! In: a point of the trajectory. Out: the frequency of the stiffest joint there. Method: one step of a power iteration with
//! q'' = a(q) now and then, from the direction that the last one led to; as for the spectral radius in RKC (B. P. Sommeijer, L. F.
//! Shampine, J. G. Verwer, Journal of Computational and Applied Mathematics 88 (1998), 315-326). Stiff joints turn with the links, so
//! one rate in so many steps keeps up with them.

use core::ops::Range;

use nalgebra::SVector;

use super::tableau;
use crate::model::capability::SecondOrder;
use crate::model::scalar::double::{fraction, power, root};
use crate::solve::integrator::{Flow, Point};

/// Steps after a restart that each iterate once.
const FIRST_STEPS: u32 = 8;
/// Steps between iterations later on.
const PAUSE: u32 = 4;
/// The size of the trial displacement, in parts of the largest position.
pub(super) const DISPLACEMENT: f64 = 1e-7;
/// The fractional part of the golden ratio: its multiples lie evenly, so that no oscillation of equal parts has no share in them.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The fastest oscillation as far as it is known.
#[derive(Clone, Debug)]
pub(super) struct Ring<const N: usize> {
    /// Its frequency, rad/s; 0 where it is not known or there is none.
    pub frequency: f64,
    /// Its direction, of length 1; 0 where it is not known.
    pub(super) direction: SVector<f64, N>,
    /// Accepted steps since the restart.
    steps: u32,
    /// Whether the present step has been looked at.
    is_done: bool,
}

impl<const N: usize> Ring<N> {
    pub fn new() -> Self {
        Self { frequency: 0.0, direction: SVector::zeros(), steps: 0, is_done: false }
    }

    /// A step was accepted.
    pub fn advance(&mut self) {
        self.steps += 1;
        self.is_done = false;
    }

    /// Another flow, or another branch of it.
    pub fn restart(&mut self) {
        self.steps = 0;
        self.is_done = false;
    }

    /// Iterates once if it is time to.
    pub fn follow(&mut self, flow: &impl Flow<N>, point: &Point<N>, states: &Range<usize>) {
        let Some(second_order) = flow.second_order().filter(|_| !states.is_empty()) else {
            self.frequency = 0.0;
            return;
        };
        if !self.is_due() {
            return;
        }
        let masked =
            |x: &SVector<f64, N>| SVector::<f64, N>::from_fn(|i, _| if states.contains(&i) { x[i] } else { 0.0 });
        if self.begins() {
            // What rang before the branch changed, and a share of everything else.
            let any = SVector::<f64, N>::from_fn(|i, _| 1.0 + fraction(GOLDEN * i as f64));
            self.direction = (self.direction + masked(&any).normalize()).normalize();
        }
        let size = DISPLACEMENT * masked(&point.x).amax().max(DISPLACEMENT);
        let x = point.x + self.direction * size;
        let (mut moved, mut second) = (SVector::zeros(), point.rate);
        second_order.second_derivatives(&point.x, &mut second);
        // Not `SecondOrder::forces`, which may round otherwise: their difference is small.
        flow.rate(point.t, &x, &mut moved);
        second_order.second_derivatives(&x, &mut moved);
        let change = masked(&(moved - second));
        let stiffness = change.norm() / size;
        if stiffness.is_finite() {
            self.direction = if stiffness > 0.0 { change.normalize() } else { SVector::zeros() };
        }
        self.found(stiffness);
    }

    /// Whether it is time to iterate.
    pub fn is_due(&self) -> bool {
        !self.is_done && (self.steps < FIRST_STEPS || self.steps.is_multiple_of(PAUSE))
    }

    /// Whether the direction is to be found anew.
    pub fn begins(&self) -> bool {
        self.steps == 0 || self.frequency == 0.0
    }

    /// An iteration has given this stiffness, rad^2/s^2.
    pub fn found(&mut self, stiffness: f64) {
        self.is_done = true;
        if stiffness.is_finite() {
            self.frequency = root(stiffness);
        }
    }

    /// The error norm that holds a step of size `h` (s) to where the oscillation is stable.
    pub fn reach(&self, h: f64) -> f64 {
        power(h * self.frequency / tableau::REACH, tableau::ERROR_ORDER as u32)
    }
}
