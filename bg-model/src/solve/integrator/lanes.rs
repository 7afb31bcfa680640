//! Methods for runs side by side, each run with its own start, size of the step and branches.
//!
//! In: a system that calculates with numbers side by side, where the runs stand, what each run's method knows. Out: the steps that each
//! run makes by itself, to the bit.

use std::ops::Range;

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use super::explicit::{CalvoFrancoMontijanoRandez, DormandPrince, ExplicitInLanes, Tableau};
use super::nystrom::NystromInLanes;
use super::steps::{Begin, Forces, Rates};
use super::{AnyMethod, Scale};
use crate::model::capability::SecondOrder;
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector, at};
use crate::model::system::System;

/// A system side by side, its switches frozen.
#[derive(Debug)]
pub(crate) struct Side<'a, Sys, V: Vector, const G: usize> {
    /// The system.
    pub system: &'a Sys,
    /// Where the guard of each switch is negative.
    pub negative: &'a [V::Mask; G],
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
        side.inlined_rate(t, x, dx);
    }
}

impl<Sys, V: Vector, const N: usize, const G: usize> Rates<Lanes<V>, N> for Side<'_, Sys, V, G>
where
    Sys: System<Lanes<V>, N, G>,
{
    #[inline(never)]
    fn rate(&self, t: Lanes<V>, x: &SVector<Lanes<V>, N>, dx: &mut SVector<Lanes<V>, N>) {
        V::vectorized(Rate { side: self, t, x, dx });
    }

    #[inline(always)]
    fn inlined_rate(&self, t: Lanes<V>, x: &SVector<Lanes<V>, N>, dx: &mut SVector<Lanes<V>, N>) {
        self.system.always_inlined_rate(t, x, self.negative, dx);
    }
}

impl<Sys, V: Vector, const N: usize, const G: usize> Forces<Lanes<V>, N> for Side<'_, Sys, V, G>
where
    Sys: System<Lanes<V>, N, G>,
{
    #[inline(always)]
    fn second(&self) -> Range<usize> {
        self.system.second_order().map_or(0..0, |second| second.states())
    }

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
            None => self.inlined_rate(t, x, dx),
        }
    }
}

/// What a run's own method tells where runs are side by side, and is told.
pub(crate) trait OfOne<const N: usize> {
    /// What it carries over from step to step, state by state.
    fn compensation(&mut self) -> &mut SVector<f64, N>;

    /// Takes over what it would keep of an attempt for its compensated sum, and the rates of the attempt's stages, of which `stage` gives each.
    fn keep(&mut self, compensation: SVector<f64, N>, stage: &dyn Fn(usize) -> SVector<f64, N>);

    /// The rates of an attempt, without that at its start.
    fn rates(&self) -> u64;

    /// Whether the fastest oscillation of the states of second order is to be looked at before the next step.
    fn is_due(&self) -> bool {
        false
    }

    /// Begins anew to look for it, where that is called for, in the norm of these weights; gives whether it is.
    fn begins(&mut self, _second: &Range<usize>, _weights: &SVector<f64, N>) -> bool {
        false
    }

    /// Takes note of the stiffness of the fastest oscillation.
    fn stiffness(&mut self, _stiffness: f64) {}

    /// The frequency of the fastest oscillation, rad/s.
    fn frequency(&self) -> f64 {
        0.0
    }

    /// A step was accepted.
    fn advanced(&mut self) {}

    /// The error norm that keeps a step of size `h` (s) where the fastest oscillation is stable.
    fn reach(&self, _h: f64) -> f64 {
        0.0
    }
}

/// One of the methods for runs side by side.
#[derive(Debug)]
pub(crate) enum AnyInLanes<V, const N: usize> {
    Cfmr7(Box<ExplicitInLanes<CalvoFrancoMontijanoRandez, V, N>>),
    Dop853(Box<ExplicitInLanes<DormandPrince, V, N>>),
    Nystrom(Box<NystromInLanes<V, N>>),
}

impl<V: Vector, const N: usize> AnyInLanes<V, N> {
    /// That of runs by `method`, its work space empty; none of a method whose runs cannot be side by side.
    pub fn of(method: &AnyMethod<N>) -> Option<Self> {
        match method {
            AnyMethod::Cfmr7(_) => Some(Self::Cfmr7(Box::new(ExplicitInLanes::new()))),
            AnyMethod::Dop853(_) => Some(Self::Dop853(Box::new(ExplicitInLanes::new()))),
            AnyMethod::Nystrom(_) => Some(Self::Nystrom(Box::new(NystromInLanes::new()))),
            _ => None,
        }
    }

    /// The power of the step with which the norm of the error estimate falls.
    pub fn order(&self) -> f64 {
        match self {
            Self::Cfmr7(_) => CalvoFrancoMontijanoRandez::ERROR_ORDER,
            Self::Dop853(_) => DormandPrince::ERROR_ORDER,
            Self::Nystrom(_) => NystromInLanes::<V, N>::ORDER,
        }
    }

    /// What each run's method carries over from step to step.
    pub fn compensation(&mut self) -> &mut SVector<Lanes<V>, N> {
        match self {
            Self::Cfmr7(method) => method.compensation(),
            Self::Dop853(method) => method.compensation(),
            Self::Nystrom(method) => method.compensation(),
        }
    }

    /// What each run's method would keep of its attempt for its compensated sum.
    fn to_be_carried(&self) -> &SVector<Lanes<V>, N> {
        match self {
            Self::Cfmr7(method) => method.to_be_carried(),
            Self::Dop853(method) => method.to_be_carried(),
            Self::Nystrom(method) => method.to_be_carried(),
        }
    }

    /// The rates of a stage of the last attempts.
    fn stage(&self, stage: usize) -> &SVector<Lanes<V>, N> {
        match self {
            Self::Cfmr7(method) => method.stage(stage),
            Self::Dop853(method) => method.stage(stage),
            Self::Nystrom(method) => method.stage(stage),
        }
    }

    /// Hands the attempt at a place over to its run's own `method`.
    pub fn hand_over(&self, lane: usize, method: &mut dyn OfOne<N>) {
        method.keep(at(lane, self.to_be_carried()), &|stage| at(lane, self.stage(stage)));
    }

    /// Iterates towards the fastest oscillations at the places of `due`, from states `x` with rates `rate` at time
    /// `t` (s), in the norm of the weights of `scale`; gives their stiffnesses. For Nystrom's method.
    #[inline(always)]
    pub fn follow<Sys, const G: usize>(
        &mut self,
        side: &Side<'_, Sys, V, G>,
        due: V::Mask,
        (t, x, rate): (Lanes<V>, &SVector<Lanes<V>, N>, &SVector<Lanes<V>, N>),
        scale: &Scale<N, Lanes<V>>,
    ) -> Lanes<V>
    where
        Sys: System<Lanes<V>, N, G>,
    {
        match self {
            Self::Cfmr7(_) | Self::Dop853(_) => t.alike(0.0),
            Self::Nystrom(method) => method.follow(side, due, (t, x, rate), &scale.weights),
        }
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
        match self {
            Self::Cfmr7(method) => method.attempt(side, begin, scale, end),
            Self::Dop853(method) => method.attempt(side, begin, scale, end),
            Self::Nystrom(method) => method.attempt(side, begin, scale, end),
        }
    }

    /// Whether the fastest oscillation holds steps to where it is stable.
    pub fn is_held(&self) -> bool {
        matches!(self, Self::Nystrom(_))
    }

    /// The frequency of the fastest oscillation at a place is this, rad/s.
    pub fn hold_to(&mut self, place: usize, frequency: f64) {
        if let Self::Nystrom(method) = self {
            method.hold_to(place, frequency);
        }
    }

    /// The error norms that keep steps of size `h` (s) where the fastest oscillations are stable.
    #[inline(always)]
    pub fn reach(&self, h: Lanes<V>) -> Lanes<V> {
        match self {
            Self::Cfmr7(_) | Self::Dop853(_) => h.alike(0.0),
            Self::Nystrom(method) => method.reach(h),
        }
    }

    /// The attempts at the places of `accepted` were.
    #[inline(always)]
    pub fn advance(&mut self, accepted: V::Mask) {
        match self {
            Self::Cfmr7(method) => method.advance(accepted),
            Self::Dop853(method) => method.advance(accepted),
            Self::Nystrom(_) => {}
        }
    }
}
