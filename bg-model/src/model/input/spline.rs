//! The rates at the rows of a cubic spline.
//!
//! In: rows. Out: the rate at each of them, for which the second derivative is continuous. Source: C. de Boor, A
//! Practical Guide to Splines, chapter IV, equations (5) and (13) for the ends "not a knot"; the rows of the system as
//! SciPy's `CubicSpline` has them. The matrix has three diagonals; elimination without row exchanges, as each pivot is
//! at least the length of an interval: below the first row it stays dominant.

use alloc::vec;
use alloc::vec::Vec;

/// The rates of the spline through `values` at `times`, which ascend: two or more.
pub(super) fn slopes(times: &[f64], values: &[f64]) -> Vec<f64> {
    let rows = times.len();
    let lengths: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let chords: Vec<f64> = values.windows(2).zip(&lengths).map(|(pair, length)| (pair[1] - pair[0]) / length).collect();
    match rows {
        2 => vec![chords[0]; 2],
        3 => {
            // The parabola through the three rows.
            let twice_bend = 2.0 * (chords[1] - chords[0]) / (lengths[0] + lengths[1]);
            let middle = chords[0] + 0.5 * twice_bend * lengths[0];
            vec![middle - twice_bend * lengths[0], middle, middle + twice_bend * lengths[1]]
        }
        _ => eliminate(&(0..rows).map(|row| equation(row, &lengths, &chords)).collect::<Vec<_>>()),
    }
}

/// An equation of the system: its coefficients of the rates at the row before, at the row, at the row after, and the
/// right side.
type Equation = [f64; 4];

fn equation(row: usize, lengths: &[f64], chords: &[f64]) -> Equation {
    let last = lengths.len();
    if row == 0 {
        let ([near, far], [steep, next]) = ([lengths[0], lengths[1]], [chords[0], chords[1]]);
        let both = near + far;
        return [0.0, far, both, end(near, far, both, steep, next)];
    }
    if row == last {
        let ([near, far], [steep, next]) =
            ([lengths[last - 1], lengths[last - 2]], [chords[last - 1], chords[last - 2]]);
        let both = near + far;
        return [both, far, 0.0, end(near, far, both, steep, next)];
    }
    let [before, after] = [lengths[row - 1], lengths[row]];
    let right = 3.0 * (after * chords[row - 1] + before * chords[row]);
    [after, 2.0 * (before + after), before, right]
}

/// The right side at an end, of the chord at the end and the next one and their lengths.
fn end(near: f64, far: f64, both: f64, chord: f64, next: f64) -> f64 {
    ((near + 2.0 * both) * far * chord + near * near * next) / both
}

/// The solution of a system of three diagonals.
fn eliminate(equations: &[Equation]) -> Vec<f64> {
    let mut solved: Vec<[f64; 2]> = Vec::with_capacity(equations.len());
    for [before, own, after, right] in equations {
        let [ratio, value] = solved.last().copied().unwrap_or_default();
        let pivot = own - before * ratio;
        solved.push([after / pivot, (right - before * value) / pivot]);
    }
    let mut next = 0.0;
    let mut slopes: Vec<f64> = solved
        .iter()
        .rev()
        .map(|[ratio, value]| {
            next = value - ratio * next;
            next
        })
        .collect();
    slopes.reverse();
    slopes
}
