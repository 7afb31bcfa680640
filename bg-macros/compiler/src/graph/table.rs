//! Functions that are given by points, as pieces of polynomials.
//!
//! In: points in SI, what the function is between and beyond them. Out: a [`Table`]. No longer occurs: interpolation.
//! Methods: straight lines; monotone cubics by F. N. Fritsch, J. Butland, A Method for Constructing Local Monotone
//! Piecewise Cubic Interpolants, SIAM J. Sci. Stat. Comput. 5 (1984), 300-304, with end slopes of the three-point
//! formula, limited as by C. Moler, Numerical Computing with MATLAB (2004), section 3.6; the cubic spline whose first two
//! and last two pieces are one polynomial each ("not a knot"; C. de Boor, A Practical Guide to Splines (1978), chapter IV).

use super::units::Dimension;
use crate::source::ast::{Between, Beyond};

/// Coefficients of 1, h, h^2, h^3, with h = argument - origin.
pub type Cubic = [f64; 4];

/// A function of one variable in pieces.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// The dimension of its argument.
    pub argument: Dimension,
    /// The dimension of its value.
    pub value: Dimension,
    /// Where one piece ends and the next begins, ascending.
    pub knots: Vec<f64>,
    /// The pieces, one more than knots: below the first, between each two, above the last.
    pub pieces: Vec<Piece>,
}

/// A piece of a table.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Piece {
    /// Where h is 0.
    pub origin: f64,
    /// Its polynomial; none where the table is not defined.
    pub cubic: Option<Cubic>,
    /// The integral of the table from its first point to the origin.
    pub integral: f64,
}

impl Table {
    /// Whether it has a value for every argument.
    #[must_use]
    pub fn is_everywhere(&self) -> bool {
        self.pieces.iter().all(|piece| piece.cubic.is_some())
    }
}

/// The pieces of a function through at least two points whose arguments ascend.
pub fn pieces(points: &[(f64, f64)], between: Between, beyond: Beyond) -> (Vec<f64>, Vec<Piece>) {
    let slopes = match between {
        Between::Straight => Vec::new(),
        Between::Monotone => monotone(points),
        Between::Spline => spline(points),
    };
    let inner: Vec<(f64, Cubic)> = points
        .windows(2)
        .enumerate()
        .map(|(k, ends)| {
            let (width, secant) = secant(ends);
            let cubic = match slopes.get(k..k + 2) {
                Some(&[first, last]) => hermite(ends[0].1, width, secant, first, last),
                _ => [ends[0].1, secant, 0.0, 0.0],
            };
            (ends[0].0, cubic)
        })
        .collect();
    let (first, last) = (points[0], points[points.len() - 1]);
    let end_slopes = match (inner.first(), inner.last()) {
        (Some((_, low)), Some(&(origin, high))) => [low[1], slope_at(&high, last.0 - origin)],
        _ => [0.0; 2],
    };
    let outer = |(_, value): (f64, f64), slope: f64| match beyond {
        Beyond::Refused => None,
        Beyond::Held => Some([value, 0.0, 0.0, 0.0]),
        Beyond::Continued => Some([value, slope, 0.0, 0.0]),
    };
    let mut all = vec![Piece { origin: first.0, cubic: outer(first, end_slopes[0]), integral: 0.0 }];
    let mut integral = 0.0;
    for ((origin, cubic), ends) in inner.into_iter().zip(points.windows(2)) {
        all.push(Piece { origin, cubic: Some(cubic), integral });
        integral += area(&cubic, ends[1].0 - ends[0].0);
    }
    all.push(Piece { origin: last.0, cubic: outer(last, end_slopes[1]), integral });
    joined(points.iter().map(|point| point.0).collect(), &all)
}

/// Without the knots at which a straight line goes on.
fn joined(knots: Vec<f64>, all: &[Piece]) -> (Vec<f64>, Vec<Piece>) {
    let (mut kept, mut pieces) = (Vec::new(), vec![all[0]]);
    for (knot, &piece) in knots.into_iter().zip(&all[1..]) {
        let before = pieces[pieces.len() - 1];
        if !goes_on(&before, &piece) {
            kept.push(knot);
            pieces.push(piece);
        }
    }
    (kept, pieces)
}

fn goes_on(before: &Piece, piece: &Piece) -> bool {
    let (Some([a, slope, 0.0, 0.0]), Some([b, next, 0.0, 0.0])) = (before.cubic, piece.cubic) else { return false };
    slope == next && a + slope * (piece.origin - before.origin) == b
}

/// Width and slope between two points.
fn secant(ends: &[(f64, f64)]) -> (f64, f64) {
    let width = ends[1].0 - ends[0].0;
    (width, (ends[1].1 - ends[0].1) / width)
}

/// The cubic of this value at its beginning and these slopes at its ends.
fn hermite(value: f64, width: f64, secant: f64, first: f64, last: f64) -> Cubic {
    [value, first, (3.0 * secant - 2.0 * first - last) / width, (first + last - 2.0 * secant) / (width * width)]
}

fn slope_at([_, b, c, d]: &Cubic, h: f64) -> f64 {
    b + h * (2.0 * c + h * 3.0 * d)
}

fn area([a, b, c, d]: &Cubic, h: f64) -> f64 {
    h * (a + h * (b / 2.0 + h * (c / 3.0 + h * d / 4.0)))
}

/// Slopes at the points of cubics without overshoot.
fn monotone(points: &[(f64, f64)]) -> Vec<f64> {
    let parts: Vec<(f64, f64)> = points.windows(2).map(secant).collect();
    let inner = parts.windows(2).map(|pair| {
        let [(h, s), (g, t)] = [pair[0], pair[1]];
        if s * t <= 0.0 { 0.0 } else { 3.0 * (h + g) / ((2.0 * g + h) / s + (g + 2.0 * h) / t) }
    });
    let reversed: Vec<(f64, f64)> = parts.iter().rev().copied().collect();
    std::iter::once(end_slope(&parts)).chain(inner).chain([end_slope(&reversed)]).collect()
}

/// The slope at the first of the points between which these widths and slopes are.
fn end_slope(parts: &[(f64, f64)]) -> f64 {
    let [(h, s), (g, t)] = match parts {
        [first, second, ..] => [*first, *second],
        [only] => return only.1,
        [] => return 0.0,
    };
    let slope = ((2.0 * h + g) * s - h * t) / (h + g);
    if slope * s <= 0.0 {
        0.0
    } else if s * t <= 0.0 && slope.abs() > 3.0 * s.abs() {
        3.0 * s
    } else {
        slope
    }
}

/// Slopes at the points of the cubic spline.
fn spline(points: &[(f64, f64)]) -> Vec<f64> {
    let parts: Vec<(f64, f64)> = points.windows(2).map(secant).collect();
    match *parts.as_slice() {
        [(_, s)] => return vec![s; 2],
        // One parabola.
        [(h, s), (g, t)] => {
            let curvature = (t - s) / (h + g);
            return vec![s - curvature * h, s + curvature * h, t + curvature * g];
        }
        _ => {}
    }
    // Continuous second derivatives: g d0 + 2 (h + g) d1 + h d2 = 3 (g s + h t) at each inner point. A row has the
    // coefficients below, on and above the diagonal, and the right side.
    let count = points.len();
    let mut rows: Vec<[f64; 4]> = vec![[0.0; 4]; count];
    for (k, pair) in parts.windows(2).enumerate() {
        let [(h, s), (g, t)] = [pair[0], pair[1]];
        rows[k + 1] = [g, 2.0 * (h + g), h, 3.0 * (g * s + h * t)];
    }
    let [diagonal, beside, right] = not_a_knot(parts[0], parts[1]);
    rows[0] = [0.0, diagonal, beside, right];
    let [diagonal, beside, right] = not_a_knot(parts[count - 2], parts[count - 3]);
    rows[count - 1] = [beside, diagonal, 0.0, right];
    // Elimination without pivoting: the matrix is that of the spline, well conditioned (de Boor, chapter IV).
    for k in 1..count {
        let factor = rows[k][0] / rows[k - 1][1];
        let [_, _, above, right] = rows[k - 1];
        rows[k][1] -= factor * above;
        rows[k][3] -= factor * right;
    }
    let mut slopes = vec![0.0; count];
    for k in (0..count).rev() {
        let next = if k + 1 < count { rows[k][2] * slopes[k + 1] } else { 0.0 };
        slopes[k] = (rows[k][3] - next) / rows[k][1];
    }
    slopes
}

/// The equation of the slope at an end, of the slope beside it, and its right side, from the two pieces at that end.
fn not_a_knot((h, s): (f64, f64), (g, t): (f64, f64)) -> [f64; 3] {
    let right = ((h + 2.0 * (h + g)) * g * s + h * h * t) / (h + g);
    [g, h + g, right]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The value at `x`.
    fn at((knots, pieces): &(Vec<f64>, Vec<Piece>), x: f64) -> f64 {
        let piece = pieces[knots.partition_point(|&knot| knot <= x)];
        piece.cubic.map_or(f64::NAN, |[a, b, c, d]| {
            let h = x - piece.origin;
            a + h * (b + h * (c + h * d))
        })
    }

    fn sampled(of: impl Fn(f64) -> f64, count: u32, uneven: f64) -> Vec<(f64, f64)> {
        let place = |k: u32| {
            let x = f64::from(k) / f64::from(count - 1);
            x + uneven * (7.0 * x).sin() * x * (1.0 - x)
        };
        (0..count).map(|k| (place(k), of(place(k)))).collect()
    }

    #[test]
    fn a_spline_is_exact_for_cubics_and_of_fourth_order() {
        let cubic = |x: f64| 2.0 - x + 3.0 * x * x - 5.0 * x * x * x;
        for count in 4..9 {
            let spline = pieces(&sampled(cubic, count, 0.3), Between::Spline, Beyond::Continued);
            for k in 0..=100 {
                let x = f64::from(k) / 100.0;
                assert!((at(&spline, x) - cubic(x)).abs() < 1e-13, "{count} points at {x}");
            }
        }
        let error = |count: u32| {
            let spline = pieces(&sampled(|x| (5.0 * x).sin(), count, 0.0), Between::Spline, Beyond::Held);
            (0..=1000)
                .map(|k| f64::from(k) / 1000.0)
                .map(|x| (at(&spline, x) - (5.0 * x).sin()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(41) / error(81)).log2();
        assert!((order - 4.0).abs() < 0.15, "{order}");
    }

    #[test]
    fn few_points_of_a_spline_are_a_line_or_a_parabola() {
        let line = pieces(&[(1.0, 2.0), (3.0, 6.0)], Between::Spline, Beyond::Continued);
        assert_eq!((line.0.len(), at(&line, 2.5)), (0, 5.0));
        let parabola = pieces(&[(0.0, 0.0), (1.0, 1.0), (3.0, 9.0)], Between::Spline, Beyond::Refused);
        assert!((at(&parabola, 2.0) - 4.0).abs() < 1e-14);
        assert!(at(&parabola, 3.5).is_nan() && at(&parabola, -0.5).is_nan());
    }

    #[test]
    fn monotone_cubics_do_not_overshoot() {
        // Fritsch and Carlson's data, SIAM J. Numer. Anal. 17 (1980), 238-246, table 1, where splines overshoot.
        let points = [
            (7.99, 0.0),
            (8.09, 2.76429e-5),
            (8.19, 4.37498e-2),
            (8.7, 0.169183),
            (9.2, 0.469428),
            (10.0, 0.943740),
            (12.0, 0.998636),
            (15.0, 0.999919),
            (20.0, 0.999994),
        ];
        let table = pieces(&points, Between::Monotone, Beyond::Held);
        let values: Vec<f64> = (0..=2000).map(|k| at(&table, 7.5 + 13.0 * f64::from(k) / 2000.0)).collect();
        assert!(values.windows(2).all(|pair| pair[0] <= pair[1] + 1e-15));
        assert!(points.iter().all(|&(x, y)| (at(&table, x) - y).abs() < 1e-15));
    }

    #[test]
    fn lines_have_no_knot_where_they_go_on() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, 4.0), (3.0, 0.0)];
        let (knots, pieces) = pieces(&points, Between::Straight, Beyond::Continued);
        assert_eq!(knots, [2.0]);
        assert_eq!(pieces.iter().map(|piece| piece.integral).collect::<Vec<_>>(), [0.0, 4.0]);
    }
}
