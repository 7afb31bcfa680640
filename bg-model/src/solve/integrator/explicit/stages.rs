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
use crate::solve::integrator::side_by_side::{Padded, Stack, put, some};
use crate::solve::integrator::steps::{Begin, Rates};
use crate::solve::integrator::tolerances::largest;

/// The most stages of a method.
pub(super) const STAGES: usize = 16;
/// In its place among the numbers of a group: the state at the start of the step.
const START: usize = STAGES;
const ROWS: usize = STAGES + 1;

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

/// The rates of all stages of tableau `T` and the start of the step, with room for what steps need beside them: in
/// groups of `W` states.
#[derive(Clone, Debug)]
pub(crate) struct Stages<T, S, const W: usize> {
    k: Stack<S, W, ROWS>,
    /// The state of a stage and the rate of the one before it; the state at the end of the step.
    x: Padded<S, W>,
    rate: Padded<S, W>,
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
    pub fn write(&self, row: Row, h: S, out: &mut Padded<S, W>) {
        for (first, k) in self.k.groups() {
            let mut group = combined(k, row);
            for sum in &mut group {
                *sum = *sum * h;
            }
            out.set_group(*first, group);
        }
    }

    /// Evaluates these stages behind the one whose rates were taken last; `completed` completes their states. Their
    /// sums are written out, so that each finds its weights as constants; the rate stands there once, which is less to
    /// compile and takes no longer.
    #[inline(always)]
    pub fn evaluate(
        &mut self,
        rates: &impl Rates<S>,
        from: &Begin<'_, S>,
        stages: Range<usize>,
        completed: &mut impl Complete<S>,
    ) {
        self.x.copy_from_slice(from.x);
        self.k.set_row(START, &self.x);
        let last = stages.end - 1;
        for stage in stages {
            self.move_to::<true>(stage, from.h);
            completed.complete(stage, &mut self.x);
            let t = from.t + from.h.times(T::C[stage]);
            rates.inlined_rate(t, &self.x, &mut self.rate);
        }
        self.k.set_row(last, &self.rate);
    }

    /// The state of a stage of the last step, of size `h`.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn state(&mut self, stage: usize, h: S) -> &[S] {
        if stage == 0 {
            self.k.groups().iter().for_each(|(first, k)| self.x.set_group(*first, k[START]));
        } else {
            self.move_to::<false>(stage, h);
        }
        &self.x
    }

    /// Moves the state on from the start to a stage that comes after it, and takes the rates of the one before it if it
    /// has to.
    #[inline(always)]
    fn move_to<const TAKES: bool>(&mut self, stage: usize, h: S) {
        let [x, rate] = Padded::with_room([&mut self.x, &mut self.rate]);
        macro_rules! written_out {
            ($($stage:literal)*) => {
                match stage {
                    $( $stage if $stage < T::A.len() => {
                        for (first, k) in self.k.groups_mut() {
                            if TAKES {
                                k[$stage - 1] = some(rate, *first);
                            }
                            let (start, mut to) = (k[START], combined(k, T::A[$stage]));
                            for i in 0..W {
                                to[i] = start[i] + h * to[i];
                            }
                            put(x, *first, to);
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
        let Self { k, end: reached, absolute, differences: [of_first, of_second], .. } = self;
        let [reached, absolute, of_first, of_second] = Padded::with_room([reached, absolute, of_first, of_second]);
        for (first, k) in k.groups() {
            let (start, absolute): (_, [S; W]) = (k[START], some(absolute, *first));
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
            put(reached, *first, to);
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
            put(of_first, *first, errors);
            if !T::SECOND.is_empty() {
                let mut errors = combined(k, T::SECOND);
                for i in 0..W {
                    errors[i] = ((slopes[i] - errors[i]) / allowed[i]).abs();
                }
                put(of_second, *first, errors);
            }
        }
        end.copy_from_slice(&self.end);
        let [first, second] = &self.differences;
        [largest(first), if T::SECOND.is_empty() { from.h.alike(0.0) } else { largest(second) }]
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
fn combined<S: Scalar, const W: usize>(k: &[[S; W]; ROWS], row: Row) -> [S; W] {
    // Adding to -0 changes nothing, not even the sign of a zero.
    let mut sums = [k[0][0].alike(-0.0); W];
    for (stage, weight) in row {
        for i in 0..W {
            sums[i] = sums[i] + k[*stage][i].times(*weight);
        }
    }
    sums
}
