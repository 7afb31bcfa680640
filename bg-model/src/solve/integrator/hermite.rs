//! The cubic through the states and rates at both ends of a step.
//!
//! In: the two ends. Out: the state in between, with an error of order h^4. Source: Hairer, Norsett, Wanner, Solving
//! Ordinary Differential Equations I, 2nd edition, section II.6, equation (6.7).

use nalgebra::SVector;

use super::Point;
use crate::model::scalar::Scalar;

/// Writes the state at `start` plus the part `theta` (0 to 1) of the step of size `h` (s) into `x`. Inlined, so that a part that is a
/// constant, as the middle for the guards, is folded into its weights.
#[inline(always)]
pub(crate) fn hermite<const N: usize>(start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
    let (from, to) = (&start.x.data.0[0], &end.x.data.0[0]);
    let (from_rate, to_rate) = (&start.rate.data.0[0], &end.rate.data.0[0]);
    let out = &mut x.data.0[0];
    for i in 0..N {
        out[i] = between(h, theta, [from[i], to[i]], [from_rate[i], to_rate[i]]);
    }
}

/// The same of one state, whose values and rates at both ends are given.
#[inline(always)]
pub(crate) fn between<S: Scalar>(h: S, theta: f64, [from, to]: [S; 2], [from_rate, to_rate]: [S; 2]) -> S {
    let rest = 1.0 - theta;
    let bulge = theta * (theta - 1.0);
    let chord = to - from;
    let bend = chord.times(1.0 - 2.0 * theta) + h.times(theta - 1.0) * from_rate + h.times(theta) * to_rate;
    from.times(rest) + to.times(theta) + bend.times(bulge)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_reproduced() {
        let point = |t: f64| Point {
            t,
            x: SVector::from([1.0 + t * (2.0 + t * (3.0 - 4.0 * t))]),
            rate: SVector::from([2.0 + t * (6.0 - 12.0 * t)]),
        };
        let (start, end) = (point(0.5), point(2.5));
        for theta in [0.0, 0.125, 0.5, 0.8, 1.0] {
            let mut x = SVector::from([0.0]);
            hermite(&start, 2.0, &end, theta, &mut x);
            assert!((x - point(0.5 + 2.0 * theta).x).norm() < 4e-14, "{theta}");
        }
    }
}
