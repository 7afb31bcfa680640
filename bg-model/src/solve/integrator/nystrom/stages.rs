//! The stages of a Runge-Kutta-Nystrom step, of one run or of several side by side.
//!
//! In: the start of a step, what gives forces. Out: the state at its end and what it errs by. The numbers of runs side by side
//! are those of each by itself, to the bit.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::tableau::{FIRST, INSTANTS, SECOND, STAGES};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::side_by_side::{OfEach, for_each, put, some};
use crate::solve::integrator::steps::{Begin, Forces};
use crate::solve::integrator::tolerances::largest;

/// Behind the rows of the stages: those of the state at the end, and of the error estimate.
pub(super) const END: usize = STAGES;
pub(super) const ERROR: usize = STAGES + 1;

/// The second derivatives of the states of second order and the rates of the others, at the stages and at the end, with room for what steps
/// need beside them.
#[derive(Clone, Debug)]
pub(crate) struct Stages<S> {
    pub(super) k: [Vec<S>; STAGES + 1],
    /// The state of a stage.
    x: Vec<S>,
    /// The magnitudes of the differences to the embedded method in parts of what is allowed.
    pub(super) errors: Vec<S>,
}

impl<S: Scalar> Stages<S> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let room = || vec![S::from_f64(0.0); states];
        Self { k: core::array::from_fn(|_| room()), x: room(), errors: room() }
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.x.len()
    }

    /// Evaluates the stages. Their sums are written out, so that each finds its weights as constants.
    #[inline(always)]
    fn evaluate(&mut self, forces: &impl Forces<S>, second: &Range<usize>, from: &Begin<'_, S>) {
        let n = forces.states();
        self.k[0][..n].copy_from_slice(&from.rate[..n]);
        forces.at_start(from.x, &mut self.k[0]);
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            let x = &mut self.x[..n];
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => reach::<S, $stage>(&self.k, second, *c, from, x), )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            forces.at_stage(from.t + from.h.times(*c), x, &mut self.k[stage][..n]);
        }
    }

    /// Writes the state at the end of a step; gives the largest difference to the embedded method in parts of what is allowed.
    #[inline(always)]
    pub fn step(&mut self, forces: &impl Forces<S>, from: &Begin<'_, S>, scale: &Scale<S>, end: &mut [S]) -> S {
        let (second, n) = (&forces.second(), forces.states());
        self.evaluate(forces, second, from);
        let Self { k, errors, .. } = self;
        reach::<S, END>(k, second, 1.0, from, &mut end[..n]);
        let ends = [from.x, &*end];
        let mut each = |states: Range<usize>, is_second| {
            let (weights, h) = (if is_second { SECOND[ERROR] } else { FIRST[ERROR] }, from.h);
            let errors = &mut *errors;
            for_each::<S>(states.start, states.end, &mut Errors { k, weights, h, is_second, ends, scale, errors });
        };
        each(0..second.start, false);
        each(second.clone(), true);
        each(second.end..n, false);
        largest(&errors[..n])
    }
}

/// The sums of the stages, of `W` states from `first` on.
#[inline(always)]
fn combined<S: Scalar, const W: usize>(k: &[Vec<S>], weights: &[f64], first: usize) -> [S; W] {
    let mut sums: [S; W] = some(&k[0], first);
    for sum in &mut sums {
        *sum = sum.times(weights[0]);
    }
    for (k, &weight) in k[1..].iter().zip(&weights[1..]) {
        let rates: [S; W] = some(k, first);
        for i in 0..W {
            sums[i] = sums[i] + rates[i].times(weight);
        }
    }
    sums
}

/// Writes the state of a row at the instant `c` of the step.
#[inline(always)]
fn reach<S: Scalar, const ROW: usize>(k: &[Vec<S>], second: &Range<usize>, c: f64, from: &Begin<'_, S>, x: &mut [S]) {
    let n = x.len();
    for_each::<S>(0, second.start, &mut Reach::<S, ROW> { k, from, x });
    for_each::<S>(second.start, second.end, &mut ReachSecond::<S, ROW> { k, from, c, x });
    for_each::<S>(second.end, n, &mut Reach::<S, ROW> { k, from, x });
}

/// States of first order at a stage.
struct Reach<'a, S, const ROW: usize> {
    k: &'a [Vec<S>],
    from: &'a Begin<'a, S>,
    x: &'a mut [S],
}

impl<S: Scalar, const ROW: usize> OfEach for Reach<'_, S, ROW> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { k, from, x } = self;
        let (start, mut sums): ([S; W], [S; W]) = (some(from.x, first), combined(k, FIRST[ROW], first));
        for i in 0..W {
            sums[i] = start[i] + from.h * sums[i];
        }
        put(x, first, sums);
    }
}

/// States of second order at a stage, at the instant `c` of the step.
struct ReachSecond<'a, S, const ROW: usize> {
    k: &'a [Vec<S>],
    from: &'a Begin<'a, S>,
    c: f64,
    x: &'a mut [S],
}

impl<S: Scalar, const ROW: usize> OfEach for ReachSecond<'_, S, ROW> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { k, from, c, x } = self;
        let (start, rate): ([S; W], [S; W]) = (some(from.x, first), some(from.rate, first));
        let mut sums: [S; W] = combined(k, SECOND[ROW], first);
        for i in 0..W {
            sums[i] = start[i] + from.h * (rate[i].times(*c) + from.h * sums[i]);
        }
        put(x, first, sums);
    }
}

/// The magnitudes of errors in parts of what is allowed.
struct Errors<'a, S> {
    k: &'a [Vec<S>],
    weights: &'a [f64],
    h: S,
    is_second: bool,
    ends: [&'a [S]; 2],
    scale: &'a Scale<S>,
    errors: &'a mut [S],
}

impl<S: Scalar> OfEach for Errors<'_, S> {
    #[inline(always)]
    fn of<const W: usize>(&mut self, first: usize) {
        let Self { k, weights, h, is_second, ends: [start, end], scale, errors } = self;
        let (start, end, absolute): ([S; W], [S; W], [S; W]) =
            (some(start, first), some(end, first), some(&scale.absolute, first));
        let mut sums: [S; W] = combined(k, weights, first);
        for i in 0..W {
            let error = *h * sums[i];
            let error = if *is_second { *h * error } else { error };
            sums[i] = (error / scale.allowed_from(absolute[i], start[i], end[i])).abs();
        }
        put(errors, first, sums);
    }
}
