//! Observed orders, and errors that follow the tolerance.

use crate::problems::*;
use bg_model::integrator::{Absolute, Dop853, Method, Rk4, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings};
use bg_model::system::System;

/// The slope of the error over the step between two steps, in logarithms.
fn order(coarse: (f64, f64), fine: (f64, f64)) -> f64 {
    (coarse.1 / fine.1).log2() / (coarse.0 / fine.0).log2()
}

/// The errors at t = 2 of x' = x cos t, x(0) = 1, for both steps.
fn errors<M: Method>(method: impl Fn(f64) -> M, steps: [f64; 2]) -> [(f64, f64); 2] {
    let system = smooth(|t: f64, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * libm::cos(t)]);
    steps.map(|step| {
        let (finish, _) = run(&system, method(step), [1.0], 2.0, &fixed(step));
        (step, (finish.x[0] - libm::exp(libm::sin(2.0))).abs())
    })
}

#[test]
fn rk4_has_order_4_with_time_in_the_rate() {
    let [coarse, fine] = errors(Rk4::new, [0.02, 0.01]);
    let order = order(coarse, fine);
    assert!((3.9..4.1).contains(&order), "{order}");
}

#[test]
fn dop853_has_order_8_with_time_in_the_rate() {
    let [coarse, fine] = errors(|_| Dop853::new(), [0.5, 0.25]);
    let order = order(coarse, fine);
    assert!((7.6..8.6).contains(&order), "{order}: {coarse:?} {fine:?}");
}

/// The error at the end of one turn on a circle, for both steps.
fn circle_errors<M: Method>(method: impl Fn(f64) -> M, parts: [f64; 2]) -> [(f64, f64); 2] {
    let turn = 2.0 * std::f64::consts::PI;
    let start = SVector::from([1.0, 0.0, 0.0, 1.0]);
    parts.map(|parts| {
        let step = turn / parts;
        let (finish, _) = run(&kepler(), method(step), start, turn, &fixed(step));
        (step, (finish.x - start).norm())
    })
}

#[test]
fn both_have_their_order_on_a_nonlinear_system() {
    let [coarse, fine] = circle_errors(Rk4::new, [200.0, 400.0]);
    assert!((3.8..4.3).contains(&order(coarse, fine)), "{coarse:?} {fine:?}");
    let [coarse, fine] = circle_errors(|_| Dop853::new(), [16.0, 32.0]);
    assert!((7.6..8.8).contains(&order(coarse, fine)), "{coarse:?} {fine:?}");
}

/// The largest error inside a single step of the oscillator, for both steps.
fn dense_errors<M: Method>(method: impl Fn(f64) -> M, steps: [f64; 2]) -> [(f64, f64); 2] {
    let system = smooth(|_, x: &SVector<f64, 2>, _: &[bool; 0]| [x[1], -x[0]]);
    steps.map(|step| {
        let settings = Settings { samples: Samples::Every(step / 32.0), ..fixed(step) };
        let (finish, record) = run(&system, method(step), [0.6, 0.8], step, &settings);
        assert_eq!(finish.statistics.steps, 1);
        assert_eq!(record.samples.len(), 33);
        let error = |(t, x, _): &(f64, SVector<f64, 2>, _)| {
            (x - SVector::from([0.6 * t.cos() + 0.8 * t.sin(), 0.8 * t.cos() - 0.6 * t.sin()])).norm()
        };
        (step, record.samples.iter().map(error).fold(0.0, f64::max))
    })
}

#[test]
fn the_dense_output_of_dop853_has_order_7() {
    let [coarse, fine] = dense_errors(|_| Dop853::new(), [0.8, 0.4]);
    let order = order(coarse, fine);
    assert!((7.7..8.4).contains(&order), "a step's error falls with the power 8: {order}");
}

#[test]
fn the_dense_output_of_rk4_falls_with_the_power_4() {
    let [coarse, fine] = dense_errors(Rk4::new, [0.2, 0.1]);
    let order = order(coarse, fine);
    assert!((3.9..4.3).contains(&order), "{order}");
}

#[test]
fn the_error_follows_the_tolerance_over_eight_decades() {
    let mut errors = Vec::new();
    for exponent in [-4, -6, -8, -10, -12] {
        let tolerance = 10.0_f64.powi(exponent);
        let (finish, _) = run(&kepler(), Dop853::new(), kepler_start(), 20.0, &settings(tolerance));
        errors.push((finish.x - SVector::from(KEPLER_AT_20)).norm() / tolerance);
    }
    // The orbit's sensitivity to an early error grows with the time; the ratio must stay within a few decades.
    assert!(errors.iter().all(|ratio| (1.0..2e3).contains(ratio)), "{errors:?}");
}

#[test]
fn arenstorfs_orbit_closes() {
    let (finish, _) = run(&arenstorf(), Dop853::new(), ARENSTORF_START, ARENSTORF_PERIOD, &settings(1e-12));
    let gap = (finish.x - SVector::from(ARENSTORF_START)).norm();
    assert!(gap < 1e-7, "{gap}");
    let (finish, _) = run(&arenstorf(), Dop853::new(), ARENSTORF_START, ARENSTORF_PERIOD, &settings(1e-8));
    let looser = (finish.x - SVector::from(ARENSTORF_START)).norm();
    assert!(looser > 100.0 * gap, "{looser} {gap}");
}

#[test]
fn scalar_and_per_state_tolerances_agree() {
    let scalar = settings(1e-9);
    let absolute = Absolute::PerState(vec![1e-9; 4]);
    let per_state = Settings { tolerances: Tolerances { relative: 1e-9, absolute }, ..scalar.clone() };
    let run = |settings| run(&kepler(), Dop853::new(), kepler_start(), 20.0, settings);
    assert_eq!(run(&scalar), run(&per_state));
    let absolute = Absolute::PerState(vec![1e-9, 1e-9, 1e-3, 1e-3]);
    let uneven = Settings { tolerances: Tolerances { relative: 1e-9, absolute }, ..scalar.clone() };
    assert!(run(&uneven).0.statistics.steps < run(&scalar).0.statistics.steps);
}

/// A rotation at a constant angular velocity, brought back onto the rotations or not.
struct Turning {
    is_projected: bool,
}

const OMEGA: [f64; 3] = [3.0, -2.0, 6.0];

impl System<f64, 9, 0> for Turning {
    fn rate(&self, _: f64, x: &SVector<f64, 9>, _: &[bool; 0], dx: &mut SVector<f64, 9>) {
        for column in 0..3 {
            let v: [f64; 3] = std::array::from_fn(|row| x[3 * column + row]);
            dx[3 * column] = OMEGA[1] * v[2] - OMEGA[2] * v[1];
            dx[3 * column + 1] = OMEGA[2] * v[0] - OMEGA[0] * v[2];
            dx[3 * column + 2] = OMEGA[0] * v[1] - OMEGA[1] * v[0];
        }
    }
    /// A step of Newton's iteration to the nearest orthogonal matrix: X (3 - X^T X) / 2.
    fn project(&self, _: f64, _: &[bool; 0], x: &mut SVector<f64, 9>) {
        if self.is_projected {
            let m = bg_model::nalgebra::Matrix3::from_column_slice(x.as_slice());
            let near = m * (bg_model::nalgebra::Matrix3::identity() * 3.0 - m.transpose() * m) * 0.5;
            x.copy_from_slice(near.as_slice());
        }
    }
}

fn drift<M: Method>(is_projected: bool, method: M, samples: Samples) -> f64 {
    let start = SVector::from([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
    let (_, record) = run(&Turning { is_projected }, method, start, 20.0, &Settings { samples, ..settings(1e-6) });
    let of = |x: &SVector<f64, 9>| {
        let m = bg_model::nalgebra::Matrix3::from_column_slice(x.as_slice());
        (m.transpose() * m - bg_model::nalgebra::Matrix3::identity()).norm()
    };
    record.samples.iter().map(|(_, x, _)| of(x)).fold(0.0, f64::max)
}

#[test]
fn the_projection_stops_the_drift_at_steps_and_samples() {
    let steps = [drift(false, Dop853::new(), Samples::Steps), drift(true, Dop853::new(), Samples::Steps)];
    assert!(steps[0] > 1e-7 && steps[1] < 1e-12, "{steps:?}");
    let steps = [drift(false, Rk4::new(0.02), Samples::Steps), drift(true, Rk4::new(0.02), Samples::Steps)];
    assert!(steps[0] > 1e-5 && steps[1] < 1e-11, "{steps:?}");
    let samples =
        [drift(false, Dop853::new(), Samples::Every(0.0137)), drift(true, Dop853::new(), Samples::Every(0.0137))];
    assert!(samples[0] > 1e-7 && samples[1] < 1e-10, "{samples:?}");
}
