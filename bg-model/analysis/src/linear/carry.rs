//! A finite move of a mechanism along its kinematics.
//!
//! In: a state, momenta that carry it for one unit of pseudo-time, changes that are added, which states stay. Out: the
//! state after the move: orientations are rotations, displacements that are integrated fit the poses, gaps of rigid
//! joints closed.
//! Method: q' = A(q) p from rest, with the slope A of the rates of the other states by the momenta, by the classical
//! Runge-Kutta method. Where joints are rigid, p loses what they hold, as by an impulse, and closes the gaps q by p
//! such that the flows are -q.

use bg_model::dynamics::{Dynamics, branches};
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::scalar::{Gradient, Scalar};

use super::sloped::{held, projected, rates};

/// Singular values below this part of the largest entry are of rows that follow from others.
const FOLLOWS: f64 = 1e-10;

/// A move.
pub(super) struct Carry {
    /// The momenta that carry: zero for states that are not momenta.
    pub push: DVector<f64>,
    /// What is added to every state.
    pub add: DVector<f64>,
    /// Which states the kinematics leaves alone: momenta, and integrals that outputs ask for.
    pub stays: Vec<bool>,
    /// Which states are momenta.
    pub momenta: Vec<bool>,
    /// The number of steps.
    pub steps: usize,
}

/// The state that the move leads to from `x`.
pub(super) fn carried(model: &dyn Dynamics<Gradient>, t: f64, x: &DVector<f64>, carry: &Carry) -> DVector<f64> {
    let momenta: DVector<f64> = x.zip_map(&mask(&carry.momenta), |value, is| value * is);
    let negative = branches(model, t, &still(x));
    let kinematics = Kinematics { model, t: Gradient::from_f64(t), carry, negative };
    let mut place = x - &momenta;
    let gaps = kinematics.gaps(&place);
    let h = 1.0 / carry.steps as f64;
    for _ in 0..carry.steps {
        let k1 = kinematics.slope(&place, &gaps);
        let k2 = kinematics.slope(&(&place + &k1 * (h / 2.0)), &gaps);
        let k3 = kinematics.slope(&(&place + &k2 * (h / 2.0)), &gaps);
        let k4 = kinematics.slope(&(&place + &k3 * h), &gaps);
        place += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
        place = kinematics.projected(&place);
    }
    let added = carry.add.zip_map(&mask(&carry.momenta), |value, is| value * is);
    kinematics.fitting(place + momenta + added)
}

struct Kinematics<'a> {
    model: &'a dyn Dynamics<Gradient>,
    t: Gradient,
    carry: &'a Carry,
    negative: Vec<bool>,
}

impl Kinematics<'_> {
    /// d/ds of all states but momenta, which are zero at `place`.
    fn slope(&self, place: &DVector<f64>, gaps: &DVector<f64>) -> DVector<f64> {
        let mut push = self.carry.push.clone();
        if let Some(held) = held(self.model, self.t, &along(place, &push), &self.negative) {
            let flows = DVector::from_iterator(held.flows.len(), held.flows.iter().map(|flow| flow.slopes()[0]));
            push -= held.moves * solved(held.matrix, &(flows + gaps));
        }
        let rates = rates(self.model, self.t, &along(place, &push), &self.negative);
        let moved = |state: usize| rates[state].slopes()[0] + self.carry.add[state];
        DVector::from_fn(place.len(), |state, _| if self.carry.stays[state] { 0.0 } else { moved(state) })
    }

    /// The gaps of the rigid motions; none without rigid joints.
    fn gaps(&self, place: &DVector<f64>) -> DVector<f64> {
        let held = held(self.model, self.t, &still(place), &self.negative);
        held.map_or(DVector::zeros(0), |held| held.gaps)
    }

    /// The state with momenta that rigid joints allow.
    fn fitting(&self, x: DVector<f64>) -> DVector<f64> {
        let Some(held) = held(self.model, self.t, &still(&x), &self.negative) else {
            return x;
        };
        let flows = DVector::from_iterator(held.flows.len(), held.flows.iter().map(|flow| flow.value));
        x - held.moves * solved(held.matrix, &flows)
    }

    fn projected(&self, x: &DVector<f64>) -> DVector<f64> {
        let projected = projected(self.model, self.t, &still(x), &self.negative);
        DVector::from_iterator(x.len(), projected.iter().map(|state| state.value))
    }
}

/// The solution of least norm: rows may follow from others.
fn solved(matrix: DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let least = FOLLOWS * matrix.amax();
    let solution = matrix.svd(true, true).solve(right, least);
    solution.unwrap_or_else(|_| DVector::repeat(right.len(), f64::NAN))
}

/// The state, changing along one direction.
fn along(x: &DVector<f64>, direction: &DVector<f64>) -> Vec<Gradient> {
    x.iter().zip(direction).map(|(&x, &along)| Gradient::new(x, [along; Gradient::WIDTH])).collect()
}

/// The state, which does not change.
fn still(x: &DVector<f64>) -> Vec<Gradient> {
    x.iter().map(|&x| Gradient::from_f64(x)).collect()
}

/// 1 where true, 0 where not.
fn mask(of: &[bool]) -> DVector<f64> {
    DVector::from_iterator(of.len(), of.iter().map(|&is| if is { 1.0 } else { 0.0 }))
}
