//! Steps of several runs side by side, each with its own start, size and branches.
//!
//! In: a system that calculates with numbers side by side. Out: the steps that each run makes by itself, to the bit.

use std::ops::Range;

use nalgebra::SVector;

use super::Nystrom;
use super::ring::{Pull, reach};
use super::stages::Stages;
use super::tableau::{ERROR_ORDER, STAGES};
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::model::system::System;
use crate::solve::integrator::Scale;
use crate::solve::integrator::lanes::{OfOne, Side};
use crate::solve::integrator::steps::{Begin, Forces};
use crate::solve::integrator::tolerances::largest;

/// The method for runs side by side.
#[derive(Debug)]
pub(crate) struct NystromInLanes<V, const N: usize> {
    stages: Stages<Lanes<V>, N>,
    /// The directions of the fastest oscillations.
    direction: SVector<Lanes<V>, N>,
    /// Their frequencies, rad/s.
    frequency: Lanes<V>,
}

impl<V: Vector, const N: usize> NystromInLanes<V, N> {
    /// The power of the step with which the norm of the error estimate falls.
    pub const ORDER: f64 = ERROR_ORDER;

    /// Its work space empty.
    pub fn new() -> Self {
        let zero = Lanes::from_f64(0.0);
        Self { stages: Stages::new(), direction: SVector::from([zero; N]), frequency: zero }
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
    pub fn compensation(&mut self) -> &mut SVector<Lanes<V>, N> {
        &mut self.direction
    }

    /// The same: no step changes them.
    pub fn to_be_carried(&self) -> &SVector<Lanes<V>, N> {
        &self.direction
    }

    /// The second derivatives, or rates, of a stage.
    pub fn stage(&self, stage: usize) -> &SVector<Lanes<V>, N> {
        &self.stages.k[stage].0
    }

    /// One iteration towards the fastest oscillation at the places of `due`, from states `x` with rates `rate` at
    /// time `t` (s), in the norm of these weights: see [`Ring::follow`](super::ring::Ring::follow). Gives the
    /// stiffnesses.
    #[inline(always)]
    pub fn follow<Sys, const G: usize>(
        &mut self,
        side: &Side<'_, Sys, V, G>,
        due: V::Mask,
        (t, x, rate): (Lanes<V>, &SVector<Lanes<V>, N>, &SVector<Lanes<V>, N>),
        weights: &SVector<Lanes<V>, N>,
    ) -> Lanes<V>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        let states = Forces::<Lanes<V>, N>::second(side);
        let zero = t.alike(0.0);
        let pull = Pull::along(&self.direction, weights, &states, side, (t, x, rate));
        let stiffness = pull.stiffness;
        let infinity = t.alike(f64::INFINITY);
        let is_finite = V::below(stiffness.abs().0, infinity.0);
        let is_stiff = V::below(zero.0, stiffness.0);
        let is_found = V::mask(V::bits(due) & V::bits(is_finite));
        for i in states {
            let new = Lanes::select(is_stiff, pull.direction(i), zero);
            self.direction.data.0[0][i] = Lanes::select(is_found, new, self.direction.data.0[0][i]);
        }
        stiffness
    }

    /// Tries a step at each place; gives the norms of the error estimates.
    #[inline(always)]
    pub fn attempt<Sys, const G: usize>(
        &mut self,
        side: &Side<'_, Sys, V, G>,
        begin: &Begin<'_, Lanes<V>, N>,
        scale: &Scale<N, Lanes<V>>,
        end: &mut SVector<Lanes<V>, N>,
    ) -> Lanes<V>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        largest(&self.stages.step(side, begin, scale, end))
    }
}

impl<const N: usize> OfOne<N> for Nystrom<N> {
    /// The direction of the fastest oscillation.
    fn compensation(&mut self) -> &mut SVector<f64, N> {
        &mut self.ring.direction
    }

    fn keep(&mut self, compensation: SVector<f64, N>, stage: &dyn Fn(usize) -> SVector<f64, N>) {
        self.ring.direction = compensation;
        self.stages.k[..STAGES].iter_mut().enumerate().for_each(|(index, k)| k.0 = stage(index));
    }

    fn rates(&self) -> u64 {
        (STAGES - 1) as u64
    }

    fn is_due(&self) -> bool {
        self.ring.is_due()
    }

    fn begins(&mut self, second: &Range<usize>, weights: &SVector<f64, N>) -> bool {
        self.second = second.clone();
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
