//! A system as integrators see it: its switches frozen, its evaluations counted.
//!
//! In: a system, the branches of its switches, the statistics of the run. Out: a [`Flow`].

use core::cell::Cell;
use core::ops::Range;

use nalgebra::Complex;

use crate::model::dynamics::Dynamics;
use crate::model::linear::Sparsity;
use crate::solve::integrator::{Flow, SeriesSize};
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

/// A system with its switches frozen, counting its evaluations.
#[derive(Clone, Copy)]
pub(crate) struct Frozen<'a> {
    system: &'a dyn Dynamics,
    negative: &'a [bool],
    counters: Counters<'a>,
}

impl<'a> Frozen<'a> {
    pub fn new(system: &'a dyn Dynamics, negative: &'a [bool], statistics: &'a mut Statistics) -> Self {
        Self { system, negative, counters: Counters::from(statistics) }
    }
}

impl Flow for Frozen<'_> {
    fn states(&self) -> usize {
        self.system.states()
    }

    fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.system.rate(t, x, self.negative, dx);
    }

    fn sparsity(&self) -> Sparsity {
        self.system.sparsity()
    }

    fn jacobian(&self, t: f64, x: &[f64], entries: &mut [f64], slope: &mut [f64]) {
        count(self.counters.jacobians, 1);
        self.system.jacobian(t, x, self.negative, entries, slope);
    }

    fn damping_sparsity(&self) -> Sparsity {
        self.system.damping_sparsity()
    }

    fn damping(&self, t: f64, x: &[f64], entries: &mut [f64]) {
        count(self.counters.jacobians, 1);
        self.system.damping(t, x, self.negative, entries);
    }

    fn factors(&self) -> Option<usize> {
        self.system.factors()
    }

    fn eliminate(&self, c: f64, entries: &[f64], factors: &mut [f64]) -> bool {
        self.system.eliminate(c, entries, factors)
    }

    fn eliminate_complex(&self, c: Complex<f64>, entries: &[f64], factors: &mut [Complex<f64>]) -> bool {
        self.system.eliminate_complex(c, entries, factors)
    }

    fn substitute(&self, factors: &[f64], b: &mut [f64]) {
        self.system.substitute(factors, b);
    }

    fn substitute_complex(&self, factors: &[Complex<f64>], b: &mut [Complex<f64>]) {
        self.system.substitute_complex(factors, b);
    }

    fn second(&self) -> Range<usize> {
        self.system.second()
    }

    fn second_derivatives(&self, x: &[f64], dx: &mut [f64]) {
        self.system.second_derivatives(x, dx);
    }

    fn forces(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.system.forces(t, x, self.negative, dx);
    }

    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.system.operations_of_forces()
    }

    fn series(&self) -> Option<SeriesSize> {
        self.system.series()
    }

    fn expand(&self, t: f64, h: f64, rows: &mut [f64], series: &mut [f64]) {
        if !series.is_empty() {
            count(self.counters.series_orders, (series.len() / self.states() - 1) as u64);
            self.system.expand(t, h, self.negative, rows, series);
        }
    }

    fn is_held(&self) -> bool {
        self.system.held().is_some()
    }

    fn count_factorisation(&self, is_fallback: bool) {
        count(self.counters.factorisations, 1);
        count(self.counters.pivoted, u64::from(is_fallback));
    }
}
