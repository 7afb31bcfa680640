//! The least and the largest value of each of many outputs so far, compared in groups for the vectors of the machine:
//! most values of most steps are neither, and a choice for each of them would take longer than the step.
//!
//! In: values at instants, and at the ends of a part of a step. Out: peaks, and which outputs may turn beyond them.

use alloc::vec;
use alloc::vec::Vec;

use pulp::NullaryFnOnce;

use crate::solve::integrator::Arch;
use crate::solve::integrator::side_by_side::{OfEach, for_each, some};

/// A value of an output and its instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Time, s.
    pub t: f64,
    /// The output's value, in its unit.
    pub value: f64,
}

/// Where an output is least and where it is largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// The least value.
    pub least: Peak,
    /// The largest value.
    pub largest: Peak,
}

impl Peaks {
    /// Those of an output that has one value.
    const fn of(peak: Peak) -> Self {
        Self { least: peak, largest: peak }
    }

    /// Those of values at `times` (s); none of no values.
    #[must_use]
    pub fn of_samples(times: &[f64], values: &[f64]) -> Option<Self> {
        let samples = times.iter().zip(values).map(|(&t, &value)| Self::of(Peak { t, value }));
        samples.reduce(Self::and)
    }

    /// Those of this and of a later time.
    pub(crate) fn and(self, later: Self) -> Self {
        let Self { mut least, mut largest } = self;
        if later.least.value < least.value {
            least = later.least;
        }
        if later.largest.value > largest.value {
            largest = later.largest;
        }
        Self { least, largest }
    }
}

/// A parabola turns in a part that changes it by less than half of its bend, and leads beyond the ends by an eighth of
/// that at most. Four times as much is looked at.
const TURN: f64 = 2.0;
const BEYOND: f64 = 0.5;

/// What is known of outputs.
#[derive(Clone, Debug)]
pub(super) struct Extremes {
    /// For each output the least and the largest value; infinity where none is known yet.
    least: Vec<f64>,
    largest: Vec<f64>,
    /// The instants of both, s.
    at: Vec<[f64; 2]>,
    /// What is below this, or above that, leads beyond what is known.
    floor: Vec<f64>,
    ceiling: Vec<f64>,
    /// The machine's vectors.
    arch: Arch,
}

impl Extremes {
    /// Nothing yet, of so many outputs, from the instant `from` (s) on.
    pub fn new(from: f64, outputs: usize) -> Self {
        let [least, largest] = [f64::INFINITY, f64::NEG_INFINITY].map(|end| vec![end; outputs]);
        let (floor, ceiling) = (least.clone(), largest.clone());
        Self { least, largest, at: vec![[from; 2]; outputs], floor, ceiling, arch: Arch::new() }
    }

    /// Takes values at `t` (s) into account.
    pub fn take(&mut self, t: f64, values: &[f64]) {
        self.arch.dispatch(Taking { known: self, t, values });
    }

    /// Marks which outputs may turn in a part of a step, beyond what is known, beside those that are marked; gives
    /// whether any may.
    pub fn mark(&self, ends: Ends<'_>, marked: &mut [bool]) -> bool {
        self.arch.dispatch(Marking { known: self, ends, marked, is_any: false })
    }

    /// Whether these values of an output lead beyond what is known: down, and up.
    pub fn leads(&self, index: usize, [least, largest]: [f64; 2]) -> [bool; 2] {
        [least < self.floor[index], largest > self.ceiling[index]]
    }

    /// The peaks of an output; none where no value is known.
    pub fn peaks(&self, index: usize) -> Option<Peaks> {
        let [from, to] = self.at[index];
        let least = Peak { t: from, value: self.least[index] };
        let largest = Peak { t: to, value: self.largest[index] };
        (least.value <= largest.value).then_some(Peaks { least, largest })
    }

    /// Takes a value of an output at `t` (s) into account that may be beyond what is known.
    #[inline(never)]
    fn widen(&mut self, index: usize, t: f64, value: f64) {
        let is_least = value < self.least[index] && value.is_finite();
        let is_largest = value > self.largest[index] && value.is_finite();
        if is_least {
            (self.least[index], self.at[index][0]) = (value, t);
        }
        if is_largest {
            (self.largest[index], self.at[index][1]) = (value, t);
        }
        if is_least || is_largest {
            self.bound(index);
        }
    }

    /// Sets from where on an output leads beyond what is known. Rounding moves a constant by less than counts.
    fn bound(&mut self, index: usize) {
        const OF_RANGE: f64 = 1e-9;
        const OF_SIZE: f64 = 1e-6;
        let [low, high] = [self.least[index], self.largest[index]];
        let margin = OF_RANGE * (high - low).max(OF_SIZE * low.abs().max(high.abs()));
        (self.floor[index], self.ceiling[index]) = (low - margin, high + margin);
    }
}

// Closures are not inlined into what is compiled for vectors.

struct Taking<'a> {
    known: &'a mut Extremes,
    t: f64,
    values: &'a [f64],
}

impl OfEach for Taking<'_> {
    const CAN_REPEAT: bool = true;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let values: [f64; W] = some(self.values, first);
        let least: [f64; W] = some(&self.known.least, first);
        let largest: [f64; W] = some(&self.known.largest, first);
        let mut outside = [0; W];
        for i in 0..W {
            outside[i] = u64::from((values[i] < least[i]) | (values[i] > largest[i]));
        }
        if outside != [0; W] {
            for i in 0..W {
                if outside[i] != 0 {
                    self.known.widen(first + i, self.t, values[i]);
                }
            }
        }
    }
}

impl NullaryFnOnce for Taking<'_> {
    type Output = ();

    #[inline(always)]
    fn call(mut self) {
        for_each(self.values.len(), &mut self);
    }
}

/// Outputs in a part of a step.
#[derive(Clone, Copy)]
pub(super) struct Ends<'a> {
    /// The values at the end before the part, at its start and at its end.
    pub before: &'a [f64],
    pub from: &'a [f64],
    pub to: &'a [f64],
    /// By how much the change before the part is multiplied to be that which is expected in it.
    pub ratio: f64,
}

struct Marking<'a> {
    known: &'a Extremes,
    ends: Ends<'a>,
    marked: &'a mut [bool],
    is_any: bool,
}

impl OfEach for Marking<'_> {
    const CAN_REPEAT: bool = true;

    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Ends { before, from, to, ratio } = self.ends;
        let before: [f64; W] = some(before, first);
        let from: [f64; W] = some(from, first);
        let to: [f64; W] = some(to, first);
        let floor: [f64; W] = some(&self.known.floor, first);
        let ceiling: [f64; W] = some(&self.known.ceiling, first);
        let mut turns = [0; W];
        for i in 0..W {
            let change = to[i] - from[i];
            // By how much it bends: its change less that which is expected.
            let bend = (change - (from[i] - before[i]) * ratio).abs();
            let reach = BEYOND * bend;
            let low = if from[i] < to[i] { from[i] } else { to[i] };
            let high = if from[i] < to[i] { to[i] } else { from[i] };
            let leads = (low - reach < floor[i]) | (high + reach > ceiling[i]);
            turns[i] = u64::from((change.abs() <= TURN * bend) & leads);
        }
        if turns != [0; W] {
            self.is_any = true;
            for (marked, turns) in self.marked[first..].iter_mut().zip(turns) {
                *marked |= turns != 0;
            }
        }
    }
}

impl NullaryFnOnce for Marking<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(mut self) -> bool {
        for_each(self.ends.to.len(), &mut self);
        self.is_any
    }
}
