//! Reference solutions: a model integrated in double-double arithmetic.
//!
//! In: a model. Out: its outputs at the instants, rounded to `f64` once, at the end. The initial value problem is that
//! of a run: the model in [`DoubleDouble`], from the start state that it has in `f64`. Method: [`bg_model::extended`].

use bg_model::assembly::AssemblyError;
use bg_model::extended::{Accuracy, Fault, outputs};
use bg_model::mechanism::Liftable;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::simulation::{Column, Recording};
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
pub fn solve(
    model: &dyn Liftable<DoubleDouble>,
    accuracy: Accuracy,
    instants: &[f64],
    is_wanted: &dyn Fn(&str) -> bool,
) -> Result<Solution, ReferenceError> {
    let start = model.machine().start()?;
    let table = model.description().outputs;
    let wanted: Vec<usize> = (0..table.len()).filter(|&index| is_wanted(table[index].name)).collect();
    let column = |&index: &usize| Column::new(table[index].name, table[index].unit);
    let mut samples = Recording::new(wanted.iter().map(column).collect());
    let values: Vec<DoubleDouble> = model.values().into_iter().map(DoubleDouble::from).collect();
    let exact = model.lifted(&values).expect("a model was made with these parameters before");
    let finish = outputs(&*exact, &start, accuracy, instants, &wanted, &mut |t, values| {
        samples.push(t, values.iter().copied());
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
