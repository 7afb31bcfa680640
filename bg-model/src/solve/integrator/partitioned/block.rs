//! The damped states of a step: which they are, their block of the Jacobian, and the implicit part of the stages.
//!
//! In: a flow and a step. Out: the states of the stages with their implicit part.

use nalgebra::SVector;

use super::pattern::Pattern;
use super::tableau::{KennedyCarpenter, STAGES};
use crate::solve::integrator::explicit::{Complete, Tableau};
use crate::solve::integrator::linear::Jacobian;
use crate::solve::integrator::{Flow, Point, Scale};

/// The accepted steps after which the Jacobian is renewed.
const RENEWAL: u32 = 8;
/// A step longer than this many times the one that the damped states were chosen for chooses them anew.
const GROWTH: f64 = 2.0;

/// Numbers of damped states side by side.
const LANES: usize = 4;
type Lanes = [f64; LANES];

/// The damped states of a step, with the work space of their stages.
#[derive(Clone, Debug)]
pub(super) struct Block<const N: usize> {
    jacobian: Jacobian<N>,
    pattern: Pattern,
    /// The accepted steps since the Jacobian was made; none where there is none.
    age: Option<u32>,
    /// The step that the states were chosen for, and the one that the inverse belongs to, s; zero where there is none.
    chosen: f64,
    inverted: f64,
    states: Vec<usize>,
    /// The entries of the Jacobian that are in B, each with its place there.
    sources: Vec<(usize, usize)>,
    /// B and the inverse of I - h gamma B, column by column; behind each column, as behind other numbers of the states, are zeros
    /// up to a multiple of [`LANES`].
    matrix: Vec<Lanes>,
    inverse: Vec<Lanes>,
    exchanges: Vec<usize>,
    /// The start of the step and of the one before; none where what was known no longer holds.
    start: (f64, SVector<f64, N>),
    before: Option<(f64, SVector<f64, N>)>,
    h: f64,
    /// Of each damped state its value at the start of the step, how much the line changes in it, how far a stage is off the
    /// line, and stage by stage the implicit part.
    from: Vec<Lanes>,
    change: Vec<Lanes>,
    off: Vec<Lanes>,
    parts: Vec<Lanes>,
}

impl<const N: usize> Block<N> {
    /// Nothing yet; room is made at the first step.
    pub fn new() -> Self {
        Self {
            jacobian: Jacobian::new(),
            pattern: Pattern::default(),
            age: None,
            chosen: 0.0,
            inverted: 0.0,
            states: Vec::new(),
            sources: Vec::new(),
            matrix: Vec::new(),
            inverse: Vec::new(),
            exchanges: Vec::new(),
            start: (0.0, SVector::zeros()),
            before: None,
            h: 0.0,
            from: Vec::new(),
            change: Vec::new(),
            off: Vec::new(),
            parts: Vec::new(),
        }
    }

    /// The last attempt was accepted.
    pub fn advance(&mut self) {
        self.before = Some(self.start);
        self.age = self.age.map(|age| age + 1);
    }

    /// What was known of the flow no longer holds.
    pub fn restart(&mut self) {
        (self.before, self.age) = (None, None);
    }

    /// Makes ready for a step of size `h` (s) from `start`. Gives whether the Jacobian is one of numbers.
    pub fn prepare(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) -> bool {
        (self.start, self.h) = ((start.t, start.x), h);
        if self.age.is_none_or(|age| age >= RENEWAL) {
            self.jacobian.evaluate(flow, start, h, scale);
            if !self.jacobian.is_finite() {
                return false;
            }
            (self.age, self.chosen) = (Some(0), 0.0);
        }
        if self.chosen == 0.0 || h > GROWTH * self.chosen {
            self.choose(flow);
        }
        let (from, change) = (self.from.as_flattened_mut(), self.change.as_flattened_mut());
        for (k, &state) in self.states.iter().enumerate() {
            from[k] = start.x[state];
            change[k] = self.before.as_ref().map_or(0.0, |(t, x)| h / (start.t - t) * (start.x[state] - x[state]));
        }
        true
    }

    /// Chooses the damped states, and takes their block out of the Jacobian.
    fn choose(&mut self, flow: &impl Flow<N>) {
        (self.chosen, self.inverted) = (self.h, 0.0);
        let entries = self.pattern.entries(flow, &self.jacobian);
        let has_changed = self.pattern.choose(&entries, self.h, N, &mut self.states);
        if has_changed {
            let (n, groups) = (self.states.len(), self.states.len().div_ceil(LANES));
            self.pattern.sources(&self.states, LANES * groups, &mut self.sources);
            self.exchanges.resize(n, 0);
            for (lanes, length) in [
                (&mut self.matrix, n * groups),
                (&mut self.inverse, n * groups),
                (&mut self.from, groups),
                (&mut self.change, groups),
                (&mut self.off, groups),
                (&mut self.parts, groups * STAGES),
            ] {
                lanes.clear();
                lanes.resize(length, [0.0; LANES]);
            }
        }
        let matrix = self.matrix.as_flattened_mut();
        self.sources.iter().for_each(|&(entry, place)| matrix[place] = entries[entry]);
    }

    /// Inverts I - h gamma B in place, by elimination with exchanges. Gives whether it is regular.
    ///
    /// Columns take the part of rows: the inverse of the transpose is the transpose of the inverse.
    #[inline(always)]
    pub fn invert(&mut self) -> bool {
        if self.inverted == self.h {
            return true;
        }
        self.inverted = 0.0;
        let (n, groups) = (self.states.len(), self.from.len());
        let factor = -self.h * KennedyCarpenter::GAMMA;
        let inverse = &mut self.inverse;
        inverse.iter_mut().zip(&self.matrix).for_each(|(to, from)| *to = from.map(|entry| factor * entry));
        for k in 0..n {
            let (group, lane) = (k / LANES, k % LANES);
            inverse[k * groups + group][lane] += 1.0;
        }
        for k in 0..n {
            let (group, lane) = (k / LANES, k % LANES);
            let size = |column: usize| inverse[column * groups + group][lane].abs();
            let best = (k..n).fold(k, |best, column| if size(column) > size(best) { column } else { best });
            self.exchanges[k] = best;
            if best != k {
                (0..groups).for_each(|group| inverse.swap(k * groups + group, best * groups + group));
            }
            let (above, rest) = inverse.split_at_mut(k * groups);
            let (pivot, below) = rest.split_at_mut(groups);
            let reciprocal = 1.0 / std::mem::replace(&mut pivot[group][lane], 1.0);
            if !reciprocal.is_finite() {
                return false;
            }
            pivot.as_flattened_mut().iter_mut().for_each(|entry| *entry *= reciprocal);
            for column in above.chunks_exact_mut(groups).chain(below.chunks_exact_mut(groups)) {
                let factor = std::mem::take(&mut column[group][lane]);
                for (entries, of_pivot) in column.iter_mut().zip(&*pivot) {
                    *entries = std::array::from_fn(|lane| entries[lane] - factor * of_pivot[lane]);
                }
            }
        }
        for (k, &other) in self.exchanges.iter().enumerate().rev().filter(|(k, other)| *k != **other) {
            inverse.as_flattened_mut().chunks_exact_mut(groups * LANES).for_each(|column| column.swap(k, other));
        }
        self.inverted = self.h;
        true
    }
}

/// Rows of group `group` of the product of `matrix`, column by column, with `vector`.
#[inline(always)]
fn rows_of_product(matrix: &[Lanes], vector: &[Lanes], group: usize) -> Lanes {
    let columns = matrix.chunks_exact(vector.len()).zip(vector.as_flattened());
    columns
        .fold([0.0; LANES], |sum, (column, entry)| std::array::from_fn(|lane| sum[lane] + column[group][lane] * entry))
}

/// Solves for the implicit part of a stage.
impl<const N: usize> Complete<N> for Block<N> {
    #[inline(always)]
    fn complete(&mut self, stage: usize, c: f64, x: &mut SVector<f64, N>) {
        let Self { states, inverse, from, change, off, parts, h, .. } = self;
        let (groups, reciprocal) = (from.len(), 1.0 / (*h * KennedyCarpenter::GAMMA));
        let (before, behind) = parts.split_at_mut(stage * groups);
        for (group, states) in states.chunks(LANES).enumerate() {
            let off = &mut off[group];
            off.iter_mut().zip(states).for_each(|(off, &state)| *off = x[state]);
            let mut more = [0.0; LANES];
            for &(earlier, weight) in KennedyCarpenter::MORE[stage] {
                let part = &before[earlier * groups + group];
                more = std::array::from_fn(|lane| more[lane] + weight * part[lane]);
            }
            (0..LANES).for_each(|lane| off[lane] += *h * more[lane] - (from[group][lane] + c * change[group][lane]));
        }
        for (group, states) in states.chunks(LANES).enumerate() {
            let solved = rows_of_product(inverse, off, group);
            behind[group] = std::array::from_fn(|lane| (solved[lane] - off[group][lane]) * reciprocal);
            let line: Lanes = std::array::from_fn(|lane| from[group][lane] + c * change[group][lane]);
            states.iter().enumerate().for_each(|(lane, &state)| x[state] = line[lane] + solved[lane]);
        }
    }

    /// What an error of a damped state leaves of itself: its implicit part takes away most of it.
    #[inline(always)]
    fn correct(&mut self, errors: &mut [f64; N], error: impl Fn(usize) -> f64, allowed: impl Fn(usize) -> f64) {
        self.off.as_flattened_mut().iter_mut().zip(&self.states).for_each(|(off, &state)| *off = error(state));
        for (group, states) in self.states.chunks(LANES).enumerate() {
            let left = rows_of_product(&self.inverse, &self.off, group);
            states.iter().enumerate().for_each(|(lane, &state)| errors[state] = (left[lane] / allowed(state)).abs());
        }
    }
}
