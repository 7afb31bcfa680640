//! The gradient of one number of a run, by a run followed backwards: for programs that ask for it by
//! [`Program::gradients`](crate::Program::gradients), since it is compiled for each of their models.
//!
//! In: a model with its parameters, what is differentiated, by what. Out: the number and its derivatives; the same as a
//! table and as CSV.

use std::marker::PhantomData;

use bg_model::description::ParameterInfo;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::run::Request;
use bg_model::sensitivity::{Direction, Gradients, Objective, SensitivityError, gradient};
use thiserror::Error;

use crate::scenes::{Fixed, Scene, own_parameters};
use crate::sensitivity::quotient;
use crate::tables::table;

/// What is asked.
pub struct Asked<'a> {
    /// The model.
    pub scene: &'a Scene,
    /// The models of its mechanism.
    pub scenes: &'a [Scene],
    /// The values of the mechanism's parameters, in the order of their table.
    pub values: &'a [f64],
    /// The inputs.
    pub inputs: &'a [Input],
    /// What is asked of the run.
    pub request: &'a Request,
    /// What is differentiated.
    pub objective: &'a Objective<'a>,
    /// The names of the parameters.
    pub by: &'a [&'a str],
}

/// A gradient that could not be had.
#[derive(Debug, Error)]
pub enum Fault {
    /// A parameter has a value that the scene does not have.
    #[error("{0}")]
    Fixed(Fixed),
    /// The model cannot be made.
    #[error(transparent)]
    Model(#[from] ParameterError),
    /// The run has none.
    #[error(transparent)]
    Gradient(#[from] SensitivityError),
}

/// Gives the gradient.
pub type Differentiate = fn(Asked<'_>) -> Result<Gradients, Fault>;

/// [`Differentiate`] for a mechanism.
///
/// # Errors
/// [`Fault`].
pub fn differentiate<Me: Scenes>(asked: Asked<'_>) -> Result<Gradients, Fault> {
    Me::model(asked.scene.index, Differentiated::<Me::Parameters> { asked, all: PhantomData })
}

struct Differentiated<'a, P> {
    asked: Asked<'a>,
    all: PhantomData<P>,
}

impl<P: Parameters> MechanismVisitor for Differentiated<'_, P> {
    type Output = Result<Gradients, Fault>;

    fn visit<Sc: Mechanism>(self) -> Self::Output {
        let Asked { scene, scenes, values, inputs, request, objective, by } = self.asked;
        let mut all = P::default();
        values.iter().enumerate().for_each(|(index, value)| all.set_value(index, *value));
        let own = own_parameters(scene, scenes, &all).map_err(Fault::Fixed)?;
        let by = by.iter().map(|name| Direction::parameter::<Sc>(name)).collect::<Result<Vec<_>, _>>()?;
        Ok(gradient(&Sc::make(own, inputs)?, request, objective, &by)?)
    }
}

/// The derivative by one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Slope {
    /// The parameter.
    pub parameter: &'static ParameterInfo,
    /// Its value, in its unit.
    pub at: f64,
    /// The derivative, in the number's unit per the parameter's.
    pub derivative: f64,
}

/// The table of a gradient: the parameters with an influence, the largest for a part of the parameter first. `value` is
/// the number, in `unit`.
#[must_use]
pub fn text(value: f64, unit: &str, slopes: &[Slope]) -> String {
    let mut sorted: Vec<&Slope> = slopes.iter().filter(|slope| slope.derivative != 0.0).collect();
    sorted.sort_by(|a, b| (b.derivative * b.at).abs().total_cmp(&(a.derivative * a.at).abs()));
    let row = |slope: &&Slope| {
        let relative = slope.derivative * slope.at / value;
        [
            slope.parameter.name.to_owned(),
            format!("{:.6e}", slope.derivative),
            quotient(unit, slope.parameter.unit),
            if relative.is_finite() { format!("{relative:.4}") } else { "-".to_owned() },
        ]
    };
    let head = ["parameter", "derivative", "unit", "% for 1 %"].map(str::to_owned);
    table(&std::iter::once(head).chain(sorted.iter().map(row)).collect::<Vec<_>>())
}

/// All derivatives as CSV, and whole numbers of digits.
#[must_use]
pub fn csv(value: f64, unit: &str, slopes: &[Slope]) -> String {
    let mut text = "value,unit,parameter,parameter_unit,parameter_value,derivative\n".to_owned();
    for Slope { parameter, at, derivative } in slopes {
        text += &format!("{value:?},{unit},{},{},{at:?},{derivative:?}\n", parameter.name, parameter.unit);
    }
    text
}
