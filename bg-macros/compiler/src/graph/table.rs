//! Functions that are given by points, as pieces of polynomials.
//!
//! In: points in SI, what the function is between and beyond them. Out: a [`Table`]. No longer occurs: interpolation.
//! Methods: straight lines; monotone cubics by F. N. Fritsch, J. Butland, A Method for Constructing Local Monotone
//! Piecewise Cubic Interpolants, SIAM J. Sci. Stat. Comput. 5 (1984), 300-304, with end slopes of the three-point
//! formula, limited as by C. Moler, Numerical Computing with MATLAB (2004), section 3.6; the cubic spline whose first
//! two and last two pieces are one polynomial each ("not a knot"; C. de Boor, A Practical Guide to Splines (1978),
//! chapter IV).

use super::units::Dimension;
use crate::source::ast::{Between, Beyond};

/// Coefficients of 1, h, h^2, h^3, with h = argument - origin.
pub type Cubic = [f64; 4];

/// A function of one variable in pieces.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// The dimensions of its arguments, one or two.
    pub arguments: Vec<Dimension>,
    /// The dimension of its value.
    pub value: Dimension,
    /// Where one piece ends and the next begins, ascending.
    pub knots: Vec<f64>,
    /// The pieces, one more than knots: below the first, between each two, above the last. Of a periodic table one from
    /// each knot to the next, the last one to the first knot of the next period.
    pub pieces: Vec<Piece>,
    /// What it repeats, if it does.
    pub period: Option<Period>,
    /// What it is of two arguments; knots and pieces are of one.
    pub surface: Option<Surface>,
}

/// A function of two variables in patches.
#[derive(Clone, PartialEq, Debug)]
pub struct Surface {
    /// Of each argument where one patch ends and the next begins, ascending.
    pub knots: [Vec<f64>; 2],
    /// Of each argument where h is 0 in its patches, one more than knots.
    pub origins: [Vec<f64>; 2],
    /// The patches by those of the first argument, for each by those of the second; none where it is not defined.
    pub patches: Vec<Vec<Option<Patch>>>,
}

/// Coefficients of the powers of h of the first argument, for each of those of the second.
pub type Patch = [Cubic; 4];

/// The function through values at all pairs of arguments that ascend, which of each argument has at least two. Straight
/// lines make it bilinear; a spline one of splines in both directions (the tensor product; C. de Boor, A Practical
/// Guide to Splines (1978), chapter XVII). `values` has for each first argument those by the second.
pub fn surface([first, second]: [&[f64]; 2], values: &[Vec<f64>], between: Between, beyond: Beyond) -> Surface {
    let along = |arguments: &[f64], values: &mut dyn Iterator<Item = f64>| {
        let points: Vec<(f64, f64)> = arguments.iter().copied().zip(values).collect();
        all_pieces(&points, between, beyond)
    };
    let columns: Vec<Vec<Piece>> =
        (0..second.len()).map(|k| along(first, &mut values.iter().map(|row| row[k]))).collect();
    let patches = (0..=first.len()).map(|k| {
        // The coefficients of each power, as functions of the second argument.
        let powers: [Vec<Piece>; 4] = std::array::from_fn(|power| {
            along(second, &mut columns.iter().map(|column| column[k].cubic.map_or(0.0, |cubic| cubic[power])))
        });
        let is_defined = columns[0][k].cubic.is_some();
        (0..=second.len())
            .map(|j| {
                let of_power = |power: usize| powers[power][j].cubic.filter(|_| is_defined);
                Some([of_power(0)?, of_power(1)?, of_power(2)?, of_power(3)?])
            })
            .collect()
    });
    let origins = |arguments: &[f64]| std::iter::once(arguments[0]).chain(arguments.iter().copied()).collect();
    let knots = [first.to_vec(), second.to_vec()];
    Surface { knots, origins: [origins(first), origins(second)], patches: patches.collect() }
}

/// What a table repeats. The knot number [`Period::half`] is half a period after the first one, so that no piece is
/// longer than half a period.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Period {
    /// How long it is.
    pub length: f64,
    /// The number of the knot in its middle.
    pub half: usize,
    /// The mean of the table over it.
    pub mean: f64,
}

/// A piece of a table.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Piece {
    /// Where h is 0.
    pub origin: f64,
    /// Its polynomial; none where the table is not defined.
    pub cubic: Option<Cubic>,
    /// The integral of the table from its first point to the origin; in a periodic table without that of its mean.
    pub integral: f64,
}

/// Two arguments that differ by less, beside the period, are one.
const SAME: f64 = 1e-12;

impl Table {
    /// Whether it has a value for every argument.
    #[must_use]
    pub fn is_everywhere(&self) -> bool {
        let mut patches = self.surface.iter().flat_map(|surface| surface.patches.iter().flatten());
        self.pieces.iter().all(|piece| piece.cubic.is_some()) && patches.all(Option::is_some)
    }
}

/// Knots and pieces of a function through at least two points whose arguments ascend. A periodic one has at least
/// three, the last of which is the first one a period later.
pub fn pieces(points: &[(f64, f64)], between: Between, beyond: Beyond) -> (Vec<f64>, Vec<Piece>, Option<Period>) {
    if beyond == Beyond::Periodic {
        let (knots, pieces, period) = periodic(points, between);
        return (knots, pieces, Some(period));
    }
    let (knots, pieces) = ended(points, between, beyond);
    (knots, pieces, None)
}

/// Between each two points the argument of the first one and the polynomial from there on; by slopes at the points, if
/// not straight.
fn cubics(points: &[(f64, f64)], slopes: &[f64]) -> Vec<(f64, Cubic)> {
    points
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
        .collect()
}

/// Of a function that repeats itself: pieces about their middles.
fn periodic(points: &[(f64, f64)], between: Between) -> (Vec<f64>, Vec<Piece>, Period) {
    let slopes = match between {
        Between::Straight => Vec::new(),
        Between::Monotone => monotone_periodic(points),
        Between::Spline => spline_periodic(points),
    };
    let (first, last) = (points[0].0, points[points.len() - 1].0);
    let (length, middle) = (last - first, 0.5 * (first + last));
    // A point in the middle but for rounding is there.
    let snapped = |&(x, y): &(f64, f64)| (if (x - middle).abs() < SAME * length { middle } else { x }, y);
    let points: Vec<(f64, f64)> = points.iter().map(snapped).collect();
    let mut parts: Vec<(f64, f64, f64, Cubic)> = Vec::new();
    for ((origin, cubic), ends) in cubics(&points, &slopes).into_iter().zip(points.windows(2)) {
        let end = ends[1].0;
        if origin < middle && middle < end {
            parts.extend([(origin, origin, middle, cubic), (origin, middle, end, cubic)]);
        } else {
            parts.push((origin, origin, end, cubic));
        }
    }
    let whole =
        |(origin, from, to, cubic): &(f64, f64, f64, Cubic)| area(cubic, to - origin) - area(cubic, from - origin);
    let mean = parts.iter().map(whole).sum::<f64>() / length;
    let (mut knots, mut pieces, mut before) = (Vec::new(), Vec::new(), 0.0);
    for part in &parts {
        let &(origin, from, to, cubic) = part;
        let center = 0.5 * (from + to);
        let cubic = about(&cubic, center - origin);
        let half = from - center;
        knots.push(from);
        pieces.push(Piece { origin: center, cubic: Some(cubic), integral: before - area(&cubic, half) + mean * half });
        before += whole(part) - mean * (to - from);
    }
    let half = knots.partition_point(|&knot| knot < middle);
    (knots, pieces, Period { length, half, mean })
}

/// The same polynomial from another origin.
fn about(&[a, b, c, d]: &Cubic, h: f64) -> Cubic {
    [a + h * (b + h * (c + h * d)), b + h * (2.0 * c + h * 3.0 * d), c + 3.0 * d * h, d]
}

/// Of a function with ends.
fn ended(points: &[(f64, f64)], between: Between, beyond: Beyond) -> (Vec<f64>, Vec<Piece>) {
    joined(points.iter().map(|point| point.0).collect(), &all_pieces(points, between, beyond))
}

/// A piece below the first point, between each two, above the last.
fn all_pieces(points: &[(f64, f64)], between: Between, beyond: Beyond) -> Vec<Piece> {
    let slopes = match between {
        Between::Straight => Vec::new(),
        Between::Monotone => monotone(points),
        Between::Spline => spline(points),
    };
    let inner = cubics(points, &slopes);
    let (first, last) = (points[0], points[points.len() - 1]);
    let end_slopes = match (inner.first(), inner.last()) {
        (Some((_, low)), Some(&(origin, high))) => [low[1], slope_at(&high, last.0 - origin)],
        _ => [0.0; 2],
    };
    let outer = |(_, value): (f64, f64), slope: f64| match beyond {
        Beyond::Refused | Beyond::Periodic => None,
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
    all
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
    let inner = parts.windows(2).map(|pair| between_parts(pair[0], pair[1]));
    let reversed: Vec<(f64, f64)> = parts.iter().rev().copied().collect();
    std::iter::once(end_slope(&parts)).chain(inner).chain([end_slope(&reversed)]).collect()
}

/// The same of a function that repeats itself.
fn monotone_periodic(points: &[(f64, f64)]) -> Vec<f64> {
    let parts: Vec<(f64, f64)> = points.windows(2).map(secant).collect();
    let last = parts[parts.len() - 1];
    let seam = between_parts(last, parts[0]);
    let inner = parts.windows(2).map(|pair| between_parts(pair[0], pair[1]));
    std::iter::once(seam).chain(inner).chain([seam]).collect()
}

/// The slope of a cubic without overshoot between two parts, by their widths and slopes.
fn between_parts((h, s): (f64, f64), (g, t): (f64, f64)) -> f64 {
    if s * t <= 0.0 { 0.0 } else { 3.0 * (h + g) / ((2.0 * g + h) / s + (g + 2.0 * h) / t) }
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
    let count = points.len();
    let mut rows: Vec<Row> = vec![[0.0; 4]; count];
    for (k, pair) in parts.windows(2).enumerate() {
        rows[k + 1] = curvature_row(pair[0], pair[1]);
    }
    let [diagonal, beside, right] = not_a_knot(parts[0], parts[1]);
    rows[0] = [0.0, diagonal, beside, right];
    let [diagonal, beside, right] = not_a_knot(parts[count - 2], parts[count - 3]);
    rows[count - 1] = [beside, diagonal, 0.0, right];
    tridiagonal(rows)
}

/// Coefficients below, on and above the diagonal, and the right side.
type Row = [f64; 4];

/// The second derivative is continuous between two pieces: g d0 + 2 (h + g) d1 + h d2 = 3 (g s + h t).
fn curvature_row((h, s): (f64, f64), (g, t): (f64, f64)) -> Row {
    [g, 2.0 * (h + g), h, 3.0 * (g * s + h * t)]
}

/// Elimination without pivoting: the matrix is that of the spline, well conditioned (de Boor, chapter IV).
fn tridiagonal(mut rows: Vec<Row>) -> Vec<f64> {
    let count = rows.len();
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

/// Slopes at the points of the cubic spline that repeats itself: a cyclic system, of which the slope at the seam is
/// found from two others, with that slope 0 and 1 and without the row of the seam (Sherman and Morrison's way to solve
/// it).
fn spline_periodic(points: &[(f64, f64)]) -> Vec<f64> {
    let parts: Vec<(f64, f64)> = points.windows(2).map(secant).collect();
    let count = parts.len();
    let inner: Vec<Row> = parts.windows(2).map(|pair| curvature_row(pair[0], pair[1])).collect();
    let [before, at, after, right] = curvature_row(parts[count - 1], parts[0]);
    let with_seam = |seam: f64, is_whole: bool| {
        let mut rows = inner.clone();
        let last = rows.len() - 1;
        rows.iter_mut().filter(|_| !is_whole).for_each(|row| row[3] = 0.0);
        rows[0][3] -= rows[0][0] * seam;
        rows[last][3] -= rows[last][2] * seam;
        tridiagonal(rows)
    };
    let (still, by_seam) = (with_seam(0.0, true), with_seam(1.0, false));
    let ends = |of: &[f64]| before * of[count - 2] + after * of[0];
    let seam = (right - ends(&still)) / (at + ends(&by_seam));
    let slopes = still.iter().zip(&by_seam).map(|(still, by)| still + seam * by);
    std::iter::once(seam).chain(slopes).chain([seam]).collect()
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
    fn at((knots, pieces, period): &(Vec<f64>, Vec<Piece>, Option<Period>), x: f64) -> f64 {
        if let Some(Period { length, .. }) = period {
            let turned = knots[0] + (x - knots[0]).rem_euclid(*length);
            let piece = pieces[knots.partition_point(|&knot| knot <= turned) - 1];
            let [a, b, c, d] = piece.cubic.expect("a periodic table is defined everywhere");
            let h = turned - piece.origin;
            return a + h * (b + h * (c + h * d));
        }
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
        let (knots, pieces, _) = pieces(&points, Between::Straight, Beyond::Continued);
        assert_eq!(knots, [2.0]);
        assert_eq!(pieces.iter().map(|piece| piece.integral).collect::<Vec<_>>(), [0.0, 4.0]);
    }

    #[test]
    fn a_periodic_spline_is_of_fourth_order_at_the_seam_as_elsewhere() {
        let of = |x: f64| (x.sin() + 0.3 * (3.0 * x).cos()).exp();
        let error = |count: u32| {
            let turn = 2.0 * std::f64::consts::PI;
            let place = |k: u32| 0.4 + turn * f64::from(k) / f64::from(count);
            let points: Vec<(f64, f64)> = (0..=count).map(|k| (place(k), of(place(k % count)))).collect();
            let spline = pieces(&points, Between::Spline, Beyond::Periodic);
            (-1000..=2000).map(|k| f64::from(k) / 100.0).map(|x| (at(&spline, x) - of(x)).abs()).fold(0.0, f64::max)
        };
        let order = (error(80) / error(160)).log2();
        assert!((order - 4.0).abs() < 0.15, "{order}");
    }

    #[test]
    fn a_period_has_a_knot_in_its_middle_and_its_mean() {
        let points = [(1.0, 0.0), (2.0, 4.0), (5.0, 0.0)];
        for between in [Between::Straight, Between::Monotone] {
            let table = pieces(&points, between, Beyond::Periodic);
            let Some(Period { length, half, mean }) = table.2 else { panic!("no period") };
            assert_eq!((length, half, table.0.as_slice()), (4.0, 2, &[1.0, 2.0, 3.0][..]), "{between:?}");
            let steps = (0..40_000).map(|k| at(&table, 1.0 + (f64::from(k) + 0.5) / 1e4));
            assert!((steps.sum::<f64>() / 4e4 - mean).abs() < 1e-8, "{between:?}");
            assert!(points.iter().all(|&(x, y)| (at(&table, x + 8.0) - y).abs() < 1e-15), "{between:?}");
        }
    }

    fn on(surface: &Surface, [x, y]: [f64; 2]) -> f64 {
        let [row, column] = [(0, x), (1, y)].map(|(k, at)| surface.knots[k].partition_point(|&knot| knot <= at));
        let Some(patch) = surface.patches[row][column] else { return f64::NAN };
        let [h, k] = [x - surface.origins[0][row], y - surface.origins[1][column]];
        let powers = patch.map(|[a, b, c, d]| a + k * (b + k * (c + k * d)));
        powers[0] + h * (powers[1] + h * (powers[2] + h * powers[3]))
    }

    #[test]
    fn surfaces_are_exact_for_products_of_their_own_kind() {
        let (first, second) = ([-1.0, 0.3, 1.0, 2.5, 4.0], [0.0, 0.5, 2.0, 2.2]);
        let lines = |x: f64, y: f64| (1.0 + 2.0 * x) * (3.0 - y);
        let cubics = |x: f64, y: f64| (1.0 - x + 0.5 * x * x * x) * (2.0 + y * y - y * y * y);
        let of = |function: fn(f64, f64) -> f64| -> Vec<Vec<f64>> {
            first.iter().map(|&x| second.iter().map(|&y| function(x, y)).collect()).collect()
        };
        for (function, between) in [(lines as fn(f64, f64) -> f64, Between::Straight), (cubics, Between::Spline)] {
            let made = surface([&first, &second], &of(function), between, Beyond::Refused);
            for k in 0..50 {
                let at = [-1.0 + 0.1 * f64::from(k), 2.2 * f64::from((7 * k) % 51) / 51.0];
                assert!((on(&made, at) - function(at[0], at[1])).abs() < 1e-12, "{at:?}");
            }
            assert!(on(&made, [4.5, 1.0]).is_nan() && on(&made, [1.0, -0.1]).is_nan());
        }
        let made = surface([&first, &second], &of(lines), Between::Straight, Beyond::Continued);
        assert!((on(&made, [7.0, -3.0]) - lines(7.0, -3.0)).abs() < 1e-12);
        let made = surface([&first, &second], &of(lines), Between::Straight, Beyond::Held);
        assert!((on(&made, [7.0, -3.0]) - lines(4.0, 0.0)).abs() < 1e-12);
    }
}
