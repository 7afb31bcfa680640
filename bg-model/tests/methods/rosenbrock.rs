//! Rosenbrock methods: orders, stiff problems, dense output, cost.

use crate::problems::*;
use bg_model::integrator::{Method, Rodas5p, Ros2};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings};

/// The errors at t = 2 of x' = x cos t, x(0) = 1.
fn smooth_errors<M: Method>(method: impl Fn(f64) -> M, steps: &[f64]) -> Vec<f64> {
    let system = smooth(|t: f64, x: &SVector<f64, 1>, _: &[bool; 0]| [x[0] * libm::cos(t)]);
    let error = |step: &f64| {
        let (finish, _) = run(&system, method(*step), [1.0], 2.0, &fixed(*step));
        (finish.x[0] - libm::exp(libm::sin(2.0))).abs()
    };
    steps.iter().map(error).collect()
}

#[test]
fn both_have_their_order_with_time_in_the_rate() {
    let found = orders(&smooth_errors(|_| Rodas5p::new(), &[0.2, 0.1, 0.05]));
    assert!(found.iter().all(|order| (4.7..5.6).contains(order)), "{found:?}");
    let found = orders(&smooth_errors(Ros2::new, &[0.02, 0.01, 0.005]));
    assert!(found.iter().all(|order| (1.9..2.1).contains(order)), "{found:?}");
}

#[test]
fn both_have_their_order_on_a_nonlinear_system() {
    let turn = 2.0 * std::f64::consts::PI;
    let start = SVector::from([1.0, 0.0, 0.0, 1.0]);
    let errors =
        |run: &dyn Fn(f64) -> SVector<f64, 4>| [64.0, 128.0, 256.0].map(|parts| (run(turn / parts) - start).norm());
    let found = orders(&errors(&|step| *run(&kepler(), Rodas5p::new(), start, turn, &fixed(step)).0.state()));
    assert!(found.iter().all(|order| (4.7..5.6).contains(order)), "{found:?}");
    let found = orders(&errors(&|step| *run(&kepler(), Ros2::new(step), start, turn, &fixed(step)).0.state()));
    assert!(found.iter().all(|order| (2.0..2.3).contains(order)), "{found:?}");
}

/// The errors at t = 1 of Prothero and Robinson's x' = lambda (x - cos t) - sin t with lambda = -1e6: solution cos t.
fn prothero_robinson<M: Method>(method: impl Fn(f64) -> M, steps: &[f64]) -> Vec<f64> {
    let rate = |t: f64, x: &SVector<f64, 1>, _: &[bool; 0]| [-1e6 * (x[0] - libm::cos(t)) - libm::sin(t)];
    let error = |step: &f64| {
        let (finish, _) = run(&smooth(rate), method(*step), [1.0], 1.0, &fixed(*step));
        (finish.x[0] - 1.0_f64.cos()).abs()
    };
    steps.iter().map(error).collect()
}

#[test]
fn order_reduction_on_a_stiff_problem() {
    // Both keep what their conditions for stiff problems promise: order 3 of the 5, and the full order 2, whose error
    // is not divided by lambda, though.
    let errors = prothero_robinson(|_| Rodas5p::new(), &[0.1, 0.05, 0.025]);
    let found = orders(&errors);
    assert!(errors[0] < 5e-12 && found.iter().all(|order| (2.9..3.2).contains(order)), "{errors:?} {found:?}");
    let errors = prothero_robinson(Ros2::new, &[0.1, 0.05, 0.025]);
    let found = orders(&errors);
    assert!(errors[0] < 3e-3 && found.iter().all(|order| (1.9..2.2).contains(order)), "{errors:?} {found:?}");
}

#[test]
fn van_der_pol_at_t_2() {
    let mut before = f64::INFINITY;
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let (finish, _) = run(&van_der_pol(), Rodas5p::new(), VAN_DER_POL_START, 2.0, &settings(tolerance));
        let error = (finish.x - SVector::from(VAN_DER_POL_AT_2)).norm();
        assert!(error < 10.0 * tolerance && error < before, "{tolerance:e}: {error:e}");
        before = error;
    }
}

#[test]
fn the_dense_output_of_rodas5p_has_order_4() {
    let system = smooth(|_, x: &SVector<f64, 2>, _: &[bool; 0]| [x[1], -x[0]]);
    let errors = [0.4, 0.2, 0.1].map(|step: f64| {
        let settings = Settings { samples: Samples::Every(step / 32.0), ..fixed(step) };
        let (_, record) = run(&system, Rodas5p::new(), [0.6, 0.8], step, &settings);
        let exact = |t: f64| SVector::from([0.6 * t.cos() + 0.8 * t.sin(), 0.8 * t.cos() - 0.6 * t.sin()]);
        record.samples.iter().map(|(t, x, _)| (x - exact(*t)).norm()).fold(0.0, f64::max)
    });
    let found = orders(&errors);
    assert!(found.iter().all(|order| (4.7..5.3).contains(order)), "a step's error falls with the power 5: {found:?}");
}

#[test]
fn a_step_takes_one_jacobian_and_one_factorisation() {
    let (finish, _) = run(&kepler(), Ros2::new(0.01), [1.0, 0.0, 0.0, 1.0], 1.0, &fixed(0.01));
    let statistics = finish.statistics;
    assert_eq!((statistics.steps, statistics.jacobian_evaluations, statistics.factorisations), (100, 100, 100));
    assert_eq!(statistics.pivoted_factorisations, 0);
    // One inside the step, one at its end; one at the start.
    assert_eq!(statistics.rate_evaluations, 100 * 2 + 1);
}

#[test]
fn switching_instants_are_exact() {
    let (finish, record) = run(&bilinear(), Rodas5p::new(), [1.0, 0.0], 6.0, &settings(1e-9));
    let quarter = std::f64::consts::FRAC_PI_2;
    let exact = [quarter, 2.0 * quarter, 4.0 * quarter - 1e-300];
    assert_eq!(finish.statistics.events, 2, "{:?}", record.event_times());
    for (time, exact) in record.event_times().iter().zip(exact) {
        assert!((time - exact).abs() < 1e-8, "{time} {exact}");
    }
}
