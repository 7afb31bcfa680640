//! Derivatives of a run by differences of runs in double-double arithmetic: what exact ones are checked with.
//!
//! In: a model, a parameter, a time. Out: the derivative of each output there. Method: five points, whose truncation
//! error goes with the fourth power of their distance; rounding of the assembly, which is in `f64`, is 1e-16 over the
//! distance.

use thiserror::Error;

use crate::model::assembly::AssemblyError;
use crate::model::mechanism::Liftable;
use crate::model::parameters::ParameterError;
use crate::model::scalar::{DoubleDouble, Scalar};
use crate::solve::extended::{self, Accuracy, Fault};
use crate::solve::simulation::Span;

/// Differences that could not be had.
#[derive(Debug, Error)]
pub enum DifferencesError {
    /// The model cannot be made of a parameter beside its value.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// It cannot be assembled there.
    #[error(transparent)]
    Start(#[from] AssemblyError),
    /// The run failed there.
    #[error(transparent)]
    Run(#[from] Fault),
}

/// The derivatives of the outputs of `model` at `t` (s) by the parameter of this index, in the output's unit per the
/// parameter's: by runs at distances of `part` of its value; of its default where it is zero, and of 1 in its unit
/// where that is zero, too.
///
/// # Errors
/// [`DifferencesError`].
pub fn differences(
    model: &dyn Liftable<DoubleDouble>,
    parameter: usize,
    t: f64,
    part: f64,
    accuracy: Accuracy,
) -> Result<Vec<f64>, DifferencesError> {
    let number = DoubleDouble::from_f64;
    let (values, description) = (model.values(), model.description());
    let default = description.parameters[parameter].default;
    let size = [values[parameter], default, 1.0].into_iter().find(|&size| size != 0.0).map_or(1.0, f64::abs);
    let distance = part * size;
    let span = Span { t0: 0.0, t_end: t };
    let at = |steps: f64| -> Result<Vec<DoubleDouble>, DifferencesError> {
        let mut values: Vec<DoubleDouble> = values.iter().copied().map(number).collect();
        values[parameter] = values[parameter] + number(steps) * number(distance);
        let model = model.lifted(&values)?;
        let finish = extended::integrate(&*model, &model.start()?, span, accuracy, &[], &mut |_, _, _| {})?;
        let mut outputs = vec![number(0.0); description.outputs.len()];
        model.outputs(number(t), &finish.x, &finish.negative, &mut outputs);
        Ok(outputs)
    };
    let (far_back, back, ahead, far) = (at(-2.0)?, at(-1.0)?, at(1.0)?, at(2.0)?);
    let slope = |i: usize| ((ahead[i] - back[i]) * number(8.0) - (far[i] - far_back[i])) / number(12.0 * distance);
    Ok((0..ahead.len()).map(|i| slope(i).to_f64()).collect())
}
