//! The stages of a step by an explicit tableau, of one run or of several side by side.
//!
//! In: the start of a step, what gives rates. Out: the state at its end and what it errs by. The numbers of runs side by side are those of
//! each by itself, to the bit: operations stand in loops, since closures around vectors of a machine are calls.

use alloc::vec;
use alloc::vec::Vec;
use core::marker::PhantomData;
use core::ops::Range;

use super::{Row, Tableau};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::compensated::{CompensatedSum, compensated};
use crate::solve::integrator::side_by_side::{OfEach, for_each, put, some};
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

/// The rates of all stages of tableau `T`, with room for what steps need beside them.
#[derive(Clone, Debug)]
pub(crate) struct Stages<T, S> {
    pub k: [Vec<S>; STAGES],
    /// The state of a stage.
    x: Vec<S>,
    /// The differences to the embedded methods in parts of what is allowed.
    differences: [Vec<S>; 2],
    tableau: PhantomData<T>,
}

impl<T: Tableau, S: Scalar> Stages<T, S> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let room = || vec![S::from_f64(0.0); states];
        Self {
            k: core::array::from_fn(|_| room()),
            x: room(),
            differences: core::array::from_fn(|_| room()),
            tableau: PhantomData,
        }
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.x.len()
    }

    /// Entry `i` of the linear combination of the stages, summed in their order.
    #[inline(always)]
    pub fn combine(&self, row: Row, i: usize) -> S {
        let [sum] = combined(&self.k, row, i);
        sum
    }

    /// Evaluates these stages, whose states `completed` completes. Their sums are written out, so that each finds its weights
    /// as constants; the rate stands there once, which is less to compile and takes no longer. It is called where not `IS_INLINED`.
    #[inline(always)]
    pub fn evaluate<const IS_INLINED: bool>(
        &mut self,
        rates: &impl Rates<S>,
        from: &Begin<'_, S>,
        stages: Range<usize>,
        completed: &mut impl Complete<S>,
    ) {
        let n = rates.states();
        for stage in stages {
            let x = &mut self.x[..n];
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage if $stage < T::A.len() => {
                            let (k, start, h, tableau) = (&self.k, &from.x[..n], from.h, PhantomData);
                            for_each::<S>(0, n, &mut Reach::<T, S, $stage> { k, h, start, x, tableau });
                        } )*
                        _ => unreachable!("a tableau has fewer stages than there is room for"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
            completed.complete(stage, x);
            let t = from.t + from.h.times(T::C[stage]);
            if IS_INLINED {
                rates.inlined_rate(t, x, &mut self.k[stage][..n]);
            } else {
                rates.rate(t, x, &mut self.k[stage][..n]);
            }
        }
    }

    /// Writes the state at the end of a step; gives the largest of the differences to each of the embedded methods, in parts of what is
    /// allowed and per s: without a second one, zero.
    #[inline(always)]
    pub fn step(
        &mut self,
        rates: &impl Rates<S>,
        from: &Begin<'_, S>,
        scale: &Scale<S>,
        sum: &mut CompensatedSum<S>,
        end: &mut [S],
    ) -> [S; 2] {
        let n = rates.states();
        self.k[0][..n].copy_from_slice(&from.rate[..n]);
        self.evaluate::<true>(rates, from, 1..T::END, &mut ());
        let Self { k, differences: [first, second], .. } = self;
        let (start, end) = (&from.x[..n], &mut end[..n]);
        let (h, differences, tableau) = (from.h, [&mut first[..], &mut second[..]], PhantomData::<T>);
        for_each::<S>(0, n, &mut End { k, h, start, scale, sum, end, differences, tableau });
        let second = if T::SECOND.is_empty() { from.h.alike(0.0) } else { largest(&second[..n]) };
        [largest(&first[..n]), second]
    }
}

/// The state at the end of a step, and its differences to the embedded methods.
struct End<'a, T, S> {
    k: &'a [Vec<S>; STAGES],
    h: S,
    start: &'a [S],
    scale: &'a Scale<S>,
    sum: &'a mut CompensatedSum<S>,
    end: &'a mut [S],
    differences: [&'a mut [S]; 2],
    tableau: PhantomData<T>,
}

impl<T: Tableau, S: Scalar> OfEach for End<'_, T, S> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { k, h, start, scale, sum, end, differences: [of_first, of_second], .. } = self;
        let start: [S; W] = some(start, first);
        let absolute: [S; W] = some(&scale.absolute, first);
        let slopes: [S; W] = combined(*k, T::B, first);
        let mut to = start;
        if T::IS_COMPENSATED {
            let (mut lost, before): ([S; W], [S; W]) = (to, some(&sum.start, first));
            for i in 0..W {
                (to[i], lost[i]) = compensated(start[i], *h * slopes[i], before[i]);
            }
            put(&mut sum.end, first, lost);
        } else {
            for i in 0..W {
                to[i] = start[i] + *h * slopes[i];
            }
        }
        put(end, first, to);
        let mut allowed = to;
        for i in 0..W {
            allowed[i] = scale.allowed_from(absolute[i], start[i], to[i]);
        }
        let mut errors: [S; W] = combined(*k, T::ERROR, first);
        for i in 0..W {
            errors[i] = (errors[i] / allowed[i]).abs();
        }
        put(of_first, first, errors);
        if !T::SECOND.is_empty() {
            let mut errors: [S; W] = combined(*k, T::SECOND, first);
            for i in 0..W {
                errors[i] = ((slopes[i] - errors[i]) / allowed[i]).abs();
            }
            put(of_second, first, errors);
        }
    }
}

/// The state of a stage, without what completes it.
struct Reach<'a, T, S, const STAGE: usize> {
    k: &'a [Vec<S>; STAGES],
    h: S,
    start: &'a [S],
    x: &'a mut [S],
    tableau: PhantomData<T>,
}

impl<T: Tableau, S: Scalar, const STAGE: usize> OfEach for Reach<'_, T, S, STAGE> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { k, h, start, x, .. } = self;
        let (start, mut sums): ([S; W], [S; W]) = (some(start, first), combined(*k, T::A[STAGE], first));
        for i in 0..W {
            sums[i] = start[i] + *h * sums[i];
        }
        put(x, first, sums);
    }
}

/// The linear combinations of the stages `k` by a row, each summed in its order, of `W` states from `first` on.
#[inline(always)]
fn combined<S: Scalar, const W: usize>(k: &[Vec<S>], row: Row, first: usize) -> [S; W] {
    // Adding to -0 changes nothing, not even the sign of a zero.
    let mut sums = [k[0][first].alike(-0.0); W];
    for (stage, weight) in row {
        let rates: [S; W] = some(&k[*stage], first);
        for i in 0..W {
            sums[i] = sums[i] + rates[i].times(*weight);
        }
    }
    sums
}

/// Writes the linear combinations of the stages `k` for all states.
#[inline(always)]
pub(crate) fn write_row(k: &[Vec<f64>], row: Row, out: &mut [f64]) {
    for_each::<f64>(0, out.len(), &mut Written { k, row, out });
}

/// Linear combinations of the stages.
struct Written<'a> {
    k: &'a [Vec<f64>],
    row: Row,
    out: &'a mut [f64],
}

impl OfEach for Written<'_> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let sums: [f64; W] = combined(self.k, self.row, first);
        put(self.out, first, sums);
    }
}
