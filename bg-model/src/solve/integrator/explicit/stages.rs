//! The stages of a step by an explicit tableau, of one run or of several side by side.
//!
//! In: the start of a step, what gives rates. Out: the state at its end and what it errs by. The numbers of runs side by side are those of
//! each by itself, to the bit: operations stand in loops, since closures around vectors of a machine are calls.

use core::marker::PhantomData;
use core::ops::Range;

use nalgebra::SVector;

use super::{Row, Tableau};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::compensated::CompensatedSum;
use crate::solve::integrator::steps::{Begin, Rates};
use crate::solve::integrator::tolerances::largest;

/// The most stages of a method.
pub(super) const STAGES: usize = 16;

/// What a method adds to the states of an explicit one.
pub(crate) trait Complete<S, const N: usize> {
    /// Completes the state `x` of stage `stage`.
    fn complete(&mut self, stage: usize, x: &mut SVector<S, N>);
}

/// Nothing.
impl<S, const N: usize> Complete<S, N> for () {
    #[inline(always)]
    fn complete(&mut self, _stage: usize, _x: &mut SVector<S, N>) {}
}

/// The rates of all stages of tableau `T`.
#[derive(Clone, Debug)]
pub(crate) struct Stages<T, S, const N: usize> {
    pub k: [SVector<S, N>; STAGES],
    tableau: PhantomData<T>,
}

impl<T: Tableau, S: Scalar, const N: usize> Stages<T, S, N> {
    pub fn new() -> Self {
        Self { k: [SVector::from([S::from_f64(0.0); N]); STAGES], tableau: PhantomData }
    }

    /// Entry `i` of the linear combination of the stages, summed in their order.
    #[inline(always)]
    pub fn combine(&self, row: Row, i: usize) -> S {
        // Adding to -0 changes nothing, not even the sign of a zero.
        let mut sum = self.k[0].data.0[0][i].alike(-0.0);
        for (stage, weight) in row {
            sum = sum + self.k[*stage].data.0[0][i].times(*weight);
        }
        sum
    }

    /// Evaluates these stages, whose states `completed` completes. Their sums are written out, so that each finds its weights
    /// as constants; the rate stands there once, which is less to compile and takes no longer. It is called where not `IS_INLINED`.
    #[inline(always)]
    pub fn evaluate<const IS_INLINED: bool>(
        &mut self,
        rates: &impl Rates<S, N>,
        from: &Begin<'_, S, N>,
        stages: Range<usize>,
        completed: &mut impl Complete<S, N>,
    ) {
        let mut x = *from.x;
        for stage in stages {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage if $stage < T::A.len() => self.reach::<$stage>(from, &mut x), )*
                        _ => unreachable!("a tableau has fewer stages than there is room for"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
            completed.complete(stage, &mut x);
            let t = from.t + from.h.times(T::C[stage]);
            if IS_INLINED {
                rates.inlined_rate(t, &x, &mut self.k[stage]);
            } else {
                rates.rate(t, &x, &mut self.k[stage]);
            }
        }
    }

    /// Writes the state of a stage, without what completes it.
    #[inline(always)]
    fn reach<const STAGE: usize>(&self, from: &Begin<'_, S, N>, x: &mut SVector<S, N>) {
        let (start, x) = (&from.x.data.0[0], &mut x.data.0[0]);
        for i in 0..N {
            x[i] = start[i] + from.h * self.combine(T::A[STAGE], i);
        }
    }

    /// Writes the state at the end of a step; gives the largest of the differences to each of the embedded methods, in parts of what is
    /// allowed and per s: without a second one, zero.
    #[inline(always)]
    pub fn step(
        &mut self,
        rates: &impl Rates<S, N>,
        from: &Begin<'_, S, N>,
        scale: &Scale<N, S>,
        sum: &mut CompensatedSum<S, N>,
        end: &mut SVector<S, N>,
    ) -> [S; 2] {
        self.k[0] = *from.rate;
        self.evaluate::<true>(rates, from, 1..T::END, &mut ());
        let nothing = from.h.alike(0.0);
        let (mut first, mut second) = ([nothing; N], [nothing; N]);
        let start = &from.x.data.0[0];
        for i in 0..N {
            let slope = self.combine(T::B, i);
            let change = from.h * slope;
            let to = if T::IS_COMPENSATED { sum.add(i, start[i], change) } else { start[i] + change };
            end.data.0[0][i] = to;
            let allowed = scale.allowed_between(i, start[i], to);
            first[i] = (self.combine(T::ERROR, i) / allowed).abs();
            if !T::SECOND.is_empty() {
                second[i] = ((slope - self.combine(T::SECOND, i)) / allowed).abs();
            }
        }
        [largest(&first), if T::SECOND.is_empty() { nothing } else { largest(&second) }]
    }
}
