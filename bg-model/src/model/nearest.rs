//! The nearest coordinates at which residuals vanish.
//!
//! In: guessed coordinates and their residuals. Out: the coordinates nearest to them, to first order, at which the norm
//! of the residuals falls no further.
//! Method: Gauss-Newton with a pseudo-inverse step (least norm, so coordinates that no residual depends on stay where
//! they are), damped as Levenberg and Marquardt do where the plain step does not shrink the residuals.

use alloc::vec::Vec;

use nalgebra::{DMatrix, DVector};

use crate::model::scalar::Scalar;
use crate::model::scalar::double::first_not_finite;

/// Writes the residuals at some coordinates.
type Residual<'a> = dyn Fn(&[f64], &mut [f64]) + 'a;

/// The coordinates nearest to `guess`, to first order, at which the norm of the `rows` residuals falls no further, and
/// the residuals there. `longest` limits a step.
///
/// # Errors
/// The first residual, or derivative of one, that is not finite: the row and the number.
pub(crate) fn nearest(
    guess: &[f64],
    rows: usize,
    longest: &dyn Fn(&[f64]) -> f64,
    residual: &Residual<'_>,
) -> Result<(Vec<f64>, DVector<f64>), (usize, f64)> {
    // Quadratic convergence needs some ten iterations; more only for far guesses, whose steps are limited.
    const ITERATIONS: usize = 200;
    let sizes_at = |coordinates: &[f64]| {
        let mut sizes = DVector::zeros(rows);
        residual(coordinates, sizes.as_mut_slice());
        sizes
    };
    let check = |sizes: &[f64]| first_not_finite(sizes).map_or(Ok(()), Err);
    let mut coordinates = guess.to_vec();
    let mut sizes = sizes_at(&coordinates);
    check(sizes.as_slice())?;
    if !coordinates.is_empty() {
        for _ in 0..ITERATIONS {
            let jacobian = jacobian(&coordinates, rows, &sizes_at);
            jacobian.column_iter().try_for_each(|column| check(column.as_slice()))?;
            let longest = longest(&coordinates);
            let Some((nearer, smaller)) = shrink(&coordinates, &sizes, jacobian, longest, &sizes_at) else { break };
            (coordinates, sizes) = (nearer, smaller);
        }
    }
    Ok((coordinates, sizes))
}

/// The coordinates `found`, nearest to `guess`, in another scalar: with the derivatives that follow from those of the
/// guess and of the residuals, by the implicit function theorem. The same numbers where there are none.
///
/// Exact where the residuals determine all coordinates, or the guess is not moved; else to first order in how far it
/// is.
pub(crate) fn lifted<S: Scalar>(guess: &[S], found: &[f64], residual: &dyn Fn(&[S]) -> Vec<S>) -> Vec<S> {
    // The first solves for derivatives in `f64`; the second takes away what rounding leaves where these have more
    // digits.
    const SOLUTIONS: usize = 2;
    let zero = S::from_f64(0.0);
    let beyond = |value: S| value - S::from_f64(value.to_f64());
    let plain: Vec<S> = found.iter().copied().map(S::from_f64).collect();
    if found.is_empty() {
        return plain;
    }
    let moved: Vec<S> = guess.iter().copied().map(beyond).collect();
    let mut lifted: Vec<S> = plain.iter().zip(&moved).map(|(&plain, &moved)| plain + moved).collect();
    let mut left: Vec<S> = residual(&lifted).into_iter().map(beyond).collect();
    if moved.iter().chain(&left).all(|&value| value == zero) {
        return plain;
    }
    let sizes_at = |coordinates: &[f64]| {
        let coordinates: Vec<S> = coordinates.iter().copied().map(S::from_f64).collect();
        let sizes = residual(&coordinates);
        DVector::from_iterator(sizes.len(), sizes.into_iter().map(S::to_f64))
    };
    let Some(inverse) = inverse(found, left.len(), &sizes_at) else { return lifted };
    for _ in 0..SOLUTIONS {
        for (k, lifted) in lifted.iter_mut().enumerate() {
            for (row, &left) in left.iter().enumerate() {
                *lifted = *lifted - S::from_f64(inverse[(k, row)]) * left;
            }
        }
        left = residual(&lifted).into_iter().map(beyond).collect();
    }
    lifted
}

/// Singular values below this part of the largest one are rounding errors of the differences.
const RANK: f64 = 1e-10;

/// The pseudo-inverse of the derivatives of the gaps; none where there are none.
fn inverse(found: &[f64], rows: usize, gaps_at: &Gaps<'_>) -> Option<DMatrix<f64>> {
    let jacobian = jacobian(found, rows, gaps_at);
    if jacobian.is_empty() {
        return None;
    }
    let smallest = RANK * jacobian.norm();
    jacobian.pseudo_inverse(smallest).ok()
}

/// Gives the gaps at some coordinates.
type Gaps<'a> = dyn Fn(&[f64]) -> DVector<f64> + 'a;

/// The derivatives of the gaps by five-point central differences; their error is of the order 1e-13 for mechanisms of
/// the size of 1 m.
fn jacobian(coordinates: &[f64], rows: usize, gaps_at: &Gaps<'_>) -> DMatrix<f64> {
    // Balances the truncation error d^4 / 30 against the rounding error 1e-16 / d. Of an angle this is a part of a
    // radian; in lengths and velocities gaps and flows are linear, so that no displacement of them is too long.
    const DISPLACEMENT: f64 = 1.0 / 1024.0;
    let mut jacobian = DMatrix::zeros(rows, coordinates.len());
    for (column, &coordinate) in coordinates.iter().enumerate() {
        let d = DISPLACEMENT * coordinate.abs().max(1.0);
        let moved = |by: f64| {
            let mut displaced = coordinates.to_vec();
            displaced[column] += by;
            gaps_at(&displaced)
        };
        let near = (moved(d) - moved(-d)) * (2.0 / (3.0 * d));
        let far = (moved(2.0 * d) - moved(-2.0 * d)) * (1.0 / (12.0 * d));
        jacobian.set_column(column, &(near - far));
    }
    jacobian
}

/// The first damped step, at most `longest`, that shrinks the gaps' norm, with the new gaps; none if the norm has
/// stopped falling.
fn shrink(
    coordinates: &[f64],
    sizes: &DVector<f64>,
    jacobian: DMatrix<f64>,
    longest: f64,
    gaps_at: &Gaps<'_>,
) -> Option<(Vec<f64>, DVector<f64>)> {
    const DAMPINGS: [f64; 8] = [0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0];
    let norm = sizes.norm();
    if jacobian.is_empty() || norm == 0.0 {
        return None;
    }
    let svd = jacobian.svd(true, true);
    let (u, v_t) = (svd.u.as_ref()?, svd.v_t.as_ref()?);
    let largest = svd.singular_values.max();
    let projected = u.tr_mul(sizes);
    DAMPINGS.iter().find_map(|damping| {
        let lambda = damping * largest;
        let weights = DVector::from_fn(projected.len(), |i, _| {
            let sigma = svd.singular_values[i];
            if sigma <= RANK * largest { 0.0 } else { -projected[i] * sigma / (sigma * sigma + lambda * lambda) }
        });
        let step = limited(v_t.tr_mul(&weights), longest);
        let nearer: Vec<f64> = coordinates.iter().zip(&step).map(|(coordinate, step)| coordinate + step).collect();
        let smaller = gaps_at(&nearer);
        (smaller.norm() < norm).then_some((nearer, smaller))
    })
}

/// Shortens a step that is longer than `longest`.
fn limited(step: DVector<f64>, longest: f64) -> DVector<f64> {
    let length = step.amax();
    if length > longest { step * (longest / length) } else { step }
}
