//! The coefficients of each operation against closed forms, and against identities where there are none.

use super::*;

const ORDERS: usize = 12;

/// The coefficients that `operation` gives for an operand with these.
fn coefficients<const W: usize>(
    operand: &[f64],
    operation: impl Fn(&mut [[f64; W]], usize, f64) -> f64,
) -> [f64; ORDERS] {
    let mut rows = [[0.0; W]; ORDERS];
    core::array::from_fn(|k| operation(&mut rows, k, operand.get(k).copied().unwrap_or(0.0)))
}

/// The value of a polynomial.
fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
}

/// Holds the series of `f` of the polynomial `operand` against `f` itself, near its start.
fn agrees<const W: usize>(
    operand: &[f64],
    f: impl Fn(f64) -> f64,
    operation: impl Fn(&mut [[f64; W]], usize, f64) -> f64,
) {
    let series = coefficients(operand, operation);
    for t in [-0.004, 0.002, 0.005] {
        let (found, expected) = (value(&series, t), f(value(operand, t)));
        assert!((found - expected).abs() < 1e-14 * (1.0 + expected.abs()), "{operand:?} {t}: {found} {expected}");
    }
}

#[test]
fn functions_follow_their_values() {
    for operand in [&[0.4, -0.7, 0.3, 0.5][..], &[0.8, 1.1], &[0.25], &[0.3, 0.0, -2.0]] {
        agrees::<1>(operand, f64::sqrt, |rows, k, u| sqrt(rows, k, 0, u));
        agrees::<1>(operand, f64::abs, |rows, k, u| abs(rows, k, 0, u));
        agrees::<2>(operand, f64::exp, |rows, k, u| exp(rows, k, 0, u));
        agrees::<2>(operand, f64::ln, |rows, k, u| ln(rows, k, 0, u));
        agrees::<3>(operand, f64::sin, |rows, k, u| sin(rows, k, 0, u));
        agrees::<3>(operand, f64::cos, |rows, k, u| cos(rows, k, 0, u));
        agrees::<3>(operand, f64::tan, |rows, k, u| tan(rows, k, 0, u));
        agrees::<3>(operand, f64::tanh, |rows, k, u| tanh(rows, k, 0, u));
        agrees::<3>(operand, f64::asin, |rows, k, u| asin(rows, k, 0, u));
        agrees::<3>(operand, f64::acos, |rows, k, u| acos(rows, k, 0, u));
        for exponent in [-1.5, 0.5, 3.0] {
            let constant = |k| constant(k, exponent);
            agrees::<2>(operand, |u| u.powf(exponent), |rows, k, u| powf(rows, k, 0, u, exponent));
            agrees::<6>(operand, |u| u.powf(exponent), |rows, k, u| power(rows, k, 0, u, constant(k)));
        }
    }
    agrees::<1>(&[-0.4, 0.2], f64::abs, |rows, k, u| abs(rows, k, 0, u));
    agrees::<2>(&[-0.4, 0.2], |u| u.powi(18), |rows, k, u| powf(rows, k, 0, u, 18.0));
}

#[test]
fn products_and_quotients_undo_each_other() {
    let (a, b) = ([2.0, -1.0, 0.5, 3.0], [-1.5, 0.25, 0.0, 1.0, 2.0]);
    let mut rows = [[0.0; 4]; ORDERS];
    for k in 0..ORDERS {
        let [a, b] = [&a[..], &b[..]].map(|of| of.get(k).copied().unwrap_or(0.0));
        let product = product(&mut rows, k, 0, a, b);
        let expected: f64 = (0..=k).map(|j| rows[j][0] * rows[k - j][1]).sum();
        assert_eq!(product, expected, "{k}");
        let quotient = quotient(&mut rows, k, 2, product, b);
        assert!((quotient - a).abs() < 1e-12, "{k}: {quotient} {a}");
    }
}

#[test]
fn inner_products_leave_out_the_ends() {
    // Passes of each length.
    const P: usize = 24;
    let rows: [[f64; 2 * P]; 7] =
        core::array::from_fn(|j| core::array::from_fn(|i| libm::sin((7 * i + 31 * j) as f64)));
    let mut inner = InnerProducts::<f64, P>::first();
    for k in 1..=7 {
        let found = inner.at_next_order(&rows[..k]);
        for (i, found) in found.iter().enumerate() {
            let expected: f64 = (1..k).map(|j| rows[j][i] * rows[k - j][P + i]).sum();
            assert!((found - expected).abs() < 1e-15, "{k} {i}: {found} {expected}");
        }
    }
}

#[test]
fn inner_products_side_by_side_have_the_bits_of_single_ones() {
    // Wide vectors, and what is left.
    const COUNT: usize = 44;
    let mut numbers: [f64; 9 * 90] = core::array::from_fn(|i| libm::sin((7 * i) as f64));
    let rows = Flat { numbers: &mut numbers, width: 90 };
    for k in 0..9 {
        let mut sums = [1.0; COUNT];
        inner_products(&rows, k, &mut sums);
        for (i, sum) in sums.iter().enumerate() {
            assert_eq!(sum.to_bits(), inner_product(&rows, k, i, COUNT + i).to_bits(), "{k} {i}");
        }
    }
}

#[test]
fn the_angle_of_a_turning_point_is_the_angle_turned() {
    let angle = [2.5, 3.0, -0.5];
    let mut rows = [[0.0; 10]; ORDERS];
    for k in 0..ORDERS {
        let u = angle.get(k).copied().unwrap_or(0.0);
        let (sine, cosine) = (sin(&mut rows, k, 0, u), cos(&mut rows, k, 3, u));
        let found = atan2(&mut rows, k, 6, sine, cosine);
        assert!((found - u).abs() < 1e-13, "{k}: {found} {u}");
    }
}

#[test]
fn a_power_with_a_changing_exponent() {
    // (1 + t)^t = exp(t ln(1 + t)).
    let mut rows = [[0.0; 6]; ORDERS];
    let series: [f64; ORDERS] = core::array::from_fn(|k| {
        let time = if k == 1 { 1.0 } else { 0.0 };
        let (base, exponent) = (constant(k, 1.0) + time, time);
        power(&mut rows, k, 0, base, exponent)
    });
    for t in [-0.03, 0.04] {
        assert!((value(&series, t) - (1.0_f64 + t).powf(t)).abs() < 1e-15);
    }
}
