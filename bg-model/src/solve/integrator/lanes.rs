//! Methods for runs side by side, each run with its own start, size of the step and branches.
//!
//! In: a system that calculates with numbers side by side, where the runs stand, what each run's method knows. Out: the
//! steps that each run makes by itself, to the bit.

use std::ops::Range;

use super::explicit::{CalvoFrancoMontijanoRandez, DormandPrince, ExplicitInLanes, Tableau};
use super::nystrom::NystromInLanes;
use super::steps::{Begin, Forces, Rates};
use super::{AnyMethod, Scale};
use crate::model::dynamics::Abreast;
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector, take};

/// A system side by side, its switches frozen.
#[derive(Clone, Copy)]
pub(crate) struct Side<'a, V: Vector> {
    /// The system.
    pub system: &'a dyn Abreast<V>,
    /// Where the guard of each switch is negative.
    pub negative: &'a [V::Mask],
}

impl<V: Vector> Rates<Lanes<V>> for Side<'_, V> {
    #[inline(always)]
    fn rate(&self, t: Lanes<V>, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        self.system.rate(t, x, self.negative, dx);
    }

    #[inline(always)]
    fn inlined_rate(&self, t: Lanes<V>, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        self.system.rate(t, x, self.negative, dx);
    }
}

impl<V: Vector> Forces<Lanes<V>> for Side<'_, V> {
    #[inline(always)]
    fn second(&self) -> Range<usize> {
        self.system.second()
    }

    #[inline(always)]
    fn at_start(&self, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        self.system.second_derivatives(x, dx);
    }

    #[inline(always)]
    fn at_stage(&self, t: Lanes<V>, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        self.system.forces(t, x, self.negative, dx);
    }
}

/// What a run's own method and the group exchange where runs are side by side.
pub(crate) trait OfOne {
    /// What it carries over from step to step, state by state.
    fn compensation(&mut self) -> &mut [f64];

    /// Takes over what it would keep of an attempt for its compensated sum, which `compensation` writes, and the rates
    /// of the attempt's stages, of which `stage` writes each.
    fn keep(&mut self, compensation: &dyn Fn(&mut [f64]), stage: &dyn Fn(usize, &mut [f64]));

    /// The rates of an attempt, without that at its start.
    fn rates(&self) -> u64;

    /// Whether the fastest oscillation of the states of second order is to be looked at before the next step.
    fn is_due(&self) -> bool {
        false
    }

    /// Begins anew to look for it, where that is called for, in the norm of these weights; gives whether it is.
    fn begins(&mut self, _second: &Range<usize>, _weights: &[f64]) -> bool {
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
pub(crate) enum AnyInLanes<V> {
    Cfmr7(Box<ExplicitInLanes<CalvoFrancoMontijanoRandez, V>>),
    Dop853(Box<ExplicitInLanes<DormandPrince, V>>),
    Nystrom(Box<NystromInLanes<V>>),
}

impl<V: Vector> AnyInLanes<V> {
    /// That of runs of so many states by `method`, its work space empty; none of a method whose runs cannot be side by
    /// side.
    pub fn of(method: &AnyMethod, states: usize) -> Option<Self> {
        match method {
            AnyMethod::Cfmr7(_) => Some(Self::Cfmr7(Box::new(ExplicitInLanes::new(states)))),
            AnyMethod::Dop853(_) => Some(Self::Dop853(Box::new(ExplicitInLanes::new(states)))),
            AnyMethod::Nystrom(_) => Some(Self::Nystrom(Box::new(NystromInLanes::new(states)))),
            _ => None,
        }
    }

    /// The power of the step with which the norm of the error estimate falls.
    pub fn order(&self) -> f64 {
        match self {
            Self::Cfmr7(_) => CalvoFrancoMontijanoRandez::ERROR_ORDER,
            Self::Dop853(_) => DormandPrince::ERROR_ORDER,
            Self::Nystrom(_) => NystromInLanes::<V>::ORDER,
        }
    }

    /// What each run's method carries over from step to step.
    pub fn compensation(&mut self) -> &mut [Lanes<V>] {
        match self {
            Self::Cfmr7(method) => method.compensation(),
            Self::Dop853(method) => method.compensation(),
            Self::Nystrom(method) => method.compensation(),
        }
    }

    /// What each run's method would keep of its attempt for its compensated sum.
    fn to_be_carried(&self) -> &[Lanes<V>] {
        match self {
            Self::Cfmr7(method) => method.to_be_carried(),
            Self::Dop853(method) => method.to_be_carried(),
            Self::Nystrom(method) => method.to_be_carried(),
        }
    }

    /// Writes the rates of a stage of the last attempt at a place.
    fn take_stage(&self, place: usize, stage: usize, to: &mut [f64]) {
        let mut write = |state: usize, rate: Lanes<V>| to[state] = *rate.0.at(place);
        match self {
            Self::Cfmr7(method) => method.stage(stage).for_each(|(state, rate)| write(state, rate)),
            Self::Dop853(method) => method.stage(stage).for_each(|(state, rate)| write(state, rate)),
            Self::Nystrom(method) => method.stage(stage).for_each(|(state, rate)| write(state, rate)),
        }
    }

    /// Hands the attempt at a place over to its run's own `method`.
    pub fn hand_over(&self, lane: usize, method: &mut dyn OfOne) {
        method.keep(&|to| take(lane, self.to_be_carried(), to), &|stage, to| self.take_stage(lane, stage, to));
    }

    /// Iterates towards the fastest oscillations at the places of `due`, from states `x` with rates `rate` at time
    /// `t` (s), in the norm of the weights of `scale`; gives their stiffnesses. For Nystrom's method.
    #[inline(always)]
    pub fn follow(
        &mut self,
        forces: &impl Forces<Lanes<V>>,
        due: V::Mask,
        at: (Lanes<V>, &[Lanes<V>], &[Lanes<V>]),
        scale: &Scale<Lanes<V>>,
    ) -> Lanes<V> {
        match self {
            Self::Cfmr7(_) | Self::Dop853(_) => at.0.alike(0.0),
            Self::Nystrom(method) => method.follow(forces, due, at, &scale.weights),
        }
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
        match self {
            Self::Cfmr7(method) => method.attempt(forces, begin, scale, end),
            Self::Dop853(method) => method.attempt(forces, begin, scale, end),
            Self::Nystrom(method) => method.attempt(forces, begin, scale, end),
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
