//! A smooth flow: a system as methods see it, its switches frozen, its evaluations counted.

use core::cell::Cell;
use core::ops::Range;

use nalgebra::Complex;

use crate::model::capability::SeriesSize;
use crate::model::dynamics::Dynamics;
use crate::model::linear::Sparsity;
use crate::solve::statistics::Statistics;

/// The counters of a run.
#[derive(Clone, Copy, Debug)]
struct Counters<'a> {
    rates: &'a Cell<u64>,
    jacobians: &'a Cell<u64>,
    factorisations: &'a Cell<u64>,
    pivoted: &'a Cell<u64>,
    series_orders: &'a Cell<u64>,
}

impl<'a> From<&'a mut Statistics> for Counters<'a> {
    fn from(statistics: &'a mut Statistics) -> Self {
        Self {
            rates: Cell::from_mut(&mut statistics.rate_evaluations),
            jacobians: Cell::from_mut(&mut statistics.jacobian_evaluations),
            factorisations: Cell::from_mut(&mut statistics.factorisations),
            pivoted: Cell::from_mut(&mut statistics.pivoted_factorisations),
            series_orders: Cell::from_mut(&mut statistics.series_orders),
        }
    }
}

/// Counts so many more.
#[inline(always)]
fn count(counter: &Cell<u64>, more: u64) {
    counter.set(counter.get() + more);
}

/// A smooth flow dx/dt = f(t, x): a system with its switches frozen, counting its evaluations. What it gives is what
/// [`Dynamics`] has under the same name.
#[derive(Clone, Copy)]
pub struct Flow<'a> {
    system: &'a dyn Dynamics,
    negative: &'a [bool],
    counters: Counters<'a>,
}

impl<'a> Flow<'a> {
    /// That of `system`, whose switches stay in the branches `negative`.
    pub fn new(system: &'a dyn Dynamics, negative: &'a [bool], statistics: &'a mut Statistics) -> Self {
        Self { system, negative, counters: Counters::from(statistics) }
    }

    /// The number of states.
    #[must_use]
    pub fn states(&self) -> usize {
        self.system.states()
    }

    /// Writes dx/dt at time `t` (s) and state `x` into `dx`.
    pub fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.system.rate(t, x, self.negative, dx);
    }

    /// Where the Jacobian df/dx can differ from zero.
    #[must_use]
    pub fn sparsity(&self) -> Sparsity {
        self.system.sparsity()
    }

    /// Writes df/dx in the order of the sparsity into `entries` and df/dt, per s, into `slope`.
    pub fn jacobian(&self, t: f64, x: &[f64], entries: &mut [f64], slope: &mut [f64]) {
        count(self.counters.jacobians, 1);
        self.system.jacobian(t, x, self.negative, entries, slope);
    }

    /// Where [`Flow::damping`] can differ from zero.
    #[must_use]
    pub fn damping_sparsity(&self) -> Sparsity {
        self.system.damping_sparsity()
    }

    /// Writes at least the entries of df/dx among states that are not of second order, in the order of
    /// [`Flow::damping_sparsity`], into `entries`.
    pub fn damping(&self, t: f64, x: &[f64], entries: &mut [f64]) {
        count(self.counters.jacobians, 1);
        self.system.damping(t, x, self.negative, entries);
    }

    /// How many numbers the factors of I - c J are, along an elimination made for the sparsity; none where there is no
    /// such one.
    #[must_use]
    pub fn factors(&self) -> Option<usize> {
        self.system.factors()
    }

    /// Writes the factors of I - `c` J into `factors`; `entries` is J in the order of its sparsity. Gives whether it
    /// did: not where a pivot is too small, or there is no elimination.
    pub fn eliminate(&self, c: f64, entries: &[f64], factors: &mut [f64]) -> bool {
        self.system.eliminate(c, entries, factors)
    }

    /// The same with a complex `c`.
    pub fn eliminate_complex(&self, c: Complex<f64>, entries: &[f64], factors: &mut [Complex<f64>]) -> bool {
        self.system.eliminate_complex(c, entries, factors)
    }

    /// Replaces `b` by the solution y of (I - c J) y = b, with the `factors` of I - c J.
    pub fn substitute(&self, factors: &[f64], b: &mut [f64]) {
        self.system.substitute(factors, b);
    }

    /// The same with a complex c.
    pub fn substitute_complex(&self, factors: &[Complex<f64>], b: &mut [Complex<f64>]) {
        self.system.substitute_complex(factors, b);
    }

    /// The states of second order, side by side; an empty range where there are none.
    #[must_use]
    pub fn second(&self) -> Range<usize> {
        self.system.second()
    }

    /// Replaces the rates `dx` of the states of second order at state `x` by their second derivatives with respect to
    /// time, per s^2.
    pub fn second_derivatives(&self, x: &[f64], dx: &mut [f64]) {
        self.system.second_derivatives(x, dx);
    }

    /// Writes the rates at time `t` (s) and state `x` into `dx`, in the places of the states of second order their
    /// second derivatives.
    pub fn forces(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.system.forces(t, x, self.negative, dx);
    }

    /// The operations of a rate and of [`Flow::forces`], where they have been counted.
    #[must_use]
    pub fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.system.operations_of_forces()
    }

    /// What a Taylor series of the states takes; none where there is no series.
    #[must_use]
    pub fn series(&self) -> Option<SeriesSize> {
        self.system.series()
    }

    /// Writes the Taylor series of the states from time `t` (s) on: order by order, of each all states. Those of order
    /// 0 are the state there; those of order k become the coefficients of the k-th power of the time passed in parts of
    /// `h` (s). `rows` is work space, of as many numbers for each order but the first as the series is wide.
    pub fn expand(&self, t: f64, h: f64, rows: &mut [f64], series: &mut [f64]) {
        if !series.is_empty() {
            count(self.counters.series_orders, (series.len() / self.states() - 1) as u64);
            self.system.expand(t, h, self.negative, rows, series);
        }
    }

    /// Whether joints hold motions, so that the end of each step is moved back onto them.
    #[must_use]
    pub fn is_held(&self) -> bool {
        self.system.held().is_some()
    }

    /// Counts a factorisation of I - c J; `is_fallback` where a dense one stands in for a sparse one with a small
    /// pivot.
    pub fn count_factorisation(&self, is_fallback: bool) {
        count(self.counters.factorisations, 1);
        count(self.counters.pivoted, u64::from(is_fallback));
    }
}
