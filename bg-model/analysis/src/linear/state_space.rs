//! The linear model of a mechanism at a state: x' = A x + B u, y = C x + D u for small changes of states, inputs and
//! outputs.
//!
//! In: a mechanism, a time at which its inputs are held, a state. Out: the four matrices, names and units of what they
//! are between, the operating point, the modes.
//! Method: exact derivatives by numbers with slopes, in the independent coordinates of `manifold`.
//!
//! At a state that is no equilibrium the same matrices describe the motion relative to that of the model: rotations are
//! those from where the model itself turns. For a rotor that spins about its axis of symmetry they stay the same, and
//! their modes are those of a Campbell diagram; else they are true for a short time only.

use bg_model::description::Description;
use bg_model::mechanism::Differentiable;
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::run::State;
use serde::{Serialize, Serializer};

use super::error::LinearError;
use super::manifold::{LeftOut, Manifold};
use super::modes::{Mode, modes};
use super::plant::{ByInputs, Derivatives, Plant};

/// A name with its unit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Named {
    /// The name.
    pub name: String,
    /// The unit.
    pub unit: String,
}

/// A state at the operating point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointState {
    /// The state's name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Its rate, in its unit per s.
    pub rate: f64,
}

/// A linear model.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StateSpace {
    /// The model's name.
    pub model: String,
    /// The time at which the inputs are held, s.
    pub t: f64,
    /// All states of the model with their values and rates there.
    pub point: Vec<PointState>,
    /// The linear model's states: independent coordinates, such as `rod.position_x`, `rod.rotation_z` (a rotation
    /// vector in inertial axes, rad), `rod.linear.p_x`.
    pub states: Vec<Named>,
    /// Its inputs, in the order of the description.
    pub inputs: Vec<Named>,
    /// Its outputs, in the order of the description.
    pub outputs: Vec<Named>,
    /// States by states, 1/s.
    #[serde(serialize_with = "rows")]
    pub a: DMatrix<f64>,
    /// States by inputs.
    #[serde(serialize_with = "rows")]
    pub b: DMatrix<f64>,
    /// Outputs by states; an output without a derivative there, such as the norm of a force that is zero, has a row of
    /// not-a-number (`null` in JSON).
    #[serde(serialize_with = "rows")]
    pub c: DMatrix<f64>,
    /// Outputs by inputs.
    #[serde(serialize_with = "rows")]
    pub d: DMatrix<f64>,
    /// The modes, the slowest first.
    pub modes: Vec<Mode>,
    /// States of the model that are not among `states`.
    pub left_out: LeftOut,
}

/// The linear model of `mechanism` at state `x`, with its inputs held as they are at time `t` (s). Its switches are in
/// the branches that the signs of their guards call for; [`linearise_at`] knows what sticks or rests.
///
/// # Errors
/// [`LinearError::NotFinite`], [`LinearError::BadRate`] name a rate without a derivative or a value.
pub fn linearise(mechanism: &dyn Differentiable, t: f64, x: &[f64]) -> Result<StateSpace, LinearError> {
    linearised(&Plant::at(mechanism, t, None)?, t, &DVector::from_column_slice(x))
}

/// The linear model of `mechanism` in a state of a run, in the branches of the switches that are known there.
///
/// # Errors
/// As [`linearise`].
pub fn linearise_at(mechanism: &dyn Differentiable, state: &State) -> Result<StateSpace, LinearError> {
    let plant = Plant::at(mechanism, state.t, state.negative())?;
    linearised(&plant, state.t, &DVector::from_vec(state.values()))
}

fn linearised(plant: &Plant, t: f64, x: &DVector<f64>) -> Result<StateSpace, LinearError> {
    let description = plant.description;
    let (here, inputs) = checked(plant, t, x)?;
    let manifold = Manifold::at(plant, x, &here, &inputs);
    let named = |name: &str, unit: &str| Named { name: name.to_owned(), unit: unit.to_owned() };
    let states: Vec<Named> = manifold.coordinates.iter().map(|k| named(&k.name, k.unit)).collect();
    let a = &manifold.chart * (&here.rates_by_state * &manifold.tangent - &manifold.turning);
    let point = description.states.iter().zip(x).zip(&here.rates);
    Ok(StateSpace {
        model: description.name.to_owned(),
        t,
        point: point
            .map(|((state, &value), &rate)| PointState {
                name: state.name.to_owned(),
                unit: state.unit.to_owned(),
                value,
                rate,
            })
            .collect(),
        inputs: description.inputs.iter().map(|input| named(input.name, input.unit)).collect(),
        outputs: description.outputs.iter().map(|output| named(output.name, output.unit)).collect(),
        b: &manifold.chart * &inputs.rates,
        c: &here.outputs_by_state * &manifold.tangent,
        d: inputs.outputs,
        modes: modes(&a, &manifold.coordinates)?,
        states,
        a,
        left_out: manifold.left_out.holding(plant.held()),
    })
}

/// The derivatives at state `x`, all finite.
pub(super) fn checked(plant: &Plant, t: f64, x: &DVector<f64>) -> Result<(Derivatives, ByInputs), LinearError> {
    let here = plant.derivatives(x);
    check_rates(plant.description, &here, t)?;
    let inputs = plant.by_inputs(x);
    check_derivatives(plant.description, &here, &inputs, t)?;
    Ok((here, inputs))
}

/// Whether the rates are finite.
fn check_rates(description: &Description, here: &Derivatives, t: f64) -> Result<(), LinearError> {
    match here.rates.iter().position(|rate| !rate.is_finite()) {
        Some(k) => Err(LinearError::BadRate { of: description.states[k].name.to_owned(), value: here.rates[k], t }),
        None => Ok(()),
    }
}

/// Whether the derivatives of the rates are finite.
fn check_derivatives(
    description: &Description,
    here: &Derivatives,
    inputs: &ByInputs,
    t: f64,
) -> Result<(), LinearError> {
    let name = |row: usize| description.states[row].name.to_owned();
    if let Some((row, column)) = bad_entry(&here.rates_by_state) {
        return Err(LinearError::NotFinite { of: name(row), by: format!("state `{}`", name(column)), t });
    }
    match bad_entry(&inputs.rates) {
        Some((row, column)) => {
            let by = format!("input `{}`", description.inputs[column].name);
            Err(LinearError::NotFinite { of: name(row), by, t })
        }
        None => Ok(()),
    }
}

fn bad_entry(matrix: &DMatrix<f64>) -> Option<(usize, usize)> {
    let place = matrix.iter().position(|entry| !entry.is_finite())?;
    Some((place % matrix.nrows(), place / matrix.nrows()))
}

/// A matrix as a list of its rows.
fn rows<S: Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<f64>>()))
}
