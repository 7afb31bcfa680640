//! The Jacobian by differences, for systems that do not know theirs.
//!
//! In: a rate. Out: its derivatives by every state, column by column, and by time. Source of the increments: the
//! subroutine RADCOR of Hairer's `radau5.f`, sqrt(rounding unit * max(1e-5, |x_j|)).

use nalgebra::SVector;

use crate::scalar::Scalar;

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
        S::from_f64((f64::EPSILON * if size > 1e-5 { size } else { 1e-5 }).sqrt())
    };
    let zero = S::from_f64(0.0);
    let mut before = SVector::from([zero; N]);
    let mut after = before;
    rate(t, x, &mut before);
    let mut ahead = *x;
    for (j, column) in entries.chunks_exact_mut(N).enumerate() {
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
