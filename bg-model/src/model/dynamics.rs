//! A system and a model as a run sees them: over slices, whatever the number of their states, switches and outputs, so
//! that what drives them is compiled once.
//!
//! In: a [`System`] or [`Model`] whose numbers are in its type. Out: the same behind one table of functions,
//! [`Dynamics`] and [`Machine`]; rates, series and eliminations are compiled for the vectors of the machine at hand.

use alloc::rc::Rc;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::{Deref, Range};

use nalgebra::{ArrayStorage, Complex, SVector};
use pulp::NullaryFnOnce;

use crate::model::assembly::AssemblyError;
use crate::model::capability::{Elimination, Impacts, Joints, Linearised, SecondOrder, Series, SeriesSize, Storages};
use crate::model::description::{Description, StateInfo};
use crate::model::holding::{Held, Redundancy, Stops};
use crate::model::linear::{Field, Sparsity, differences};
use crate::model::origin::Origin;
use crate::model::scalar::machine::Arch;
use crate::model::scalar::slopes::Slopes;
use crate::model::scalar::{GradientIn, Scalar};
use crate::model::system::{Model, Powers, System, decide_by_sign, switches, values, values_mut};

/// A system of ordinary differential equations: [`System`], over slices. States `x` and all that there is one of for
/// each of them have [`Dynamics::states`] numbers, the branches `negative` of the switches [`Dynamics::switches`]. Only
/// the number of states and the rate have to be written; what else a system knows of itself it may say.
///
/// # Panics
/// Each function, where a slice is shorter.
pub trait Dynamics<S: Scalar = f64> {
    /// The number of states.
    fn states(&self) -> usize;

    /// The number of switches; none by default.
    fn switches(&self) -> usize {
        0
    }

    /// [`System::rate`].
    fn rate(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]);

    /// [`System::guards`].
    fn guards(&self, _t: S, _x: &[S], _negative: &[S::Switch], _guards: &mut [S]) {}

    /// [`System::first_branches`].
    fn first_branches(&self) -> Vec<bool> {
        vec![false; self.switches()]
    }

    /// [`System::project`].
    fn project(&self, _t: S, _negative: &[S::Switch], _x: &mut [S]) {}

    /// [`System::next_break`].
    fn next_break(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// [`System::state_name`].
    fn state_name(&self, _index: usize) -> &'static str {
        "state"
    }

    /// [`System::switch_name`].
    fn switch_name(&self, _index: usize) -> Option<&'static str> {
        None
    }

    /// [`System::not_finite`].
    fn not_finite(&self, _t: S, _x: &[S], _negative: &[S::Switch]) -> Option<Origin> {
        None
    }

    /// [`Linearised::sparsity`]; full where the system does not know its Jacobian.
    fn sparsity(&self) -> Sparsity {
        Sparsity::Full
    }

    /// [`Linearised::jacobian`]; by differences where the system does not know it.
    fn jacobian(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S], slope: &mut [S]) {
        let rate = |t, x: &[S], dx: &mut [S]| self.rate(t, x, negative, dx);
        differences(rate, t, x, entries, slope, &mut vec![S::from_f64(0.0); x.len()]);
    }

    /// [`Linearised::damping_sparsity`].
    fn damping_sparsity(&self) -> Sparsity {
        self.sparsity()
    }

    /// [`Linearised::damping`].
    fn damping(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        self.jacobian(t, x, negative, entries, &mut vec![S::from_f64(0.0); x.len()]);
    }

    /// [`Elimination::factors`]; none where there is no elimination.
    fn factors(&self) -> Option<usize> {
        None
    }

    /// [`Elimination::eliminate`].
    fn eliminate(&self, _c: S, _entries: &[S], _factors: &mut [S]) -> bool {
        false
    }

    /// The same with a complex `c`.
    fn eliminate_complex(&self, _c: Complex<f64>, _entries: &[f64], _factors: &mut [Complex<f64>]) -> bool {
        false
    }

    /// [`Elimination::substitute`].
    fn substitute(&self, _factors: &[S], _b: &mut [S]) {}

    /// The same with a complex c.
    fn substitute_complex(&self, _factors: &[Complex<f64>], _b: &mut [Complex<f64>]) {}

    /// [`SecondOrder::states`]; an empty range where none are known.
    fn second(&self) -> Range<usize> {
        0..0
    }

    /// [`SecondOrder::second_derivatives`].
    fn second_derivatives(&self, _x: &[S], _dx: &mut [S]) {}

    /// [`SecondOrder::forces`]; the rate where no states of second order are known.
    fn forces(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        self.rate(t, x, negative, dx);
    }

    /// [`SecondOrder::operations`].
    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        None
    }

    /// What a Taylor series takes; none where there is no series.
    fn series(&self) -> Option<SeriesSize> {
        None
    }

    /// [`Series::expand`]: order by order, of each all states.
    fn expand(&self, _t: S, _h: S, _negative: &[S::Switch], _rows: &mut [S], _series: &mut [S]) {}

    /// [`Joints::held`]; none where joints hold nothing.
    fn held(&self) -> Option<Held> {
        None
    }

    /// [`Joints::kept`].
    fn kept(&self) -> &[f64] {
        &[]
    }

    /// [`Joints::hold`].
    fn hold(&self, _t: S, _x: &[S], _negative: &[S::Switch], _entries: &mut [S]) {}

    /// [`Impacts::stops`]; none where nothing is hit.
    fn stops(&self) -> Option<Stops> {
        None
    }

    /// [`Impacts::kept`].
    fn kept_of_stops(&self) -> &[f64] {
        &[]
    }

    /// [`Impacts::impact`].
    fn impact(&self, _t: S, _x: &[S], _negative: &[S::Switch], _entries: &mut [S]) {}

    /// [`Storages::states`]; none of a system that does not know what it stores.
    fn stored(&self) -> Option<&'static [StateInfo]> {
        None
    }

    /// [`Storages::energy`]; 0 where nothing is known.
    fn energy(&self, _t: S, _x: &[S], _negative: &[S::Switch], curvatures: &mut [S]) -> S {
        curvatures.fill(S::from_f64(0.0));
        S::from_f64(0.0)
    }
}

/// A model, over slices: [`Model`]. Outputs `y` are [`Description::outputs`] many.
///
/// # Panics
/// As [`Dynamics`].
pub trait Machine<S: Scalar = f64>: Dynamics<S> {
    /// [`Model::description`].
    fn description(&self) -> &'static Description;

    /// [`Model::start`].
    ///
    /// # Errors
    /// As there.
    fn start(&self) -> Result<Vec<S>, AssemblyError>;

    /// [`Model::redundant`].
    fn redundant(&self) -> Vec<Redundancy>;

    /// [`Model::decided`].
    fn decided(&self) -> Vec<f64>;

    /// [`Model::impulse_energy`].
    ///
    /// # Errors
    /// As there.
    fn impulse_energy(&self) -> Result<S, AssemblyError>;

    /// [`Model::outputs`].
    fn outputs(&self, t: S, x: &[S], negative: &[S::Switch], y: &mut [S]);

    /// [`Model::stored_energy`].
    fn stored_energy(&self, t: S, x: &[S], negative: &[S::Switch]) -> S;

    /// [`Model::shown`].
    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>);

    /// [`Model::powers`].
    fn powers(&self, t: S, x: &[S], negative: &[S::Switch]) -> Powers<S>;
}

/// A system as a step of a state with slopes in the vectors `V` asks for it, over slices: each of its functions is
/// compiled for these vectors.
///
/// # Panics
/// As [`Dynamics`].
pub trait Rates<V> {
    /// [`System::rate`] at time `t` (s).
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]);

    /// [`System::project`] at time `t` (s).
    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]);
}

/// The branches of the switches of a system at time `t` (s) and state `x`.
#[must_use]
pub fn branches<S: Scalar>(system: &dyn Dynamics<S>, t: f64, x: &[S]) -> Vec<bool> {
    let mut negative = system.first_branches();
    let mut guards = vec![S::from_f64(0.0); system.switches()];
    decide_by_sign(&mut negative, &mut guards, |negative, guards| {
        let negative: Vec<S::Switch> = negative.iter().copied().map(S::Switch::from).collect();
        system.guards(S::from_f64(t), x, &negative, guards);
    });
    negative
}

/// A model over slices. What is generic over [`Model`] and asks for this is compiled once for each model.
pub fn shared<Mo, const N: usize, const G: usize, const M: usize>(model: Mo) -> Rc<dyn Machine>
where
    Mo: Model<f64, N, G, M> + 'static,
{
    Rc::new(Typed::<Rc<Mo>, N, G, M>::model(Rc::new(model)))
}

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

/// A system or model in any scalar, borrowed or held by `H`, as starts, reactions and studies ask for it. Its functions
/// are those that calculate with one number at a time, and hand over copies.
#[derive(Clone, Copy, Debug)]
pub struct Over<H, const N: usize, const G: usize, const M: usize>(pub H);

impl<S, H, const N: usize, const G: usize, const M: usize> Dynamics<S> for Over<H, N, G, M>
where
    S: Scalar,
    H: Deref,
    H::Target: System<S, N, G> + Sized,
{
    fn states(&self) -> usize {
        N
    }

    fn switches(&self) -> usize {
        G
    }

    fn rate(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        let mut rates = SVector::from_column_slice(dx);
        self.0.rate(t, &SVector::from_column_slice(x), &each(negative), &mut rates);
        dx.copy_from_slice(rates.as_slice());
    }

    fn guards(&self, t: S, x: &[S], negative: &[S::Switch], guards: &mut [S]) {
        let mut values = SVector::from_column_slice(guards);
        self.0.guards(t, &SVector::from_column_slice(x), &each(negative), &mut values);
        guards.copy_from_slice(values.as_slice());
    }

    fn first_branches(&self) -> Vec<bool> {
        self.0.first_branches().to_vec()
    }

    fn project(&self, t: S, negative: &[S::Switch], x: &mut [S]) {
        let mut state = SVector::from_column_slice(x);
        self.0.project(t, &each(negative), &mut state);
        x.copy_from_slice(state.as_slice());
    }

    fn next_break(&self, t: f64) -> f64 {
        self.0.next_break(t)
    }

    fn state_name(&self, index: usize) -> &'static str {
        self.0.state_name(index)
    }

    fn switch_name(&self, index: usize) -> Option<&'static str> {
        self.0.switch_name(index)
    }

    fn held(&self) -> Option<Held> {
        self.0.joints().map(Joints::held)
    }

    fn kept(&self) -> &[f64] {
        self.0.joints().map_or(&[], Joints::kept)
    }

    fn hold(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(joints) = self.0.joints() {
            joints.hold(t, &SVector::from_column_slice(x), &each(negative), entries);
        }
    }

    fn stops(&self) -> Option<Stops> {
        self.0.impacts().map(Impacts::stops)
    }

    fn kept_of_stops(&self) -> &[f64] {
        self.0.impacts().map_or(&[], Impacts::kept)
    }

    fn impact(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(impacts) = self.0.impacts() {
            impacts.impact(t, &SVector::from_column_slice(x), &each(negative), entries);
        }
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.0.storages().map(Storages::states)
    }

    fn energy(&self, t: S, x: &[S], negative: &[S::Switch], curvatures: &mut [S]) -> S {
        let Some(storages) = self.0.storages() else { return S::from_f64(0.0) };
        let mut values = SVector::from_column_slice(curvatures);
        let energy = storages.energy(t, &SVector::from_column_slice(x), &each(negative), &mut values);
        curvatures.copy_from_slice(values.as_slice());
        energy
    }
}

impl<S, H, const N: usize, const G: usize, const M: usize> Machine<S> for Over<H, N, G, M>
where
    S: Scalar,
    H: Deref,
    H::Target: Model<S, N, G, M> + Sized,
{
    fn description(&self) -> &'static Description {
        self.0.description()
    }

    fn start(&self) -> Result<Vec<S>, AssemblyError> {
        Ok(self.0.start()?.as_slice().to_vec())
    }

    fn redundant(&self) -> Vec<Redundancy> {
        self.0.redundant()
    }

    fn decided(&self) -> Vec<f64> {
        self.0.decided()
    }

    fn impulse_energy(&self) -> Result<S, AssemblyError> {
        self.0.impulse_energy()
    }

    fn outputs(&self, t: S, x: &[S], negative: &[S::Switch], y: &mut [S]) {
        let mut outputs = SVector::from_column_slice(y);
        self.0.outputs(t, &SVector::from_column_slice(x), &each(negative), &mut outputs);
        y.copy_from_slice(outputs.as_slice());
    }

    fn stored_energy(&self, t: S, x: &[S], negative: &[S::Switch]) -> S {
        self.0.stored_energy(t, &SVector::from_column_slice(x), &each(negative))
    }

    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>) {
        self.0.shown(t, &SVector::from_column_slice(x), &each(negative), shown);
    }

    fn powers(&self, t: S, x: &[S], negative: &[S::Switch]) -> Powers<S> {
        self.0.powers(t, &SVector::from_column_slice(x), &each(negative))
    }
}

/// A system whose numbers are in its type, as steps with slopes ask for it.
#[derive(Clone, Copy, Debug)]
pub struct InVectors<Sys, const N: usize, const G: usize>(pub Sys);

impl<V: Slopes, Sys: System<GradientIn<V>, N, G>, const N: usize, const G: usize> Rates<V> for InVectors<Sys, N, G> {
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]) {
        V::vectorized(SlopedRate::<V, Sys, N, G> { system: &self.0, t, x, negative: switches(negative), dx });
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]) {
        V::vectorized(SlopedProjection::<V, Sys, N, G> { system: &self.0, t, negative: switches(negative), x });
    }
}

/// The branches in an array.
fn each<T: Copy, const G: usize>(negative: &[T]) -> [T; G] {
    negative.try_into().expect("there is a branch for each switch")
}

// What is compiled for the vectors of the machine: closures are not inlined there.

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

struct SlopedRate<'a, V, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: f64,
    x: &'a [GradientIn<V>],
    negative: &'a [bool; G],
    dx: &'a mut [GradientIn<V>],
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for SlopedRate<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (t, x) = (GradientIn::from_f64(self.t), state(self.x));
        let mut rates = x;
        if V::MUST_BE_INLINED {
            self.system.always_inlined_rate(t, &x, self.negative, &mut rates);
        } else {
            self.system.rate(t, &x, self.negative, &mut rates);
        }
        self.dx.copy_from_slice(&rates.data.0[0]);
    }
}

struct SlopedProjection<'a, V, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: f64,
    negative: &'a [bool; G],
    x: &'a mut [GradientIn<V>],
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for SlopedProjection<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (t, mut x) = (GradientIn::from_f64(self.t), state(self.x));
        if V::MUST_BE_INLINED {
            self.system.inlined_project(t, self.negative, &mut x);
        } else {
            self.system.project(t, self.negative, &mut x);
        }
        self.x.copy_from_slice(&x.data.0[0]);
    }
}

/// The numbers of all states as a system takes them; a copy, which is none where it is inlined.
#[inline(always)]
fn state<S: Copy, const N: usize>(of: &[S]) -> SVector<S, N> {
    SVector::from_array_storage(ArrayStorage([*of.first_chunk().expect("there is a number for each state")]))
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

    fn first_branches(&self) -> Vec<bool> {
        self.of.first_branches().to_vec()
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [f64]) {
        self.of.project(t, switches(negative), values_mut(x));
    }

    fn next_break(&self, t: f64) -> f64 {
        self.of.next_break(t)
    }

    fn state_name(&self, index: usize) -> &'static str {
        self.of.state_name(index)
    }

    fn switch_name(&self, index: usize) -> Option<&'static str> {
        self.of.switch_name(index)
    }

    fn not_finite(&self, t: f64, x: &[f64], negative: &[bool]) -> Option<Origin> {
        self.of.not_finite(t, values(x), switches(negative))
    }

    fn sparsity(&self) -> Sparsity {
        self.of.linearised().map_or(Sparsity::Full, Linearised::sparsity)
    }

    fn jacobian(&self, t: f64, x: &[f64], negative: &[bool], entries: &mut [f64], slope: &mut [f64]) {
        let negative = switches(negative);
        match self.of.linearised() {
            Some(linearised) => linearised.jacobian(t, values(x), negative, entries, values_mut(slope)),
            None => {
                let rate = |t, x: &[f64], dx: &mut [f64]| self.of.rate(t, values(x), negative, values_mut(dx));
                differences(rate, t, x, entries, slope, &mut [0.0; N]);
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
        Ok(self.of.start()?.as_slice().to_vec())
    }

    fn redundant(&self) -> Vec<Redundancy> {
        self.of.redundant()
    }

    fn decided(&self) -> Vec<f64> {
        self.of.decided()
    }

    fn impulse_energy(&self) -> Result<f64, AssemblyError> {
        self.of.impulse_energy()
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
}
