//! The stages of a Runge-Kutta-Nystrom step, of one run or of several side by side.
//!
//! In: the start of a step, what gives forces. Out: the state at its end and what it errs by. The numbers of runs side by side
//! are those of each by itself, to the bit.

use core::ops::Range;

use nalgebra::SVector;

use super::tableau::{FIRST, INSTANTS, SECOND, STAGES};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::steps::{Begin, Forces};

/// Behind the rows of the stages: those of the state at the end, and of the error estimate.
pub(super) const END: usize = STAGES;
pub(super) const ERROR: usize = STAGES + 1;

/// Numbers of all states where vectors of the machine begin, so that none lies across two lines of its cache.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct Aligned<S, const N: usize>(pub SVector<S, N>);

/// The second derivatives of the states of second order and the rates of the others, at the stages and at the end.
#[derive(Clone, Debug)]
pub(crate) struct Stages<S, const N: usize> {
    pub(super) k: [Aligned<S, N>; STAGES + 1],
}

impl<S: Scalar, const N: usize> Stages<S, N> {
    pub fn new() -> Self {
        Self { k: [Aligned(SVector::from([S::from_f64(0.0); N])); STAGES + 1] }
    }

    /// The sum of the stages for state `i`.
    #[inline(always)]
    fn combine(&self, weights: &[f64], i: usize) -> S {
        let mut sum = self.k[0].0.data.0[0][i].times(weights[0]);
        for (k, &weight) in self.k[1..].iter().zip(&weights[1..]) {
            sum = sum + k.0.data.0[0][i].times(weight);
        }
        sum
    }

    /// Writes the state of a row at the instant `c` of the step.
    #[inline(always)]
    fn reach<const ROW: usize>(&self, second: &Range<usize>, c: f64, from: &Begin<'_, S, N>, x: &mut SVector<S, N>) {
        let (start, rate, x) = (&from.x.data.0[0], &from.rate.data.0[0], &mut x.data.0[0]);
        for i in 0..second.start {
            x[i] = start[i] + from.h * self.combine(FIRST[ROW], i);
        }
        for i in second.clone() {
            x[i] = start[i] + from.h * (rate[i].times(c) + from.h * self.combine(SECOND[ROW], i));
        }
        for i in second.end..N {
            x[i] = start[i] + from.h * self.combine(FIRST[ROW], i);
        }
    }

    /// Evaluates the stages. Their sums are written out, so that each finds its weights as constants.
    #[inline(always)]
    fn evaluate(&mut self, forces: &impl Forces<S, N>, second: &Range<usize>, from: &Begin<'_, S, N>) {
        let mut x = *from.x;
        self.k[0].0 = *from.rate;
        forces.at_start(&x, &mut self.k[0].0);
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => self.reach::<$stage>(second, *c, from, &mut x), )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            forces.at_stage(from.t + from.h.times(*c), &x, &mut self.k[stage].0);
        }
    }

    /// The state at the end of a step, and the magnitudes of the differences to the embedded method in parts of what is allowed.
    #[inline(always)]
    pub fn step(
        &mut self,
        forces: &impl Forces<S, N>,
        from: &Begin<'_, S, N>,
        scale: &Scale<N, S>,
        end: &mut SVector<S, N>,
    ) -> [S; N] {
        let second = &forces.second();
        self.evaluate(forces, second, from);
        self.reach::<END>(second, 1.0, from, end);
        let h = from.h;
        let (start, reached) = (&from.x.data.0[0], &end.data.0[0]);
        let mut errors = [h.alike(0.0); N];
        for i in 0..second.start {
            errors[i] = part(h * self.combine(FIRST[ERROR], i), scale.allowed_between(i, start[i], reached[i]));
        }
        for i in second.clone() {
            errors[i] = part(h * (h * self.combine(SECOND[ERROR], i)), scale.allowed_between(i, start[i], reached[i]));
        }
        for i in second.end..N {
            errors[i] = part(h * self.combine(FIRST[ERROR], i), scale.allowed_between(i, start[i], reached[i]));
        }
        errors
    }
}

/// The magnitude of an error in parts of what is allowed.
#[inline(always)]
fn part<S: Scalar>(error: S, allowed: S) -> S {
    (error / allowed).abs()
}
