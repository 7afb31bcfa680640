//! Outputs compared with what is known of them, in groups for the vectors of the machine: most values of most steps are
//! none that count, and a choice for each of them would take longer than the step.
//!
//! In: values at the ends of a part of a step, what is known. Out: whether any is beyond, which may turn.

use pulp::NullaryFnOnce;

use crate::solve::integrator::Arch;
use crate::solve::integrator::side_by_side::{OfEach, for_each, some};

/// A parabola turns in a part that changes it by less than half of its bend, and leads beyond the ends by an eighth of that
/// at most. Four times as much is looked at.
const TURN: f64 = 2.0;
const BEYOND: f64 = 0.5;

/// Whether a value is below its least or above its largest one.
pub(super) fn is_any_outside(arch: Arch, values: &[f64], [least, largest]: [&[f64]; 2]) -> bool {
    arch.dispatch(Outside { values, least, largest, is_any: false })
}

struct Outside<'a> {
    values: &'a [f64],
    least: &'a [f64],
    largest: &'a [f64],
    is_any: bool,
}

impl OfEach for Outside<'_> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let [values, least, largest]: [[f64; W]; 3] = [self.values, self.least, self.largest].map(|of| some(of, first));
        let mut outside = [0; W];
        for i in 0..W {
            outside[i] = u64::from((values[i] < least[i]) | (values[i] > largest[i]));
        }
        self.is_any |= outside != [0; W];
    }
}

impl NullaryFnOnce for Outside<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(mut self) -> bool {
        for_each(self.values.len(), &mut self);
        self.is_any
    }
}

/// Outputs in a part of a step, and from where on they lead beyond what is known.
#[derive(Clone, Copy)]
pub(super) struct Ends<'a> {
    /// The values at the end before the part, at its start and at its end.
    pub before: &'a [f64],
    pub from: &'a [f64],
    pub to: &'a [f64],
    /// By how much the change before the part is multiplied to be that which is expected in it.
    pub ratio: f64,
    /// What is below, or above, leads beyond what is known.
    pub floor: &'a [f64],
    pub ceiling: &'a [f64],
}

/// Marks which outputs may turn in the part, beyond what is known, beside those that are marked; gives whether any may.
pub(super) fn mark(arch: Arch, ends: Ends<'_>, marked: &mut [bool]) -> bool {
    arch.dispatch(Turning { ends, marked, is_any: false })
}

struct Turning<'a> {
    ends: Ends<'a>,
    marked: &'a mut [bool],
    is_any: bool,
}

impl OfEach for Turning<'_> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Ends { before, from, to, ratio, floor, ceiling } = self.ends;
        let [before, from, to]: [[f64; W]; 3] = [before, from, to].map(|of| some(of, first));
        let [floor, ceiling]: [[f64; W]; 2] = [floor, ceiling].map(|of| some(of, first));
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

impl NullaryFnOnce for Turning<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(mut self) -> bool {
        for_each(self.ends.to.len(), &mut self);
        self.is_any
    }
}
