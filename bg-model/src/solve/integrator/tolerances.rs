//! Tolerances: how large the error of a step may be.
//!
//! In: what the user asks for. Out: the scale that every state's error is measured by, and norms by that scale.

use alloc::vec;
use alloc::vec::Vec;

use super::{Flow, PointRef};
use crate::model::scalar::Scalar;
use crate::model::scalar::double::{fraction, worse};

/// The error of a step that is allowed in state i: `absolute_i + relative * |x_i|`, with the value at the start of the
/// step.
#[derive(Clone, Debug, PartialEq)]
pub struct Tolerances {
    /// The part that grows with the state; from [`Tolerances::SMALLEST_RELATIVE`].
    pub relative: f64,
    /// The part that does not.
    pub absolute: Absolute,
}

/// An absolute tolerance, positive.
#[derive(Clone, Debug, PartialEq)]
pub enum Absolute {
    /// A tenth of the relative tolerance of the largest value that each state has had so far, or a thousandth of it of
    /// the value at which the state would count beside the energy stored so far, where that is more: the same steps in
    /// any units and at any size of the machine. A driver of runs finds these sizes; a step by itself takes them to be
    /// zero.
    OfSizes,
    /// The same for all states, each in its own unit.
    Scalar(f64),
    /// One for each state, in its unit.
    PerState(Vec<f64>),
}

impl Tolerances {
    /// The smallest relative tolerance that makes sense in `f64`: ten times the rounding unit, as in Hairer's programs.
    pub const SMALLEST_RELATIVE: f64 = 10.0 * f64::EPSILON;

    /// The absolute tolerances follow the sizes of the states.
    #[must_use]
    pub const fn relative(relative: f64) -> Self {
        Self { relative, absolute: Absolute::OfSizes }
    }

    /// The same absolute tolerance for all states, each in its own unit.
    #[must_use]
    pub const fn new(relative: f64, absolute: f64) -> Self {
        Self { relative, absolute: Absolute::Scalar(absolute) }
    }
}

impl Default for Tolerances {
    /// 1e-8 relative, the absolute ones follow the sizes of the states.
    fn default() -> Self {
        Self::relative(1e-8)
    }
}

/// The growth in a step that is out of all proportion.
const GROWTH: f64 = 1e6;

/// Tolerances, one for each state: what errors are divided by.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale<S = f64> {
    /// The relative tolerance.
    pub relative: f64,
    /// The absolute tolerance of every state.
    pub absolute: Vec<S>,
    /// The largest allowed error of a state in parts of its size, where sizes are known: else also in its unit.
    pub coarsest: f64,
    /// By how much the end of a step may have outgrown its start for its value to excuse the step's error: without
    /// bound where absolute tolerances are given, since a state may start from zero.
    pub growth: f64,
    /// What makes changes of different states comparable: one over the size at which each counts beside the others,
    /// per its unit; 0 where that is not known. 1 for all where absolute tolerances are given, which are in SI.
    pub weights: Vec<S>,
}

impl Scale {
    /// The tolerances of so many states.
    #[must_use]
    pub fn new(tolerances: &Tolerances, states: usize) -> Self {
        let absolute: Vec<f64> = match &tolerances.absolute {
            Absolute::OfSizes => vec![f64::MIN_POSITIVE; states],
            Absolute::Scalar(absolute) => vec![*absolute; states],
            Absolute::PerState(absolute) => {
                (0..states).map(|i| absolute.get(i).map_or(f64::MIN_POSITIVE, |of| *of)).collect()
            }
        };
        let coarsest = match &tolerances.absolute {
            Absolute::OfSizes => tolerances.relative,
            Absolute::Scalar(_) | Absolute::PerState(_) => {
                absolute.iter().fold(tolerances.relative, |most, absolute| most.max(*absolute))
            }
        };
        let growth = if tolerances.absolute == Absolute::OfSizes { GROWTH } else { f64::INFINITY };
        Self { relative: tolerances.relative, absolute, coarsest, growth, weights: vec![1.0; states] }
    }
}

impl<S: Scalar> Scale<S> {
    /// The allowed error of state `i` where it has this value.
    #[inline(always)]
    #[must_use]
    pub fn allowed(&self, i: usize, value: S) -> S {
        self.absolute[i] + value.abs().times(self.relative)
    }

    /// The same in a step between two values: by the larger one, but not by an end that has grown out of all
    /// proportion. Of a step far beyond what is stable an explicit method's error estimate is small beside where it
    /// leads.
    #[inline(always)]
    #[must_use]
    pub fn allowed_between(&self, i: usize, from: S, to: S) -> S {
        self.allowed_from(self.absolute[i], from, to)
    }

    /// The same with this absolute tolerance.
    #[inline(always)]
    pub(super) fn allowed_from(&self, absolute: S, from: S, to: S) -> S {
        let at = |value: S| absolute + value.abs().times(self.relative);
        let (at_start, at_end) = (at(from), at(to));
        at_start.larger(smaller(at_end, at_start.times(self.growth)))
    }
}

impl Scale {
    /// That of no states, to be filled from another one.
    pub(super) const fn of_nothing(relative: f64) -> Self {
        Self { relative, absolute: Vec::new(), coarsest: relative, growth: f64::INFINITY, weights: Vec::new() }
    }

    /// The state at `start` whose rate is the largest part of its allowed error.
    pub(crate) fn fastest(&self, start: PointRef<'_>) -> usize {
        index_of_largest(start.x.len(), |i| start.rate[i].abs() / self.allowed(i, start.x[i]))
    }

    /// The largest `|v_i|` divided by the allowed error at state `x`.
    #[must_use]
    pub fn norm(&self, v: &[f64], x: &[f64]) -> f64 {
        self.norm_of(x, |i| v[i])
    }

    /// The same of numbers that `v` gives.
    #[must_use]
    pub fn norm_of(&self, x: &[f64], v: impl Fn(usize) -> f64) -> f64 {
        largest_of(x.len(), |i| v(i).abs() / self.allowed(i, x[i]))
    }
}

/// The smaller number; `b` where it is none.
#[inline(always)]
pub(crate) fn smaller<S: Scalar>(a: S, b: S) -> S {
    -((-a).larger(-b))
}

/// The largest of some numbers that are not negative; not a number where one of them is none.
///
/// The maximum norm, and not a mean, so that states which repeat others or stay constant do not change the steps.
#[inline(always)]
pub(super) fn largest<S: Scalar>(of: &[S]) -> S {
    // Several maxima side by side, for none to wait for another; of all orders the result is the same.
    const SIDE_BY_SIDE: usize = 8;
    // A part of the sum that is no more than the largest, of as many states as memory holds.
    const PART: f64 = f64::EPSILON;
    let Some(nothing) = of.first().map(|first| first.alike(0.0)) else { return S::from_f64(0.0) };
    // A maximum passes over what is no number; a sum does not.
    let (mut maxima, mut sums) = ([nothing; SIDE_BY_SIDE], [nothing; SIDE_BY_SIDE]);
    let (groups, rest) = of.as_chunks::<SIDE_BY_SIDE>();
    for group in groups.iter().map(|group| &group[..]).chain([rest]) {
        for ((maximum, sum), value) in maxima.iter_mut().zip(&mut sums).zip(group) {
            *maximum = value.larger(*maximum);
            *sum = *sum + *value;
        }
    }
    let (mut largest, mut all) = (nothing, nothing);
    for (maximum, sum) in maxima.iter().zip(&sums) {
        largest = maximum.larger(largest);
        all = all + *sum;
    }
    largest.larger(all.times(PART))
}

/// The same of so many numbers that are calculated one after the other.
pub(super) fn largest_of(count: usize, value: impl Fn(usize) -> f64) -> f64 {
    (0..count).fold(0.0, |largest, i| worse(value(i), largest))
}

/// What [`displaced`] works with: a state, its rate, and the result. Each has a number for each state.
pub(crate) type Displaced<'a> = [&'a mut [f64]; 3];

/// Writes the largest change of each rate at `start` where every state is rounded up or down, in some patterns, into
/// the last of `work`: what rounding may add to the rates. Not negative. Takes four rates.
pub(crate) fn rounding(flow: &Flow<'_>, start: PointRef<'_>, work: Displaced<'_>) {
    displaced(flow, start, |i| start.x[i] * f64::EPSILON, work);
}

/// The same where every state is displaced up or down by this much.
#[inline(never)]
pub(crate) fn displaced(
    flow: &Flow<'_>,
    start: PointRef<'_>,
    by: impl Fn(usize) -> f64,
    [there, rate, largest]: Displaced<'_>,
) {
    const PATTERNS: usize = 4;
    // Up or down without a pattern that states of one kind might share: the multiples of the golden ratio lie evenly.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    largest.fill(0.0);
    for pattern in 0..PATTERNS {
        let sign = |i: usize| if fraction(GOLDEN * (PATTERNS * i + pattern) as f64) < 0.5 { 1.0 } else { -1.0 };
        for (i, there) in there.iter_mut().enumerate() {
            *there = start.x[i] + sign(i) * by(i);
        }
        flow.rate(start.t, there, rate);
        for (i, largest) in largest.iter_mut().enumerate() {
            *largest = (rate[i] - start.rate[i]).abs().larger(*largest);
        }
    }
}

/// The index below `count` with the largest error, of equal ones the first; the first that is no number where one is.
pub(super) fn index_of_largest(count: usize, error: impl Fn(usize) -> f64) -> usize {
    let is_worse = |i: usize, than: usize| error(i) > error(than) || error(i).is_nan() && !error(than).is_nan();
    (0..count).fold(0, |largest, i| if is_worse(i, largest) { i } else { largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_allowed_error_is_that_of_the_value() {
        let scale = Scale::new(&Tolerances { relative: 0.1, absolute: Absolute::PerState(vec![1.0, 2.0]) }, 2);
        assert_eq!(scale.allowed(0, -30.0), 4.0);
        assert_eq!(scale.allowed_between(1, 0.0, -20.0), 4.0);
        let scale = Scale { growth: 1e6, ..scale };
        assert_eq!(scale.allowed_between(0, 10.0, 1e60), 2e6);
        assert_eq!(scale.norm(&[4.0, 1.0], &[10.0, 20.0]), 2.0);
    }

    /// One that is none, at each place of vectors and of what is left over beside them, is seen in every norm.
    #[test]
    fn a_norm_with_a_number_that_is_none_is_none() {
        for count in 1..20 {
            let numbers: Vec<f64> = (0..count).map(|i| f64::from(i % 7) + 0.5).collect();
            let expected = numbers.iter().copied().fold(0.0, f64::max);
            let scale = Scale::new(&Tolerances::new(0.0, 1.0), numbers.len());
            assert_eq!((largest(&numbers), scale.norm(&numbers, &numbers)), (expected, expected));
            for place in 0..numbers.len() {
                let mut with_none = numbers.clone();
                with_none[place] = -f64::NAN;
                assert!(largest(&with_none).is_nan(), "{place} of {count}");
                assert!(scale.norm(&with_none, &numbers).is_nan(), "{place} of {count}");
                with_none[place] = f64::INFINITY;
                assert_eq!(largest(&with_none), f64::INFINITY);
            }
        }
        assert_eq!(largest(&[0.0; 9]), 0.0);
        assert_eq!(largest(&[1e308; 9]), f64::INFINITY);
        assert_eq!(largest(&[1e300; 9]), 1e300);
    }
}
