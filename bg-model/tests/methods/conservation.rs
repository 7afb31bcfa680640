//! Gauss' method on long conservative runs: energies and quadratic invariants over 1e5 steps.

use crate::problems::*;
use bg_model::integrator::{Gauss6, Method, Radau5, Rk4};
use bg_model::nalgebra::{SVector, Vector3};
use bg_model::simulation::{EachSample, Samples, Settings, Span, integrate};
use bg_model::system::{System, values};

/// The largest relative changes of the `invariants` in the first and the second half of a run, against the start.
fn changes<M: Method, const N: usize, const K: usize>(
    system: &impl System<f64, N, 0>,
    mut method: M,
    start: [f64; N],
    t_end: f64,
    invariants: impl Fn(&SVector<f64, N>) -> [f64; K],
) -> [[f64; K]; 2] {
    let start = SVector::from(start);
    let from = invariants(&start);
    let mut worst = [[0.0_f64; K]; 2];
    let mut observer = EachSample(|t, x: &[f64], _: &[bool]| {
        let half = &mut worst[usize::from(t > 0.5 * t_end)];
        for (worst, (now, from)) in half.iter_mut().zip(invariants(values(x)).iter().zip(&from)) {
            *worst = worst.max((now / from - 1.0).abs());
        }
    });
    let settings = Settings { samples: Samples::Steps, ..settings(1e-10) };
    integrate(system, &mut method, &start, Span { t0: 0.0, t_end }, &settings, &mut observer).unwrap();
    worst
}

#[test]
fn the_oscillators_energy_stays_to_rounding() {
    let rate: Rate<2, 0> = |_, x, _| [x[1], -4.0 * x[0]];
    let energy = |x: &SVector<f64, 2>| [4.0 * x[0] * x[0] + x[1] * x[1]];
    let [_, [change]] = changes(&smooth(rate), Gauss6::new(0.1), [1.0, 0.5], 1e4, energy);
    assert!(change < 2e-13, "{change}");
    let [_, [lost]] = changes(&smooth(rate), Rk4::new(0.1), [1.0, 0.5], 1e4, energy);
    assert!(lost > 1e-2, "{lost}");
}

#[test]
fn a_fixed_gauss_step_does_not_look_at_the_tolerances() {
    let end = |tolerance: f64| {
        let (finish, _) = run(&kepler(), Gauss6::new(0.05), [0.4, 0.0, 0.0, 2.0], 20.0, &settings(tolerance));
        finish.x
    };
    assert_eq!(end(1.0), end(1e-4));
    assert_eq!(end(1e-12), end(1e-4));
}

/// The end of 1000 revolutions about the sun.
const REVOLUTIONS: f64 = 2000.0 * std::f64::consts::PI;

/// The changes of energy and angular momentum over 1000 revolutions with eccentricity 0.6 (Hairer, Lubich, Wanner,
/// section I.2.3).
fn keplers_changes(method: impl Method) -> [[f64; 2]; 2] {
    let invariants = |x: &SVector<f64, 4>| {
        let energy = 0.5 * (x[2] * x[2] + x[3] * x[3]) - 1.0 / x[0].hypot(x[1]);
        [energy, x[0] * x[3] - x[1] * x[2]]
    };
    changes(&kepler(), method, [0.4, 0.0, 0.0, 2.0], REVOLUTIONS, invariants)
}

#[test]
fn keplers_energy_stays_bounded_and_its_angular_momentum_to_rounding() {
    let [first, second] = keplers_changes(Gauss6::new(REVOLUTIONS / 1e5));
    assert!(
        second[0] < 1.001 * first[0] && first[0] < 1e-6,
        "the energy swings and does not drift: {first:?} {second:?}"
    );
    assert!(second[1] < 5e-13, "{second:?}");
}

#[test]
fn keplers_energy_drifts_by_a_dissipative_method() {
    let [first, second] = keplers_changes(Radau5::new());
    assert!(second[0] > 1.5 * first[0], "{first:?} {second:?}");
}

#[test]
fn a_free_bodys_energy_and_angular_momentum_stay_to_rounding() {
    // Euler's equations in the body's axes, moments of inertia 1, 2 and 3; both invariants are quadratic.
    let rate: Rate<3, 0> = |_, l, _| {
        let omega = [l[0], l[1] / 2.0, l[2] / 3.0];
        let torque = Vector3::new(l[0], l[1], l[2]).cross(&Vector3::from(omega));
        [torque[0], torque[1], torque[2]]
    };
    let invariants =
        |l: &SVector<f64, 3>| [0.5 * (l[0] * l[0] + l[1] * l[1] / 2.0 + l[2] * l[2] / 3.0), l.norm_squared()];
    // Near the unstable middle axis: it tumbles.
    let [_, changes] = changes(&smooth(rate), Gauss6::new(0.1), [0.01, 1.0, 0.02], 1e4, invariants);
    assert!(changes.iter().all(|change| *change < 2e-13), "{changes:?}");
}

#[test]
fn steps_by_the_error_keep_quadratic_invariants_too() {
    let momentum = |x: &SVector<f64, 4>| [x[0] * x[3] - x[1] * x[2]];
    let [_, [change]] = changes(&kepler(), Gauss6::adaptive(), [0.4, 0.0, 0.0, 2.0], 600.0, momentum);
    assert!(change < 2e-13, "{change}");
}
