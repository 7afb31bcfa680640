//! Joints that close loops, looked at after each step.
//!
//! In: the ends of accepted steps. Out: an end of the run in place of a wrong result, where a motion that was found to
//! follow from others follows no more, and where steps creep into a singular pose. Such a pose is passed in an instant:
//! a step that is made from rates alone goes over it. One whose equations need the rates' derivatives, which grow
//! without bound there, may come so near that the joints no longer say which way the mechanism goes on.

#[cfg(feature = "std")]
use alloc::vec;
use alloc::vec::Vec;

#[cfg(feature = "std")]
use nalgebra::SVector;

use super::factors::Factors;
use super::{Hold, dropped_of, slipping};
#[cfg(feature = "std")]
use crate::model::capability::Joints;
use crate::model::dynamics::Dynamics;
use crate::model::holding::{Redundancy, Slipping};
use crate::model::scalar::Scalar;
#[cfg(feature = "std")]
use crate::model::scalar::lanes::{Lanes, Vector};

/// The fastest flow that follows from flows which are zero to rounding, in its unit.
const FOLLOWING: f64 = 1e-6;
/// How much faster than the fastest of the others it may be: Baumgarte's terms leave some flow.
const FASTER: f64 = 1e3;
/// The fastest flow that may follow from others, of which this is the fastest.
#[inline(always)]
fn followed<S: Scalar>(others: S) -> S {
    others.times(FASTER) + others.alike(FOLLOWING)
}

/// A pivot below this part of its row's mobility is of a pose 1e-4 rad from a singular one. Two steps in a row that end
/// there creep.
const NEAR: f64 = 1e-8;

/// A pivot below this part of its row's mobility is of a pose in whose neighbourhood steps err much in what joints
/// hold, some 6 degrees from a singular one.
const AROUND: f64 = 1e-2;

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Broken {
    /// A motion that follows from others no more.
    Torn(Slipping),
    /// Joints that hold the same motion in a singular pose.
    Singular(Redundancy),
}

/// What is looked at.
pub(crate) struct LoopMonitor {
    hold: Hold<f64>,
    factors: Factors<f64>,
    dropped: Vec<bool>,
    was_near: bool,
}

impl LoopMonitor {
    /// Room for what is held; none where no joint closes a loop.
    pub fn new(system: &dyn Dynamics) -> Option<Self> {
        let held = system.held()?;
        let dropped = dropped_of(held.rigid.len(), held.closing, system.kept());
        let factors = Factors::new(dropped.len());
        (!held.closing.is_empty()).then(|| Self { hold: Hold::new(held), factors, dropped, was_near: false })
    }

    /// Looks at time `t` (s) and state `x`. Allocates only where something is wrong.
    pub fn check(&mut self, system: &dyn Dynamics, (t, x): (f64, &[f64]), negative: &[bool]) -> Option<Broken> {
        system.hold(t, x, negative, &mut self.hold.entries);
        self.torn().map(Broken::Torn).or_else(|| self.singular().map(Broken::Singular))
    }

    /// Whether `other` leaves the same motions out, and the last pose that was looked at was not near a singular one.
    #[cfg(feature = "std")]
    pub fn is_that_of<V: Vector>(&self, other: &LoopsInLanes<V>) -> bool {
        !self.was_near && self.dropped == other.dropped
    }

    /// Whether the pose at time `t` (s) and state `x` is in the neighbourhood of a singular one.
    pub fn is_around(&mut self, system: &dyn Dynamics, (t, x): (f64, &[f64]), negative: &[bool]) -> bool {
        let Self { hold, factors, dropped, .. } = self;
        system.hold(t, x, negative, &mut hold.entries);
        factors.factor_where(hold.matrix(), |row, pivot, mobility| dropped[row] || pivot <= AROUND * mobility);
        (0..dropped.len()).any(|row| factors.follows(row) && !dropped[row])
    }

    /// The motion that has come apart most.
    fn torn(&self) -> Option<Slipping> {
        let Self { hold, dropped, .. } = self;
        let flows = &hold.flows()[..dropped.len()];
        let fastest = |is_dropped: bool| {
            let rows = (0..flows.len()).filter(|&row| dropped[row] == is_dropped);
            rows.max_by(|&a, &b| flows[a].abs().total_cmp(&flows[b].abs()))
        };
        let others = fastest(false).map_or(0.0, |row| flows[row].abs());
        let row = fastest(true).filter(|&row| flows[row].abs() > followed(others))?;
        Some(slipping(&hold.held, row, flows[row]))
    }

    /// The joint that holds almost what others hold, for the second time in a row.
    fn singular(&mut self) -> Option<Redundancy> {
        let Self { hold, factors, dropped, was_near } = self;
        factors.factor_where(hold.matrix(), |row, pivot, mobility| dropped[row] || pivot <= NEAR * mobility);
        let found = (0..dropped.len()).find(|&row| factors.follows(row) && !dropped[row]);
        let is_creeping = core::mem::replace(was_near, found.is_some());
        found.filter(|_| is_creeping).map(|row| factors.shared(hold.held.rigid, &[row]))
    }
}

/// Joints that close loops, of runs side by side: where nothing is wrong with them, beyond doubt.
#[cfg(feature = "std")]
#[derive(Debug)]
pub(crate) struct LoopsInLanes<V> {
    hold: Hold<Lanes<V>>,
    factors: Factors<Lanes<V>>,
    pivots: Vec<[Lanes<V>; 2]>,
    dropped: Vec<bool>,
}

#[cfg(feature = "std")]
impl<V: Vector> LoopsInLanes<V> {
    /// Room for what is held; none where no joint closes a loop, or what they hold is not inlined.
    pub fn new<J, const N: usize, const G: usize>(joints: &J) -> Option<Self>
    where
        J: Joints<Lanes<V>, N, G>,
    {
        let held = joints.held();
        let dropped = dropped_of(held.rigid.len(), held.closing, joints.kept());
        let (factors, pivots) = (Factors::new(dropped.len()), vec![[Lanes::from_f64(0.0); 2]; dropped.len()]);
        let is_fit = joints.is_hold_inlined() && !held.closing.is_empty();
        is_fit.then(|| Self { hold: Hold::new(held), factors, pivots, dropped })
    }

    /// A bit for each run whose pose at time `t` (s) and state `x` is not in the neighbourhood of a singular one, and
    /// none of whose motions has come apart.
    #[inline(always)]
    pub fn whole<J, const N: usize, const G: usize>(
        &mut self,
        joints: &J,
        (t, x): (Lanes<V>, &SVector<Lanes<V>, N>),
        negative: &[V::Mask; G],
    ) -> u8
    where
        J: Joints<Lanes<V>, N, G>,
    {
        let Self { hold, factors, pivots, dropped } = self;
        joints.inlined_hold(t, x, negative, &mut hold.entries);
        let (mut fastest, mut others) = (t.alike(0.0), t.alike(0.0));
        for (row, is_dropped) in dropped.iter().enumerate() {
            let flow = hold.flows()[row].abs();
            if *is_dropped {
                fastest = flow.larger(fastest);
            } else {
                others = flow.larger(others);
            }
        }
        let mut whole = !V::bits(V::below(followed(others).0, fastest.0));
        factors.factor_without(hold.matrix(), dropped, pivots);
        for (row, [pivot, mobility]) in pivots.iter().enumerate() {
            if !dropped[row] {
                whole &= V::bits(V::below(mobility.abs().times(AROUND).0, pivot.abs().0));
            }
        }
        whole
    }
}
