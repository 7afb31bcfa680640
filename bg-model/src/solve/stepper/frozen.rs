//! A system as integrators see it: its switches frozen, its evaluations counted.
//!
//! In: a system, the branches of its switches, the statistics of the run. Out: a [`Flow`], and capabilities of a system
//! without switches.

use core::cell::Cell;
use core::ops::Range;

use nalgebra::{Complex, SVector};

use crate::model::capability::{Elimination, Linearised, SecondOrder, Series};
use crate::model::linear::{Field, Sparsity, differences};
use crate::model::system::System;
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
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frozen<'a, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    negative: &'a [bool; G],
    counters: Counters<'a>,
}

impl<'a, Sys, const N: usize, const G: usize> Frozen<'a, Sys, N, G>
where
    Sys: System<f64, N, G>,
{
    pub fn new(system: &'a Sys, negative: &'a [bool; G], statistics: &'a mut Statistics) -> Self {
        Self { system, negative, counters: Counters::from(statistics) }
    }

    /// The elimination made for the system's sparsity.
    #[inline(always)]
    fn elimination(&self) -> Option<&'a impl Elimination<f64, N>> {
        self.system.linearised().and_then(Linearised::elimination)
    }

    #[inline(always)]
    fn eliminated<F: Field<f64>>(&self, c: F, entries: &[f64], factors: &mut [F]) -> bool {
        self.elimination().is_some_and(|elimination| elimination.eliminate(c, entries, factors))
    }

    #[inline(always)]
    fn substituted<F: Field<f64>>(&self, factors: &[F], b: &mut [F]) {
        if let Some(elimination) = self.elimination() {
            elimination.substitute(factors, b.first_chunk_mut().expect("there is a number for each state"));
        }
    }
}

/// The numbers of all states as a system takes them.
#[inline(always)]
fn whole<const N: usize>(of: &[f64]) -> &SVector<f64, N> {
    bytemuck::from_bytes(bytemuck::cast_slice(of))
}

#[inline(always)]
fn whole_mut<const N: usize>(of: &mut [f64]) -> &mut SVector<f64, N> {
    bytemuck::from_bytes_mut(bytemuck::cast_slice_mut(of))
}

impl<Sys, const N: usize, const G: usize> Flow for Frozen<'_, Sys, N, G>
where
    Sys: System<f64, N, G>,
{
    #[inline(always)]
    fn states(&self) -> usize {
        N
    }

    #[inline(always)]
    fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.system.rate(t, whole(x), self.negative, whole_mut(dx));
    }

    #[inline(always)]
    fn inlined_rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        if Sys::HAS_INLINED_STEPS {
            count(self.counters.rates, 1);
            self.system.inlined_rate(t, whole(x), self.negative, whole_mut(dx));
        } else {
            self.rate(t, x, dx);
        }
    }

    fn sparsity(&self) -> Sparsity {
        self.system.linearised().map_or(Sparsity::Full, Linearised::sparsity)
    }

    fn jacobian(&self, t: f64, x: &[f64], entries: &mut [f64], slope: &mut [f64]) {
        count(self.counters.jacobians, 1);
        match self.system.linearised() {
            Some(linearised) => linearised.jacobian(t, whole(x), self.negative, entries, whole_mut(slope)),
            None => {
                let rate = |t, x: &[f64], dx: &mut [f64]| self.system.rate(t, whole(x), self.negative, whole_mut(dx));
                differences(rate, t, x, entries, slope, &mut [0.0; N]);
            }
        }
    }

    fn damping_sparsity(&self) -> Sparsity {
        self.system.linearised().map_or(Sparsity::Full, Linearised::damping_sparsity)
    }

    fn damping(&self, t: f64, x: &[f64], entries: &mut [f64]) {
        match self.system.linearised() {
            Some(linearised) => {
                count(self.counters.jacobians, 1);
                linearised.damping(t, whole(x), self.negative, entries);
            }
            None => self.jacobian(t, x, entries, &mut [0.0; N]),
        }
    }

    fn factors(&self) -> Option<usize> {
        self.elimination().map(Elimination::factors)
    }

    #[inline(always)]
    fn eliminate(&self, c: f64, entries: &[f64], factors: &mut [f64]) -> bool {
        self.eliminated(c, entries, factors)
    }

    #[inline(always)]
    fn eliminate_complex(&self, c: Complex<f64>, entries: &[f64], factors: &mut [Complex<f64>]) -> bool {
        self.eliminated(c, entries, factors)
    }

    #[inline(always)]
    fn substitute(&self, factors: &[f64], b: &mut [f64]) {
        self.substituted(factors, b);
    }

    #[inline(always)]
    fn substitute_complex(&self, factors: &[Complex<f64>], b: &mut [Complex<f64>]) {
        self.substituted(factors, b);
    }

    #[inline(always)]
    fn second(&self) -> Range<usize> {
        self.system.second_order().map_or(0..0, |second| second.states())
    }

    #[inline(always)]
    fn second_derivatives(&self, x: &[f64], dx: &mut [f64]) {
        if let Some(second) = self.system.second_order() {
            second.second_derivatives(whole(x), whole_mut(dx));
        }
    }

    #[inline(always)]
    fn forces(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        match self.system.second_order() {
            Some(second) => {
                count(self.counters.rates, 1);
                second.forces(t, whole(x), self.negative, whole_mut(dx));
            }
            None => self.inlined_rate(t, x, dx),
        }
    }

    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.system.second_order()?.operations()
    }

    fn series(&self) -> Option<SeriesSize> {
        self.system.series().map(|series| SeriesSize { width: series.width(), operations: series.operations() })
    }

    #[inline(always)]
    fn expand(&self, t: f64, h: f64, rows: &mut [f64], series: &mut [f64]) {
        let series: &mut [SVector<f64, N>] = bytemuck::cast_slice_mut(series);
        if let Some(expansion) = self.system.series().filter(|_| !series.is_empty()) {
            count(self.counters.series_orders, (series.len() - 1) as u64);
            expansion.expand(t, h, self.negative, rows, series);
        }
    }

    fn is_held(&self) -> bool {
        self.system.joints().is_some()
    }

    fn count_factorisation(&self, is_fallback: bool) {
        count(self.counters.factorisations, 1);
        count(self.counters.pivoted, u64::from(is_fallback));
    }
}
