//! The stages of a Runge-Kutta-Nystrom step, of one run or of several side by side.
//!
//! In: the start of a step, what gives forces. Out: the state at its end and what it errs by. The numbers of runs side
//! by side are those of each by itself, to the bit.

use core::ops::Range;

use super::tableau::{FIRST, INSTANTS, SECOND, STAGES};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::side_by_side::{Padded, Stack};
use crate::solve::integrator::steps::{Begin, Forces};
use crate::solve::integrator::tolerances::largest;

/// Behind the rows of the stages: those of the state at the end, and of the error estimate.
pub(super) const END: usize = STAGES;
pub(super) const ERROR: usize = STAGES + 1;

/// The second derivatives of the states of second order and the rates of the others, at the stages and at the end, with
/// room for what steps need beside them: in groups of `W` states of one order.
#[derive(Clone, Debug)]
pub(crate) struct Stages<S, const W: usize> {
    k: Stack<S, W, { STAGES + 1 }>,
    /// The states of second order.
    pub(super) second: Range<usize>,
    /// The state of a stage and its forces; the states at the start and at the end of the step, the rates at its start.
    x: Padded<S, W>,
    force: Padded<S, W>,
    start: Padded<S, W>,
    rate: Padded<S, W>,
    end: Padded<S, W>,
    /// The absolute tolerances.
    absolute: Padded<S, W>,
    /// The magnitudes of the differences to the embedded method in parts of what is allowed.
    pub(super) errors: Padded<S, W>,
}

impl<S: Scalar, const W: usize> Stages<S, W> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        let (zero, one) = (S::from_f64(0.0), S::from_f64(1.0));
        let room = || Padded::new(states, zero);
        Self {
            k: Stack::new(states, 2, zero),
            second: 0..0,
            x: room(),
            force: room(),
            start: room(),
            rate: room(),
            end: room(),
            absolute: Padded::new(states, one),
            errors: room(),
        }
    }

    /// The number of states.
    pub fn states(&self) -> usize {
        self.x.len()
    }

    /// The second derivatives, or rates, of a stage, each with its state.
    pub fn stage(&self, stage: usize) -> impl Iterator<Item = (usize, S)> {
        self.k.row(stage, self.states())
    }

    /// Takes those of a stage that `write` writes.
    pub fn set_stage(&mut self, stage: usize, write: impl FnOnce(&mut [S])) {
        write(&mut self.force);
        self.k.set_row(stage, &self.force);
    }

    /// Writes the sums of the stages by these weights, times `h`.
    pub fn write(&self, weights: &[f64], h: S, out: &mut [S]) {
        out.fill(h.alike(-0.0));
        for (stage, weight) in weights.iter().enumerate() {
            self.stage(stage).for_each(|(state, rate)| out[state] = out[state] + rate.times(*weight));
        }
        out.iter_mut().for_each(|out| *out = *out * h);
    }

    /// The second derivatives at both ends of the step, each with its state.
    pub fn ends(&self) -> impl Iterator<Item = (usize, [S; 2])> {
        let both = self.stage(0).zip(self.stage(END)).map(|((state, before), (_, behind))| (state, [before, behind]));
        both.filter(|(state, _)| self.second.contains(state))
    }

    /// Makes groups for these states of second order, where they are others than before.
    pub fn arrange(&mut self, second: Range<usize>) {
        if self.second != second {
            let ranges = [0..second.start, second.clone(), second.end..self.states()];
            self.k.arrange(ranges, S::from_f64(0.0));
            self.second = second;
        }
    }

    /// Evaluates the stages. Their sums are written out, so that each finds its weights as constants.
    #[inline(always)]
    fn evaluate(&mut self, forces: &impl Forces<S>, from: &Begin<'_, S>) {
        self.start.copy_from_slice(from.x);
        self.rate.copy_from_slice(from.rate);
        self.force.copy_from_slice(from.rate);
        forces.at_start(from.x, &mut self.force);
        self.k.set_row(0, &self.force);
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => {
                            let Self { k, second, x, start, rate, .. } = self;
                            reach::<S, W, $stage>(k, second, (start, rate), [from.h.alike(*c), from.h], x);
                        } )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            forces.at_stage(from.t + from.h.times(*c), &self.x, &mut self.force);
            self.k.set_row(stage, &self.force);
        }
    }

    /// Writes the state at the end of a step of states that are arranged; gives the largest difference to the embedded
    /// method in parts of what is allowed.
    #[inline(always)]
    pub fn step(&mut self, forces: &impl Forces<S>, from: &Begin<'_, S>, scale: &Scale<S>, end: &mut [S]) -> S {
        self.evaluate(forces, from);
        self.absolute.copy_from_slice(&scale.absolute);
        let Self { k, second, start, rate, end: reached, absolute, errors, .. } = self;
        let h = from.h;
        reach::<S, W, END>(k, second, (start, rate), [h.alike(1.0), h], reached);
        for (first, k) in k.groups() {
            let (start, to, absolute) = (start.group(*first), reached.group(*first), absolute.group(*first));
            let is_second = second.contains(first);
            let mut error = if is_second { combined(k, SECOND[ERROR]) } else { combined(k, FIRST[ERROR]) };
            for i in 0..W {
                error[i] = h * error[i];
                error[i] = if is_second { h * error[i] } else { error[i] };
                error[i] = (error[i] / scale.allowed_from(absolute[i], start[i], to[i])).abs();
            }
            errors.set_group(*first, error);
        }
        end.copy_from_slice(reached);
        largest(errors)
    }
}

/// Writes the state of a row at the instant `c` of the step. A group may end in states of the next order, which come
/// after it.
#[inline(always)]
fn reach<S: Scalar, const W: usize, const ROW: usize>(
    k: &Stack<S, W, { STAGES + 1 }>,
    second: &Range<usize>,
    (start, rate): (&Padded<S, W>, &Padded<S, W>),
    [c, h]: [S; 2],
    x: &mut Padded<S, W>,
) {
    for (first, k) in k.groups() {
        let start = start.group(*first);
        let mut to = start;
        if second.contains(first) {
            let (rate, sums) = (rate.group(*first), combined(k, SECOND[ROW]));
            for i in 0..W {
                to[i] = start[i] + h * (rate[i] * c + h * sums[i]);
            }
        } else {
            let sums = combined(k, FIRST[ROW]);
            for i in 0..W {
                to[i] = start[i] + h * sums[i];
            }
        }
        x.set_group(*first, to);
    }
}

/// The sums of the stages of a group.
#[inline(always)]
fn combined<S: Scalar, const W: usize>(k: &[[S; W]; STAGES + 1], weights: &[f64]) -> [S; W] {
    let mut sums = k[0];
    for sum in &mut sums {
        *sum = sum.times(weights[0]);
    }
    for (k, &weight) in k[1..].iter().zip(&weights[1..]) {
        for i in 0..W {
            sums[i] = sums[i] + k[i].times(weight);
        }
    }
    sums
}
