//! The implicit part of a stage.
//!
//! In: the damped states as an explicit stage leaves them, the inverse for the step. Out: these states with their implicit part.
//! Nothing here depends on a system, so it is compiled once, for the vectors of every machine and for those of this one.

use alloc::vec::Vec;

use pulp::NullaryFnOnce;

use super::inverse::{Inverse, Lanes, in_blocks, product};
use super::tableau::{KennedyCarpenter, STAGES};
use crate::solve::integrator::explicit::Tableau;

/// The damped states of a step, in groups; behind them are zeros up to whole groups.
#[derive(Clone, Debug, Default)]
pub(super) struct Stages {
    /// The values at the start of the step, and how much the line changes in it.
    pub from: Vec<Lanes>,
    pub change: Vec<Lanes>,
    /// The values at the present stage; an error, and what the implicit part leaves of it.
    pub at: Vec<Lanes>,
    /// How far they are off the line.
    off: Vec<Lanes>,
    /// Stage by stage the implicit part.
    parts: Vec<Lanes>,
}

impl Stages {
    /// Makes room for so many groups of states.
    pub fn resize(&mut self, groups: usize) {
        let Self { from, change, at, off, parts } = self;
        for (lanes, length) in [(from, groups), (change, groups), (at, groups), (off, groups), (parts, groups * STAGES)]
        {
            lanes.clear();
            lanes.resize(length, Lanes::default());
        }
    }

    /// Adds their implicit part to the values at a stage of a step of size `h` (s), at the part `c` of it.
    #[inline(always)]
    pub fn complete(&mut self, inverse: &Inverse, stage: usize, c: f64, h: f64) {
        inverse.arch.dispatch(Complete { stages: self, inverse, stage, c, h });
    }

    /// Replaces an error by what the implicit part leaves of it.
    pub fn reduce(&mut self, inverse: &Inverse) {
        core::mem::swap(&mut self.at, &mut self.off);
        inverse.times(&self.off, &mut self.at);
    }
}

struct Complete<'a> {
    stages: &'a mut Stages,
    inverse: &'a Inverse,
    stage: usize,
    c: f64,
    h: f64,
}

impl NullaryFnOnce for Complete<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        in_blocks!(self.stages.at.len(), G, blocks => complete::<G>(blocks, self));
    }
}

#[inline(always)]
fn complete<const G: usize>(blocks: usize, of: Complete<'_>) {
    let Complete { stages: Stages { from, change, at, off, parts }, inverse: Inverse { columns, .. }, stage, c, h } =
        of;
    let groups = blocks * G;
    let (before, behind) = parts.split_at_mut(stage * groups);
    let (from, change, more) = (&from[..groups], &change[..groups], KennedyCarpenter::MORE[stage]);
    let (at, off, part) = (&mut at[..groups], &mut off[..groups], &mut behind[..groups]);
    let line = |group: usize| -> Lanes { core::array::from_fn(|lane| from[group][lane] + c * change[group][lane]) };
    for block in 0..blocks {
        let mut sums = [Lanes::default(); G];
        for &(earlier, weight) in more {
            for (sum, part) in sums.iter_mut().zip(&before[earlier * groups + block * G..][..G]) {
                *sum = core::array::from_fn(|lane| sum[lane] + weight * part[lane]);
            }
        }
        for (sum, group) in sums.into_iter().zip(block * G..) {
            let line = line(group);
            off[group] = core::array::from_fn(|lane| at[group][lane] + (h * sum[lane] - line[lane]));
        }
    }
    product::<G>(blocks, columns, off, at);
    let reciprocal = 1.0 / (h * KennedyCarpenter::GAMMA);
    for group in 0..groups {
        let (solved, line) = (at[group], line(group));
        part[group] = core::array::from_fn(|lane| (solved[lane] - off[group][lane]) * reciprocal);
        at[group] = core::array::from_fn(|lane| line[lane] + solved[lane]);
    }
}
