//! Derivatives of a run by differences of runs in double-double arithmetic: what exact ones are checked with.
//!
//! In: a model, a parameter, a time. Out: the derivative of each output there. Method: five points, whose truncation
//! error goes with the fourth power of their distance; rounding of the assembly, which is in `f64`, is 1e-16 over the
//! distance.

use nalgebra::SVector;
use thiserror::Error;

use crate::model::assembly::AssemblyError;
use crate::model::mechanism::{LiftedVisitor, Mechanism};
use crate::model::parameters::{ParameterError, Parameters};
use crate::model::scalar::{DoubleDouble, Scalar};
use crate::model::system::Model;
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
pub fn differences<Me: Mechanism>(
    model: &Me,
    parameter: usize,
    t: f64,
    part: f64,
    accuracy: Accuracy,
) -> Result<Vec<f64>, DifferencesError> {
    let values = model.parameters().values();
    let default = Me::describe().parameters[parameter].default;
    let size = [values[parameter], default, 1.0].into_iter().find(|&size| size != 0.0).map_or(1.0, f64::abs);
    let distance = part * size;
    model.visit_lifted(Differences { values, parameter, distance, t, accuracy })
}

struct Differences {
    values: Vec<f64>,
    parameter: usize,
    distance: f64,
    t: f64,
    accuracy: Accuracy,
}

impl LiftedVisitor<DoubleDouble, DoubleDouble> for Differences {
    type Output = Result<Vec<f64>, DifferencesError>;

    fn visit<Mo, Li, Ot, const N: usize, const G: usize, const M: usize>(
        self,
        _: &Mo,
        _: impl Fn(&[f64]) -> Result<Mo, ParameterError>,
        lifted: impl Fn(&[DoubleDouble]) -> Result<Li, ParameterError>,
        _: impl Fn(&[&Li], fn(&[DoubleDouble]) -> DoubleDouble) -> Ot,
    ) -> Self::Output
    where
        Mo: Model<f64, N, G, M>,
        Li: Model<DoubleDouble, N, G, M>,
        Ot: Model<DoubleDouble, N, G, M>,
    {
        let number = DoubleDouble::from_f64;
        let span = Span { t0: 0.0, t_end: self.t };
        let at = |steps: f64| -> Result<SVector<DoubleDouble, M>, DifferencesError> {
            let mut values: Vec<DoubleDouble> = self.values.iter().copied().map(number).collect();
            values[self.parameter] = values[self.parameter] + number(steps) * number(self.distance);
            let model = lifted(&values)?;
            let finish = extended::integrate(&model, &model.start()?, span, self.accuracy, &[], |_, _, _| {})?;
            let mut outputs = SVector::repeat(number(0.0));
            model.outputs(number(self.t), &finish.x, &finish.negative, &mut outputs);
            Ok(outputs)
        };
        let (far_back, back, ahead, far) = (at(-2.0)?, at(-1.0)?, at(1.0)?, at(2.0)?);
        let slope =
            |i: usize| ((ahead[i] - back[i]) * number(8.0) - (far[i] - far_back[i])) / number(12.0 * self.distance);
        Ok((0..M).map(|i| slope(i).to_f64()).collect())
    }
}
