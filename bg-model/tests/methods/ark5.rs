//! The method that is implicit in the damped states alone: order, strong dampers, dense output, switches, cost.

use crate::problems::*;
use bg_model::integrator::{Ark5, Dop853, Radau9, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings};

/// Two masses of 1 kg and 2 kg with a damper of `r` (N s/m) between them, the first on a hardening spring that is
/// pulled to and fro: momenta, kg m/s, and displacements, m.
fn damped(r: f64) -> impl Fn(f64, &SVector<f64, 4>, &[bool; 0]) -> [f64; 4] {
    move |t, x, _| {
        let (v, w) = (x[0], 0.5 * x[1]);
        let damper = r * (v - w);
        let spring = 4.0 * x[2] * (1.0 + x[2] * x[2]) - (3.0 * t).sin();
        [-spring - damper, damper - x[3], v, w]
    }
}

const START: [f64; 4] = [0.5, 1.0, 0.2, -0.1];

/// Where the two masses are at t = 2 s, to rounding.
fn exact(r: f64) -> SVector<f64, 4> {
    *run(&smooth(damped(r)), Radau9::new(), START, 2.0, &settings(1e-13)).0.state()
}

#[test]
fn it_has_order_5_where_dampers_are_implicit_and_where_nothing_is() {
    // Without states that are damped stiffly it is an explicit method. With 80 N s/m the last step is too short for the
    // dampers to be implicit: nothing shows where that begins.
    let steps = [64.0, 128.0, 256.0, 512.0].map(|parts: f64| 2.0 / parts);
    for r in [0.0, 80.0] {
        let errors =
            steps.map(|step| (run(&smooth(damped(r)), Ark5::new(), START, 2.0, &fixed(step)).0.x - exact(r)).norm());
        let found = orders(&errors);
        assert!(found.iter().all(|order| (4.6..5.2).contains(order)), "{r}: {errors:?} {found:?}");
    }
}

#[test]
fn stronger_dampers_cost_no_more_steps() {
    let of = |r: f64, tolerance: f64| {
        let (finish, _) = run(&smooth(damped(r)), Ark5::new(), START, 2.0, &settings(tolerance));
        ((finish.x - exact(r)).norm(), finish.statistics.steps)
    };
    for tolerance in [1e-3, 1e-5, 1e-7] {
        let weak = of(10.0, tolerance).1;
        for r in [1e3, 1e5, 1e7, 1e9] {
            let (error, steps) = of(r, tolerance);
            assert!(error < 10.0 * tolerance, "{r:e} at {tolerance:e}: {error:e}");
            assert!(steps < 3 * weak, "{r:e} at {tolerance:e}: {steps} steps, {weak} with a weak damper");
        }
    }
    let (finish, _) = run(&smooth(damped(1e5)), Dop853::new(), START, 2.0, &settings(1e-3));
    assert!(finish.statistics.steps > 10_000, "an explicit method has to follow the damper");
}

#[test]
fn the_error_falls_with_the_tolerance_on_van_der_pol() {
    let mut before = f64::INFINITY;
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let (finish, _) = run(&van_der_pol(), Ark5::new(), VAN_DER_POL_START, 2.0, &settings(tolerance));
        let error = (finish.x - SVector::from(VAN_DER_POL_AT_2)).norm();
        assert!(error < 100.0 * tolerance && error < before, "{tolerance:e}: {error:e}");
        before = error;
    }
}

#[test]
fn looser_tolerances_than_a_thousandth_count_as_that() {
    let of = |tolerance: f64| {
        let tolerances = Tolerances::new(tolerance, 1e-4);
        let settings = Settings { tolerances, first_step: Some(1e-3), ..Settings::default() };
        run(&smooth(damped(1e5)), Ark5::new(), START, 2.0, &settings).0.x
    };
    assert_eq!(of(1e-1), of(1e-3));
    assert_ne!(of(1e-3), of(1e-4));
}

#[test]
fn a_strong_damper_may_turn() {
    // A mass of 1 kg in the plane on springs; the damper turns at 20 rad/s: momenta, then displacements.
    let turning = |t: f64, x: &SVector<f64, 4>, _: &[bool; 0]| {
        let (sine, cosine) = (20.0 * t).sin_cos();
        let damper = 1e6 * (cosine * x[0] + sine * x[1]);
        [-damper * cosine - 9e4 * x[2], -damper * sine - 9e4 * x[3], x[0], x[1]]
    };
    let start = [0.0, 1.0, 0.0, 0.0];
    let exact = run(&smooth(turning), Radau9::new(), start, 1.0, &settings(1e-12)).0.x;
    let (finish, _) = run(&smooth(turning), Ark5::new(), start, 1.0, &settings(1e-4));
    let statistics = finish.statistics;
    let error = (finish.x - exact).amax();
    assert!(error < 1e-2, "{error:e}");
    // Between two Jacobians the damper is followed: 5814 steps, 9 of them rejected. Kept as it was at the last one it
    // costs 6777 and 117.
    assert!(statistics.steps < 6000 && 200 * statistics.rejected < statistics.steps, "{statistics:?}");
}

#[test]
fn the_dense_output_has_order_4() {
    let system = smooth(damped(0.0));
    let errors = [0.4, 0.2, 0.1].map(|step: f64| {
        let settings = Settings { samples: Samples::Every(step / 16.0), ..fixed(step) };
        let (_, record) = run(&system, Ark5::new(), START, step, &settings);
        let (_, exact) = run(
            &system,
            Dop853::new(),
            START,
            step,
            &Settings { samples: settings.samples, ..crate::problems::settings(1e-13) },
        );
        record
            .samples
            .iter()
            .zip(&exact.samples)
            .map(|((_, x, _), (_, exact, _))| (x - exact).norm())
            .fold(0.0, f64::max)
    });
    let found = orders(&errors);
    assert!(found.iter().all(|order| (4.5..5.6).contains(order)), "a step's error falls with the power 5: {found:?}");
}

#[test]
fn switching_instants_are_exact() {
    let (_, record) = run(&bilinear(), Ark5::new(), [1.0, 0.0], 6.0, &settings(1e-9));
    let quarter = std::f64::consts::FRAC_PI_2;
    let times = record.event_times();
    assert!((times[0] - quarter).abs() < 1e-8, "{times:?}");
}

#[test]
fn a_jacobian_serves_eight_steps() {
    let (finish, _) = run(&smooth(damped(1e5)), Ark5::new(), START, 2.0, &fixed(1.0 / 64.0));
    let statistics = finish.statistics;
    assert_eq!((statistics.steps, statistics.jacobian_evaluations, statistics.factorisations), (128, 16, 0));
    // Seven inside each step, one at its end; one at the start.
    assert_eq!(statistics.rate_evaluations, 128 * 8 + 1);
}
