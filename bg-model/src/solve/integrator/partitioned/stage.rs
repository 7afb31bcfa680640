//! The implicit part of a stage.
//!
//! In: the damped states as an explicit stage leaves them, the inverse for the step. Out: these states with their
//! implicit part. Nothing here depends on a system, so it is compiled once, for the vectors of every machine and for
//! those of this one.

use alloc::vec::Vec;

use pulp::NullaryFnOnce;

use super::inverse::{Inverse, in_blocks, product};
use super::places::{Group, Lanes};
use super::tableau::{KennedyCarpenter, STAGES};
use crate::solve::integrator::explicit::Tableau;

/// The damped states of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Stages {
    /// The size of the step, s, and the reciprocal of what its inverse has it times.
    h: f64,
    reciprocal: f64,
    groups: Vec<Damped>,
    /// How far the values at a stage are off the line; errors.
    off: Vec<Lanes>,
}

/// A group of them.
#[derive(Clone, Copy, Debug)]
struct Damped {
    states: Group,
    /// The values at the start of the step, and how much the line changes in it.
    from: Lanes,
    change: Lanes,
    /// Stage by stage the implicit part.
    parts: [Lanes; STAGES],
}

impl Stages {
    /// Makes room for these groups of states.
    pub fn resize(&mut self, groups: &[Group]) {
        let nothing = Lanes::default();
        let damped =
            |states: &Group| Damped { states: *states, from: nothing, change: nothing, parts: [nothing; STAGES] };
        self.groups.clear();
        self.groups.extend(groups.iter().map(damped));
        self.off.resize(groups.len(), nothing);
    }

    /// A step of size `h` (s) begins at `x`. `before`: its size in parts of the step before, with the start of that
    /// one.
    pub fn begin(&mut self, h: f64, x: &[f64], before: Option<(f64, &[f64])>) {
        (self.h, self.reciprocal) = (h, 1.0 / (h * KennedyCarpenter::GAMMA));
        for Damped { states, from, change, .. } in &mut self.groups {
            *from = states.read(x);
            *change = before.map_or(Lanes::default(), |(ratio, before)| {
                let before = states.read(before);
                core::array::from_fn(|lane| ratio * (from[lane] - before[lane]))
            });
        }
    }

    /// Adds their implicit part to the values at a stage.
    #[inline(always)]
    pub fn complete(&mut self, inverse: &Inverse, stage: usize, x: &mut [f64]) {
        inverse.arch.dispatch(Complete { stages: self, columns: &inverse.columns, stage, x });
    }

    /// Replaces errors by what the implicit part leaves of them.
    #[inline(always)]
    pub fn reduce(&mut self, inverse: &Inverse, errors: [&mut [f64]; 2]) {
        inverse.arch.dispatch(Reduce { stages: self, columns: &inverse.columns, errors });
    }
}

struct Complete<'a> {
    stages: &'a mut Stages,
    columns: &'a [Lanes],
    stage: usize,
    x: &'a mut [f64],
}

impl NullaryFnOnce for Complete<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        in_blocks!(self.stages.groups.len(), G, blocks => complete::<G>(blocks, self));
    }
}

#[inline(always)]
fn complete<const G: usize>(blocks: usize, Complete { stages, columns, stage, x }: Complete<'_>) {
    // Numbers handed over side by side would have to wait for their way through memory.
    let (h, reciprocal, c) = (stages.h, stages.reciprocal, KennedyCarpenter::C[stage]);
    let groups = &mut stages.groups.as_chunks_mut::<G>().0[..blocks];
    let off = &mut stages.off.as_chunks_mut::<G>().0[..blocks];
    let line = |group: &Damped| -> Lanes {
        let Damped { from, change, .. } = group;
        core::array::from_fn(|lane| from[lane] + c * change[lane])
    };
    for (groups, off) in groups.iter().zip(&mut *off) {
        let mut sums = [Lanes::default(); G];
        for &(earlier, weight) in KennedyCarpenter::MORE[stage] {
            for (sum, group) in sums.iter_mut().zip(groups) {
                *sum = core::array::from_fn(|lane| sum[lane] + weight * group.parts[earlier][lane]);
            }
        }
        for ((sum, group), off) in sums.into_iter().zip(groups).zip(off) {
            let (at, line) = (group.states.read(x), line(group));
            *off = core::array::from_fn(|lane| at[lane] + (h * sum[lane] - line[lane]));
        }
    }
    for (block, groups) in groups.iter_mut().enumerate() {
        let left = product::<G>(blocks, block, columns, off.as_flattened().as_flattened());
        for ((left, group), off) in left.into_iter().zip(groups).zip(&off[block]) {
            let line = line(group);
            group.parts[stage] = core::array::from_fn(|lane| (left[lane] - off[lane]) * reciprocal);
            group.states.write(&core::array::from_fn(|lane| line[lane] + left[lane]), x);
        }
    }
}

struct Reduce<'a> {
    stages: &'a mut Stages,
    columns: &'a [Lanes],
    errors: [&'a mut [f64]; 2],
}

impl NullaryFnOnce for Reduce<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        in_blocks!(self.stages.groups.len(), G, blocks => reduce::<G>(blocks, self));
    }
}

#[inline(always)]
fn reduce<const G: usize>(blocks: usize, Reduce { stages, columns, errors }: Reduce<'_>) {
    let groups = &stages.groups.as_chunks::<G>().0[..blocks];
    let off = &mut stages.off.as_chunks_mut::<G>().0[..blocks];
    for errors in errors {
        for (group, off) in groups.as_flattened().iter().zip(off.as_flattened_mut()) {
            *off = group.states.read(errors);
        }
        for (block, groups) in groups.iter().enumerate() {
            let left = product::<G>(blocks, block, columns, off.as_flattened().as_flattened());
            for (group, left) in groups.iter().zip(&left) {
                group.states.write(left, errors);
            }
        }
    }
}
