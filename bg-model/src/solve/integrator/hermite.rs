//! The cubic through the states and rates at both ends of a step.
//!
//! In: the two ends. Out: the state in between, with an error of order h^4. Source: Hairer, Norsett, Wanner, Solving
//! Ordinary Differential Equations I, 2nd edition, section II.6, equation (6.7).

use super::PointRef;
use crate::model::scalar::Scalar;

/// Writes the state at `start` plus the part `theta` (0 to 1) of the step of size `h` (s) into `x`. Inlined, so that a
/// part that is a constant, as the middle for the guards, is folded into its weights.
#[inline(always)]
pub(crate) fn hermite(start: PointRef<'_>, h: f64, end: PointRef<'_>, theta: f64, x: &mut [f64]) {
    let n = x.len();
    let (from, to, from_rate, to_rate) = (&start.x[..n], &end.x[..n], &start.rate[..n], &end.rate[..n]);
    for i in 0..n {
        x[i] = between(h, theta, [from[i], to[i]], [from_rate[i], to_rate[i]]);
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
        let state = |t: f64| [1.0 + t * (2.0 + t * (3.0 - 4.0 * t))];
        let rate = |t: f64| [2.0 + t * (6.0 - 12.0 * t)];
        let ends = [0.5, 2.5].map(|t| (t, state(t), rate(t)));
        let [start, end] = ends.each_ref().map(|(t, x, rate)| PointRef { t: *t, x, rate });
        for theta in [0.0, 0.125, 0.5, 0.8, 1.0] {
            let mut x = [0.0];
            hermite(start, 2.0, end, theta, &mut x);
            assert!((x[0] - state(0.5 + 2.0 * theta)[0]).abs() < 4e-14, "{theta}");
        }
    }
}
