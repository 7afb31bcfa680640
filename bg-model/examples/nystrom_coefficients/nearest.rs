//! Weights that meet linear conditions and lie as near as possible to a start.

use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::scalar::{DoubleDouble, Scalar};

use crate::trees::dot;
use crate::widened;

/// Corrections; each makes the residual about 1e-12 times as large, down to the rounding of the result.
const CORRECTIONS: usize = 4;

/// The sum of products with these weights must have this value.
pub struct Condition {
    pub weights: Vec<DoubleDouble>,
    pub exact: f64,
}

/// The nearest weights to the start that meet the conditions, but for those with singular values up to `dependent`.
pub fn nearest(start: &[f64], conditions: &[Condition], dependent: f64) -> Vec<f64> {
    let matrix =
        DMatrix::from_fn(conditions.len(), start.len(), |row, column| conditions[row].weights[column].to_f64());
    let inverse = matrix.pseudo_inverse(dependent).expect("the threshold is not negative");
    let mut found = DVector::from_column_slice(start);
    for _ in 0..CORRECTIONS {
        found -= &inverse * DVector::from_vec(residuals(found.as_slice(), conditions));
    }
    found.as_slice().to_vec()
}

/// The largest residual.
pub fn residual(row: &[f64], conditions: &[Condition]) -> f64 {
    residuals(row, conditions).into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// The residuals, calculated in double-double arithmetic.
fn residuals(row: &[f64], conditions: &[Condition]) -> Vec<f64> {
    let row = widened(row);
    let of = |condition: &Condition| (dot(&row, &condition.weights) - exact(condition.exact)).to_f64();
    conditions.iter().map(of).collect()
}

fn exact(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}
