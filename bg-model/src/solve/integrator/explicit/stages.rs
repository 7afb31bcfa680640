//! The stages of a step by an explicit tableau, of one run or of several side by side.
//!
//! In: the start of a step, what gives rates. Out: the state at its end and what it errs by. The numbers of runs side
//! by side are those of each by itself, to the bit: operations stand in loops, since closures around vectors of a
//! machine are calls.

use core::marker::PhantomData;
use core::ops::Range;

use super::{Row, Tableau};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::compensated::{CompensatedSum, compensated};
use crate::solve::integrator::side_by_side::{Padded, Stack};
use crate::solve::integrator::steps::{Begin, Rates};
use crate::solve::integrator::tolerances::largest;

/// The most stages of a method.
pub(super) const STAGES: usize = 16;

/// What a method adds to the states of an explicit one.
pub(crate) trait Complete<S> {
    /// Completes the state `x` of stage `stage`.
    fn complete(&mut self, stage: usize, x: &mut [S]);
}

/// Nothing.
impl<S> Complete<S> for () {
    #[inline(always)]
    fn complete(&mut self, _stage: usize, _x: &mut [S]) {}
}

/// The rates of all stages of tableau `T`, with room for what steps need beside them: in groups of `W` states.
#[derive(Clone, Debug)]
pub(crate) struct Stages<T, S, const W: usize> {
    k: Stack<S, W, STAGES>,
    /// The state of a stage and its rate; the states at the start and at the end of the step.
    x: Padded<S, W>,
    rate: Padded<S, W>,
    start: Padded<S, W>,
    pub end: Padded<S, W>,
    /// The absolute tolerances.
    absolute: Padded<S, W>,
    /// The differences to the embedded methods in parts of what is allowed.
    pub differences: [Padded<S, W>; 2],
    tableau: PhantomData<T>,
}

impl<T: Tableau, S: Scalar, const W: usize> Stages<T, S, W> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
        let room = || Padded::new(states, zero);
        Self {
            k: Stack::new(states, 0, zero),
            x: room(),
            rate: room(),
            start: room(),
            end: room(),
            absolute: Padded::new(states, one),
            differences: [room(), room()],
            tableau: PhantomData,
        }
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.x.len()
    }

    /// The rates of a stage, each with its state.
    pub fn stage(&self, stage: usize) -> impl Iterator<Item = (usize, S)> {
        self.k.row(stage, self.states())
    }

    /// Takes the rates of a stage that `write` writes.
    pub fn set_stage(&mut self, stage: usize, write: impl FnOnce(&mut [S])) {
        write(&mut self.rate);
        self.k.set_row(stage, &self.rate);
    }

    /// Entry `i` of the linear combination of the stages, summed in their order.
    pub fn combine(&self, row: Row, i: usize) -> S {
        combined(&self.k.groups()[i / W].1, row)[i % W]
    }

    /// The difference of state `i` to the embedded method, per s.
    pub fn difference(&self, i: usize) -> S {
        let [error, other] = [T::ERROR, T::OTHER_ERROR].map(|row| self.combine(row, i));
        if other.abs() > error.abs() { other } else { error }
    }

    /// Writes the linear combinations of the stages for all states, times `h`.
    pub fn write(&self, row: Row, h: S, out: &mut [S]) {
        for ((_, k), out) in self.k.groups().iter().zip(out.chunks_mut(W)) {
            out.iter_mut().zip(combined(k, row)).for_each(|(out, sum)| *out = sum * h);
        }
    }

    /// Evaluates these stages, whose states `completed` completes. Their sums are written out, so that each finds its
    /// weights as constants; the rate stands there once, which is less to compile and takes no longer.
    #[inline(always)]
    pub fn evaluate(
        &mut self,
        rates: &impl Rates<S>,
        from: &Begin<'_, S>,
        stages: Range<usize>,
        completed: &mut impl Complete<S>,
    ) {
        self.start.copy_from_slice(from.x);
        for stage in stages {
            self.move_to(stage, from.h);
            completed.complete(stage, &mut self.x);
            let t = from.t + from.h.times(T::C[stage]);
            rates.inlined_rate(t, &self.x, &mut self.rate);
            self.k.set_row(stage, &self.rate);
        }
    }

    /// The state of a stage of the last step, of size `h`.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn state(&mut self, stage: usize, h: S) -> &[S] {
        if stage == 0 {
            return &self.start;
        }
        self.move_to(stage, h);
        &self.x
    }

    /// Moves the state on from the start to a stage that comes after it.
    #[inline(always)]
    fn move_to(&mut self, stage: usize, h: S) {
        let Self { k, x, start, .. } = self;
        macro_rules! written_out {
            ($($stage:literal)*) => {
                match stage {
                    $( $stage if $stage < T::A.len() => {
                        for (first, k) in k.groups() {
                            let (from_start, mut to) = (start.group(*first), combined(k, T::A[$stage]));
                            for i in 0..W {
                                to[i] = from_start[i] + h * to[i];
                            }
                            x.set_group(*first, to);
                        }
                    } )*
                    _ => unreachable!("a tableau has fewer stages than there is room for"),
                }
            };
        }
        written_out!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    }

    /// The rates at the start of a step.
    #[inline(always)]
    pub fn begin(&mut self, rate: &[S]) {
        self.rate.copy_from_slice(rate);
        self.k.set_row(0, &self.rate);
    }

    /// Writes the state at the end of a step; gives the largest of the differences to each of the embedded methods, in
    /// parts of what is allowed and per s: without a second one, zero.
    #[inline(always)]
    pub fn step(
        &mut self,
        rates: &impl Rates<S>,
        from: &Begin<'_, S>,
        scale: &Scale<S>,
        sum: &mut CompensatedSum<S, W>,
        end: &mut [S],
    ) -> [S; 2] {
        self.begin(from.rate);
        self.evaluate(rates, from, 1..T::END, &mut ());
        self.absolute.copy_from_slice(&scale.absolute);
        let Self { k, start, end: reached, absolute, differences: [of_first, of_second], .. } = self;
        for (first, k) in k.groups() {
            let (start, absolute) = (start.group(*first), absolute.group(*first));
            let slopes = combined(k, T::B);
            let mut to = start;
            if T::IS_COMPENSATED {
                let before = sum.start.group(*first);
                let mut lost = before;
                for i in 0..W {
                    (to[i], lost[i]) = compensated(start[i], from.h * slopes[i], before[i]);
                }
                sum.end.set_group(*first, lost);
            } else {
                for i in 0..W {
                    to[i] = start[i] + from.h * slopes[i];
                }
            }
            reached.set_group(*first, to);
            let mut allowed = to;
            for i in 0..W {
                allowed[i] = scale.allowed_from(absolute[i], start[i], to[i]);
            }
            let mut errors = combined(k, T::ERROR);
            if !T::OTHER_ERROR.is_empty() {
                let others = combined(k, T::OTHER_ERROR);
                for i in 0..W {
                    errors[i] = others[i].abs().larger(errors[i].abs());
                }
            }
            for i in 0..W {
                errors[i] = (errors[i] / allowed[i]).abs();
            }
            of_first.set_group(*first, errors);
            if !T::SECOND.is_empty() {
                let mut errors = combined(k, T::SECOND);
                for i in 0..W {
                    errors[i] = ((slopes[i] - errors[i]) / allowed[i]).abs();
                }
                of_second.set_group(*first, errors);
            }
        }
        end.copy_from_slice(reached);
        let second = if T::SECOND.is_empty() { from.h.alike(0.0) } else { largest(of_second) };
        [largest(of_first), second]
    }
}

impl<T, S: Scalar, const W: usize> Stages<T, S, W> {
    /// Writes the linear combinations of the stages by these rows into the state at the end and into both differences.
    #[inline(always)]
    pub fn write_rows(&mut self, [of_end, first, second]: [Row; 3]) {
        let Self { k, end, differences: [of_first, of_second], .. } = self;
        for (at, k) in k.groups() {
            end.set_group(*at, combined(k, of_end));
            of_first.set_group(*at, combined(k, first));
            of_second.set_group(*at, combined(k, second));
        }
    }
}

/// The linear combinations of the stages `k` of a group by a row, each summed in its order.
#[inline(always)]
fn combined<S: Scalar, const W: usize>(k: &[[S; W]; STAGES], row: Row) -> [S; W] {
    // Adding to -0 changes nothing, not even the sign of a zero.
    let mut sums = [k[0][0].alike(-0.0); W];
    for (stage, weight) in row {
        for i in 0..W {
            sums[i] = sums[i] + k[*stage][i].times(*weight);
        }
    }
    sums
}
