//! Steps of several runs side by side, each with its own start, size and branches.
//!
//! In: a system that calculates with numbers side by side. Out: the steps that each run makes by itself, to the bit.

use std::ops::Range;

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use super::Nystrom;
use super::ring::Pull;
use super::stages::{Begin, Forces, Stages};
use crate::model::capability::SecondOrder;
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::model::system::System;
use crate::solve::integrator::Scale;

/// A system side by side, its switches frozen.
#[derive(Debug)]
pub(crate) struct Side<'a, Sys, V: Vector, const G: usize> {
    /// The system.
    pub system: &'a Sys,
    /// Where the guard of each switch is negative.
    pub negative: &'a [V::Mask; G],
}

impl<Sys, V: Vector, const N: usize, const G: usize> Forces<Lanes<V>, N> for Side<'_, Sys, V, G>
where
    Sys: System<Lanes<V>, N, G>,
{
    #[inline(always)]
    fn at_start(&self, x: &SVector<Lanes<V>, N>, dx: &mut SVector<Lanes<V>, N>) {
        if let Some(second) = self.system.second_order() {
            second.second_derivatives(x, dx);
        }
    }

    #[inline(always)]
    fn at_stage(&self, t: Lanes<V>, x: &SVector<Lanes<V>, N>, dx: &mut SVector<Lanes<V>, N>) {
        match self.system.second_order() {
            Some(second) => second.forces(t, x, self.negative, dx),
            None => self.system.always_inlined_rate(t, x, self.negative, dx),
        }
    }

    #[inline(never)]
    fn rate(&self, t: Lanes<V>, x: &SVector<Lanes<V>, N>, dx: &mut SVector<Lanes<V>, N>) {
        V::vectorized(Rate { side: self, t, x, dx });
    }
}

struct Rate<'a, Sys, V: Vector, const N: usize, const G: usize> {
    side: &'a Side<'a, Sys, V, G>,
    t: Lanes<V>,
    x: &'a SVector<Lanes<V>, N>,
    dx: &'a mut SVector<Lanes<V>, N>,
}

impl<Sys, V: Vector, const N: usize, const G: usize> NullaryFnOnce for Rate<'_, Sys, V, N, G>
where
    Sys: System<Lanes<V>, N, G>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { side, t, x, dx } = self;
        side.system.always_inlined_rate(t, x, side.negative, dx);
    }
}

impl<Sys, V: Vector, const G: usize> Side<'_, Sys, V, G> {
    /// The states of second order.
    pub fn second<const N: usize>(&self) -> Range<usize>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        self.system.second_order().map_or(0..0, |second| second.states())
    }
}

/// The method for runs side by side.
#[derive(Debug)]
pub(crate) struct NystromInLanes<V, const N: usize> {
    stages: Stages<Lanes<V>, N>,
    /// The directions of the fastest oscillations.
    direction: SVector<Lanes<V>, N>,
}

impl<V: Vector, const N: usize> NystromInLanes<V, N> {
    /// Its work space empty.
    pub fn new() -> Self {
        Self { stages: Stages::new(), direction: SVector::from([Lanes::from_f64(0.0); N]) }
    }

    /// What the methods know of the flow: the directions of the fastest oscillations.
    pub fn direction(&mut self) -> &mut SVector<Lanes<V>, N> {
        &mut self.direction
    }

    /// Gives back to `method` what is known of the flow at a place.
    pub fn store(&self, lane: usize, method: &mut Nystrom<N>) {
        method.ring.direction = SVector::from_fn(|i, _| self.direction[i].get(lane));
    }

    /// One iteration towards the fastest oscillation at the places of `due`, from states `x` with rates `rate` at time `t` (s): see
    /// [`Ring::follow`](super::ring::Ring::follow). Gives the stiffnesses.
    #[inline(always)]
    pub fn follow<Sys, const G: usize>(
        &mut self,
        side: &Side<'_, Sys, V, G>,
        due: V::Mask,
        t: Lanes<V>,
        x: &SVector<Lanes<V>, N>,
        rate: &SVector<Lanes<V>, N>,
    ) -> Lanes<V>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        let states = side.second();
        let zero = t.alike(0.0);
        let pull = Pull::along(&self.direction, &states, side, t, (x, rate));
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
        scale: &Scale<N>,
        end: &mut SVector<Lanes<V>, N>,
    ) -> Lanes<V>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        let errors = self.stages.step(side, &side.second(), begin, scale, end);
        let mut largest = begin.h.alike(0.0);
        for error in &errors {
            largest = error.larger(largest);
        }
        largest
    }
}

impl<const N: usize> Nystrom<N> {
    /// What the method knows of the flow: the direction of the fastest oscillation.
    pub(crate) fn direction(&self) -> &SVector<f64, N> {
        &self.ring.direction
    }

    /// Whether the fastest oscillation is to be looked at before the next step, whose flow has no states of second order unless
    /// `second`; nothing where that is to begin anew.
    pub(crate) fn is_due(&self, second: bool) -> Option<bool> {
        let due = second && self.ring.is_due();
        (!due || !self.ring.begins()).then_some(due)
    }

    /// Takes note of the stiffness of the fastest oscillation.
    pub(crate) fn stiffness(&mut self, stiffness: f64) {
        self.ring.found(stiffness);
    }

    /// The error norm that keeps a step of size `h` (s) where the fastest oscillation is stable.
    pub(crate) fn reach(&self, h: f64) -> f64 {
        self.ring.reach(h)
    }
}
