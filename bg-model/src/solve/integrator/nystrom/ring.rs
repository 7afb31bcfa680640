//! The fastest oscillation of a flow, by which stability limits the step.
//!
//! In: a point of the trajectory. Out: the frequency of the stiffest joint there. Method: one step of a power iteration with
//! q'' = a(q) now and then, from the direction that the last one led to; as for the spectral radius in RKC (B. P. Sommeijer, L. F.
//! Shampine, J. G. Verwer, Journal of Computational and Applied Mathematics 88 (1998), 315-326). Stiff joints turn with the links, so
//! one rate in so many steps keeps up with them. Lengths of directions are in parts of the sizes at which states
//! count beside each other, so that metres and radians compare in any units.

use core::ops::Range;

use nalgebra::SVector;

use super::tableau;
use crate::model::scalar::Scalar;
use crate::model::scalar::double::{fraction, power, root};
use crate::solve::integrator::Point;
use crate::solve::integrator::steps::Forces;

/// Steps after a restart that each iterate once.
const FIRST_STEPS: u32 = 8;
/// Steps between iterations later on.
const PAUSE: u32 = 4;
/// The size of the trial displacement, in parts of the largest state of second order.
const DISPLACEMENT: f64 = 1e-7;
/// The fractional part of the golden ratio: its multiples lie evenly, so that no oscillation of equal parts has no share in them.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The fastest oscillation as far as it is known.
#[derive(Clone, Debug)]
pub(super) struct Ring<const N: usize> {
    /// Its frequency, rad/s; 0 where it is not known or there is none.
    pub frequency: f64,
    /// Its direction; 0 where it is not known.
    pub(super) direction: SVector<f64, N>,
    /// Accepted steps since the restart.
    steps: u32,
    /// Whether the present step has been looked at.
    is_done: bool,
}

/// What pulls back along a direction.
#[derive(Clone, Debug)]
pub(super) struct Pull<S, const N: usize> {
    /// Its strength, rad^2/s^2; none along a direction of length 0.
    pub stiffness: S,
    /// The change of the second derivatives in a trial displacement, and its length.
    change: [S; N],
    length: S,
}

impl<S: Scalar, const N: usize> Pull<S, N> {
    /// What pulls back along `direction`, a part of `states`, at time `t` (s) and a state with its rate, in the norm
    /// of these weights.
    #[inline(always)]
    pub fn along(
        direction: &SVector<S, N>,
        weights: &SVector<S, N>,
        states: &Range<usize>,
        forces: &impl Forces<S, N>,
        (t, x, rate): (S, &SVector<S, N>, &SVector<S, N>),
    ) -> Self {
        let zero = x.data.0[0][0].alike(0.0);
        let mut largest = zero;
        for i in states.clone() {
            largest = (x.data.0[0][i] * weights.data.0[0][i]).abs().larger(largest);
        }
        let size = largest.larger(zero.alike(DISPLACEMENT)).times(DISPLACEMENT);
        let factor = size / length(&direction.data.0[0], weights);
        let (mut displaced, mut before, mut behind) = (*x, *rate, *rate);
        for i in states.clone() {
            displaced.data.0[0][i] = x.data.0[0][i] + direction.data.0[0][i] * factor;
        }
        forces.at_start(x, &mut before);
        // Not `Forces::at_stage`, which may round otherwise: their difference is small.
        forces.rate(t, &displaced, &mut behind);
        forces.at_start(&displaced, &mut behind);
        let mut change = [zero; N];
        for i in states.clone() {
            change[i] = behind.data.0[0][i] - before.data.0[0][i];
        }
        let length = length(&change, weights);
        Self { stiffness: length / size, change, length }
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
fn length<S: Scalar, const N: usize>(of: &[S; N], weights: &SVector<S, N>) -> S {
    const SIDE_BY_SIDE: usize = 8;
    let mut sums = [of[0].alike(0.0); SIDE_BY_SIDE];
    for (i, (&entry, &weight)) in of.iter().zip(&weights.data.0[0]).enumerate() {
        let part = entry * weight;
        sums[i % SIDE_BY_SIDE] = sums[i % SIDE_BY_SIDE] + part * part;
    }
    let mut sum = sums[0];
    for other in &sums[1..] {
        sum = sum + *other;
    }
    sum.sqrt()
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

    /// Iterates once if it is time to, in the norm of these weights.
    pub fn follow(
        &mut self,
        forces: &impl Forces<f64, N>,
        point: &Point<N>,
        states: &Range<usize>,
        weights: &SVector<f64, N>,
    ) {
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
        let Point { t, x, rate } = point;
        let pull = Pull::along(&self.direction, weights, states, forces, (*t, x, rate));
        let stiffness = pull.stiffness;
        if stiffness.is_finite() {
            self.direction = SVector::zeros();
            for i in states.clone().filter(|_| stiffness > 0.0) {
                self.direction[i] = pull.direction(i);
            }
        }
        self.found(stiffness);
    }

    /// The direction of what rang before the branch changed, and a share of everything else.
    pub fn begin(&mut self, states: &Range<usize>, weights: &SVector<f64, N>) {
        let mut any = SVector::<f64, N>::zeros();
        for i in states.clone().filter(|&i| weights[i] > 0.0) {
            any[i] = (1.0 + fraction(GOLDEN * i as f64)) / weights[i];
        }
        let [rung, all] = [self.direction, any].map(|of| {
            let length = length(&of.data.0[0], weights);
            if length > 0.0 { of / length } else { SVector::zeros() }
        });
        self.direction = rung + all;
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
    use super::*;

    fn is_that_of_nalgebra<const N: usize>() {
        let of: [f64; N] = core::array::from_fn(|i| root(0.7 + i as f64) - 2.3);
        let expected = SVector::from(of).norm();
        assert!((length(&of, &SVector::repeat(1.0)) - expected).abs() <= 4.0 * f64::EPSILON * expected, "{N}");
    }

    #[test]
    fn lengths() {
        is_that_of_nalgebra::<1>();
        is_that_of_nalgebra::<8>();
        is_that_of_nalgebra::<29>();
    }
}
