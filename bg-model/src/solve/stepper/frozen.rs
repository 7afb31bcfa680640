//! A system as integrators see it: its switches frozen, its evaluations counted.
//!
//! In: a system, the branches of its switches, the statistics of the run. Out: a [`Flow`], and capabilities of a system
//! without switches.

use core::cell::Cell;
use core::ops::Range;

use nalgebra::SVector;

use crate::model::capability::{Elimination, Linearised, Operations, SecondOrder, Series};
use crate::model::linear::{Sparsity, differences};
use crate::model::system::System;
use crate::solve::integrator::Flow;
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frozen<'a, Sys, const G: usize> {
    system: &'a Sys,
    negative: &'a [bool; G],
    counters: Counters<'a>,
}

impl<'a, Sys, const G: usize> Frozen<'a, Sys, G> {
    pub fn new(system: &'a Sys, negative: &'a [bool; G], statistics: &'a mut Statistics) -> Self {
        Self { system, negative, counters: Counters::from(statistics) }
    }

    /// A capability of the system in the same branches.
    #[inline(always)]
    fn of<C>(&self, system: &'a C) -> Frozen<'a, C, G> {
        Frozen { system, negative: self.negative, counters: self.counters }
    }
}

impl<Sys, const N: usize, const G: usize> Flow<N> for Frozen<'_, Sys, G>
where
    Sys: System<f64, N, G>,
{
    #[inline(always)]
    fn rate(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        count(self.counters.rates, 1);
        self.system.rate(t, x, self.negative, dx);
    }

    #[inline(always)]
    fn inlined_rate(&self, t: f64, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        count(self.counters.rates, 1);
        self.system.inlined_rate(t, x, self.negative, dx);
    }

    fn sparsity(&self) -> Sparsity {
        self.system.linearised().map_or(Sparsity::Full, Linearised::sparsity)
    }

    fn jacobian(&self, t: f64, x: &SVector<f64, N>, entries: &mut [f64], slope: &mut SVector<f64, N>) {
        count(self.counters.jacobians, 1);
        match self.system.linearised() {
            Some(linearised) => linearised.jacobian(t, x, self.negative, entries, slope),
            None => differences(|t, x, dx| self.system.rate(t, x, self.negative, dx), t, x, entries, slope),
        }
    }

    fn damping_sparsity(&self) -> Sparsity {
        self.system.linearised().map_or(Sparsity::Full, Linearised::damping_sparsity)
    }

    fn damping(&self, t: f64, x: &SVector<f64, N>, entries: &mut [f64]) {
        match self.system.linearised() {
            Some(linearised) => {
                count(self.counters.jacobians, 1);
                linearised.damping(t, x, self.negative, entries);
            }
            None => self.jacobian(t, x, entries, &mut SVector::zeros()),
        }
    }

    fn elimination(&self) -> Option<&impl Elimination<f64, N>> {
        self.system.linearised().and_then(Linearised::elimination)
    }

    #[inline(always)]
    fn second_order(&self) -> Option<impl SecondOrder<f64, N, 0>> {
        self.system.second_order().map(|second_order| self.of(second_order))
    }

    #[inline(always)]
    fn series(&self) -> Option<impl Series<f64, N, 0>> {
        self.system.series().map(|series| self.of(series))
    }

    fn is_held(&self) -> bool {
        self.system.joints().is_some()
    }

    fn count_factorisation(&self, is_fallback: bool) {
        count(self.counters.factorisations, 1);
        count(self.counters.pivoted, u64::from(is_fallback));
    }
}

impl<C, const N: usize, const G: usize> SecondOrder<f64, N, 0> for Frozen<'_, C, G>
where
    C: SecondOrder<f64, N, G>,
{
    #[inline(always)]
    fn states(&self) -> Range<usize> {
        self.system.states()
    }

    #[inline(always)]
    fn second_derivatives(&self, x: &SVector<f64, N>, dx: &mut SVector<f64, N>) {
        self.system.second_derivatives(x, dx);
    }

    #[inline(always)]
    fn forces(&self, t: f64, x: &SVector<f64, N>, _: &[bool; 0], dx: &mut SVector<f64, N>) {
        count(self.counters.rates, 1);
        self.system.forces(t, x, self.negative, dx);
    }

    fn operations(&self) -> Option<[u32; 2]> {
        self.system.operations()
    }
}

impl<C, const N: usize, const G: usize> Series<f64, N, 0> for Frozen<'_, C, G>
where
    C: Series<f64, N, G>,
{
    fn width(&self) -> usize {
        self.system.width()
    }

    fn operations(&self) -> Option<Operations> {
        self.system.operations()
    }

    #[inline(always)]
    fn expand(&self, t: f64, h: f64, _: &[bool; 0], rows: &mut [f64], series: &mut [SVector<f64, N>]) {
        count(self.counters.series_orders, (series.len() - 1) as u64);
        self.system.expand(t, h, self.negative, rows, series);
    }
}
