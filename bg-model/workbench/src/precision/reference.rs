//! Reference solutions: a model integrated in double-double arithmetic.
//!
//! In: a model. Out: its outputs at the instants, rounded to `f64` once, at the end. The initial value problem is that
//! of a run: the model in [`DoubleDouble`], from the start state that it has in `f64`. Method: [`bg_model::extended`].

use bg_model::assembly::AssemblyError;
use bg_model::extended::{Accuracy, Fault, integrate};
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::SVector;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Column, Recording, Span};
use bg_model::system::Model;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Settings and work of a computation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effort {
    /// Columns of the extrapolation; the order is twice as high.
    pub columns: usize,
    /// Tolerance of a step.
    pub tolerance: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, those on the search for events included.
    pub rejected: u64,
    /// Evaluations of the rate function.
    pub rate_evaluations: u64,
    /// The times of the switchings, s.
    pub events: Vec<f64>,
}

/// What a computation gives.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The outputs at the instants.
    pub samples: Recording,
    /// What it took.
    pub effort: Effort,
}

/// A computation that fails.
#[derive(Debug, Error)]
pub enum ReferenceError {
    /// The start.
    #[error(transparent)]
    Start(#[from] AssemblyError),
    /// The run.
    #[error(transparent)]
    Run(#[from] Fault),
}

/// The outputs of `model` whose names `is_wanted` accepts at `instants` (s, ascending, from 0 on), integrated with
/// `accuracy`.
///
/// # Errors
/// Instants that cannot be, and a run that fails.
pub fn solve<Me: Mechanism>(
    model: &Me,
    accuracy: Accuracy,
    instants: &[f64],
    is_wanted: impl Fn(&str) -> bool,
) -> Result<Solution, ReferenceError> {
    let start = model.visit::<f64, _>(Start)?;
    let outputs = Me::describe().outputs;
    let wanted = (0..outputs.len()).filter(|index| is_wanted(outputs[*index].name)).collect();
    model.visit::<DoubleDouble, _>(Extended { start, wanted, accuracy, instants })
}

/// The start state in `f64`.
struct Start;

impl ModelVisitor<f64> for Start {
    type Output = Result<Vec<f64>, AssemblyError>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M>,
    {
        Ok(model.start()?.iter().copied().collect())
    }
}

struct Extended<'a> {
    start: Vec<f64>,
    wanted: Vec<usize>,
    accuracy: Accuracy,
    instants: &'a [f64],
}

impl ModelVisitor<DoubleDouble> for Extended<'_> {
    type Output = Result<Solution, ReferenceError>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<DoubleDouble, N, G, M>,
    {
        let Self { start, wanted, accuracy, instants } = self;
        let start = SVector::<DoubleDouble, N>::from_fn(|index, _| start[index].into());
        let outputs = model.description().outputs;
        let column = |index: &usize| Column::new(outputs[*index].name, outputs[*index].unit);
        let mut samples = Recording::new(wanted.iter().map(column).collect());
        let mut y = SVector::from_element(DoubleDouble::default());
        let span = Span { t0: 0.0, t_end: instants.last().copied().unwrap_or(0.0) };
        let finish = integrate(model, &start, span, accuracy, instants, |t, x, negative| {
            model.outputs(t, x, negative, &mut y);
            samples.push(t.to_f64(), wanted.iter().map(|index| y[*index].to_f64()));
        })?;
        let effort = Effort {
            columns: accuracy.columns,
            tolerance: accuracy.tolerance,
            steps: finish.steps,
            rejected: finish.rejected,
            rate_evaluations: finish.rate_evaluations,
            events: finish.events.iter().map(|event| event.t.to_f64()).collect(),
        };
        Ok(Solution { samples, effort })
    }
}
