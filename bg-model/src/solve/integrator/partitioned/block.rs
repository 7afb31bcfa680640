//! The damped states of a step: which they are, their block of the Jacobian, and the implicit part of the stages.
//!
//! In: a flow and a step. Out: the states of the stages with their implicit part.

use alloc::vec::Vec;

use crate::model::capability::SecondOrder;
use crate::model::linear::Sparsity;
use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::inverse::{Inverse, LANES, Lanes, groups};
use super::pattern::Pattern;
use super::stage::Stages;
use super::tableau::KennedyCarpenter;
use crate::solve::integrator::explicit::{Complete, Tableau};
use crate::solve::integrator::linear::Jacobian;
use crate::solve::integrator::{Flow, Point, Scale};

/// The accepted steps after which the Jacobian is renewed, and the Jacobians after which the damped states are chosen anew.
const RENEWAL: u32 = 8;
const CHOICE: u32 = 4;
/// A step longer than this many times the one that the damped states were chosen for chooses them anew.
const GROWTH: f64 = 2.0;

/// A flow whose Jacobian has what is asked of it here: the entries among states that are not of second order.
struct Damping<'a, F>(&'a F);

impl<F: Flow<N>, const N: usize> Flow<N> for Damping<'_, F> {
    fn rate(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        self.0.rate(t, x, dx);
    }

    fn sparsity(&self) -> Sparsity {
        self.0.damping_sparsity()
    }

    fn jacobian(&self, t: f64, x: &SVector<f64, N>, entries: &mut [f64], slope: &mut SVector<f64, N>) {
        self.0.damping(t, x, entries);
        slope.fill(0.0);
    }

    fn second_order(&self) -> Option<impl SecondOrder<f64, N, 0>> {
        self.0.second_order()
    }
}

/// The damped states of a step, with the work space of their stages.
#[derive(Clone, Debug)]
pub(super) struct Block<const N: usize> {
    jacobian: Jacobian<N>,
    pattern: Pattern,
    /// The accepted steps since the Jacobian was made; none where there is none.
    age: Option<u32>,
    /// When it was made, s; how long after the one before, where that says how it changes.
    time: f64,
    interval: Option<f64>,
    /// Its entries, and those of the one before.
    entries: Vec<f64>,
    earlier: Vec<f64>,
    /// The step that the states were chosen for, s, and the Jacobians since then; none where they are to be chosen.
    chosen: Option<(f64, u32)>,
    states: Vec<usize>,
    /// The entries of the Jacobian that are in B, each with its place there.
    sources: Vec<(usize, usize)>,
    /// B, column by column; behind each column, as behind other numbers of the states, are zeros up to whole groups.
    matrix: Vec<Lanes>,
    /// How it changes, per s.
    slope: Vec<Lanes>,
    /// Of I - h gamma B.
    inverse: Inverse,
    /// The start of the step and of the one before; none where what was known no longer holds.
    start: (f64, SVector<f64, N>),
    before: Option<(f64, SVector<f64, N>)>,
    h: f64,
    stages: Stages,
}

impl<const N: usize> Block<N> {
    /// Nothing yet, calculated in these vectors; room is made at the first step.
    pub fn new(arch: Arch) -> Self {
        Self {
            jacobian: Jacobian::new(),
            pattern: Pattern::default(),
            age: None,
            time: 0.0,
            interval: None,
            entries: Vec::new(),
            earlier: Vec::new(),
            chosen: None,
            states: Vec::new(),
            sources: Vec::new(),
            matrix: Vec::new(),
            slope: Vec::new(),
            inverse: Inverse::new(arch),
            start: (0.0, SVector::zeros()),
            before: None,
            h: 0.0,
            stages: Stages::default(),
        }
    }

    /// The last attempt was accepted.
    pub fn advance(&mut self) {
        self.before = Some(self.start);
        self.age = self.age.map(|age| age + 1);
    }

    /// What was known of the flow no longer holds.
    pub fn restart(&mut self) {
        (self.before, self.age, self.chosen) = (None, None, None);
    }

    /// Makes ready for a step of size `h` (s) from `start`. Gives whether the Jacobian is one of numbers.
    pub fn prepare(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) -> bool {
        (self.start, self.h) = ((start.t, start.x), h);
        if self.age.is_none_or(|age| age >= RENEWAL) {
            self.jacobian.evaluate(&Damping(flow), start, h, scale);
            if !self.jacobian.is_finite() {
                return false;
            }
            core::mem::swap(&mut self.entries, &mut self.earlier);
            self.pattern.entries(&Damping(flow), &self.jacobian, &mut self.entries);
            self.interval = self.age.map(|_| start.t - self.time);
            (self.time, self.age) = (start.t, Some(0));
            self.chosen = self.chosen.map(|(step, age)| (step, age + 1)).filter(|(_, age)| *age < CHOICE);
            self.take();
        }
        if self.chosen.is_none_or(|(step, _)| h > GROWTH * step) {
            self.choose();
        }
        let Stages { from, change, .. } = &mut self.stages;
        gather(&self.states, &start.x, from);
        let before = self.before.as_ref().map(|(t, x)| (h / (start.t - t), x));
        for (change, &state) in change.as_flattened_mut().iter_mut().zip(&self.states) {
            *change = before.map_or(0.0, |(ratio, x)| ratio * (start.x[state] - x[state]));
        }
        true
    }

    /// Chooses the damped states.
    fn choose(&mut self) {
        self.chosen = Some((self.h, 0));
        let has_changed = self.pattern.choose(&self.entries, self.h, N, &mut self.states);
        if has_changed {
            let (n, groups) = (self.states.len(), groups(self.states.len()));
            self.pattern.sources(&self.states, LANES * groups, &mut self.sources);
            self.inverse.resize(n);
            self.stages.resize(groups);
            for matrix in [&mut self.matrix, &mut self.slope] {
                matrix.clear();
                matrix.resize(n * groups, Lanes::default());
            }
            self.take();
        }
    }

    /// Takes the block of the damped states out of the Jacobian.
    fn take(&mut self) {
        let Self { entries, earlier, sources, .. } = self;
        let (matrix, slope) = (self.matrix.as_flattened_mut(), self.slope.as_flattened_mut());
        for &(entry, place) in &*sources {
            matrix[place] = entries[entry];
            slope[place] = self.interval.map_or(0.0, |interval| (entries[entry] - earlier[entry]) / interval);
        }
    }

    /// Makes the inverse for the step. Gives whether there is one.
    pub fn invert(&mut self) -> bool {
        let Self { inverse, matrix, slope, h, .. } = self;
        // In the middle of the step, but no further from the last Jacobian than that is from the one before.
        let ahead = (self.start.0 + 0.5 * *h - self.time).min(self.interval.unwrap_or(0.0));
        inverse.invert(matrix, slope, ahead, *h * KennedyCarpenter::GAMMA)
    }
}

/// Writes these states of `x` side by side.
#[inline(always)]
fn gather<const N: usize>(states: &[usize], x: &SVector<f64, N>, to: &mut [Lanes]) {
    let x = &x.data.0[0];
    let (whole, rest) = states.as_chunks::<LANES>();
    to.iter_mut().zip(whole).for_each(|(to, group)| *to = group.map(|state| x[state]));
    let behind = to[whole.len()..].as_flattened_mut();
    behind.iter_mut().zip(rest).for_each(|(to, &state)| *to = x[state]);
}

/// Writes what stands side by side into these states of `x`.
#[inline(always)]
fn scatter<const N: usize>(states: &[usize], from: &[Lanes], x: &mut SVector<f64, N>) {
    let x = &mut x.data.0[0];
    let (whole, rest) = states.as_chunks::<LANES>();
    for (from, group) in from.iter().zip(whole) {
        (0..LANES).for_each(|lane| x[group[lane]] = from[lane]);
    }
    let behind = from[whole.len()..].as_flattened();
    behind.iter().zip(rest).for_each(|(from, &state)| x[state] = *from);
}

/// Solves for the implicit part of a stage.
impl<const N: usize> Complete<f64, N> for Block<N> {
    #[inline(always)]
    fn complete(&mut self, stage: usize, c: f64, x: &mut SVector<f64, N>) {
        let Self { states, stages, inverse, h, .. } = self;
        gather(states, x, &mut stages.at);
        stages.complete(inverse, stage, c, *h);
        scatter(states, &stages.at, x);
    }

    /// What an error of a damped state leaves of itself: its implicit part takes away most of it.
    #[inline(always)]
    fn correct(&mut self, errors: &mut [f64; N], differences: &SVector<f64, N>, allowed: &[f64; N]) {
        let Self { states, stages, inverse, .. } = self;
        gather(states, differences, &mut stages.at);
        stages.reduce(inverse);
        let left = states.iter().zip(stages.at.as_flattened());
        left.for_each(|(&state, left)| errors[state] = (left / allowed[state]).abs());
    }
}
