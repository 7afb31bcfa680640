//! A system as integrators see it: its switches frozen, its evaluations counted.
//!
//! In: a system, the branches of its switches, the statistics of the run. Out: a [`Flow`], and capabilities of a system
//! without switches.

use core::cell::Cell;
use core::ops::Range;

use nalgebra::{Complex, SVector};
use pulp::NullaryFnOnce;

use crate::model::capability::{Elimination, Linearised, SecondOrder, Series};
use crate::model::linear::{Field, Sparsity, differences};
use crate::model::system::System;
use crate::solve::integrator::{Arch, Flow, SeriesSize};
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
    /// The machine's vectors.
    arch: Arch,
}

impl<'a, Sys, const N: usize, const G: usize> Frozen<'a, Sys, N, G>
where
    Sys: System<f64, N, G>,
{
    pub fn new(system: &'a Sys, negative: &'a [bool; G], statistics: &'a mut Statistics, arch: Arch) -> Self {
        Self { system, negative, counters: Counters::from(statistics), arch }
    }

    /// The elimination made for the system's sparsity.
    #[inline(always)]
    fn elimination(&self) -> Option<&'a impl Elimination<f64, N>> {
        self.system.linearised().and_then(Linearised::elimination)
    }

    fn eliminated<F: Field<f64>>(&self, c: F, entries: &[f64], factors: &mut [F]) -> bool {
        let in_vectors = |elimination| self.arch.dispatch(Eliminate { elimination, c, entries, factors });
        self.elimination().is_some_and(in_vectors)
    }

    fn substituted<F: Field<f64>>(&self, factors: &[F], b: &mut [F]) {
        if let Some(elimination) = self.elimination() {
            let b = b.first_chunk_mut().expect("there is a number for each state");
            self.arch.dispatch(Substitute { elimination, factors, b });
        }
    }
}

struct Rate<'a, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: f64,
    x: &'a SVector<f64, N>,
    negative: &'a [bool; G],
    dx: &'a mut SVector<f64, N>,
}

impl<Sys: System<f64, N, G>, const N: usize, const G: usize> NullaryFnOnce for Rate<'_, Sys, N, G> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.system.inlined_rate(self.t, self.x, self.negative, self.dx);
    }
}

struct Eliminate<'a, E, F, const N: usize> {
    elimination: &'a E,
    c: F,
    entries: &'a [f64],
    factors: &'a mut [F],
}

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> NullaryFnOnce for Eliminate<'_, E, F, N> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.elimination.eliminate(self.c, self.entries, self.factors)
    }
}

struct Substitute<'a, E, F, const N: usize> {
    elimination: &'a E,
    factors: &'a [F],
    b: &'a mut [F; N],
}

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> NullaryFnOnce for Substitute<'_, E, F, N> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.elimination.substitute(self.factors, self.b);
    }
}

struct Forces<'a, C, const N: usize, const G: usize> {
    second: &'a C,
    t: f64,
    x: &'a SVector<f64, N>,
    negative: &'a [bool; G],
    dx: &'a mut SVector<f64, N>,
}

impl<C: SecondOrder<f64, N, G>, const N: usize, const G: usize> NullaryFnOnce for Forces<'_, C, N, G> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.second.forces(self.t, self.x, self.negative, self.dx);
    }
}

struct Expansion<'a, C, const N: usize, const G: usize> {
    expansion: &'a C,
    t: f64,
    h: f64,
    negative: &'a [bool; G],
    rows: &'a mut [f64],
    series: &'a mut [SVector<f64, N>],
}

impl<C: Series<f64, N, G>, const N: usize, const G: usize> NullaryFnOnce for Expansion<'_, C, N, G> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.expansion.expand(self.t, self.h, self.negative, self.rows, self.series);
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
    fn states(&self) -> usize {
        N
    }

    fn rate(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        count(self.counters.rates, 1);
        self.arch.dispatch(Rate { system: self.system, t, x: whole(x), negative: self.negative, dx: whole_mut(dx) });
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

    fn eliminate(&self, c: f64, entries: &[f64], factors: &mut [f64]) -> bool {
        self.eliminated(c, entries, factors)
    }

    fn eliminate_complex(&self, c: Complex<f64>, entries: &[f64], factors: &mut [Complex<f64>]) -> bool {
        self.eliminated(c, entries, factors)
    }

    fn substitute(&self, factors: &[f64], b: &mut [f64]) {
        self.substituted(factors, b);
    }

    fn substitute_complex(&self, factors: &[Complex<f64>], b: &mut [Complex<f64>]) {
        self.substituted(factors, b);
    }

    fn second(&self) -> Range<usize> {
        self.system.second_order().map_or(0..0, |second| second.states())
    }

    fn second_derivatives(&self, x: &[f64], dx: &mut [f64]) {
        if let Some(second) = self.system.second_order() {
            second.second_derivatives(whole(x), whole_mut(dx));
        }
    }

    fn forces(&self, t: f64, x: &[f64], dx: &mut [f64]) {
        match self.system.second_order() {
            Some(second) => {
                count(self.counters.rates, 1);
                self.arch.dispatch(Forces { second, t, x: whole(x), negative: self.negative, dx: whole_mut(dx) });
            }
            None => self.rate(t, x, dx),
        }
    }

    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.system.second_order()?.operations()
    }

    fn series(&self) -> Option<SeriesSize> {
        self.system.series().map(|series| SeriesSize { width: series.width(), operations: series.operations() })
    }

    fn expand(&self, t: f64, h: f64, rows: &mut [f64], series: &mut [f64]) {
        let series: &mut [SVector<f64, N>] = bytemuck::cast_slice_mut(series);
        if let Some(expansion) = self.system.series().filter(|_| !series.is_empty()) {
            count(self.counters.series_orders, (series.len() - 1) as u64);
            self.arch.dispatch(Expansion { expansion, t, h, negative: self.negative, rows, series });
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
