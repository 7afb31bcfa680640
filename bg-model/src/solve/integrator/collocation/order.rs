//! Checks of the tableaus against the conditions that define the methods.
//!
//! Source: Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition, section IV.5, after Butcher 1964:
//! B(p) and C(q) and D(r) with p up to q + r + 1 and 2 q + 2 give order p (theorem 5.1).

use super::tableau::Tableau;
use super::{GAUSS6, RADAU5, RADAU9};

const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The largest violations of B(p), C(s) and D(r).
fn violations<const S: usize, const P: usize>(tableau: &Tableau<S, P>, p: i32, r: i32) -> [f64; 3] {
    let Tableau { a, b, c, .. } = tableau;
    let sum = |term: &dyn Fn(usize) -> f64| (0..S).map(term).sum::<f64>();
    let largest = |of: Vec<f64>| of.into_iter().map(f64::abs).fold(0.0, f64::max);
    let quadrature = (1..=p).map(|q| sum(&|i| b[i] * c[i].powi(q - 1)) - 1.0 / f64::from(q)).collect();
    let rows = |q: i32| (0..S).map(move |i| sum(&|j| a[i][j] * c[j].powi(q - 1)) - c[i].powi(q) / f64::from(q));
    let columns = |q: i32| {
        let of = move |j: usize| b[j] / f64::from(q) * (1.0 - c[j].powi(q));
        (0..S).map(move |j| sum(&|i| b[i] * c[i].powi(q - 1) * a[i][j]) - of(j))
    };
    [
        largest(quadrature),
        largest((1..=S as i32).flat_map(rows).collect()),
        largest((1..=r).flat_map(columns).collect()),
    ]
}

/// The largest differences between A and the sum over its eigenvalues, and between left times right and the identity.
fn decomposition<const S: usize, const P: usize>(tableau: &Tableau<S, P>) -> [f64; 2] {
    let Tableau { a, real, pairs, .. } = tableau;
    let mut worst = [0.0_f64; 2];
    for (i, row) in a.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            let mut sums = [real.right[i] * real.left[j]; 2];
            sums[0] *= real.value;
            for pair in pairs {
                let re = pair.right[0][i] * pair.left[0][j] - pair.right[1][i] * pair.left[1][j];
                let im = pair.right[0][i] * pair.left[1][j] + pair.right[1][i] * pair.left[0][j];
                sums[0] += pair.value[0] * re - pair.value[1] * im;
                sums[1] += re;
            }
            worst[0] = worst[0].max((sums[0] - entry).abs());
            worst[1] = worst[1].max((sums[1] - if i == j { 1.0 } else { 0.0 }).abs());
        }
    }
    worst
}

/// The largest error of the slope at zero of the powers 1 to s, and of their values inside, by the increments' weights.
fn interpolation<const S: usize, const P: usize>(tableau: &Tableau<S, P>) -> [f64; 2] {
    let at_nodes = |weights: &[f64; S], q: i32| (0..S).map(|j| weights[j] * tableau.c[j].powi(q)).sum::<f64>();
    let slope = |q| (at_nodes(&tableau.slope, q) - if q == 1 { 1.0 } else { 0.0 }).abs();
    let value = |theta: f64, q| (at_nodes(&tableau.weights(theta), q) - theta.powi(q)).abs();
    let powers = 1..=S as i32;
    let values = powers.clone().flat_map(|q| [0.1, 0.5, 0.93, 1.0, 1.5].map(|theta| value(theta, q)));
    [powers.map(slope).fold(0.0, f64::max), values.fold(0.0, f64::max)]
}

fn check<const S: usize, const P: usize>(tableau: &Tableau<S, P>, order: i32, excess: i32, large: f64) {
    let s = S as i32;
    let exact = violations(tableau, order, s - excess);
    assert!(exact.iter().all(|of| *of < ROUNDING), "{exact:?}");
    let more = violations(tableau, order + 1, 0);
    assert!(more[0] > 1e-9, "the order is not higher: {more:?}");
    let split = decomposition(tableau);
    assert!(split.iter().all(|of| *of < large * ROUNDING), "{split:?}");
    let inside = interpolation(tableau);
    assert!(inside.iter().all(|of| *of < large * ROUNDING), "{inside:?}");
}

#[test]
fn the_methods_have_their_orders_and_eigenvalues() {
    // The last number: how much larger than 1 the products of eigenvectors and weights get.
    check(&RADAU5, 5, 1, 4.0);
    check(&RADAU9, 9, 1, 10.0);
    check(&GAUSS6, 6, 0, 4.0);
}

#[test]
fn more_stages_agree_with_hairers_program() {
    // The subroutine COERCV of his `radau.f`: nodes; eigenvalues of the inverse of A; weights DD of the estimate.
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < ROUNDING, "{a} {b}");
    near(RADAU9.c[1], 0.276_843_013_638_123_8);
    near(RADAU9.real.value * 6.286_704_751_729_276, 1.0);
    near(RADAU9.slope[0], 27.780_933_944_064_637);
    let inverse = |[re, im]: [f64; 2], [alpha, beta]: [f64; 2]| {
        near(re, alpha / (alpha * alpha + beta * beta));
        near(im, beta / (alpha * alpha + beta * beta));
    };
    inverse(RADAU9.pairs[0].value, [5.700_953_298_671_789, 3.210_265_600_308_55]);
    inverse(RADAU9.pairs[1].value, [3.655_694_325_463_572, 6.543_736_899_360_077]);
}

#[test]
fn radau_is_stiffly_accurate() {
    assert_eq!((RADAU5.c[2], RADAU5.a[2]), (1.0, RADAU5.b));
    assert_eq!((RADAU9.c[4], RADAU9.a[4]), (1.0, RADAU9.b));
}

#[test]
fn the_closed_forms_of_three_stages_are_met() {
    // Table 5.6 and the constants U1, ALPH and BETA of `radau5.f`, eigenvalues of the inverse of A; table 5.2.
    let (root, cube, ninth) = (6.0_f64.sqrt(), libm::cbrt(81.0), libm::cbrt(9.0));
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < ROUNDING, "{a} {b}");
    near(RADAU5.c[0], (4.0 - root) / 10.0);
    near(RADAU5.a[0][0], (88.0 - 7.0 * root) / 360.0);
    near(RADAU5.a[1][2], (-2.0 - 3.0 * root) / 225.0);
    near(RADAU5.real.value, (6.0 + cube - ninth) / 30.0);
    let (alpha, beta) = ((12.0 - cube + ninth) / 60.0, (cube + ninth) * 3.0_f64.sqrt() / 60.0);
    near(RADAU5.pairs[0].value[0], alpha);
    near(RADAU5.pairs[0].value[1], beta);
    near(RADAU5.slope[0], (13.0 + 7.0 * root) / 3.0);
    near(GAUSS6.c[0], 0.5 - 15.0_f64.sqrt() / 10.0);
    near(GAUSS6.a[0][2], 5.0 / 36.0 - 15.0_f64.sqrt() / 30.0);
}
