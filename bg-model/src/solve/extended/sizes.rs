//! How large the states of a reference solution are: what their errors are measured by.
//!
//! In: a system in any scalar, a state. Out: for each state its own value, or a part of the size at which it counts
//! beside the others, as in a run ([`crate::simulation::sizes`]): in any units, and of a machine of any size, the steps
//! are the same.

use nalgebra::SVector;

use crate::model::capability::Storages;
use crate::model::description::StateInfo;
use crate::model::dynamics::Dynamics;
use crate::model::scalar::Scalar;
use crate::model::system::{System, switches, values};
use crate::solve::simulation::sizes_within;

/// By how much a state outgrows its size before the sizes are looked at anew.
const OUTGROWN: f64 = 8.0;

/// The part of its size beside the others that a state has at least, as in a run; more where the tolerance is near
/// rounding, which mixes all states: so many times rounding is no error.
const BESIDE: f64 = 1e-9;
const NOISE: f64 = 100.0;

/// The rounding of a scalar, relative: what roots leave of their squares.
fn rounding<S: Scalar>() -> f64 {
    let left = |square: f64| {
        let root = S::from_f64(square).sqrt();
        ((root * root - S::from_f64(square)).to_f64() / square).abs()
    };
    [2.0, 3.0, 5.0, 7.0, 11.0].into_iter().map(left).fold(f64::EPSILON * f64::EPSILON, f64::max)
}

/// A system in another scalar, in `f64` at its face.
struct Rounded<'a, S, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    scalar: core::marker::PhantomData<S>,
}

fn lifted<S: Scalar, const N: usize>(x: &[f64]) -> SVector<S, N> {
    values::<N>(x).map(S::from_f64)
}

fn rounded<S: Scalar>(from: &[S], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from.to_f64());
}

impl<S, Sys, const N: usize, const G: usize> Dynamics for Rounded<'_, S, Sys, N, G>
where
    S: Scalar<Switch = bool>,
    Sys: System<S, N, G>,
{
    fn states(&self) -> usize {
        N
    }

    fn switches(&self) -> usize {
        G
    }

    fn rate(&self, t: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let mut rate = SVector::from_element(S::from_f64(0.0));
        self.system.rate(S::from_f64(t), &lifted(x), switches::<G>(negative), &mut rate);
        rounded(rate.as_slice(), dx);
    }

    fn guards(&self, t: f64, x: &[f64], negative: &[bool], guards: &mut [f64]) {
        let mut value = SVector::from_element(S::from_f64(0.0));
        self.system.guards(S::from_f64(t), &lifted(x), switches::<G>(negative), &mut value);
        rounded(value.as_slice(), guards);
    }

    fn first_branches(&self) -> Vec<bool> {
        self.system.first_branches().to_vec()
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.system.storages().map(Storages::states)
    }

    fn energy(&self, t: f64, x: &[f64], negative: &[bool], curvatures: &mut [f64]) -> f64 {
        curvatures.fill(0.0);
        let Some(storages) = self.system.storages() else { return 0.0 };
        let mut of_states = SVector::from_element(S::from_f64(0.0));
        let energy = storages.energy(S::from_f64(t), &lifted(x), switches::<G>(negative), &mut of_states);
        rounded(of_states.as_slice(), curvatures);
        energy.to_f64()
    }
}

/// Whether a state has outgrown its size.
pub(super) fn are_outgrown<S: Scalar, const N: usize>(sizes: &SVector<f64, N>, x: &SVector<S, N>) -> bool {
    (0..N).any(|i| x[i].to_f64().abs() > OUTGROWN * sizes[i])
}

/// Raises the sizes to those at time `t` (s) and state `x`; of a start at rest by what happens in `ahead` (s).
/// Of a system that does not know what it stores all states have the size of the largest.
pub(super) fn raise<S, Sys, const N: usize, const G: usize>(
    sizes: &mut SVector<f64, N>,
    system: &Sys,
    (t, x): (S, &SVector<S, N>),
    ahead: f64,
    tolerance: f64,
) where
    S: Scalar<Switch = bool>,
    Sys: System<S, N, G>,
{
    let rounded = Rounded { system, scalar: core::marker::PhantomData::<S> };
    let [own, beside] = sizes_within(&rounded, t.to_f64(), x.map(S::to_f64).as_slice(), ahead);
    let part = if rounded.stored().is_some() { (NOISE * rounding::<S>() / tolerance).clamp(BESIDE, 1.0) } else { 1.0 };
    for (i, size) in sizes.iter_mut().enumerate() {
        *size = size.max(own[i]).max(part * beside[i]);
    }
}
