//! Least squares with bounds by Levenberg's and Marquardt's method.
//!
//! In: what gives residuals, alone and with their derivatives, where the variables start, their bounds. Out: the
//! variables at which the sum of squares falls no further, with residuals and derivatives there.
//! Method: steps (J'J + l D) d = -J'r with D the diagonal of J'J (J. J. More, The Levenberg-Marquardt algorithm,
//! Lecture Notes in Mathematics 630 (1978)), solved by singular values of [J; sqrt(l D)]; a step is cut at the bounds,
//! and a variable at a bound towards which the sum falls stays there. A step is tried without derivatives, which are
//! taken where it has helped. Ours, since the crate `levenberg-marquardt` has no bounds.

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
    /// Evaluations that it took: points at which there were residuals.
    pub evaluations: usize,
    /// Whether it has converged, or only come to the number of evaluations that was allowed.
    pub has_converged: bool,
}

/// The damping at the start, its factors after steps that help and that do not, the smallest and the largest. The
/// smallest one hinders no step along what the residuals determine to seven digits.
const DAMPING: f64 = 1e-4;
const LESS: f64 = 0.1;
const MORE: f64 = 10.0;
const SMALLEST: f64 = 1e-14;
const LARGEST: f64 = 1e12;
/// A step below this part of a variable's size is none, nor one by which the sum of squares is to fall by less than
/// this part of one residual's square: a hundred thousandth of a standard deviation.
const STEP: f64 = 1e-9;
const FALL: f64 = 1e-10;
/// A step that differs by less than this part of it from one that did not help is not tried.
const DIFFERENT: f64 = 0.05;

/// What is fitted.
pub trait Problem {
    /// Why there are no residuals.
    type Error;

    /// The residuals, which cost much less than their derivatives.
    ///
    /// # Errors
    /// There are none for these variables, which calls for a shorter step.
    fn residuals(&mut self, x: &DVector<f64>) -> Result<DVector<f64>, Self::Error>;

    /// The residuals and their derivatives.
    ///
    /// # Errors
    /// As [`Problem::residuals`].
    fn linear(&mut self, x: &DVector<f64>) -> Result<Linear, Self::Error>;
}

/// Fits the variables from `start` on between `lower` and `upper`, by at most `most` evaluations. `sizes` are what
/// steps are measured with.
///
/// # Errors
/// That of the problem at the start.
pub fn fit<P: Problem>(
    start: &DVector<f64>,
    [lower, upper]: [&DVector<f64>; 2],
    sizes: &DVector<f64>,
    most: usize,
    problem: &mut P,
) -> Result<Fitted, P::Error> {
    let within = |x: DVector<f64>| DVector::from_fn(x.len(), |k, _| x[k].clamp(lower[k], upper[k]));
    let length = |way: &DVector<f64>| way.component_div(sizes).norm();
    let mut x = within(start.clone());
    let (mut residuals, mut jacobian) = problem.linear(&x)?;
    let (mut evaluations, mut damping, mut has_converged) = (1, DAMPING, false);
    // The last step from here that did not help.
    let mut failed: Option<DVector<f64>> = None;
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
        let is_known = failed.as_ref().is_some_and(|failed| length(&(&way - failed)) < DIFFERENT * length(failed));
        // A step that is cut at the bounds may lead up; a shorter one does not.
        let mut helps = false;
        if fall >= 0.0 && !is_known {
            evaluations += 1;
            helps = problem.residuals(&next).is_ok_and(|there| there.norm_squared() < before);
        }
        match helps.then(|| problem.linear(&next)) {
            Some(Ok(there)) => {
                (x, (residuals, jacobian), failed) = (next, there, None);
                damping = (damping * LESS).max(SMALLEST);
            }
            _ => {
                failed = Some(way);
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

    /// Rosenbrock's valley: residuals 10 (y - x^2), 1 - x and a rest that jitters; how often residuals and derivatives
    /// were asked for.
    #[derive(Default)]
    struct Valley {
        rest: f64,
        counts: [usize; 2],
    }

    impl Problem for Valley {
        type Error = ();

        fn residuals(&mut self, x: &DVector<f64>) -> Result<DVector<f64>, ()> {
            self.counts[0] += 1;
            let rest = self.rest * (1.0 + 1e-4 * (1e9 * (x[0] + x[1])).sin());
            Ok(DVector::from_vec(vec![10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0], rest]))
        }

        fn linear(&mut self, x: &DVector<f64>) -> Result<Linear, ()> {
            let residuals = self.residuals(x)?;
            self.counts[0] -= 1;
            self.counts[1] += 1;
            Ok((residuals, DMatrix::from_row_slice(3, 2, &[-20.0 * x[0], 10.0, -1.0, 0.0, 0.0, 0.0])))
        }
    }

    fn fitted(lower: [f64; 2], upper: [f64; 2], valley: &mut Valley) -> Fitted {
        let vector = |of: [f64; 2]| DVector::from_vec(of.to_vec());
        let bounds = [&vector(lower), &vector(upper)];
        fit(&vector([-1.2, 1.0]), bounds, &vector([1.0, 1.0]), 200, valley).unwrap()
    }

    #[test]
    fn the_end_of_the_valley_is_found() {
        let mut valley = Valley::default();
        let found = fitted([f64::NEG_INFINITY; 2], [f64::INFINITY; 2], &mut valley);
        assert!(found.has_converged && (found.x[0] - 1.0).abs() < 1e-8 && (found.x[1] - 1.0).abs() < 1e-8, "{found:?}");
        // Derivatives at the start and where a step has helped; residuals wherever one was tried.
        let [tried, linear] = valley.counts;
        assert!(linear <= tried && tried + 1 == found.evaluations, "{:?}", valley.counts);
    }

    #[test]
    fn residuals_that_jitter_more_than_a_step_promises_end_the_fit_soon() {
        let mut valley = Valley { rest: 1.0, ..Valley::default() };
        let found = fitted([f64::NEG_INFINITY; 2], [f64::INFINITY; 2], &mut valley);
        assert!(found.has_converged && (found.x[0] - 1.0).abs() < 1e-2, "{found:?}");
        assert!(valley.counts[0] <= 50, "{:?}", valley.counts);
    }

    #[test]
    fn a_bound_holds_what_would_pass_it() {
        let found = fitted([-2.0, -2.0], [0.5, 2.0], &mut Valley::default());
        assert!((found.x[0] - 0.5).abs() < 1e-12 && (found.x[1] - 0.25).abs() < 1e-6, "{found:?}");
        assert_eq!(found.held, [true, false]);
    }
}
