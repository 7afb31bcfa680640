//! How large the states of a reference solution are: what their errors are measured by.
//!
//! In: a system in any scalar, a state. Out: for each state its own value, or a part of the size at which it counts
//! beside the others, as in a run ([`crate::simulation::sizes`]): in any units, and of a machine of any size, the steps
//! are the same.

use crate::model::description::StateInfo;
use crate::model::dynamics::Dynamics;
use crate::model::scalar::Scalar;
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
struct Rounded<'a, S: Scalar>(&'a dyn Dynamics<S>);

fn lifted<S: Scalar>(x: &[f64]) -> Vec<S> {
    x.iter().copied().map(S::from_f64).collect()
}

fn rounded<S: Scalar>(from: &[S], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = from.to_f64());
}

impl<S: Scalar<Switch = bool>> Dynamics for Rounded<'_, S> {
    fn states(&self) -> usize {
        self.0.states()
    }

    fn switches(&self) -> usize {
        self.0.switches()
    }

    fn rate(&self, t: f64, x: &[f64], negative: &[bool], dx: &mut [f64]) {
        let mut rate = lifted::<S>(dx);
        self.0.rate(S::from_f64(t), &lifted(x), negative, &mut rate);
        rounded(&rate, dx);
    }

    fn guards(&self, t: f64, x: &[f64], negative: &[bool], guards: &mut [f64]) {
        let mut values = lifted::<S>(guards);
        self.0.guards(S::from_f64(t), &lifted(x), negative, &mut values);
        rounded(&values, guards);
    }

    fn first_branches(&self) -> Vec<bool> {
        self.0.first_branches()
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        self.0.stored()
    }

    fn energy(&self, t: f64, x: &[f64], negative: &[bool], curvatures: &mut [f64]) -> f64 {
        curvatures.fill(0.0);
        let mut of_states = lifted::<S>(curvatures);
        let energy = self.0.energy(S::from_f64(t), &lifted(x), negative, &mut of_states);
        rounded(&of_states, curvatures);
        energy.to_f64()
    }
}

/// Whether a state has outgrown its size.
pub(super) fn are_outgrown<S: Scalar>(sizes: &[f64], x: &[S]) -> bool {
    sizes.iter().zip(x).any(|(size, x)| x.to_f64().abs() > OUTGROWN * size)
}

/// Raises the sizes to those at time `t` (s) and state `x`; of a start at rest by what happens in `ahead` (s).
/// Of a system that does not know what it stores all states have the size of the largest.
pub(super) fn raise<S: Scalar<Switch = bool>>(
    sizes: &mut [f64],
    system: &dyn Dynamics<S>,
    (t, x): (S, &[S]),
    ahead: f64,
    tolerance: f64,
) {
    let rounded = Rounded(system);
    let x: Vec<f64> = x.iter().copied().map(S::to_f64).collect();
    let [own, beside] = sizes_within(&rounded, t.to_f64(), &x, ahead);
    let part = if rounded.stored().is_some() { (NOISE * rounding::<S>() / tolerance).clamp(BESIDE, 1.0) } else { 1.0 };
    for (i, size) in sizes.iter_mut().enumerate() {
        *size = size.max(own[i]).max(part * beside[i]);
    }
}
