//! A system or model in `f64`, over slices.
//!
//! In: a [`System`] or [`Model`] whose numbers are in its type. Out: [`Typed`]: rates, forces, series and eliminations
//! are compiled for the vectors of the machine.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Deref, Range};

use nalgebra::{Complex, SVector};
use pulp::NullaryFnOnce;

use super::{Dynamics, Machine, inlined, memory};
use crate::model::assembly::AssemblyError;
use crate::model::capability::{
    Elimination, Impacts, Inlined, Joints, Linearised, Named, Reversed, SecondOrder, Series, SeriesSize, Storages,
    Turning,
};
use crate::model::clock::Clock;
use crate::model::delay::Delay;
use crate::model::description::{Description, StateInfo};
use crate::model::holding::{Held, Redundancy, Stops};
use crate::model::linear::{Field, Sparsity, differences};
use crate::model::origin::Origin;
use crate::model::scalar::machine::Arch;
use crate::model::slices::UNNAMED;
use crate::model::system::{Model, Powers, System, switches, values, values_mut};

/// A system, or a model with `M` outputs, whose numbers are in its type: borrowed, or held by `H`.
#[derive(Clone, Copy, Debug)]
pub struct Typed<H, const N: usize, const G: usize, const M: usize> {
    pub(crate) of: H,
    /// The machine's vectors.
    pub(crate) arch: Arch,
}

impl<H: Deref, const N: usize, const G: usize> Typed<H, N, G, 0>
where
    H::Target: System<f64, N, G> + Sized,
{
    /// A system.
    #[must_use]
    pub fn system(of: H) -> Self {
        Self { of, arch: Arch::new() }
    }
}

impl<H: Deref, const N: usize, const G: usize, const M: usize> Typed<H, N, G, M>
where
    H::Target: Model<f64, N, G, M> + Sized,
{
    /// A model.
    #[must_use]
    pub fn model(of: H) -> Self {
        Self { of, arch: Arch::new() }
    }
}

impl<H: Deref, const N: usize, const G: usize, const M: usize> Typed<H, N, G, M>
where
    H::Target: System<f64, N, G> + Sized,
{
    /// The elimination made for the system's sparsity.
    #[inline(always)]
    fn elimination(&self) -> Option<&impl Elimination<f64, N>> {
        self.of.linearised().and_then(Linearised::elimination)
    }

    fn eliminated<F: Field<f64>>(&self, c: F, entries: &[f64], factors: &mut [F]) -> bool {
        let made =
            |elimination| self.arch.dispatch_or(Eliminate { elimination, c, entries, factors }, Eliminate::compactly);
        self.elimination().is_some_and(made)
    }

    fn substituted<F: Field<f64>>(&self, factors: &[F], b: &mut [F]) {
        if let Some(elimination) = self.elimination() {
            let b = b.first_chunk_mut().expect("there is a number for each state");
            self.arch.dispatch_or(Substitute { elimination, factors, b }, Substitute::compactly);
        }
    }
}

impl<H: Deref, const N: usize, const G: usize, const M: usize> Dynamics for Typed<H, N, G, M>
where
    H::Target: System<f64, N, G> + Sized,
{
    fn states(&self) -> usize {
        N
    }

    fn switches(&self) -> usize {
        G
    }

    fn rate(&self, t: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let (x, negative, dx) = (values(x), switches(negative), values_mut(dx));
        self.arch.dispatch(Rate { system: &*self.of, t, x, negative, dx });
    }

    fn guards(&self, t: f64, x: &[f64], negative: &[bool], guards: &mut [f64]) {
        self.of.guards(t, values(x), switches(negative), values_mut(guards));
    }

    fn clocks(&self) -> Vec<Clock<f64>> {
        memory::clocks(self.of.memories())
    }

    fn delays(&self) -> Vec<Delay<f64>> {
        memory::delays(self.of.memories())
    }

    fn memories(&self) -> Vec<usize> {
        memory::states(self.of.memories())
    }

    fn first_branches(&self) -> Vec<bool> {
        self.of.first_branches().to_vec()
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [f64]) {
        self.of.project(t, switches(negative), values_mut(x));
    }

    fn next_break(&self, t: f64) -> f64 {
        self.of.next_break(t)
    }

    fn runs_in_lanes(&self) -> bool {
        self.of.inlined().is_none_or(Inlined::runs_in_lanes)
    }

    fn state_name(&self, index: usize) -> &'static str {
        self.of.named().map_or(UNNAMED, |named| named.state_name(index))
    }

    fn switch_name(&self, index: usize) -> Option<&'static str> {
        self.of.named()?.switch_name(index)
    }

    fn not_finite(&self, t: f64, x: &[f64], negative: &[bool]) -> Option<Origin> {
        self.of.named()?.not_finite(t, values(x), switches(negative))
    }

    fn turning(&self) -> &'static [&'static str] {
        self.of.turning().map_or(&[], Turning::joints)
    }

    fn pivots(&self, t: f64, x: &[f64], negative: &[bool], pivots: &mut [f64]) {
        if let Some(turning) = self.of.turning() {
            turning.pivots(t, values(x), switches(negative), pivots);
        }
    }

    fn sparsity(&self) -> Sparsity {
        self.of.linearised().map_or(Sparsity::Full, Linearised::sparsity)
    }

    fn jacobian(&self, t: f64, x: &[f64], negative: &[bool], entries: &mut [f64], slope: &mut [f64]) {
        let negative = switches(negative);
        match self.of.linearised() {
            Some(linearised) => linearised.jacobian(t, values(x), negative, entries, values_mut(slope)),
            None => {
                let mut rate = |t, x: &[f64], dx: &mut [f64]| self.of.rate(t, values(x), negative, values_mut(dx));
                differences(&mut rate, t, x, entries, slope, &mut [0.0; N]);
            }
        }
    }

    fn damping_sparsity(&self) -> Sparsity {
        self.of.linearised().map_or(Sparsity::Full, Linearised::damping_sparsity)
    }

    fn damping(&self, t: f64, x: &[f64], negative: &[bool], entries: &mut [f64]) {
        match self.of.linearised() {
            Some(linearised) => linearised.damping(t, values(x), switches(negative), entries),
            None => self.jacobian(t, x, negative, entries, &mut [0.0; N]),
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
        self.of.second_order().map_or(0..0, |second| second.states())
    }

    fn second_derivatives(&self, x: &[f64], dx: &mut [f64]) {
        if let Some(second) = self.of.second_order() {
            second.second_derivatives(values(x), values_mut(dx));
        }
    }

    fn forces(&self, t: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        match self.of.second_order() {
            Some(second) => {
                let (x, negative, dx) = (values(x), switches(negative), values_mut(dx));
                self.arch.dispatch(Forces { second, t, x, negative, dx });
            }
            None => self.rate(t, x, negative, dx),
        }
    }

    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.of.second_order()?.operations()
    }

    fn series(&self) -> Option<SeriesSize> {
        self.of.series().map(|series| SeriesSize { width: series.width(), operations: series.operations() })
    }

    fn expand(&self, t: f64, h: f64, negative: &[bool], rows: &mut [f64], series: &mut [f64]) {
        let series: &mut [SVector<f64, N>] = bytemuck::cast_slice_mut(series);
        if let Some(expansion) = self.of.series() {
            self.arch.dispatch(Expansion { expansion, t, h, negative: switches(negative), rows, series });
        }
    }

    fn held(&self) -> Option<Held> {
        self.of.joints().map(Joints::held)
    }

    fn kept(&self) -> &[f64] {
        self.of.joints().map_or(&[], Joints::kept)
    }

    fn hold(&self, t: f64, x: &[f64], negative: &[bool], entries: &mut [f64]) {
        if let Some(joints) = self.of.joints() {
            joints.hold(t, values(x), switches(negative), entries);
        }
    }

    fn stops(&self) -> Option<Stops> {
        self.of.impacts().map(Impacts::stops)
    }

    fn kept_of_stops(&self) -> &[f64] {
        self.of.impacts().map_or(&[], Impacts::kept)
    }

    fn impact(&self, t: f64, x: &[f64], negative: &[bool], entries: &mut [f64]) {
        if let Some(impacts) = self.of.impacts() {
            impacts.impact(t, values(x), switches(negative), entries);
        }
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.of.storages().map(Storages::states)
    }

    fn energy(&self, t: f64, x: &[f64], negative: &[bool], curvatures: &mut [f64]) -> f64 {
        let of = self.of.storages();
        of.map_or(0.0, |storages| storages.energy(t, values(x), switches(negative), values_mut(curvatures)))
    }
}

impl<H: Deref, const N: usize, const G: usize, const M: usize> Machine for Typed<H, N, G, M>
where
    H::Target: Model<f64, N, G, M> + Sized,
{
    fn description(&self) -> &'static Description {
        self.of.description()
    }

    fn start(&self) -> Result<Vec<f64>, AssemblyError> {
        let mut x = vec![0.0; N];
        self.of.start_over(self, &mut x)?;
        Ok(x)
    }

    fn redundant(&self) -> Vec<Redundancy> {
        self.of.redundant_over(self)
    }

    fn decided(&self) -> Vec<f64> {
        self.of.decided()
    }

    fn impulse_energy(&self) -> Result<f64, AssemblyError> {
        self.of.impulse_energy_over(self)
    }

    fn outputs(&self, t: f64, x: &[f64], negative: &[bool], y: &mut [f64]) {
        self.of.outputs(t, values(x), switches(negative), values_mut(y));
    }

    fn stored_energy(&self, t: f64, x: &[f64], negative: &[bool]) -> f64 {
        self.of.stored_energy(t, values(x), switches(negative))
    }

    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>) {
        self.of.shown(t, values(x), switches(negative), shown);
    }

    fn powers(&self, t: f64, x: &[f64], negative: &[bool]) -> Powers<f64> {
        self.of.powers(t, values(x), switches(negative))
    }

    fn constants(&self) -> &[f64] {
        self.of.reversed().map_or(&[], Reversed::constants)
    }
}

// Closures are not inlined into what is compiled for vectors.

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
        let Self { system, t, x, negative, dx } = self;
        inlined::where_short(system, system.inlined(), t, x, negative, dx);
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

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> Eliminate<'_, E, F, N> {
    fn compactly(self) -> bool {
        self.elimination.eliminate_compactly(self.c, self.entries, self.factors)
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

impl<E: Elimination<f64, N>, F: Field<f64>, const N: usize> Substitute<'_, E, F, N> {
    fn compactly(self) {
        self.elimination.substitute_compactly(self.factors, self.b);
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
