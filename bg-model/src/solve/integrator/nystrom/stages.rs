//! The stages of a Runge-Kutta-Nystrom step, of one run or of several side by side.
//!
//! In: the start of a step, what gives forces. Out: the state at its end and what it errs by. The numbers of runs side
//! by side are those of each by itself, to the bit.

use core::ops::Range;

use super::tableau::{DENSE, FIRST, INSTANTS, SECOND, STAGES};
use crate::model::scalar::Scalar;
use crate::solve::integrator::Scale;
use crate::solve::integrator::dense::FROM_ENDS;
use crate::solve::integrator::side_by_side::{Padded, Stack, put, some};
use crate::solve::integrator::steps::{Begin, Forces};
use crate::solve::integrator::tolerances::largest;

/// Behind the rows of the stages: those of the state at the end, and of the error estimate.
pub(super) const END: usize = STAGES;
pub(super) const ERROR: usize = STAGES + 1;
/// In their places among the numbers of a group: the state at the start of the step, and its rate.
const START: usize = STAGES + 1;
const RATE: usize = STAGES + 2;
const ROWS: usize = STAGES + 3;

/// The second derivatives of the states of second order and the rates of the others, at the stages and at the end, and
/// the start of the step, with room for what steps need beside them: in groups of `W` states of one order.
#[derive(Clone, Debug)]
pub(crate) struct Stages<S, const W: usize> {
    k: Stack<S, W, ROWS>,
    /// The states of second order.
    pub(super) second: Range<usize>,
    /// The state of a stage, or at the end of the step, and the forces of the stage before it.
    x: Padded<S, W>,
    force: Padded<S, W>,
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

    /// Writes coefficient `m` behind those of the ends of the dense output of a step of size `h` (s), whose forces at
    /// its end are known. Of states of second order it makes the polynomial of degree 5 through the second derivatives
    /// at both ends, too.
    pub fn write_dense(&self, m: usize, h: S, ends: &[Padded<S, W>; FROM_ENDS], out: &mut Padded<S, W>) {
        let half = h.times(0.5) * h;
        for (first, k) in self.k.groups() {
            let mut group = [h; W];
            if self.second.contains(first) {
                let [_, first, third] = ends.each_ref().map(|coefficient| coefficient.group(*first));
                for i in 0..W {
                    let at_start = half * k[0][i] + first[i] - third[i];
                    let at_end = half * k[END][i] + first[i] + third[i].times(2.0) - at_start;
                    group[i] = if m == 0 { at_start } else { at_end };
                }
            } else {
                let sums = combined(k, &DENSE[m]);
                for i in 0..W {
                    group[i] = sums[i] * h;
                }
            }
            out.set_group(*first, group);
        }
    }

    /// Makes groups for these states of second order, where they are others than before.
    pub fn arrange(&mut self, second: Range<usize>) {
        if self.second != second {
            let ranges = [0..second.start, second.clone(), second.end..self.states()];
            self.k.arrange(ranges, S::from_f64(0.0));
            self.second = second;
        }
    }

    /// Evaluates the stages, but takes no forces of the last one. Their sums are written out, so that each finds its
    /// weights as constants.
    #[inline(always)]
    fn evaluate(&mut self, forces: &impl Forces<S>, from: &Begin<'_, S>) {
        self.x.copy_from_slice(from.x);
        self.force.copy_from_slice(from.rate);
        for (first, k) in self.k.groups_mut() {
            (k[START], k[RATE]) = (self.x.group(*first), self.force.group(*first));
        }
        forces.at_start(from.x, &mut self.force);
        for (stage, c) in INSTANTS.iter().enumerate().skip(1) {
            macro_rules! written_out {
                ($($stage:literal)*) => {
                    match stage {
                        $( $stage => {
                            let Self { k, second, x, force, .. } = self;
                            let [force, x] = Padded::with_room([force, x]);
                            for (first, k) in k.groups_mut() {
                                let instant = [from.h.alike(*c), from.h];
                                let forces = (k, some(force, *first));
                                put(x, *first, reached::<S, W, $stage>(forces, second.contains(first), instant));
                            }
                        } )*
                        _ => unreachable!("a step has nine stages"),
                    }
                };
            }
            written_out!(1 2 3 4 5 6 7 8);
            forces.at_stage(from.t + from.h.times(*c), &self.x, &mut self.force);
        }
    }

    /// Writes the state at the end of a step of states that are arranged; gives the largest difference to the embedded
    /// method in parts of what is allowed.
    #[inline(always)]
    pub fn step(&mut self, forces: &impl Forces<S>, from: &Begin<'_, S>, scale: &Scale<S>, end: &mut [S]) -> S {
        self.evaluate(forces, from);
        self.absolute.copy_from_slice(&scale.absolute);
        let Self { k, second, x, force, absolute, errors, .. } = self;
        let [x, force, absolute, errors] = Padded::with_room([x, force, absolute, errors]);
        let h = from.h;
        for (first, k) in k.groups_mut() {
            let is_second = second.contains(first);
            let to = reached::<S, W, END>((k, some(force, *first)), is_second, [h.alike(1.0), h]);
            put(x, *first, to);
            let absolute: [S; W] = some(absolute, *first);
            let mut error = if is_second { combined(k, SECOND[ERROR]) } else { combined(k, FIRST[ERROR]) };
            for i in 0..W {
                error[i] = h * error[i];
                error[i] = if is_second { h * error[i] } else { error[i] };
                error[i] = (error[i] / scale.allowed_from(absolute[i], k[START][i], to[i])).abs();
            }
            put(errors, *first, error);
        }
        end.copy_from_slice(&self.x);
        largest(&self.errors)
    }
}

/// The states of a row at the instant `c` of the step, of a group that takes the forces of the stage before it. A group
/// may end in states of the next order, which come after it.
#[inline(always)]
fn reached<S: Scalar, const W: usize, const ROW: usize>(
    (k, forces): (&mut [[S; W]; ROWS], [S; W]),
    is_second: bool,
    [c, h]: [S; 2],
) -> [S; W] {
    k[ROW - 1] = forces;
    let (start, rate) = (k[START], k[RATE]);
    let mut to = start;
    if is_second {
        let sums = combined(k, SECOND[ROW]);
        for i in 0..W {
            to[i] = start[i] + h * (rate[i] * c + h * sums[i]);
        }
    } else {
        let sums = combined(k, FIRST[ROW]);
        for i in 0..W {
            to[i] = start[i] + h * sums[i];
        }
    }
    to
}

/// The sums of the stages of a group.
#[inline(always)]
fn combined<S: Scalar, const W: usize>(k: &[[S; W]; ROWS], weights: &[f64]) -> [S; W] {
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
