//! Joints that close loops, looked at after each step.
//!
//! In: the ends of accepted steps. Out: an end of the run in place of a wrong result, where a motion that was found to
//! follow from others follows no more, and where steps creep into a singular pose. Such a pose is passed in an instant:
//! a step that is made from rates alone goes over it. One whose equations need the rates' derivatives, which grow
//! without bound there, may come so near that the joints no longer say which way the mechanism goes on.

use alloc::vec;
use alloc::vec::Vec;

use super::factors::Factors;
use super::{Hold, dropped_of, slipping};
#[cfg(feature = "std")]
use crate::model::dynamics::Abreast;
use crate::model::dynamics::Dynamics;
use crate::model::holding::{HeldNow, Redundancy, Slipping};
use crate::model::scalar::Scalar;
#[cfg(feature = "std")]
use crate::model::scalar::lanes::{Lanes, Vector};

/// The fastest flow that follows from flows which are zero to rounding, as a part of the one that a row would have with
/// all the energy that there has been so far. That depends neither on units nor on the size of the machine.
const FOLLOWING: f64 = 1e-6;
/// How much faster than the fastest of the others it may be: Baumgarte's terms leave some flow.
const FASTER: f64 = 1e3;

/// How fast a row flows beside what it would with 1/2 J, in roots of twice the energy: its flow over the root of its
/// mobility, J M^-1 J^T. So flows in m/s and in rad/s are comparable. Of rows that nothing with a mass moves it is
/// infinite, or not a number.
#[inline(always)]
fn speed<S: Scalar>(flow: S, mobility: S) -> S {
    flow.abs() / mobility.abs().sqrt()
}

/// The fastest that may follow from others, of which this is the fastest, with this energy (J).
#[inline(always)]
fn followed<S: Scalar>(others: S, energy: S) -> S {
    others.times(FASTER) + energy.times(2.0).sqrt().times(FOLLOWING)
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

/// How much has moved so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved<'a> {
    /// The largest energy, J; none of a system that does not know what it stores.
    pub energy: Option<f64>,
    /// The largest magnitude of each state.
    pub states: &'a [f64],
}

/// What is looked at.
pub(crate) struct LoopMonitor {
    hold: Hold<f64>,
    /// Room for another state, for what is held there and for what its momenta store.
    other: Vec<f64>,
    held_there: Hold<f64>,
    curvatures: Vec<f64>,
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
        let room = || vec![0.0; system.states()];
        (!held.closing.is_empty()).then(|| Self {
            hold: Hold::new(held),
            other: room(),
            held_there: Hold::new(held),
            curvatures: room(),
            factors,
            dropped,
            was_near: false,
        })
    }

    /// Looks at time `t` (s) and state `x`. Allocates only where something is wrong.
    pub fn check(
        &mut self,
        system: &dyn Dynamics,
        at: (f64, &[f64]),
        negative: &[bool],
        moved: Moved<'_>,
    ) -> Option<Broken> {
        let (t, x) = at;
        system.hold(t, x, negative, &mut self.hold.entries);
        self.torn(system, at, negative, moved).map(Broken::Torn).or_else(|| self.singular().map(Broken::Singular))
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
    fn torn(
        &mut self,
        system: &dyn Dynamics,
        at: (f64, &[f64]),
        negative: &[bool],
        moved: Moved<'_>,
    ) -> Option<Slipping> {
        let Self { hold, dropped, .. } = self;
        let HeldNow { flows, mobilities, .. } = hold.held.read(&hold.entries);
        let of = |row: usize| speed(flows[row], mobilities[row]);
        let fastest = |is_dropped: bool| {
            // What nothing with a mass moves has no energy to be measured by.
            let rows = (0..dropped.len()).filter(|&row| dropped[row] == is_dropped && of(row).is_finite());
            rows.max_by(|&a, &b| of(a).total_cmp(&of(b)))
        };
        let others = fastest(false).map_or(0.0, of);
        let follows = |row: usize, energy: f64| of(row) <= followed(others, energy);
        let row = fastest(true).filter(|&row| !follows(row, moved.energy.unwrap_or(0.0)))?;
        let (flow, mobility) = (flows[row], mobilities[row].abs());
        // The energy so far may be that before something began to move.
        let energy = if moved.energy.is_some() {
            let (t, x) = at;
            system.energy(t, x, negative, &mut self.curvatures).abs()
        } else {
            let largest = self.flow_of_momenta(system, at, negative, moved.states, row);
            0.5 * largest * largest / mobility
        };
        let is_torn = speed(flow, mobility) > followed(others, energy);
        is_torn.then(|| slipping(&self.hold.held, row, flow))
    }

    /// The flow of a row by its largest momenta so far, each alone, and by sources: what it is measured by in a system
    /// that does not know what it stores.
    fn flow_of_momenta(
        &mut self,
        system: &dyn Dynamics,
        (t, x): (f64, &[f64]),
        negative: &[bool],
        largest: &[f64],
        row: usize,
    ) -> f64 {
        let Self { other, held_there, .. } = self;
        let momenta = held_there.held.moved;
        let mut flow = |other: &[f64]| {
            system.hold(t, other, negative, &mut held_there.entries);
            held_there.flows()[row]
        };
        other.copy_from_slice(x);
        momenta.iter().for_each(|&i| other[i] = 0.0);
        let rest = flow(other);
        let mut squares = 0.0;
        for &i in momenta {
            other[i] = largest[i].max(x[i].abs());
            let alone = flow(other) - rest;
            squares += alone * alone;
            other[i] = 0.0;
        }
        libm::sqrt(squares) + rest.abs()
    }

    /// The joint that holds almost what others hold, for the second time in a row.
    fn singular(&mut self) -> Option<Redundancy> {
        let Self { hold, factors, dropped, was_near, .. } = self;
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
    pub fn new(system: &dyn Abreast<V>) -> Option<Self> {
        let held = system.held()?;
        let dropped = dropped_of(held.rigid.len(), held.closing, system.kept());
        let (factors, pivots) = (Factors::new(dropped.len()), vec![[Lanes::from_f64(0.0); 2]; dropped.len()]);
        let is_fit = system.is_hold_inlined() && !held.closing.is_empty();
        is_fit.then(|| Self { hold: Hold::new(held), factors, pivots, dropped })
    }

    /// A bit for each run whose pose at time `t` (s) and state `x` is not in the neighbourhood of a singular one, and
    /// none of whose motions has come apart, with the largest `energy` (J) so far.
    #[inline(always)]
    pub fn whole(
        &mut self,
        system: &dyn Abreast<V>,
        (t, x): (Lanes<V>, &[Lanes<V>]),
        negative: &[V::Mask],
        energy: Lanes<V>,
    ) -> u8 {
        let Self { hold, factors, pivots, dropped } = self;
        system.hold(t, x, negative, &mut hold.entries);
        let (mut fastest, mut others) = (t.alike(0.0), t.alike(0.0));
        let HeldNow { flows, mobilities, .. } = hold.held.read(&hold.entries);
        for (row, is_dropped) in dropped.iter().enumerate() {
            let speed = speed(flows[row], mobilities[row]);
            if *is_dropped {
                fastest = speed.larger(fastest);
            } else {
                others = speed.larger(others);
            }
        }
        let (most, infinity) = (followed(others, energy), t.alike(f64::INFINITY));
        // What is infinite is looked at more closely, too.
        let follow = V::bits(V::below(fastest.0, most.0)) & V::bits(V::below(most.0, infinity.0));
        let mut whole = if dropped.contains(&true) { follow } else { u8::MAX };
        factors.factor_without(hold.matrix(), dropped, pivots);
        for (row, [pivot, mobility]) in pivots.iter().enumerate() {
            if !dropped[row] {
                whole &= V::bits(V::below(mobility.abs().times(AROUND).0, pivot.abs().0));
            }
        }
        whole
    }
}
