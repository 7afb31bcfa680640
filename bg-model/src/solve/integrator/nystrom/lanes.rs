//! Steps of several runs side by side, each with its own start, size and branches.
//!
//! In: a system that calculates with numbers side by side. Out: the steps that each run makes by itself, to the bit.

use std::ops::Range;

use super::Nystrom;
use super::ring::{Pull, reach};
use super::stages::Stages;
use super::tableau::{ERROR_ORDER, STAGES};
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::solve::integrator::Scale;
use crate::solve::integrator::lanes::OfOne;
use crate::solve::integrator::steps::{Begin, Forces};

/// The method for runs side by side.
#[derive(Debug)]
pub(crate) struct NystromInLanes<V> {
    stages: Stages<Lanes<V>, 1>,
    /// The directions of the fastest oscillations.
    direction: Vec<Lanes<V>>,
    pull: Pull<Lanes<V>>,
    /// Their frequencies, rad/s.
    frequency: Lanes<V>,
}

impl<V: Vector> NystromInLanes<V> {
    /// The power of the step with which the norm of the error estimate falls.
    pub const ORDER: f64 = ERROR_ORDER;

    /// Of so many states, its work space empty.
    pub fn new(states: usize) -> Self {
        let zero = Lanes::from_f64(0.0);
        Self { stages: Stages::new(states), direction: vec![zero; states], pull: Pull::new(states), frequency: zero }
    }

    /// The frequency of the fastest oscillation at a place is this, rad/s.
    pub fn hold_to(&mut self, place: usize, frequency: f64) {
        *self.frequency.0.at_mut(place) = frequency;
    }

    /// The error norms that keep steps of size `h` (s) where the fastest oscillations are stable.
    #[inline(always)]
    pub fn reach(&self, h: Lanes<V>) -> Lanes<V> {
        reach(h, self.frequency)
    }

    /// The directions of the fastest oscillations.
    pub fn compensation(&mut self) -> &mut [Lanes<V>] {
        &mut self.direction
    }

    /// The same: no step changes them.
    pub fn to_be_carried(&self) -> &[Lanes<V>] {
        &self.direction
    }

    /// The second derivatives, or rates, of a stage, each with its state.
    pub fn stage(&self, stage: usize) -> impl Iterator<Item = (usize, Lanes<V>)> {
        self.stages.stage(stage)
    }

    /// One iteration towards the fastest oscillation at the places of `due`, from states `x` with rates `rate` at
    /// time `t` (s), in the norm of these weights: see [`Ring::follow`](super::ring::Ring::follow). Gives the
    /// stiffnesses.
    #[inline(always)]
    pub fn follow(
        &mut self,
        forces: &impl Forces<Lanes<V>>,
        due: V::Mask,
        (t, x, rate): (Lanes<V>, &[Lanes<V>], &[Lanes<V>]),
        weights: &[Lanes<V>],
    ) -> Lanes<V> {
        let Self { direction, pull, .. } = self;
        let states = forces.second();
        let zero = t.alike(0.0);
        pull.follow(direction, weights, &states, forces, (t, x, rate));
        let stiffness = pull.stiffness;
        let infinity = t.alike(f64::INFINITY);
        let is_finite = V::below(stiffness.abs().0, infinity.0);
        let is_stiff = V::below(zero.0, stiffness.0);
        let is_found = V::mask(V::bits(due) & V::bits(is_finite));
        for i in states {
            let new = Lanes::select(is_stiff, pull.direction(i), zero);
            direction[i] = Lanes::select(is_found, new, direction[i]);
        }
        stiffness
    }

    /// Tries a step at each place; gives the norms of the error estimates.
    #[inline(always)]
    pub fn attempt(
        &mut self,
        forces: &impl Forces<Lanes<V>>,
        begin: &Begin<'_, Lanes<V>>,
        scale: &Scale<Lanes<V>>,
        end: &mut [Lanes<V>],
    ) -> Lanes<V> {
        self.stages.arrange(forces.second());
        self.stages.step(forces, begin, scale, end)
    }
}

impl OfOne for Nystrom {
    /// The direction of the fastest oscillation.
    fn compensation(&mut self) -> &mut [f64] {
        &mut self.ring.direction
    }

    fn keep(&mut self, compensation: &dyn Fn(&mut [f64]), stage: &dyn Fn(usize, &mut [f64])) {
        compensation(&mut self.ring.direction);
        (0..STAGES).for_each(|index| self.stages.set_stage(index, |rate| stage(index, rate)));
    }

    fn rates(&self) -> u64 {
        (STAGES - 1) as u64
    }

    fn is_due(&self) -> bool {
        self.ring.is_due()
    }

    fn begins(&mut self, second: &Range<usize>, weights: &[f64]) -> bool {
        self.stages.arrange(second.clone());
        let begins = self.ring.begins();
        if begins {
            self.ring.begin(second, weights);
        }
        begins
    }

    fn stiffness(&mut self, stiffness: f64) {
        self.ring.found(stiffness);
    }

    fn frequency(&self) -> f64 {
        self.ring.frequency
    }

    fn reach(&self, h: f64) -> f64 {
        self.ring.reach(h)
    }

    fn advanced(&mut self) {
        self.ring.advance();
    }
}
