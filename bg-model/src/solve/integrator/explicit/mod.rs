//! Explicit Runge-Kutta methods with an error estimate and a dense output: one core for all tableaus.
//!
//! In: a tableau and a step. Out: the state after it with an error estimate from embedded methods, and on request the
//! states in between. Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, sections
//! II.1, II.4 and II.6; the tableaus name theirs.

mod bs5;
mod cfmr7;
mod dop853;
#[cfg(test)]
mod estimate;
mod halves;
#[cfg(feature = "std")]
mod lanes;
#[cfg(test)]
mod order;
mod stages;
#[cfg(feature = "std")]
mod transposed;
#[cfg(test)]
mod vectors;

pub use bs5::BogackiShampine;
pub use cfmr7::CalvoFrancoMontijanoRandez;
pub use dop853::DormandPrince;
use halves::Halves;

use super::compensated::CompensatedSum;
use super::dense::{FROM_ENDS, Polynomial};
use super::side_by_side::{Padded, SIDE_BY_SIDE};
use super::steps::Begin;
use super::tolerances::{index_of_largest, largest_of, smaller};
use super::vectors::{Vectorised, attempt_in};
use super::{Arch, Flow, Method, PointRef, Scale, StepControl};
use crate::model::scalar::Scalar;
use crate::model::scalar::double::worse;
#[cfg(feature = "std")]
pub(super) use lanes::ExplicitInLanes;
pub(super) use stages::{Complete, Stages};
#[cfg(feature = "std")]
pub(crate) use transposed::Transposed;

/// The method of order 5(4) of Bogacki and Shampine: eight rates a step, one more if its dense output of order 5 is
/// asked for.
pub type Bs5 = Explicit<BogackiShampine>;

/// The method of order 7(5) for oscillating solutions of Calvo, Franco, Montijano and Randez: nine rates a step, none
/// more for its dense output of order 5.
pub type Cfmr7 = Explicit<CalvoFrancoMontijanoRandez>;

/// The method of order 8(5,3) of Dormand and Prince: twelve rates a step, three more if its dense output of order 7 is
/// asked for, and 29 more where samples are asked for of a step beyond what is stable, inside of which that output errs
/// by more than twenty times what a step may: that of the two halves of the step is taken then.
pub type Dop853 = Explicit<DormandPrince>;

/// The non-zero weights of a linear combination of stages: each with its stage, in ascending order.
pub type Row = &'static [(usize, f64)];

/// The coefficients of a method.
///
/// Stages are counted from 0, the rate at the start of the step. Stage [`Tableau::END`] is the rate at its end; what
/// comes after serves the dense output only.
pub trait Tableau {
    /// The method's name.
    const NAME: &'static str;
    /// The power of the step with which the norm of the error estimate falls.
    const ERROR_ORDER: f64;
    /// The stage at the end of the step.
    const END: usize;
    /// The stages' instants, as parts of the step.
    const C: &'static [f64];
    /// The states at which the stages are evaluated.
    const A: &'static [Row];
    /// The state at the end of the step.
    const B: Row = Self::A[Self::END];
    /// The difference to the embedded method; without the stage at the end of the step, which is known only after it.
    const ERROR: Row;
    /// Another one of the same order, which counts where it is the larger of both; empty if there is none.
    const OTHER_ERROR: Row = &[];
    /// A second embedded method of lower order; empty if there is none.
    const SECOND: Row = &[];
    /// A difference to an embedded method with the rate at the end of the step, which is looked at where the first one
    /// is small; empty if there is none.
    const LATE: Row = &[];
    /// Whether the states are summed up with what rounding has kept from them, which pays at small tolerances.
    const IS_COMPENSATED: bool = false;
    /// The coefficients of the dense output from the fourth on: see `super::dense`.
    const DENSE: &'static [Row];
    /// A stage of the dense output, and how many times its distance from that the output errs; none where the output is
    /// as good as the ends of its step.
    const DENSE_ERROR: Option<(usize, f64)> = None;
    /// What the coefficients of a diagonally implicit companion have more than [`Tableau::A`] below the diagonal,
    /// without those of the first stage; empty if there is none. It has the same state at the end of the step.
    const MORE: &'static [Row] = &[];
    /// The diagonal coefficient of the companion, from the second stage on.
    const GAMMA: f64 = 0.0;
}

/// The most coefficients of a dense output.
const COEFFICIENTS: usize = 7;

/// The explicit method of tableau `T`.
#[derive(Clone, Debug)]
pub struct Explicit<T> {
    pub(super) stages: Stages<T, f64, SIDE_BY_SIDE>,
    /// The dense output's coefficients.
    polynomial: Polynomial<COEFFICIENTS>,
    /// The same of the two halves of a step; without room where no step is halved.
    halves: Halves<T>,
    /// What rounding has kept from the states.
    sum: CompensatedSum<f64, SIDE_BY_SIDE>,
    /// States at the end of a step, as they are and moved by a difference, after their projection; the latter is also
    /// room for a difference.
    projected: [Padded<f64, SIDE_BY_SIDE>; 2],
    /// The norm of the last attempt's error by the first difference.
    alone: f64,
    /// The machine's vectors.
    arch: Arch,
}

impl<T: Tableau> Explicit<T> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self {
            stages: Stages::new(0),
            polynomial: Polynomial::new(0),
            halves: Halves::new(0),
            sum: CompensatedSum::new(0),
            projected: [Padded::new(0, 0.0), Padded::new(0, 0.0)],
            alone: 0.0,
            arch: Arch::new(),
        }
    }
}

impl<T: Tableau> Default for Explicit<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Tableau> Explicit<T> {
    /// The state of a stage of the step of size `h` (s) that was tried last.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub(crate) fn stage(&mut self, stage: usize, h: f64) -> &[f64] {
        self.stages.state(stage, h)
    }

    /// What is left of the end of a step less h times a difference after the projection, in parts of what is allowed.
    fn left(
        &mut self,
        start: PointRef<'_>,
        scale: &Scale,
        end: &[f64],
        project: &dyn Fn(&mut [f64]),
        moved: impl Fn(&Stages<T, f64, SIDE_BY_SIDE>, usize) -> f64,
    ) -> f64 {
        let Self { stages, projected: [reached, other], .. } = self;
        for (i, other) in other.iter_mut().enumerate() {
            *other = end[i] - moved(stages, i);
        }
        project(other);
        largest_of(end.len(), |i| (reached[i] - other[i]).abs() / scale.allowed_between(i, start.x[i], end[i]))
    }
}

/// Makes the dense output of a step of size `h` (s) whose stages are known up to its end.
#[inline(never)]
fn interpolate<T: Tableau>(
    (stages, polynomial): (&mut Stages<T, f64, SIDE_BY_SIDE>, &mut Polynomial<COEFFICIENTS>),
    flow: &Flow<'_>,
    start: PointRef<'_>,
    h: f64,
    end: PointRef<'_>,
) {
    stages.set_stage(T::END, |rate| rate.copy_from_slice(end.rate));
    stages.evaluate(flow, &Begin::of(start, h), T::END + 1..T::A.len(), &mut ());
    let row = |m: usize| T::DENSE.get(m).copied().unwrap_or_default();
    polynomial.set(start, h, end, |m, _, out| stages.write(row(m), h, out));
}

/// The norm of a step's error, of size `h` (s): h e1, with the largest e1 of the scaled differences to the embedded
/// method. With a second one, whose largest difference is e2, it is h e1 e1 / sqrt(e1 e1 + e2 e2 / 100) (Hairer,
/// Norsett, Wanner, section II.10).
#[inline(always)]
fn norm<T: Tableau, S: Scalar>(h: S, [first, second]: [S; 2]) -> S {
    if T::SECOND.is_empty() { h.abs() * first } else { both(h.abs(), first, second) }
}

/// The error of a method with two estimates, that of the higher order first, `scale` times theirs: the first one, the
/// smaller the larger the second is beside it (`dop853.f`). Both vanish exactly at a state of rest.
#[inline(always)]
pub(crate) fn both<S: Scalar>(scale: S, first: S, second: S) -> S {
    // Of numbers so large that their squares are finite: a step with a larger error is as wrong.
    let most = scale.alike(1e150);
    let (first, second) = (smaller(most, first), smaller(most, second));
    let both = first * first + second.times(0.01) * second;
    // The quotient is zero where both are; no root of another number is as small.
    scale * first * first / both.alike(f64::MIN_POSITIVE).larger(both.sqrt())
}

impl<T: Tableau> Vectorised for Explicit<T> {
    #[inline(always)]
    fn attempt_inlined(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        let differences = self.stages.step(flow, &Begin::of(start, h), scale, &mut self.sum, end);
        self.alone = h.abs() * differences[0];
        norm::<T, _>(h, differences)
    }
}

impl<T: Tableau> Method for Explicit<T> {
    fn name(&self) -> &'static str {
        T::NAME
    }

    fn control(&self) -> StepControl {
        StepControl::Stabilised { order: T::ERROR_ORDER }
    }

    fn fit(&mut self, states: usize) {
        if self.stages.states() != states {
            (self.stages, self.sum) = (Stages::new(states), CompensatedSum::new(states));
            if T::DENSE_ERROR.is_some() {
                self.halves = Halves::new(states);
            }
            self.polynomial = Polynomial::new(states);
            self.projected = [Padded::new(states, 0.0), Padded::new(states, 0.0)];
        }
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        let norm = attempt_in(self.arch, self, flow, start, h, scale, end);
        if T::LATE.is_empty() || norm > 1.0 {
            return norm;
        }
        self.stages.set_stage(T::END, |rate| flow.rate(start.t + h, end, rate));
        let Self { stages, projected: [_, difference], .. } = self;
        stages.write(T::LATE, 1.0, difference);
        let error = |i: usize| (difference[i] / scale.allowed_between(i, start.x[i], end[i])).abs();
        let late = h.abs() * largest_of(end.len(), error);
        worse(late, norm)
    }

    fn error_alone(&self) -> f64 {
        self.alone
    }

    fn error_after(
        &mut self,
        flow: &Flow<'_>,
        start: PointRef<'_>,
        h: f64,
        scale: &Scale,
        end: &[f64],
        project: &dyn Fn(&mut [f64]),
    ) -> Option<f64> {
        self.projected[0].copy_from_slice(end);
        project(&mut self.projected[0]);
        let first = self.left(start, scale, end, project, |stages, i| h * stages.difference(i));
        if !T::SECOND.is_empty() {
            let difference =
                |stages: &Stages<T, f64, SIDE_BY_SIDE>, i| stages.combine(T::B, i) - stages.combine(T::SECOND, i);
            let second = self.left(start, scale, end, project, |stages, i| h * difference(stages, i));
            return Some(both(1.0, first, second));
        }
        if T::LATE.is_empty() || first > 1.0 {
            return Some(first);
        }
        self.stages.set_stage(T::END, |rate| flow.rate(start.t + h, end, rate));
        let late = self.left(start, scale, end, project, |stages, i| h * stages.combine(T::LATE, i));
        Some(worse(late, first))
    }

    fn advance(&mut self) {
        if T::IS_COMPENSATED {
            self.sum.advance();
        }
    }

    fn restart(&mut self) {
        self.sum.restart();
    }

    fn largest_error(&self, start: PointRef<'_>, scale: &Scale, end: &[f64]) -> usize {
        let error = |i: usize| self.stages.difference(i) / scale.allowed_between(i, start.x[i], end[i]);
        index_of_largest(end.len(), |i| error(i).abs())
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        (1..T::END).flat_map(|stage| self.stages.stage(stage)).find(|(_, rate)| !rate.is_finite())
    }

    fn prepare_dense(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>) {
        interpolate((&mut self.stages, &mut self.polynomial), flow, start, h, end);
    }

    fn prepare_samples(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, end: PointRef<'_>, scale: &Scale) {
        if T::DENSE_ERROR.is_some() {
            self.halves.look((flow, scale, self.arch), [start, end], h, (&self.stages, &self.polynomial));
        }
    }

    fn sample(&self, start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        if !self.halves.evaluate(self.arch, start, h, theta, x) {
            self.dense(start, h, end, theta, x);
        }
    }

    fn dense(&self, start: PointRef<'_>, _h: f64, _end: PointRef<'_>, theta: f64, x: &mut [f64]) {
        const { assert!(FROM_ENDS + T::DENSE.len() <= COEFFICIENTS) };
        self.polynomial.evaluate(self.arch, FROM_ENDS + T::DENSE.len(), start, theta, x);
    }
}
