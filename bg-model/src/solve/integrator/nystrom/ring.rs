//! The fastest oscillation of a flow, by which stability limits the step.
//!
//! In: a point of the trajectory. Out: the frequency of the stiffest joint there. Method: one step of a power iteration
//! with q'' = a(q) now and then, from the direction that the last one led to; as for the spectral radius in RKC (B. P.
//! Sommeijer, L. F. Shampine, J. G. Verwer, Journal of Computational and Applied Mathematics 88 (1998), 315-326). Stiff
//! joints turn with the links, so one rate in so many steps keeps up with them. Lengths of directions are in parts of
//! the sizes at which states count beside each other, so that metres and radians compare in any units.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::tableau;
use crate::model::scalar::Scalar;
use crate::model::scalar::double::{fraction, power, root};
use crate::solve::integrator::PointRef;
use crate::solve::integrator::steps::Forces;

/// Steps after a restart that each iterate once.
const FIRST_STEPS: u32 = 8;
/// Steps between iterations later on.
const PAUSE: u32 = 4;
/// The size of the trial displacement, in parts of the largest state of second order.
const DISPLACEMENT: f64 = 1e-7;
/// The fractional part of the golden ratio: its multiples lie evenly, so that no oscillation of equal parts has no
/// share in them.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The fastest oscillation as far as it is known.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// Its frequency, rad/s; 0 where it is not known or there is none.
    pub frequency: f64,
    /// Its direction; 0 where it is not known.
    pub(super) direction: Vec<f64>,
    /// Another, with a share of everything.
    any: Vec<f64>,
    pull: Pull<f64>,
    /// Accepted steps since the restart.
    steps: u32,
    /// Whether the present step has been looked at.
    is_done: bool,
}

/// What pulls back along a direction.
#[derive(Clone, Debug)]
pub(super) struct Pull<S> {
    /// Its strength, rad^2/s^2; none along a direction of length 0.
    pub stiffness: S,
    /// The change of the second derivatives in a trial displacement, and its length.
    change: Vec<S>,
    length: S,
    /// The displaced state; the rates, then the second derivatives, where they are without and with the displacement.
    displaced: Vec<S>,
    ends: [Vec<S>; 2],
}

impl<S: Scalar> Pull<S> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let zero = S::from_f64(0.0);
        let room = || vec![zero; states];
        Self { stiffness: zero, change: room(), length: zero, displaced: room(), ends: [room(), room()] }
    }

    /// Tries a displacement along `direction`, a part of `states`, at time `t` (s) and a state with its rate, in the
    /// norm of these weights.
    #[inline(always)]
    pub fn follow(
        &mut self,
        direction: &[S],
        weights: &[S],
        states: &Range<usize>,
        forces: &impl Forces<S>,
        (t, x, rate): (S, &[S], &[S]),
    ) {
        let Self { change, displaced, ends: [before, behind], .. } = self;
        let zero = x[0].alike(0.0);
        let mut largest = zero;
        for i in states.clone() {
            largest = (x[i] * weights[i]).abs().larger(largest);
        }
        let size = largest.larger(zero.alike(DISPLACEMENT)).times(DISPLACEMENT);
        let factor = size / length(direction, weights);
        displaced.copy_from_slice(x);
        before.copy_from_slice(rate);
        for i in states.clone() {
            displaced[i] = x[i] + direction[i] * factor;
        }
        forces.at_start(x, before);
        // Not `Forces::at_stage`, which may round otherwise: their difference is small.
        forces.rate(t, displaced, behind);
        forces.at_start(displaced, behind);
        for i in states.clone() {
            change[i] = behind[i] - before[i];
        }
        self.length = length(change, weights);
        self.stiffness = self.length / size;
    }

    /// The part of state `i` in the direction in which it pulls.
    #[inline(always)]
    pub fn direction(&self, i: usize) -> S {
        self.change[i] / self.length
    }
}

/// The length of a vector in the norm of these weights; its squares are summed side by side, for none to wait for
/// another.
#[inline(always)]
fn length<S: Scalar>(of: &[S], weights: &[S]) -> S {
    const SIDE_BY_SIDE: usize = 8;
    let mut sums = [of[0].alike(0.0); SIDE_BY_SIDE];
    for (i, (&entry, &weight)) in of.iter().zip(weights).enumerate() {
        let part = entry * weight;
        sums[i % SIDE_BY_SIDE] = sums[i % SIDE_BY_SIDE] + part * part;
    }
    let mut sum = sums[0];
    for other in &sums[1..] {
        sum = sum + *other;
    }
    sum.sqrt()
}

impl Ring {
    /// Of so many states.
    pub fn new(states: usize) -> Self {
        let nothing = vec![0.0; states];
        let (direction, any) = (nothing.clone(), nothing);
        Self { frequency: 0.0, direction, any, pull: Pull::new(states), steps: 0, is_done: false }
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

    /// Iterates once if it is time to, in the norm of these weights.
    pub fn follow(&mut self, forces: &impl Forces<f64>, point: PointRef<'_>, states: &Range<usize>, weights: &[f64]) {
        if states.is_empty() {
            self.frequency = 0.0;
            return;
        }
        if !self.is_due() {
            return;
        }
        if self.begins() {
            self.begin(states, weights);
        }
        let PointRef { t, x, rate } = point;
        let Self { direction, pull, .. } = self;
        pull.follow(direction, weights, states, forces, (t, x, rate));
        let stiffness = pull.stiffness;
        if stiffness.is_finite() {
            direction.fill(0.0);
            for i in states.clone().filter(|_| stiffness > 0.0) {
                direction[i] = pull.direction(i);
            }
        }
        self.found(stiffness);
    }

    /// The direction of what rang before the branch changed, and a share of everything else.
    pub fn begin(&mut self, states: &Range<usize>, weights: &[f64]) {
        let Self { direction, any, .. } = self;
        any.fill(0.0);
        for i in states.clone().filter(|&i| weights[i] > 0.0) {
            any[i] = (1.0 + fraction(GOLDEN * i as f64)) / weights[i];
        }
        for vector in [&mut *direction, &mut *any] {
            let length = length(vector, weights);
            vector.iter_mut().for_each(|part| *part = if length > 0.0 { *part / length } else { 0.0 });
        }
        direction.iter_mut().zip(any).for_each(|(direction, any)| *direction += *any);
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
        reach(h, self.frequency)
    }
}

/// The error norm that holds a step of size `h` (s) to where an oscillation of this frequency (rad/s) is stable.
#[inline(always)]
pub(super) fn reach<S: Scalar>(h: S, frequency: S) -> S {
    power(h * frequency / h.alike(tableau::REACH), tableau::ERROR_ORDER as u32)
}

#[cfg(test)]
mod tests {
    use nalgebra::SVector;

    use super::*;

    fn is_that_of_nalgebra<const N: usize>() {
        let of: [f64; N] = core::array::from_fn(|i| root(0.7 + i as f64) - 2.3);
        let expected = SVector::from(of).norm();
        assert!((length(&of, &[1.0; N]) - expected).abs() <= 4.0 * f64::EPSILON * expected, "{N}");
    }

    #[test]
    fn lengths() {
        is_that_of_nalgebra::<1>();
        is_that_of_nalgebra::<8>();
        is_that_of_nalgebra::<29>();
    }
}
