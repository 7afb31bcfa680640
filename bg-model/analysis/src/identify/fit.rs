//! Least squares with bounds by Levenberg's and Marquardt's method.
//!
//! In: a function that gives residuals with their derivatives, where the variables start, their bounds. Out: the variables at which
//! the sum of squares falls no further, with residuals and derivatives there.
//! Method: steps (J'J + l D) d = -J'r with D the diagonal of J'J (J. J. More, The Levenberg-Marquardt algorithm, Lecture Notes in
//! Mathematics 630 (1978)), solved by singular values of [J; sqrt(l D)]; a step is cut at the bounds, and a variable at a bound
//! towards which the sum falls stays there. Ours, since the crate `levenberg-marquardt` has no bounds.

use bg_model::nalgebra::{DMatrix, DVector};

/// Residuals and their derivatives, a row for each residual, a column for each variable.
pub type Linear = (DVector<f64>, DMatrix<f64>);

/// Where a fit has come to.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The variables.
    pub x: DVector<f64>,
    /// The residuals there.
    pub residuals: DVector<f64>,
    /// Their derivatives.
    pub jacobian: DMatrix<f64>,
    /// Which variables are at a bound that keeps the sum of squares from falling.
    pub held: Vec<bool>,
    /// Evaluations that it took.
    pub evaluations: usize,
    /// Whether it has converged, or only come to the number of evaluations that was allowed.
    pub has_converged: bool,
}

/// The damping at the start, its factors after steps that help and that do not, and the largest.
const DAMPING: f64 = 1e-4;
const LESS: f64 = 0.1;
const MORE: f64 = 10.0;
const LARGEST: f64 = 1e12;
/// A step below this part of a variable's size is none, nor one by which the sum of squares is to fall by less than this part of one
/// residual's square: a hundred thousandth of a standard deviation.
const STEP: f64 = 1e-9;
const FALL: f64 = 1e-10;

/// Fits the variables from `start` on between `lower` and `upper`. `sizes` are what steps are measured with; `evaluate` fails where
/// there are no residuals, which calls for a shorter step.
///
/// # Errors
/// That of `evaluate` at the start.
pub fn fit<E>(
    start: &DVector<f64>,
    [lower, upper]: [&DVector<f64>; 2],
    sizes: &DVector<f64>,
    most: usize,
    mut evaluate: impl FnMut(&DVector<f64>) -> Result<Linear, E>,
) -> Result<Fitted, E> {
    let within = |x: DVector<f64>| DVector::from_fn(x.len(), |k, _| x[k].clamp(lower[k], upper[k]));
    let mut x = within(start.clone());
    let (mut residuals, mut jacobian) = evaluate(&x)?;
    let (mut evaluations, mut damping, mut has_converged) = (1, DAMPING, false);
    while !has_converged && evaluations < most {
        let held = held(&x, lower, upper, &jacobian.tr_mul(&residuals));
        let next = within(&x + limited(step(&residuals, &jacobian, &held, damping), sizes));
        let way = &next - &x;
        let (before, rows) = (residuals.norm_squared(), residuals.len() as f64);
        let is_still = way.iter().zip(sizes).all(|(way, size)| way.abs() <= STEP * size);
        let fall = before - (&residuals + &jacobian * &way).norm_squared();
        if is_still || (0.0..=FALL * before / rows).contains(&fall) {
            has_converged = true;
            break;
        }
        if fall < 0.0 {
            // Cut at the bounds the step leads up; a shorter one does not.
            damping *= MORE;
            has_converged = damping > LARGEST;
            continue;
        }
        evaluations += 1;
        match evaluate(&next) {
            Ok((there, slopes)) if there.norm_squared() < before => {
                (x, residuals, jacobian) = (next, there, slopes);
                damping *= LESS;
            }
            _ => {
                damping *= MORE;
                has_converged = damping > LARGEST;
            }
        }
    }
    let held = self::held(&x, lower, upper, &jacobian.tr_mul(&residuals));
    Ok(Fitted { x, residuals, jacobian, held, evaluations, has_converged })
}

/// A step with no variable changed by more than its size: what hardly moves a residual would else be thrown far away.
fn limited(step: DVector<f64>, sizes: &DVector<f64>) -> DVector<f64> {
    let longest = step.iter().zip(sizes).fold(0.0_f64, |longest, (step, size)| longest.max(step.abs() / size));
    if longest > 1.0 { step / longest } else { step }
}

/// The variables at a bound beyond which the sum of squares would fall.
fn held(x: &DVector<f64>, lower: &DVector<f64>, upper: &DVector<f64>, gradient: &DVector<f64>) -> Vec<bool> {
    let is_held = |k: usize| x[k] <= lower[k] && gradient[k] > 0.0 || x[k] >= upper[k] && gradient[k] < 0.0;
    (0..x.len()).map(is_held).collect()
}

/// The damped step of the variables that are not held.
fn step(residuals: &DVector<f64>, jacobian: &DMatrix<f64>, held: &[bool], damping: f64) -> DVector<f64> {
    let (rows, variables) = jacobian.shape();
    let norms: Vec<f64> = jacobian.column_iter().map(|column| column.norm()).collect();
    let is_free = |k: usize| !held[k] && norms[k] > 0.0;
    let free: Vec<usize> = (0..variables).filter(|&k| is_free(k)).collect();
    // Columns of length one: what is left is the damping alone.
    let damped = DMatrix::from_fn(rows + free.len(), free.len(), |row, column| {
        if row < rows {
            jacobian[(row, free[column])] / norms[free[column]]
        } else if row - rows == column {
            damping.sqrt()
        } else {
            0.0
        }
    });
    let wanted = DVector::from_fn(rows + free.len(), |row, _| if row < rows { -residuals[row] } else { 0.0 });
    let mut step = DVector::zeros(variables);
    if free.is_empty() {
        return step;
    }
    if let Ok(solved) = damped.svd(true, true).solve(&wanted, 1e-14) {
        free.iter().enumerate().for_each(|(column, &k)| step[k] = solved[column] / norms[k]);
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley: residuals 10 (y - x^2) and 1 - x.
    fn valley(x: &DVector<f64>) -> Result<Linear, ()> {
        let residuals = DVector::from_vec(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]]);
        Ok((residuals, DMatrix::from_row_slice(2, 2, &[-20.0 * x[0], 10.0, -1.0, 0.0])))
    }

    fn fitted(lower: [f64; 2], upper: [f64; 2]) -> Fitted {
        let vector = |of: [f64; 2]| DVector::from_vec(of.to_vec());
        let bounds = [&vector(lower), &vector(upper)];
        fit(&vector([-1.2, 1.0]), bounds, &vector([1.0, 1.0]), 200, valley).unwrap()
    }

    #[test]
    fn the_end_of_the_valley_is_found() {
        let found = fitted([f64::NEG_INFINITY; 2], [f64::INFINITY; 2]);
        assert!(found.has_converged && (found.x[0] - 1.0).abs() < 1e-8 && (found.x[1] - 1.0).abs() < 1e-8, "{found:?}");
    }

    #[test]
    fn a_bound_holds_what_would_pass_it() {
        let found = fitted([-2.0, -2.0], [0.5, 2.0]);
        assert!((found.x[0] - 0.5).abs() < 1e-12 && (found.x[1] - 0.25).abs() < 1e-6, "{found:?}");
        assert_eq!(found.held, [true, false]);
    }
}
