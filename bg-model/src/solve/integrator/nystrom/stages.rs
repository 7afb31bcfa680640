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

/// The stages of `n` states, as far as sums go over them.
type Rates<'a, S> = [&'a [S]; STAGES];

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
                        $( $stage => reach::<S, $stage>(&rates_of(&self.k, $stage, n), second, *c, from, x), )*
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
    pub fn step(
        &mut self,
        forces: &impl Forces<S>,
        from: &Begin<'_, S>,
        scale: &Scale<S>,
        end: &mut [S],
    ) -> S {
        let (second, n) = (&forces.second(), forces.states());
        self.evaluate(forces, second, from);
        let Self { k, errors, .. } = self;
        let k = rates_of(k, STAGES, n);
        let (start, end, errors) = (&from.x[..n], &mut end[..n], &mut errors[..n]);
        reach::<S, END>(&k, second, 1.0, from, end);
        let h = from.h;
        for i in 0..second.start {
            errors[i] = part(h * combined(&k, FIRST[ERROR], i), scale.allowed_between(i, start[i], end[i]));
        }
        for i in second.clone() {
            errors[i] = part(h * (h * combined(&k, SECOND[ERROR], i)), scale.allowed_between(i, start[i], end[i]));
        }
        for i in second.end..n {
            errors[i] = part(h * combined(&k, FIRST[ERROR], i), scale.allowed_between(i, start[i], end[i]));
        }
        largest(errors)
    }
}

/// The first `count` stages, of `n` states; no others have a weight in their sums.
#[inline(always)]
fn rates_of<S>(k: &[Vec<S>; STAGES + 1], count: usize, n: usize) -> Rates<'_, S> {
    core::array::from_fn(|stage| if stage < count { &k[stage][..n] } else { &[] })
}

/// The sum of the stages for state `i`.
#[inline(always)]
fn combined<S: Scalar>(k: &Rates<'_, S>, weights: &[f64], i: usize) -> S {
    let mut sum = k[0][i].times(weights[0]);
    for (k, &weight) in k[1..].iter().zip(&weights[1..]) {
        sum = sum + k[i].times(weight);
    }
    sum
}

/// Writes the state of a row at the instant `c` of the step.
#[inline(always)]
fn reach<S: Scalar, const ROW: usize>(
    k: &Rates<'_, S>,
    second: &Range<usize>,
    c: f64,
    from: &Begin<'_, S>,
    x: &mut [S],
) {
    let n = x.len();
    let (start, rate) = (&from.x[..n], &from.rate[..n]);
    for i in 0..second.start {
        x[i] = start[i] + from.h * combined(k, FIRST[ROW], i);
    }
    for i in second.clone() {
        x[i] = start[i] + from.h * (rate[i].times(c) + from.h * combined(k, SECOND[ROW], i));
    }
    for i in second.end..n {
        x[i] = start[i] + from.h * combined(k, FIRST[ROW], i);
    }
}

/// The magnitude of an error in parts of what is allowed.
#[inline(always)]
fn part<S: Scalar>(error: S, allowed: S) -> S {
    (error / allowed).abs()
}
