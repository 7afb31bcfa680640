//! The damped states of a step: which they are, their block of the Jacobian, and the implicit part of the stages.
//!
//! In: a flow and a step. Out: the states of the stages with their implicit part.

use alloc::vec::Vec;
use core::ops::Range;

use crate::model::dynamics::Dynamics;
use crate::model::linear::Sparsity;
use crate::model::scalar::Scalar;

use super::inverse::Inverse;
use super::pattern::Pattern;
use super::places::{Lanes, Places};
use super::stage::Stages;
use super::tableau::KennedyCarpenter;
use crate::solve::integrator::explicit::{Complete, Tableau};
use crate::solve::integrator::linear::Jacobian;
use crate::solve::integrator::{Arch, Flow, PointRef, Scale};
use crate::solve::statistics::Statistics;

/// The accepted steps after which the Jacobian is renewed, and the Jacobians after which the damped states are chosen
/// anew.
const RENEWAL: u32 = 8;
const CHOICE: u32 = 4;
/// A step longer than this many times the one that the damped states were chosen for chooses them anew.
const GROWTH: f64 = 2.0;

/// A flow whose Jacobian has what is asked of it here: the entries among states that are not of second order.
struct Damping<'a>(&'a Flow<'a>);

impl Dynamics for Damping<'_> {
    fn states(&self) -> usize {
        self.0.states()
    }

    fn rate(&self, t: f64, x: &[f64], _negative: &[bool], dx: &mut [f64]) {
        self.0.rate(t, x, dx);
    }

    fn sparsity(&self) -> Sparsity {
        self.0.damping_sparsity()
    }

    fn jacobian(&self, t: f64, x: &[f64], _negative: &[bool], entries: &mut [f64], slope: &mut [f64]) {
        self.0.damping(t, x, entries);
        slope.fill(0.0);
    }

    fn second(&self) -> Range<usize> {
        self.0.second()
    }
}

/// The damped states of a step, with the work space of their stages.
#[derive(Clone, Debug)]
pub(super) struct Block {
    jacobian: Jacobian,
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
    places: Places,
    /// The entries of the Jacobian that are in B, each with its place there.
    sources: Vec<(usize, usize)>,
    /// B, column by column; after each column are zeros up to whole groups.
    matrix: Vec<Lanes>,
    /// How it changes, per s.
    slope: Vec<Lanes>,
    /// The largest magnitude in B, 1/s.
    largest: f64,
    /// Of I - h gamma B.
    inverse: Inverse,
    /// The start of the step and of the one before, in turn, and which of them is that of the step.
    starts: [(f64, Vec<f64>); 2],
    present: usize,
    /// Whether what is known of the step before still holds.
    has_before: bool,
    h: f64,
    stages: Stages,
}

impl Block {
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
            places: Places::default(),
            sources: Vec::new(),
            matrix: Vec::new(),
            slope: Vec::new(),
            largest: 0.0,
            inverse: Inverse::new(arch),
            starts: [const { (0.0, Vec::new()) }; 2],
            present: 0,
            has_before: false,
            h: 0.0,
            stages: Stages::default(),
        }
    }

    /// Makes room for so many states. Nothing is left of what was known of another number of them.
    pub fn fit(&mut self, states: usize) {
        if self.starts[0].1.len() == states {
            return;
        }
        *self = Self::new(self.inverse.arch);
        self.starts.iter_mut().for_each(|(_, start)| start.resize(states, 0.0));
    }

    /// The last attempt was accepted.
    pub fn advance(&mut self) {
        (self.present, self.has_before) = (1 - self.present, true);
        self.age = self.age.map(|age| age + 1);
    }

    /// What was known of the flow no longer holds.
    pub fn restart(&mut self) {
        (self.has_before, self.age, self.chosen) = (false, None, None);
    }

    /// Makes ready for a step of size `h` (s) from `start`. Gives whether the Jacobian is one of numbers.
    pub fn prepare(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        let (t, x) = &mut self.starts[self.present];
        *t = start.t;
        x.copy_from_slice(start.x);
        self.h = h;
        if self.age.is_none_or(|age| age >= RENEWAL) {
            // The flow itself counts.
            let (damping, mut uncounted) = (Damping(flow), Statistics::default());
            let damping = Flow::new(&damping, &[], &mut uncounted);
            if !self.jacobian.evaluate(&damping, start, h, scale) {
                return false;
            }
            core::mem::swap(&mut self.entries, &mut self.earlier);
            self.pattern.entries(&damping, &self.jacobian, &mut self.entries);
            self.interval = self.age.map(|_| start.t - self.time);
            (self.time, self.age) = (start.t, Some(0));
            self.chosen = self.chosen.map(|(step, age)| (step, age + 1)).filter(|(_, age)| *age < CHOICE);
            self.take();
        }
        if self.chosen.is_none_or(|(step, _)| h > GROWTH * step) {
            self.choose();
        }
        let (t, before) = &self.starts[1 - self.present];
        let ratio = self.has_before.then(|| h / (start.t - t));
        let before = ratio.map(|ratio| (ratio, &before[..]));
        self.stages.begin(h, start.x, before);
        true
    }

    /// Chooses the damped states.
    fn choose(&mut self) {
        self.chosen = Some((self.h, 0));
        let has_changed = self.pattern.choose(&self.entries, self.h, self.starts[0].1.len(), &mut self.states);
        if has_changed {
            self.places.take(&self.states);
            self.pattern.sources(&self.places, &mut self.sources);
            self.inverse.resize(&self.places);
            self.stages.resize(&self.places.groups);
            for matrix in [&mut self.matrix, &mut self.slope] {
                matrix.clear();
                matrix.resize(self.places.entries(), Lanes::default());
            }
            self.take();
        }
    }

    /// Takes the block of the damped states out of the Jacobian.
    fn take(&mut self) {
        let Self { entries, earlier, sources, .. } = self;
        let (matrix, slope) = (self.matrix.as_flattened_mut(), self.slope.as_flattened_mut());
        self.largest = 0.0;
        for &(entry, place) in &*sources {
            matrix[place] = entries[entry];
            self.largest = self.largest.larger(entries[entry].abs());
            slope[place] = self.interval.map_or(0.0, |interval| (entries[entry] - earlier[entry]) / interval);
        }
    }

    /// What a step of size `h` (s) makes of the rounding of the damped states, in parts of them: its rates are not
    /// those of the implicit part alone, so nothing damps this, and the error estimate does not know it.
    pub fn noise(&self, h: f64) -> f64 {
        f64::EPSILON * h.abs() * self.largest
    }

    /// Makes the inverse for the step. Gives whether there is one.
    pub fn invert(&mut self) -> bool {
        let Self { inverse, matrix, slope, h, .. } = self;
        // In the middle of the step, but no further from the last Jacobian than that is from the one before.
        let ahead = (self.starts[self.present].0 + 0.5 * *h - self.time).min(self.interval.unwrap_or(0.0));
        inverse.invert(matrix, slope, ahead, *h * KennedyCarpenter::GAMMA)
    }
}

/// Solves for the implicit part of a stage.
impl Complete<f64> for Block {
    #[inline(always)]
    fn complete(&mut self, stage: usize, x: &mut [f64]) {
        let Self { stages, inverse, .. } = self;
        stages.complete(inverse, stage, x);
    }
}

impl Block {
    /// Replaces the differences of two methods by what the implicit part, which takes away most of it, leaves in the
    /// damped states.
    #[inline(always)]
    pub fn reduce(&mut self, differences: [&mut [f64]; 2]) {
        let Self { stages, inverse, .. } = self;
        stages.reduce(inverse, differences);
    }
}
