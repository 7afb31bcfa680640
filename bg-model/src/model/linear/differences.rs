//! The Jacobian by differences, for systems that do not know theirs.
//!
//! In: a rate. Out: its derivatives by every state, column by column, and by time. Source of the increments: the
//! subroutine RADCOR of Hairer's `radau5.f`, sqrt(rounding unit * max(1e-5, |x_j|)); but at least 1e-12 |x_j|, since
//! that one is lost in the rounding of a large x_j. The 1e-5 is in the state's own unit: of a hand-written system that
//! is all that is known, and one whose states are smaller gives its Jacobian.

use crate::model::scalar::Scalar;
use crate::model::scalar::double::root;

/// Writes the rate at a time and state.
type Rate<'a, S> = dyn FnMut(S, &[S], &mut [S]) + 'a;

/// Writes df/dx into `entries`, column by column, and df/dt into `slope`. Evaluates the rate once for each state and
/// twice more. `room` has a place for each state.
pub(crate) fn differences<S: Scalar>(
    rate: &mut Rate<'_, S>,
    t: S,
    x: &[S],
    entries: &mut [S],
    slope: &mut [S],
    room: &mut [S],
) {
    let increment = |value: S| {
        let size = value.to_f64().abs();
        let (usual, least) = (root(f64::EPSILON * if size > 1e-5 { size } else { 1e-5 }), 1e-12 * size);
        S::from_f64(if usual > least { usual } else { least })
    };
    // The rate at the state itself, until there is the slope.
    rate(t, x, slope);
    room.copy_from_slice(x);
    for (j, column) in entries.chunks_exact_mut(x.len().max(1)).enumerate() {
        room[j] = x[j] + increment(x[j]);
        let delta = room[j] - x[j];
        rate(t, room, column);
        room[j] = x[j];
        column.iter_mut().zip(&*slope).for_each(|(entry, before)| *entry = (*entry - *before) / delta);
    }
    let later = t + increment(t);
    rate(later, x, room);
    slope.iter_mut().zip(room).for_each(|(slope, after)| *slope = (*after - *slope) / (later - t));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_states_and_times_have_derivatives() {
        for size in [0.0, 1.0, 1e6, 1e16, 1e100] {
            let mut rate = |t: f64, x: &[f64], dx: &mut [f64]| dx[0] = 3.0 * x[0] - 2.0 * t;
            let (mut entries, mut slope) = ([f64::NAN], [f64::NAN]);
            differences(&mut rate, size, &[size], &mut entries, &mut slope, &mut [0.0]);
            assert!((entries[0] - 3.0).abs() < 3e-3 && (slope[0] + 2.0).abs() < 3e-3, "{size}: {entries:?} {slope:?}");
        }
    }
}
