//! The start of a model: the pose that closes its joints, the velocities that fit them, what the pose decides for a
//! run.
//!
//! In: [`Starting`], the routines of parameters and unknowns from which a start is calculated, with their tables. Out:
//! the start state; on which sides roots are closed; which rows of joints that close loops take part. Whoever evaluates
//! the routines, the start has the same bits.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::assembly::{AssemblyError, Closed, Gap, close};
use crate::model::clock;
use crate::model::delayed;
use crate::model::dynamics::{Dynamics, branches};
use crate::model::holding::Redundancy;
use crate::model::nearest::lifted;
use crate::model::reactions::{self, fit};
use crate::model::requirement::{Requirement, require};
use crate::model::sampled;
use crate::model::scalar::{DoubleDouble, Gradient, Scalar, compiled_for};

/// A routine of parameters and unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartRoutine {
    /// The first guess of each unknown, of parameters alone.
    Guesses,
    /// The gaps of the joints, in the order of [`StartTable::gaps`].
    Gaps,
    /// For each gap how large the machine is, in the gap's unit.
    GapSizes,
    /// The start state.
    State,
    /// What the sides of roots have the signs of.
    Sides,
    /// The scalars of [`StartTable::required`].
    Required,
}

/// What a start is checked against, and what may move.
#[derive(Clone, Copy, Debug)]
pub struct StartTable {
    /// How many unknowns there are.
    pub unknowns: usize,
    /// The gaps to be closed.
    pub gaps: &'static [Gap],
    /// The unknowns that are velocities; the others are of the pose.
    pub speeds: &'static [usize],
    /// What is asked of the closed pose.
    pub required: &'static [Requirement],
    /// How many roots have a side.
    pub sides: usize,
    /// Whether impulses of the rigid joints make velocities fit.
    pub impulse: bool,
}

/// What a start is calculated from, over slices.
pub trait Starting<S: Scalar = f64> {
    /// The tables.
    fn table(&self) -> StartTable;

    /// Writes what a routine gives for these unknowns; the guesses take none.
    ///
    /// # Panics
    /// There is not one place for each number.
    fn in_numbers(&self, routine: StartRoutine, unknowns: &[f64], to: &mut [f64]);

    /// The same in the scalar.
    ///
    /// # Panics
    /// As [`Starting::in_numbers`].
    fn in_scalars(&self, routine: StartRoutine, unknowns: &[S], to: &mut [S]);
}

/// What is written into so many places.
fn listed<S: Scalar>(count: usize, write: impl FnOnce(&mut [S])) -> Vec<S> {
    let mut list = vec![S::from_f64(0.0); count];
    write(&mut list);
    list
}

/// The unknowns, as coordinates: the guesses, those of the pose moved until the joints are closed.
fn closed<S: Scalar>(of: &dyn Starting<S>) -> Result<Closed, AssemblyError> {
    let StartTable { unknowns, gaps, speeds, required, .. } = of.table();
    let guess = listed(unknowns, |to| of.in_numbers(StartRoutine::Guesses, &[], to));
    let places: Vec<usize> = (0..unknowns).filter(|place| !speeds.contains(place)).collect();
    let whole = |pose: &[f64]| {
        let mut unknowns = guess.clone();
        places.iter().zip(pose).for_each(|(&place, &value)| unknowns[place] = value);
        unknowns
    };
    let pose: Vec<f64> = places.iter().map(|&place| guess[place]).collect();
    let routine = |routine, pose: &[f64], to: &mut [f64]| of.in_numbers(routine, &whole(pose), to);
    let Closed { coordinates, is_exact } =
        close(&pose, gaps, &|pose, gaps| routine(StartRoutine::Gaps, pose, gaps), &|pose, sizes| {
            routine(StartRoutine::GapSizes, pose, sizes)
        })?;
    let unknowns = whole(&coordinates);
    if !required.is_empty() {
        require(required, &listed(required.len(), |to| of.in_numbers(StartRoutine::Required, &unknowns, to)))?;
    }
    Ok(Closed { coordinates: unknowns, is_exact })
}

/// The unknowns in the scalar, with what they are more than numbers, as derivatives; whether they close the joints to
/// rounding.
fn unknowns<S: Scalar>(of: &dyn Starting<S>) -> Result<(Vec<S>, bool), AssemblyError> {
    let Closed { coordinates: found, is_exact } = closed(of)?;
    let guess = listed(found.len(), |to| of.in_scalars(StartRoutine::Guesses, &[], to));
    let gaps = |unknowns: &[S]| listed(of.table().gaps.len(), |to| of.in_scalars(StartRoutine::Gaps, unknowns, to));
    Ok((lifted(&guess, &found, &gaps), is_exact))
}

/// The state at the closed start pose, guessed velocities as they are.
///
/// # Errors
/// The pose does not close.
fn pose<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>) -> Result<Vec<S>, AssemblyError> {
    let (unknowns, _) = unknowns(of)?;
    Ok(listed(system.states(), |to| of.in_scalars(StartRoutine::State, &unknowns, to)))
}

/// What is asked of a start in numbers `S`, compiled where a table of it stands.
struct Functions<S: Scalar> {
    start: Start<S>,
    redundant: fn(&dyn Starting<S>, &dyn Dynamics<S>) -> Vec<Redundancy>,
    share: Share<S, <S as Scalar>::Switch>,
}

type Start<S> = fn(&dyn Starting<S>, &dyn Dynamics<S>, &mut [S]) -> Result<S, AssemblyError>;
type Share<S, Switch> = fn(&dyn Dynamics<S>, S, &[S], &[Switch], &mut [S]);

impl<S: Scalar> Functions<S> {
    const ALL: Self = Self { start: started, redundant: held_twice, share: reactions::share };
}

static DOUBLES: Functions<f64> = Functions::ALL;
static DOUBLE_DOUBLES: Functions<DoubleDouble> = Functions::ALL;
static GRADIENTS: Functions<Gradient> = Functions::ALL;

fn functions<S: Scalar>() -> &'static Functions<S> {
    compiled_for!(S => Functions<S>, [&DOUBLES, &DOUBLE_DOUBLES, &GRADIENTS], const { &Functions::ALL })
}

/// Writes the start state of a model. The kinetic energy that impulses have taken to make it fit, J. What no unknown
/// closes of the gaps of rigid joints, which is little, a projection does: a run would take it for an error of its
/// steps. Samples whose first instant is 0 are computed there. Allocates where there are joints or clocks.
///
/// # Errors
/// The pose does not close, or the velocities do not fit.
pub fn start<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>, x: &mut [S]) -> Result<S, AssemblyError> {
    (functions().start)(of, system, x)
}

fn started<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>, x: &mut [S]) -> Result<S, AssemblyError> {
    let lost = assembled(of, system, x)?;
    let delays = system.delays();
    if !delays.is_empty() {
        delayed::begin(system, &delays, 0.0, &branches(system, 0.0, x), x);
    }
    let clocks = system.clocks();
    if clock::is_due(&clocks, 0.0) {
        sampled::compute_due(system, &clocks, 0.0, &branches(system, 0.0, x), x);
    }
    Ok(lost)
}

/// The same before samples are computed.
fn assembled<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>, x: &mut [S]) -> Result<S, AssemblyError> {
    let (unknowns, is_exact) = unknowns(of)?;
    if system.held().is_none() {
        of.in_scalars(StartRoutine::State, &unknowns, x);
        return Ok(S::from_f64(0.0));
    }
    let StartTable { speeds, impulse, .. } = of.table();
    let state = |unknowns: &[S]| listed(system.states(), |to| of.in_scalars(StartRoutine::State, unknowns, to));
    let started = fit(system, &unknowns, speeds, &state, impulse)?;
    x.copy_from_slice(&started.x);
    if !is_exact {
        let negative: Vec<S::Switch> = branches(system, 0.0, x).into_iter().map(S::Switch::from).collect();
        system.project(S::from_f64(0.0), &negative, x);
    }
    Ok(started.lost)
}

/// The signs of the roots in the closed start pose; 1 where there is none.
pub fn sides(of: &dyn Starting) -> Vec<f64> {
    let sign = |side: f64| if side < 0.0 { -1.0 } else { 1.0 };
    let mut sides = vec![1.0; of.table().sides];
    if let Ok(Closed { coordinates, .. }) = closed(of) {
        of.in_numbers(StartRoutine::Sides, &coordinates, &mut sides);
    }
    sides.into_iter().map(sign).collect()
}

/// Which rows of joints that close loops take part: 1 for each that does.
pub fn kept(of: &dyn Starting, system: &dyn Dynamics) -> Vec<f64> {
    reactions::kept(system, pose(of, system).ok())
}

/// What the start pose decides, in the array of a model that has so many.
///
/// # Panics
/// There are others.
pub fn decided<const K: usize>(of: Vec<f64>) -> [f64; K] {
    of.try_into().expect("a number for each that is decided")
}

/// Makes `reactions` those of least norm: joints that hold the same motion share what it takes. Allocates where rows
/// take no part.
pub fn share<S: Scalar>(joints: &dyn Dynamics<S>, t: S, x: &[S], negative: &[S::Switch], reactions: &mut [S]) {
    (functions().share)(joints, t, x, negative, reactions);
}

/// The joints that hold what others hold already, in all poses.
pub fn redundant<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>) -> Vec<Redundancy> {
    (functions().redundant)(of, system)
}

fn held_twice<S: Scalar>(of: &dyn Starting<S>, system: &dyn Dynamics<S>) -> Vec<Redundancy> {
    pose(of, system).map_or_else(|_| Vec::new(), |pose| reactions::redundant(system, &pose))
}
