//! Modes followed over a parameter: which mode at one value is which at the next.
//!
//! In: the modes at ascending values of a parameter, in the order of the values. Out: branches, each a mode that swings
//! and how it changes; where one crosses a line such as that of a rotor's unbalance, the value at which it does.
//! Method: a branch goes on to the mode that is nearest to where its last two eigenvalues point, relative to their
//! size, and whose shape is most alike: the product of both shapes, each coordinate by the root of its participation
//! factor and its phase, which depends on no unit (a modal assurance criterion, Allemang 2003). All pairs are taken by
//! their distance, the nearest first. What crosses a line is sought between two values by the Illinois rule (Dowell and
//! Jarratt 1971).

use bg_model::nalgebra::Complex;

use super::modes::{Mode, Participation};

/// A mode over a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Values of the parameter, ascending, and the mode at each.
    pub points: Vec<(f64, Mode)>,
}

/// The weight of a shape beside that of an eigenvalue's relative distance.
const SHAPE: f64 = 0.5;
/// The distance from which on a mode is another one: half of the eigenvalue, with a shape that is as different as can
/// be.
const FARTHEST: f64 = 1.0;
/// The most steps of a search, and its accuracy in parts of the value.
const STEPS: usize = 60;
const ACCURACY: f64 = 1e-12;

fn eigenvalue(mode: &Mode) -> Complex<f64> {
    Complex::new(mode.real, mode.imaginary)
}

/// How much alike two shapes are, 0 to 1.
fn likeness(a: &[Participation], b: &[Participation]) -> f64 {
    let weight = |part: &Participation| Complex::from_polar(part.share.max(0.0).sqrt(), part.phase);
    let product = |a: &[Participation], b: &[Participation]| {
        a.iter().zip(b).map(|(a, b)| weight(a).conj() * weight(b)).sum::<Complex<f64>>()
    };
    let [own, other] = [product(a, a).norm(), product(b, b).norm()];
    if own * other > 0.0 { product(a, b).norm_sqr() / (own * other) } else { 0.0 }
}

impl Branch {
    /// The last mode.
    fn last(&self) -> &(f64, Mode) {
        self.points.last().expect("a branch begins with a point")
    }

    /// Where its last two points let its eigenvalue be at `value`.
    fn expected(&self, value: f64) -> Complex<f64> {
        let (at, last) = self.last();
        let last = eigenvalue(last);
        match self.points.len().checked_sub(2).map(|before| &self.points[before]) {
            Some((before, mode)) => last + (last - eigenvalue(mode)) * ((value - at) / (at - before)),
            None => last,
        }
    }

    /// How far a mode at `value` is from being of this branch.
    fn distance(&self, value: f64, mode: &Mode) -> f64 {
        let found = eigenvalue(mode);
        let far = (found - self.expected(value)).norm() / eigenvalue(&self.last().1).norm().max(found.norm());
        far + SHAPE * (1.0 - likeness(&self.last().1.shape, &mode.shape))
    }

    /// How far a mode at a value between both of two points is from being between their modes.
    fn within(&self, value: f64, mode: &Mode) -> f64 {
        let [(a, first), (b, last)] = [&self.points[0], &self.points[1]];
        let part = (value - a) / (b - a);
        let between = eigenvalue(first) * (1.0 - part) + eigenvalue(last) * part;
        let alike = likeness(&first.shape, &mode.shape).max(likeness(&last.shape, &mode.shape));
        let found = eigenvalue(mode);
        (found - between).norm() / between.norm().max(found.norm()) + SHAPE * (1.0 - alike)
    }
}

/// The branches of the modes that swing; those that begin first are first, the slower one of two that begin together.
#[must_use]
pub fn branches(points: impl IntoIterator<Item = (f64, Vec<Mode>)>) -> Vec<Branch> {
    let mut all: Vec<Branch> = Vec::new();
    let mut ends: Vec<usize> = Vec::new();
    for (value, modes) in points {
        let mut left: Vec<Option<Mode>> = modes.into_iter().filter(|mode| mode.imaginary > 0.0).map(Some).collect();
        let mut pairs = Vec::new();
        for &end in &ends {
            for (k, mode) in left.iter().enumerate() {
                let distance = mode.as_ref().map_or(f64::INFINITY, |mode| all[end].distance(value, mode));
                if distance < FARTHEST {
                    pairs.push((distance, end, k));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut goes_on = Vec::new();
        for (_, end, k) in pairs {
            if goes_on.contains(&end) {
                continue;
            }
            if let Some(mode) = left[k].take() {
                all[end].points.push((value, mode));
                goes_on.push(end);
            }
        }
        for mode in left.into_iter().flatten() {
            goes_on.push(all.len());
            all.push(Branch { points: vec![(value, mode)] });
        }
        goes_on.sort_unstable();
        ends = goes_on;
    }
    all
}

/// Where `excess` of a branch changes its sign between two of its points: the value and the mode there. `modes` gives
/// the modes at a value, where there are some.
///
/// A crossing whose modes cannot be made is not there.
pub fn crossings(
    branch: &Branch,
    excess: impl Fn(f64, &Mode) -> f64,
    mut modes: impl FnMut(f64) -> Option<Vec<Mode>>,
) -> Vec<(f64, Mode)> {
    let between = |pair: &[(f64, Mode)]| {
        let [mut a, mut b] = [0, 1].map(|k: usize| {
            let (value, mode) = &pair[k];
            (*value, excess(*value, mode), mode.clone())
        });
        if b.1 == 0.0 {
            return Some((b.0, b.2));
        }
        if a.1 == 0.0 || a.1.signum() == b.1.signum() {
            return None;
        }
        let near = Branch { points: pair.to_vec() };
        for _ in 0..STEPS {
            let value = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            let found = modes(value)?.into_iter().filter(|mode| mode.imaginary > 0.0);
            let mode = found.min_by(|x, y| near.within(value, x).total_cmp(&near.within(value, y)))?;
            let left = excess(value, &mode);
            if left == 0.0 || (b.0 - a.0).abs().min((value - b.0).abs()) <= ACCURACY * value.abs() {
                return Some((value, mode));
            }
            if left.signum() == b.1.signum() {
                a.1 *= 0.5;
            } else {
                a = b;
            }
            b = (value, left, mode);
        }
        Some((b.0, b.2))
    };
    branch.points.windows(2).filter_map(between).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An undamped mode of this frequency, rad/s, in which both coordinates take part so much.
    fn mode(frequency: f64, shares: [f64; 2]) -> Mode {
        let part =
            |share| Participation { name: String::new(), unit: String::new(), share, magnitude: 1.0, phase: 0.0 };
        Mode {
            real: 0.0,
            imaginary: frequency,
            natural: frequency,
            frequency: frequency / std::f64::consts::TAU,
            damping: Some(0.0),
            shape: shares.map(part).to_vec(),
            words: String::new(),
        }
    }

    /// One mode that rises, one that falls; each alone in its coordinate.
    fn crossing(value: f64) -> Vec<Mode> {
        let mut modes = vec![mode(10.0 + value, [1.0, 0.0]), mode(20.0 - value, [0.0, 1.0])];
        modes.sort_by(|a, b| a.imaginary.total_cmp(&b.imaginary));
        modes
    }

    #[test]
    fn modes_that_cross_stay_what_they_are() {
        // At 5 both are equal but for their shapes.
        let found = branches((0..=10).map(|k| (f64::from(k), crossing(f64::from(k)))));
        assert_eq!(found.len(), 2);
        for (branch, way) in found.iter().zip([1.0, -1.0]) {
            let first = branch.points[0].1.imaginary;
            assert_eq!(branch.points.len(), 11);
            assert!(branch.points.iter().all(|(value, mode)| (mode.imaginary - first - way * value).abs() < 1e-12));
        }
        // Where nothing says yet which way they go, their shapes do.
        for branch in branches([4.9, 5.1].map(|value| (value, crossing(value)))) {
            assert_eq!(branch.points.len(), 2);
            assert_eq!(branch.points[0].1.shape, branch.points[1].1.shape);
        }
    }

    #[test]
    fn a_mode_that_begins_is_a_branch_of_its_own_and_one_that_ends_is_none_any_more() {
        let at = |value: u32| match value {
            0..=2 => vec![mode(10.0, [1.0, 0.0])],
            3 => vec![mode(10.0, [1.0, 0.0]), mode(40.0, [0.0, 1.0])],
            _ => vec![mode(40.0, [0.0, 1.0])],
        };
        let found = branches((0..6).map(|value| (f64::from(value), at(value))));
        let ends: Vec<[f64; 2]> = found.iter().map(|branch| [branch.points[0].0, branch.last().0]).collect();
        assert_eq!(ends, [[0.0, 3.0], [3.0, 5.0]]);
    }

    #[test]
    fn a_crossing_is_found_to_rounding() {
        let found = branches((0..=10).map(|k| (f64::from(k), crossing(f64::from(k)))));
        let excess = |value: f64, mode: &Mode| mode.imaginary.powi(2) - (4.0 * value).powi(2);
        // 10 + x = 4 x and 20 - x = 4 x, the second at one of the points.
        for (branch, expected) in found.iter().zip([10.0 / 3.0, 4.0]) {
            let met = crossings(branch, excess, |value| Some(crossing(value)));
            assert!(met.len() == 1 && (met[0].0 - expected).abs() < 1e-11, "{met:?}");
        }
        assert!(crossings(&found[0], excess, |_| None).is_empty());
    }
}
