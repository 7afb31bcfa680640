//! The least and the largest value of each output over a run, between the samples as well; or of other functions of the
//! state.
//!
//! In: the steps of a run, with the states inside of them. Out: for each output two values with their instants, over
//! the whole run and from an instant on, or over given windows of time. They depend on the steps alone, not on the
//! samples.
//!
//! Method: the outputs at the end of each step and at the two ends before show how they bend. Where an output may turn
//! in the step, and beyond what is known so far, its slopes at both ends give a cubic. Where that leads beyond what is
//! known as well, the step's dense output is evaluated where the cubic turns, and searched where it is off the cubic
//! there. So most steps take one evaluation of the outputs. A step of a method of higher order is longer beside what
//! happens in it, and looked at in several parts. At an event both sides count.

use alloc::vec;
use alloc::vec::Vec;

use super::extremes::{Ends, Extremes, Peaks};
use super::observer::{Inside, Observer, Switching};
use crate::model::dynamics::Machine;
use crate::solve::event::minimum;
use crate::solve::integrator::between;

/// Functions of time and state whose peaks are looked for, other than the outputs themselves.
pub trait Watched {
    /// How many there are.
    fn count(&self) -> usize;

    /// How many states there are.
    fn states(&self) -> usize;

    /// Writes their values at `t` (s), the state `x` and the branches `negative` into `values`; allocates nothing.
    fn values(&self, t: f64, x: &[f64], negative: &[bool], values: &mut [f64]);
}

/// What peaks are looked for of.
#[derive(Clone, Copy)]
enum Source<'a> {
    Outputs(&'a dyn Machine),
    Others(&'a dyn Watched),
}

impl Source<'_> {
    fn count(self) -> usize {
        match self {
            Self::Outputs(model) => model.description().outputs.len(),
            Self::Others(watched) => watched.count(),
        }
    }

    fn states(self) -> usize {
        match self {
            Self::Outputs(model) => model.states(),
            Self::Others(watched) => watched.states(),
        }
    }

    fn values(self, t: f64, x: &[f64], negative: &[bool], values: &mut [f64]) {
        match self {
            Self::Outputs(model) => model.outputs(t, x, negative, values),
            Self::Others(watched) => watched.values(t, x, negative, values),
        }
    }
}

/// Over which time peaks are looked for.
#[derive(Clone, Debug)]
struct Window {
    /// From this instant on, s, and up to this one.
    from: f64,
    to: f64,
    known: Extremes,
}

impl Window {
    fn new([from, to]: [f64; 2], outputs: usize) -> Self {
        Self { from, to, known: Extremes::new(from, outputs) }
    }

    /// Whether a time from `from` up to `to` (s) has a part in it.
    fn meets(&self, from: f64, to: f64) -> bool {
        to >= self.from && from <= self.to
    }

    /// Takes values at `t` (s) into account.
    fn take(&mut self, t: f64, values: &[f64]) {
        if t < self.from || t > self.to {
            return;
        }
        self.known.take(t, values);
    }
}

fn take(windows: &mut [Window], t: f64, values: &[f64]) {
    windows.iter_mut().for_each(|window| window.take(t, values));
}

/// An observer that finds the peaks of a model's outputs. Allocates nothing in a step.
#[derive(Clone)]
pub struct PeakMonitor<'a> {
    of: Source<'a>,
    windows: Vec<Window>,
    past: Past,
    /// The outputs at the end of the part that is looked at, and which of them may turn in it beyond what is known.
    to: Vec<f64>,
    may_turn: Vec<bool>,
    /// Slopes at both ends of a part, and outputs in its middle.
    slopes: [Vec<f64>; 2],
    middle: Vec<f64>,
    /// Room for a state and for outputs.
    x: Vec<f64>,
    row: Vec<f64>,
}

/// The outputs at the last ends of parts.
#[derive(Clone)]
struct Past {
    /// How many of them are known since the last event: 0, 1 or 2.
    known: usize,
    /// At the start of the next part.
    values: Vec<f64>,
    /// At the end before it, and how long ago that is, s.
    before: Vec<f64>,
    h: f64,
}

impl Past {
    /// The part has ended, of `h` (s), with these values, which are those before it then.
    fn advance(&mut self, h: f64, values: &mut Vec<f64>) {
        core::mem::swap(&mut self.before, &mut self.values);
        core::mem::swap(&mut self.values, values);
        self.h = h;
        self.known = 2;
    }

    /// The values at the start of a part, those before them, and by how much a change since then is multiplied to be
    /// that which is expected in a part of `h` (s): none where none is known.
    fn expected(&self, h: f64) -> (&[f64], &[f64], f64) {
        if self.known < 2 { (&self.values, &self.values, 0.0) } else { (&self.values, &self.before, h / self.h) }
    }
}

/// The part of a step from which on and up to which it is looked at.
type Stretch = [f64; 2];

/// A step as short beside another one as the argument of a difference of outputs.
const DIFFERENCE: f64 = 1e-6;
/// The order up to which a step is one part: an oscillation makes less than half a turn in it where errors are small.
const ORDER_OF_ONE: f64 = 8.0;
/// How far the middle may be off the cubic, in parts of the range in the step, for the cubic to be the course.
const RESOLVED: f64 = 0.02;
/// In how many pieces a part is searched that the cubic does not show.
const PIECES: u32 = 8;

impl<'a> PeakMonitor<'a> {
    /// That of a model: over the whole run, and from `settled` (s) on where that is given.
    #[must_use]
    pub fn new(model: &'a dyn Machine, settled: Option<f64>) -> Self {
        let from = core::iter::once(f64::NEG_INFINITY).chain(settled);
        Self::over(Source::Outputs(model), from.map(|from| [from, f64::INFINITY]))
    }

    /// That of other functions than outputs, over these windows of time: from, s, and up to, s.
    #[must_use]
    pub fn within(watched: &'a dyn Watched, windows: &[[f64; 2]]) -> Self {
        Self::over(Source::Others(watched), windows.iter().copied())
    }

    fn over(of: Source<'a>, windows: impl Iterator<Item = [f64; 2]>) -> Self {
        let count = of.count();
        let row = || vec![0.0; count];
        Self {
            of,
            windows: windows.map(|window| Window::new(window, count)).collect(),
            past: Past { known: 0, values: row(), before: row(), h: 0.0 },
            to: row(),
            may_turn: vec![false; count],
            slopes: [row(), row()],
            middle: row(),
            x: vec![0.0; of.states()],
            row: row(),
        }
    }

    /// The peaks of output `index` over the whole run; none of a run that has made no step.
    #[must_use]
    pub fn peaks(&self, index: usize) -> Option<Peaks> {
        self.windows[0].known.peaks(index)
    }

    /// The same from the instant on that was given; none of a run that has not come there.
    #[must_use]
    pub fn settled(&self, index: usize) -> Option<Peaks> {
        self.peaks_in(1, index)
    }

    /// The peaks of output `index` in window `window`; none of a run that has not come there.
    #[must_use]
    pub fn peaks_in(&self, window: usize, index: usize) -> Option<Peaks> {
        self.windows.get(window)?.known.peaks(index)
    }

    /// Whether an output may turn in a part of `h` (s) that ends at `t` (s) in `to`, beyond what is known; marks which
    /// do.
    fn may_turn(&mut self, t: f64, h: f64) -> bool {
        let Self { windows, past, to, may_turn, .. } = self;
        may_turn.fill(false);
        let (values, before, ratio) = past.expected(h);
        let mut any = false;
        for window in windows.iter().filter(|window| window.meets(t - h, t)) {
            any |= window.known.mark(Ends { before, from: values, to, ratio }, may_turn);
        }
        any
    }

    /// The part of `h` (s) has ended at `t` (s) in `to`.
    fn end(&mut self, t: f64, h: f64) {
        take(&mut self.windows, t, &self.to);
        self.past.advance(h, &mut self.to);
    }

    /// Evaluates the slopes of the outputs, which are `values`, at the part `theta` of a step: by a difference to a
    /// part before, or after at the start.
    fn slope(&mut self, step: &mut Inside<'_, '_>, theta: f64, is_end: bool) {
        let Self { of, past, to, slopes, x, .. } = self;
        let beside = if theta > 0.0 { -DIFFERENCE } else { DIFFERENCE };
        let t = if theta == 0.0 || theta == 1.0 {
            step.along_rate(theta == 1.0, beside, x)
        } else {
            step.state(theta + beside, x)
        };
        let (slopes, values) = (&mut slopes[usize::from(is_end)], if is_end { to } else { &past.values });
        of.values(t, x, step.negative(), slopes);
        let h = step.h() * beside;
        slopes.iter_mut().zip(values).for_each(|(slope, value)| *slope = (*slope - value) / h);
    }

    /// Takes the ends of windows inside of a step into account: the largest value of a window may be there.
    fn take_ends(&mut self, step: &mut Inside<'_, '_>) {
        let Self { of, windows, x, row, .. } = self;
        for window in windows {
            for t in [window.from, window.to] {
                let part = step.part_at(t);
                if part > 0.0 && part < 1.0 {
                    step.state(part, x);
                    of.values(t, x, step.negative(), row);
                    window.take(t, row);
                }
            }
        }
    }

    /// Looks for what is beyond the known inside of a part of a step, of the outputs that may turn.
    fn search(&mut self, step: &mut Inside<'_, '_>, part: Stretch, is_short: bool) {
        let [low, high] = part;
        self.slope(step, low, false);
        self.slope(step, high, true);
        let Self { of, windows, past, to, may_turn, slopes, middle, x, row, .. } = self;
        let half = 0.5 * (low + high);
        let t_half = if is_short { step.cubic(half, x) } else { step.state(half, x) };
        of.values(t_half, x, step.negative(), middle);
        take(windows, step.time(high), to);
        let h = step.h() * (high - low);
        for place in 0..windows.len() {
            let ends = [windows[place].from, windows[place].to];
            let [opens, closes] = ends.map(|t| step.part_at(t));
            if opens >= high || closes <= low {
                continue;
            }
            if opens > low {
                step.state(opens, x);
                let t = windows[place].from;
                of.values(t, x, step.negative(), row);
                windows[place].take(t, row);
            }
            let part = [low.max(opens), high.min(closes)];
            for index in (0..row.len()).filter(|&index| may_turn[index]) {
                let course = Course {
                    values: [past.values[index], to[index]],
                    slopes: [slopes[0][index], slopes[1][index]],
                    middle: middle[index],
                    h,
                };
                let Some(beyond) = course.beyond() else { continue };
                let leads = windows[place].known.leads(index, beyond);
                if leads == [false; 2] {
                    continue;
                }
                let mut at = |theta: f64| {
                    let t = step.state(theta, x);
                    of.values(t, x, step.negative(), row);
                    take(windows, t, row);
                    row[index]
                };
                if part == [low, high] && course.is_cubic(|u| at(low + u * (high - low))) {
                    continue;
                }
                for sign in [1.0, -1.0].into_iter().zip(leads).filter_map(|(sign, leads)| leads.then_some(sign)) {
                    let mut signed = |theta: f64| sign * at(theta);
                    let [low, high] = if course.is_resolved() { part } else { lowest_piece(part, &mut signed) };
                    minimum(low, high, f64::NEG_INFINITY, signed);
                }
            }
        }
    }
}

/// The neighbourhood of the lowest of some points inside of a part.
fn lowest_piece([low, high]: Stretch, at: &mut impl FnMut(f64) -> f64) -> Stretch {
    let piece = (high - low) / f64::from(PIECES);
    let inside = (1..PIECES).map(|k| low + f64::from(k) * piece);
    let values = inside.map(|theta| (theta, at(theta)));
    let lowest = values.reduce(|best, other| if other.1 < best.1 { other } else { best });
    lowest.map_or([low, high], |(theta, _)| [theta - piece, theta + piece])
}

/// An output over a part of a step, as far as it is known without the states inside.
struct Course {
    values: [f64; 2],
    slopes: [f64; 2],
    middle: f64,
    h: f64,
}

impl Course {
    /// By how much the middle is off the cubic.
    fn off(&self) -> f64 {
        (self.middle - between(self.h, 0.5, self.values, self.slopes)).abs()
    }

    fn range(&self) -> [f64; 2] {
        let [a, b] = self.values;
        [a.min(b).min(self.middle), a.max(b).max(self.middle)]
    }

    /// Whether the cubic shows the course.
    fn is_resolved(&self) -> bool {
        let [least, largest] = self.range();
        self.off() <= RESOLVED * (largest - least)
    }

    /// Whether the cubic is the course: where it turns, the output, `at` that part, is as the cubic has it. Then these
    /// are its peaks, as a small error of the place moves them by its square only.
    fn is_cubic(&self, mut at: impl FnMut(f64) -> f64) -> bool {
        const NEAR: f64 = 1e-6;
        let turns = self.turns();
        let [least, largest] = self.range();
        let is_near =
            |(part, value): (f64, f64)| (at(part) - value).abs() <= NEAR * (largest.max(value) - least.min(value));
        self.is_resolved() && turns.iter().any(Option::is_some) && turns.into_iter().flatten().all(is_near)
    }

    /// About the least and the largest value inside; none where the course leads from one end to the other.
    fn beyond(&self) -> Option<[f64; 2]> {
        let [a, b] = self.values;
        let turns = self.turns();
        if turns.iter().all(Option::is_none) && self.is_resolved() {
            return None;
        }
        let off = self.off();
        let [mut least, mut largest] = self.range();
        for (_, value) in turns.into_iter().flatten() {
            (least, largest) = (least.min(value), largest.max(value));
        }
        // By as much more as the cubic is off, and by a part of what it adds.
        let more = |added: f64| 2.0 * off + 0.5 * added;
        let added = [a.min(b) - least, largest - a.max(b)].map(|added| added.max(0.0));
        Some([least - more(added[0]), largest + more(added[1])])
    }

    /// Where the slope of the cubic is zero inside of the part, which is from 0 to 1, and its values there.
    fn turns(&self) -> [Option<(f64, f64)>; 2] {
        let ([a, b], h) = (self.values, self.h);
        let [first, last] = self.slopes.map(|slope| slope * h);
        // a + first u + square u^2 + cube u^3.
        let (square, cube) = (3.0 * (b - a) - 2.0 * first - last, first + last - 2.0 * (b - a));
        let discriminant = square * square - 3.0 * cube * first;
        if discriminant < 0.0 || discriminant.is_nan() {
            return [None; 2];
        }
        // Without cancellation: the roots of first + 2 square u + 3 cube u^2.
        let q = -(square + libm::copysign(libm::sqrt(discriminant), square));
        [q / (3.0 * cube), first / q].map(|u| {
            let is_inside = u > 0.0 && u < 1.0;
            is_inside.then_some((u, a + u * (first + u * (square + u * cube))))
        })
    }
}

impl Observer for PeakMonitor<'_> {
    fn looks_inside(&self) -> bool {
        true
    }

    fn asks(&mut self, h: f64, t: f64, x: &[f64], negative: &[bool]) -> bool {
        if self.past.known == 0 {
            return true;
        }
        self.of.values(t, x, negative, &mut self.to);
        self.may_turn(t, h)
    }

    fn skipped(&mut self, h: f64, t: f64) {
        self.end(t, h);
    }

    fn inside(&mut self, step: &mut Inside<'_, '_>) {
        if self.past.known == 0 {
            let t = step.state(0.0, &mut self.x);
            self.of.values(t, &self.x, step.negative(), &mut self.past.values);
            take(&mut self.windows, t, &self.past.values);
            self.past.known = 1;
        }
        if matches!(self.of, Source::Others(_)) {
            self.take_ends(step);
        }
        let parts = step.order().map_or(1.0, |order| libm::ceil(order / ORDER_OF_ONE).max(1.0));
        let h = step.h() / parts;
        let mut low = 0.0;
        for k in 1..=(parts as u32) {
            let high = f64::from(k) / parts;
            let t = step.state(high, &mut self.x);
            self.of.values(t, &self.x, step.negative(), &mut self.to);
            if self.may_turn(t, h) {
                self.search(step, [low, high], parts == 1.0);
            }
            self.end(t, h);
            low = high;
        }
    }

    fn switched(&mut self, switching: &Switching) {
        self.past.known = 0;
        let Switching { after, negative_after, .. } = switching;
        self.of.values(after.t, after.x.as_slice(), negative_after, &mut self.row);
        take(&mut self.windows, after.t, &self.row);
    }
}
