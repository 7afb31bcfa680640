//! A model in numbers with slopes, looked at in one state.
//!
//! In: a model, a time, states as slices, in [`Gradient`]. Out: its rates, outputs and what its rigid joints hold.

use bg_model::dynamics::{Dynamics, Machine};
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::scalar::{Gradient, Scalar};

/// What one evaluation gives.
pub(super) struct Look {
    pub rates: Vec<Gradient>,
    pub outputs: Vec<Gradient>,
    /// The flow of each motion that rigid joints hold.
    pub flows: Vec<Gradient>,
}

/// What the rigid joints of a model hold, at one state.
pub(super) struct HeldNow {
    /// The flow of each motion.
    pub flows: Vec<Gradient>,
    /// The gap of each motion.
    pub gaps: DVector<f64>,
    /// How much each reaction (column) changes the rate of each flow (row).
    pub matrix: DMatrix<f64>,
    /// How much each reaction (column) changes the rate of each state (row).
    pub moves: DMatrix<f64>,
}

/// dx/dt.
pub(super) fn rates(model: &dyn Dynamics<Gradient>, t: Gradient, x: &[Gradient], negative: &[bool]) -> Vec<Gradient> {
    let mut rates = vec![zero(); x.len()];
    model.rate(t, x, negative, &mut rates);
    rates
}

/// All that a linear model asks for.
pub(super) fn look(model: &dyn Machine<Gradient>, t: Gradient, x: &[Gradient], negative: &[bool]) -> Look {
    let mut outputs = vec![zero(); model.description().outputs.len()];
    model.outputs(t, x, negative, &mut outputs);
    let flows = held(model, t, x, negative).map_or(Vec::new(), |held| held.flows);
    Look { rates: rates(model, t, x, negative), outputs, flows }
}

/// What the rigid joints hold; none where there is no rigid joint.
pub(super) fn held(model: &dyn Dynamics<Gradient>, t: Gradient, x: &[Gradient], negative: &[bool]) -> Option<HeldNow> {
    let held = model.held()?;
    let reactions = held.rigid.len();
    if reactions == 0 {
        return None;
    }
    let mut entries = vec![zero(); held.entries()];
    model.hold(t, x, negative, &mut entries);
    let now = held.read(&entries);
    let matrix = DMatrix::from_fn(reactions, reactions, |i, j| {
        let (row, column) = (i.max(j), i.min(j));
        now.lower[row * (row + 1) / 2 + column].value
    });
    let mut by_state = DMatrix::zeros(x.len(), reactions);
    for reaction in 0..reactions {
        for (place, &state) in held.moved.iter().enumerate() {
            by_state[(state, reaction)] = now.moves[reaction * held.moved.len() + place].value;
        }
    }
    let gaps = DVector::from_iterator(reactions, now.gaps.iter().map(|gap| gap.value));
    Some(HeldNow { flows: now.flows[..reactions].to_vec(), gaps, matrix, moves: by_state })
}

/// The state moved onto what joints and orientations ask for.
pub(super) fn projected(
    model: &dyn Dynamics<Gradient>,
    t: Gradient,
    x: &[Gradient],
    negative: &[bool],
) -> Vec<Gradient> {
    let mut x = x.to_vec();
    model.project(t, negative, &mut x);
    x
}

fn zero() -> Gradient {
    Gradient::from_f64(0.0)
}
