//! The Jacobian by differences, for systems that do not know theirs.
//!
//! In: a rate. Out: its derivatives by every state, column by column, and by time. Source of the increments: the
//! subroutine RADCOR of Hairer's `radau5.f`, sqrt(rounding unit * max(1e-5, |x_j|)); but at least 1e-12 |x_j|, since that one
//! is lost in the rounding of a large x_j. The 1e-5 is in the state's own unit: of a hand-written system that is all
//! that is known, and one whose states are smaller gives its Jacobian.

use nalgebra::SVector;

use crate::model::scalar::Scalar;
use crate::model::scalar::double::root;

/// Writes df/dx into `entries`, column by column, and df/dt into `slope`. Evaluates the rate `N` + 2 times.
pub(crate) fn differences<S: Scalar, const N: usize>(
    mut rate: impl FnMut(S, &SVector<S, N>, &mut SVector<S, N>),
    t: S,
    x: &SVector<S, N>,
    entries: &mut [S],
    slope: &mut SVector<S, N>,
) {
    let increment = |value: S| {
        let size = value.to_f64().abs();
        let (usual, least) = (root(f64::EPSILON * if size > 1e-5 { size } else { 1e-5 }), 1e-12 * size);
        S::from_f64(if usual > least { usual } else { least })
    };
    let zero = S::from_f64(0.0);
    let mut before = SVector::from([zero; N]);
    let mut after = before;
    rate(t, x, &mut before);
    let mut ahead = *x;
    for (j, column) in entries.chunks_exact_mut(N.max(1)).enumerate() {
        ahead[j] = x[j] + increment(x[j]);
        let delta = ahead[j] - x[j];
        rate(t, &ahead, &mut after);
        ahead[j] = x[j];
        for (entry, (after, before)) in column.iter_mut().zip(after.iter().zip(before.iter())) {
            *entry = (*after - *before) / delta;
        }
    }
    let later = t + increment(t);
    rate(later, x, &mut after);
    for ((slope, after), before) in slope.iter_mut().zip(after.iter()).zip(before.iter()) {
        *slope = (*after - *before) / (later - t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_states_and_times_have_derivatives() {
        for size in [0.0, 1.0, 1e6, 1e16, 1e100] {
            let rate = |t: f64, x: &SVector<f64, 1>, dx: &mut SVector<f64, 1>| dx[0] = 3.0 * x[0] - 2.0 * t;
            let (mut entries, mut slope) = ([f64::NAN], SVector::from([f64::NAN]));
            differences(rate, size, &SVector::from([size]), &mut entries, &mut slope);
            assert!((entries[0] - 3.0).abs() < 3e-3 && (slope[0] + 2.0).abs() < 3e-3, "{size}: {entries:?} {slope}");
        }
    }
}
