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
use crate::solve::integrator::compensated::CompensatedSum;
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
        combined(&rates_of(&self.k, row, self.states()), row, i)
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
                        $( $stage if $stage < T::A.len() => reach::<T, S, $stage>(&self.k, from, x), )*
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
        let (first, second) = (&mut first[..n], &mut second[..n]);
        let [b, error, other] = [T::B, T::ERROR, T::SECOND].map(|row| rates_of(k, row, n));
        let (start, end) = (&from.x[..n], &mut end[..n]);
        for i in 0..n {
            let slope = combined(&b, T::B, i);
            let change = from.h * slope;
            let to = if T::IS_COMPENSATED { sum.add(i, start[i], change) } else { start[i] + change };
            end[i] = to;
            let allowed = scale.allowed_between(i, start[i], to);
            first[i] = (combined(&error, T::ERROR, i) / allowed).abs();
            if !T::SECOND.is_empty() {
                second[i] = ((slope - combined(&other, T::SECOND, i)) / allowed).abs();
            }
        }
        [largest(first), if T::SECOND.is_empty() { from.h.alike(0.0) } else { largest(second) }]
    }
}

/// The rates of the stages of a row, of `n` states.
#[inline(always)]
fn rates_of<S>(k: &[Vec<S>], row: Row, n: usize) -> [&[S]; STAGES] {
    core::array::from_fn(|m| row.get(m).map_or(&[][..], |(stage, _)| &k[*stage][..n]))
}

/// The linear combination of these rates of state `i`, summed in their order.
#[inline(always)]
fn combined<S: Scalar>(rates: &[&[S]; STAGES], row: Row, i: usize) -> S {
    // Adding to -0 changes nothing, not even the sign of a zero.
    let mut sum = rates[0][i].alike(-0.0);
    for (rates, (_, weight)) in rates.iter().zip(row) {
        sum = sum + rates[i].times(*weight);
    }
    sum
}

/// Writes the state of a stage, without what completes it.
#[inline(always)]
fn reach<T: Tableau, S: Scalar, const STAGE: usize>(k: &[Vec<S>], from: &Begin<'_, S>, x: &mut [S]) {
    let n = x.len();
    let (start, rates) = (&from.x[..n], rates_of(k, T::A[STAGE], n));
    for i in 0..n {
        x[i] = start[i] + from.h * combined(&rates, T::A[STAGE], i);
    }
}

/// Writes the linear combinations of the stages `k` for all states.
#[inline(always)]
pub(crate) fn write_row(k: &[Vec<f64>], row: Row, out: &mut [f64]) {
    let rates = rates_of(k, row, out.len());
    for (i, out) in out.iter_mut().enumerate() {
        *out = combined(&rates, row, i);
    }
}
