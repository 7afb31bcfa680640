//! The reactions of joints: whether start velocities fit, what impulses change, whether the reactions of rigid joints
//! have unique values.
//!
//! In: a system that says what its joints hold ([`Joints::held`], [`Joints::hold`]). Out: a start state that fits, or
//! the joint that is torn apart; the joints that hold the same motion, and reactions that they share.
//!
//! The reactions l of rigid joints are solved from A l + b = 0, where A_ij is how much reaction j changes the rate of
//! the flow that joint i keeps at zero: J M^-1 J^T up to the sign. An impulse obeys the same equations, with the flow
//! in place of b: it changes the flows by A l and the momenta by what the reactions move.

mod ends;
mod factors;
mod immobile;
mod impact;
mod monitor;
mod shared;

use alloc::vec;
use alloc::vec::Vec;

use crate::model::assembly::AssemblyError;
use crate::model::description::StateKind;
use crate::model::dynamics::{Dynamics, branches};
use crate::model::holding::{FITTING, Held, HeldNow, Redundancy, Slip, Slipping};
use crate::model::nearest::{lifted, nearest};
use crate::model::scalar::Scalar;
pub(crate) use ends::EndMonitor;
use factors::{Factors, Matrix};
pub(crate) use impact::{After, Collision, impacts_of};
#[cfg(feature = "std")]
pub(crate) use monitor::LoopsInLanes;
pub(crate) use monitor::{Broken, LoopMonitor, Moved};
pub(crate) use shared::{kept, redundant, share};

/// A start state whose joints fit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Started<S> {
    /// The state.
    pub x: Vec<S>,
    /// The kinetic energy that impulses have taken, J.
    pub lost: S,
}

/// The numbers of [`Joints::hold`].
#[derive(Debug)]
pub(crate) struct Hold<S> {
    held: Held,
    entries: Vec<S>,
}

impl<S: Scalar> Hold<S> {
    pub fn new(held: Held) -> Self {
        Self { held, entries: vec![S::from_f64(0.0); held.entries()] }
    }

    pub fn read(&mut self, joints: &dyn Dynamics<S>, t: S, x: &[S], negative: &[S::Switch]) {
        joints.hold(t, x, negative, &mut self.entries);
    }

    /// The flows of rigid motions, then of compliant ones.
    fn flows(&self) -> &[S] {
        self.held.read(&self.entries).flows
    }

    /// A.
    fn matrix(&self) -> Matrix<'_, S> {
        let HeldNow { lower, mobilities, .. } = self.held.read(&self.entries);
        Matrix { lower, mobilities }
    }

    /// What one unit of a reaction changes, state by state of [`Held::moved`].
    fn moves(&self, reaction: usize) -> &[S] {
        let width = self.held.moved.len();
        &self.held.read(&self.entries).moves[reaction * width..][..width]
    }

    /// The state that `impulses` of the reactions leave of `x`.
    fn struck(&self, mut x: Vec<S>, impulses: &[S]) -> Vec<S> {
        for (reaction, &impulse) in impulses.iter().enumerate() {
            for (&state, &by) in self.held.moved.iter().zip(self.moves(reaction)) {
                x[state] = x[state] - by * impulse;
            }
        }
        x
    }
}

/// The start state of a system with joints: guessed velocities such that the joints fit, then, with `impulse`, the
/// impulses of the rigid joints. `start` gives the state for unknowns, of which those at `speeds` are velocities.
/// Derivatives that the unknowns have go into the state: those of the velocities are such that the joints fit.
/// Allocates.
///
/// # Errors
/// [`AssemblyError::Torn`] where velocities do not fit, [`AssemblyError::Redundant`] where reactions are not unique,
/// [`AssemblyError::Immobile`] where nothing can move.
pub(crate) fn fit<S: Scalar>(
    system: &dyn Dynamics<S>,
    unknowns: &[S],
    speeds: &[usize],
    start: &dyn Fn(&[S]) -> Vec<S>,
    impulse: bool,
) -> Result<Started<S>, AssemblyError> {
    let held = system.held().unwrap_or(Held::NOTHING);
    let state = |values: &[S]| {
        let mut all = unknowns.to_vec();
        speeds.iter().zip(values).for_each(|(&place, &value)| all[place] = value);
        start(&all)
    };
    let read = |x: &[S]| {
        let mut hold = Hold::new(held);
        hold.read(system, S::from_f64(0.0), x, &at_start(system, x));
        hold
    };
    let mut values: Vec<S> = speeds.iter().map(|&place| unknowns[place]).collect();
    if !values.is_empty() {
        let residual = |values: &[f64], flows: &mut [f64]| {
            let values: Vec<S> = values.iter().copied().map(S::from_f64).collect();
            let hold = read(&state(&values));
            flows.iter_mut().zip(hold.flows()).for_each(|(to, flow)| *to = flow.to_f64());
        };
        let rows = held.rigid.len() + held.compliant.len();
        let torn = |(row, flow): (usize, f64)| AssemblyError::Torn {
            largest: slipping(&held, row, flow),
            allowed: 0.0,
            others: Vec::new(),
        };
        // The flows are linear in the velocities, so the first step is the last but for rounding.
        let guess: Vec<f64> = values.iter().copied().map(S::to_f64).collect();
        let found = nearest(&guess, rows, &|_| f64::INFINITY, &residual).map_err(torn)?.0;
        values = lifted(&values, &found, &|values| read(&state(values)).flows().to_vec());
    }
    let x = state(&values);
    let hold = read(&x);
    let factors = Factors::of(hold.matrix());
    if let Some(joints) = immobile::immobile(&hold, &factors) {
        return Err(AssemblyError::Immobile { joints });
    }
    if let Some(redundancy) = factors.redundancy(held.rigid, &dropped(system)) {
        return Err(AssemblyError::Redundant(redundancy));
    }
    // Guesses count as well: what is left of them where nothing moves is rounding.
    let allowed = fitting(&x, &momenta(system, [&x, &start(unknowns)]), &read);
    check_fit(&hold, &allowed, |slipping| impulse && slipping.is_rigid)?;
    let started = if impulse { strike(x, &read) } else { Started { x, lost: S::from_f64(0.0) } };
    check_fit(&read(&started.x), &allowed, |slipping| !slipping.is_rigid)?;
    Ok(started)
}

/// For each flow at state `x` the largest that fits, in its unit: the part [`FITTING`] of what sources move there and
/// of what these momenta do, each alone.
fn fitting<S: Scalar>(x: &[S], momenta: &[f64], read: &dyn Fn(&[S]) -> Hold<S>) -> Vec<f64> {
    let mut still = x.to_vec();
    let moving: Vec<usize> = (0..x.len()).filter(|&i| momenta[i] > 0.0).collect();
    moving.iter().for_each(|&i| still[i] = S::from_f64(0.0));
    let rest = read(&still);
    let mut squares = vec![0.0; rest.flows().len()];
    for &i in &moving {
        let mut alone = still.clone();
        alone[i] = S::from_f64(momenta[i]);
        for ((square, flow), rest) in squares.iter_mut().zip(read(&alone).flows()).zip(rest.flows()) {
            let by = (*flow - *rest).to_f64();
            *square += by * by;
        }
    }
    let both = squares.into_iter().zip(rest.flows());
    both.map(|(square, rest)| FITTING * (libm::sqrt(square) + rest.to_f64().abs())).collect()
}

/// How large each momentum would be if it stored alone what all of them store at one of these states; of a system
/// that does not know what it stores, how large it is there. Zero for other states.
fn momenta<S: Scalar>(system: &dyn Dynamics<S>, states: [&[S]; 2]) -> Vec<f64> {
    let count = states[0].len();
    let largest = |i: usize| states.iter().fold(0.0_f64, |largest, x| largest.max(x[i].to_f64().abs()));
    let Some(stored) = system.stored() else {
        let moved = system.held().unwrap_or(Held::NOTHING).moved;
        return (0..count).map(|i| if moved.contains(&i) { largest(i) } else { 0.0 }).collect();
    };
    let is_momentum = |i: usize| matches!(stored[i].kind, StateKind::Momentum(_));
    let mut curvatures = vec![S::from_f64(0.0); count];
    system.energy(S::from_f64(0.0), states[0], &at_start(system, states[0]), &mut curvatures);
    let curvature = |i: usize| if is_momentum(i) { curvatures[i].to_f64() } else { 0.0 };
    let doubled = |x: &[S]| (0..count).map(|i| curvature(i) * x[i].to_f64() * x[i].to_f64()).sum::<f64>();
    let most = states.into_iter().map(doubled).fold(0.0, f64::max);
    let alone = |i| if curvature(i) > 0.0 { libm::sqrt(most / curvature(i)) } else { 0.0 };
    (0..count).map(alone).collect()
}

/// For each rigid motion whether it follows from others and takes no part.
fn dropped<S: Scalar>(system: &dyn Dynamics<S>) -> Vec<bool> {
    let held = system.held().unwrap_or(Held::NOTHING);
    dropped_of(held.rigid.len(), held.closing, system.kept())
}

/// The same of so many rigid motions, of which some are `closing`, and of what is kept of these.
fn dropped_of(rigid: usize, closing: &[(usize, usize)], kept: &[f64]) -> Vec<bool> {
    let mut dropped = vec![false; rigid];
    for &(row, number) in closing {
        dropped[row] = kept[number] == 0.0;
    }
    dropped
}

/// The branches of the switches at t = 0 and this state.
fn at_start<S: Scalar>(system: &dyn Dynamics<S>, x: &[S]) -> Vec<S::Switch> {
    branches(system, 0.0, x).into_iter().map(S::Switch::from).collect()
}

/// The state after the impulses that bring the flows of rigid joints to zero, with the energy that they take: half of
/// impulse times flow before, as in a perfectly plastic impact. One solution is exact where momenta are linear in
/// flows; elsewhere it is repeated while it helps.
fn strike<S: Scalar>(mut x: Vec<S>, read: &dyn Fn(&[S]) -> Hold<S>) -> Started<S> {
    let (zero, half) = (S::from_f64(0.0), S::from_f64(0.5));
    let mut lost = zero;
    let mut before = read(&x);
    for _ in 0..20 {
        let rigid = before.held.rigid.len();
        let impulses = Factors::of(before.matrix()).solved(&before.flows()[..rigid]);
        let moved = before.struck(x.clone(), &impulses);
        let after = read(&moved);
        if fastest(&after, rigid) >= fastest(&before, rigid) {
            break;
        }
        for ((&impulse, &from), &to) in impulses.iter().zip(before.flows()).zip(after.flows()) {
            lost = lost - half * impulse * (from + to);
        }
        (x, before) = (moved, after);
    }
    Started { x, lost }
}

/// The largest of the first `rigid` flows.
fn fastest<S: Scalar>(hold: &Hold<S>, rigid: usize) -> f64 {
    hold.flows()[..rigid].iter().fold(0.0, |fastest, flow| fastest.max(flow.to_f64().abs()))
}

fn slipping(held: &Held, k: usize, speed: f64) -> Slipping {
    let is_rigid = k < held.rigid.len();
    let slip = if is_rigid { held.rigid[k] } else { held.compliant[k - held.rigid.len()] };
    Slipping { slip, speed, is_rigid }
}

/// Finds the joints whose flows are above what is `allowed`, those apart that are `excused`.
fn check_fit<S: Scalar>(
    hold: &Hold<S>,
    allowed: &[f64],
    excused: impl Fn(&Slipping) -> bool,
) -> Result<(), AssemblyError> {
    let mut joints: Vec<(Slipping, f64)> = Vec::new();
    for (k, (flow, &allowed)) in hold.flows().iter().zip(allowed).enumerate() {
        let found = slipping(&hold.held, k, flow.to_f64());
        if found.speed.abs() <= allowed || excused(&found) {
            continue;
        }
        match joints.iter_mut().find(|(known, _)| known.slip.joint == found.slip.joint) {
            Some((known, _)) if known.speed.abs() >= found.speed.abs() => {}
            Some(known) => *known = (found, allowed),
            None => joints.push((found, allowed)),
        }
    }
    joints.sort_by(|(a, _), (b, _)| b.speed.abs().total_cmp(&a.speed.abs()));
    if joints.is_empty() {
        return Ok(());
    }
    let (largest, allowed) = joints.remove(0);
    Err(AssemblyError::Torn { largest, allowed, others: joints.into_iter().map(|(other, _)| other).collect() })
}
