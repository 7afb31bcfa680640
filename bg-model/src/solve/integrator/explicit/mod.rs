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
#[cfg(feature = "std")]
mod lanes;
#[cfg(test)]
mod order;
mod stages;
#[cfg(test)]
mod vectors;

use crate::solve::integrator::Arch;
use nalgebra::SVector;

pub use bs5::BogackiShampine;
pub use cfmr7::CalvoFrancoMontijanoRandez;
pub use dop853::DormandPrince;

use super::compensated::CompensatedSum;
use super::dense::{FROM_ENDS, Polynomial, write_sum};
use super::steps::{Begin, OfFlow};
use super::tolerances::{index_of_largest, largest, smaller};
use super::vectors::{Vectorised, attempt_in};
use super::{Flow, Method, Point, Scale, StepControl, first_not_finite};
use crate::model::scalar::Scalar;
#[cfg(feature = "std")]
pub(super) use lanes::ExplicitInLanes;
pub(super) use stages::{Complete, Stages};

/// The method of order 5(4) of Bogacki and Shampine: eight rates a step, one more if its dense output of order 5 is asked
/// for.
pub type Bs5<const N: usize> = Explicit<BogackiShampine, N>;

/// The method of order 7(5) for oscillating solutions of Calvo, Franco, Montijano and Randez: nine rates a step, none more
/// for its dense output of order 5.
pub type Cfmr7<const N: usize> = Explicit<CalvoFrancoMontijanoRandez, N>;

/// The method of order 8(5,3) of Dormand and Prince: twelve rates a step, three more if its dense output of order 7 is
/// asked for.
pub type Dop853<const N: usize> = Explicit<DormandPrince, N>;

/// The non-zero weights of a linear combination of stages: each with its stage, in ascending order.
pub type Row = &'static [(usize, f64)];

/// The coefficients of a method.
///
/// Stages are counted from 0, the rate at the start of the step. Stage [`Tableau::END`] is the rate at its end; what comes
/// after serves the dense output only.
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
    /// A second embedded method of lower order; empty if there is none.
    const SECOND: Row = &[];
    /// A difference to an embedded method with the rate at the end of the step, which is looked at where the first one is
    /// small; empty if there is none.
    const LATE: Row = &[];
    /// Whether the states are summed up with what rounding has kept from them, which pays at small tolerances.
    const IS_COMPENSATED: bool = false;
    /// The coefficients of the dense output from the fourth on: see `super::dense`.
    const DENSE: &'static [Row];
    /// What the coefficients of a diagonally implicit companion have more than [`Tableau::A`] below the diagonal, without those of
    /// the first stage; empty if there is none. It has the same state at the end of the step.
    const MORE: &'static [Row] = &[];
    /// The diagonal coefficient of the companion, from the second stage on.
    const GAMMA: f64 = 0.0;
}

/// The most coefficients of a dense output.
const COEFFICIENTS: usize = 7;

/// The explicit method of tableau `T`.
#[derive(Clone, Debug)]
pub struct Explicit<T, const N: usize> {
    pub(super) stages: Stages<T, f64, N>,
    /// The dense output's coefficients.
    polynomial: Polynomial<N, COEFFICIENTS>,
    /// What rounding has kept from the states.
    sum: CompensatedSum<f64, N>,
    /// The machine's vectors.
    arch: Arch,
}

impl<T: Tableau, const N: usize> Explicit<T, N> {
    /// The method, its work space empty.
    #[must_use]
    pub fn new() -> Self {
        Self { stages: Stages::new(), polynomial: Polynomial::zero(), sum: CompensatedSum::new(), arch: Arch::new() }
    }
}

impl<T: Tableau, const N: usize> Default for Explicit<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Tableau, const N: usize> Explicit<T, N> {
    /// The magnitudes of the differences `row` to an embedded method, in parts of what is allowed.
    fn errors(&self, row: Row, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> [f64; N] {
        core::array::from_fn(|i| (self.stages.combine(row, i) / scale.allowed_between(i, start.x[i], end[i])).abs())
    }
}

/// The norm of a step's error, of size `h` (s): h e1, with the largest e1 of the scaled differences to the embedded method. With a second one,
/// whose largest difference is e2, it is h e1 e1 / sqrt(e1 e1 + e2 e2 / 100) (Hairer, Norsett, Wanner, section II.10).
#[inline(always)]
fn norm<T: Tableau, S: Scalar>(h: S, [first, second]: [S; 2]) -> S {
    if T::SECOND.is_empty() { h.abs() * first } else { both(h.abs(), first, second) }
}

/// The error of a method with two estimates, that of the higher order first, `scale` times theirs: the first one, the smaller the larger the second is
/// beside it (`dop853.f`). Both vanish exactly at a state of rest.
#[inline(always)]
pub(crate) fn both<S: Scalar>(scale: S, first: S, second: S) -> S {
    // Of numbers so large that their squares are finite: a step with a larger error is as wrong.
    let most = scale.alike(1e150);
    let (first, second) = (smaller(first, most), smaller(second, most));
    let both = first * first + second.times(0.01) * second;
    // The quotient is zero where both are; no root of another number is as small.
    scale * first * first / both.alike(f64::MIN_POSITIVE).larger(both.sqrt())
}

impl<T: Tableau, const N: usize> Vectorised<N> for Explicit<T, N> {
    #[inline(always)]
    fn attempt_inlined(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let from = Begin { t: start.t, h, x: &start.x, rate: &start.rate };
        norm::<T, _>(h, self.stages.step(&OfFlow(flow), &from, scale, &mut self.sum, end))
    }
}

impl<T: Tableau, const N: usize> Method<N> for Explicit<T, N> {
    fn name(&self) -> &'static str {
        T::NAME
    }

    fn control(&self) -> StepControl {
        StepControl::Stabilised { order: T::ERROR_ORDER }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        let norm = attempt_in(self.arch, self, flow, start, h, scale, end);
        if T::LATE.is_empty() || norm > 1.0 {
            return norm;
        }
        flow.rate(start.t + h, end, &mut self.stages.k[T::END]);
        let late = h.abs() * largest(&self.errors(T::LATE, start, scale, end));
        if late > norm { late } else { norm }
    }

    fn error_after(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &SVector<f64, N>,
        project: impl Fn(&mut SVector<f64, N>),
    ) -> Option<f64> {
        let mut reached = *end;
        project(&mut reached);
        let left = |difference: &dyn Fn(usize) -> f64| {
            let mut other = SVector::from_fn(|i, _| end[i] - h * difference(i));
            project(&mut other);
            largest::<f64, N>(&core::array::from_fn(|i| {
                (reached[i] - other[i]).abs() / scale.allowed_between(i, start.x[i], end[i])
            }))
        };
        let first = left(&|i| self.stages.combine(T::ERROR, i));
        if !T::SECOND.is_empty() {
            let second = left(&|i| self.stages.combine(T::B, i) - self.stages.combine(T::SECOND, i));
            return Some(both(1.0, first, second));
        }
        if T::LATE.is_empty() || first > 1.0 {
            return Some(first);
        }
        flow.rate(start.t + h, end, &mut self.stages.k[T::END]);
        Some(first.max(left(&|i| self.stages.combine(T::LATE, i))))
    }

    fn advance(&mut self) {
        if T::IS_COMPENSATED {
            self.sum.advance();
        }
    }

    fn restart(&mut self) {
        self.sum.restart();
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        let errors = self.errors(T::ERROR, start, scale, end);
        index_of_largest::<N>(|i| errors[i])
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        self.stages.k[1..T::END].iter().find_map(first_not_finite)
    }

    fn prepare_dense(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        self.stages.k[T::END] = end.rate;
        let from = Begin { t: start.t, h, x: &start.x, rate: &start.rate };
        self.stages.evaluate::<false>(&OfFlow(flow), &from, T::END + 1..T::A.len(), &mut ());
        let arch = self.arch;
        let row = |m: usize| T::DENSE.get(m).copied().unwrap_or_default();
        self.polynomial.set(start, h, end, |m, _, out| {
            write_sum(arch, h, row(m).iter().map(|&(stage, weight)| (weight, &self.stages.k[stage])), out);
        });
    }

    fn dense(&self, start: &Point<N>, _h: f64, _end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        const { assert!(FROM_ENDS + T::DENSE.len() <= COEFFICIENTS) };
        self.polynomial.evaluate(self.arch, FROM_ENDS + T::DENSE.len(), start, theta, x);
    }
}
