//! The choice between an explicit and an implicit method.

mod problems;

use bg_model::integrator::{Auto, Dop853, Method, Radau9};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Finish, Span, integrate};
use problems::*;

/// A run to `t_end` (s) from t = 0, and when which method took over.
fn chosen<const N: usize>(
    system: &Flow<Rate<N, 0>, 0>,
    start: [f64; N],
    t_end: f64,
) -> (Finish<N, 0>, Vec<(f64, &'static str)>) {
    let mut method = Auto::<N>::new();
    let span = Span { t0: 0.0, t_end };
    let finish = integrate(system, &mut method, &SVector::from(start), span, &settings(1e-6), &mut ()).unwrap();
    (finish, method.changes().iter().map(|change| (change.t, change.method)).collect())
}

#[test]
fn an_orbit_is_left_to_the_explicit_method() {
    let (finish, changes) = chosen(&kepler(), kepler_start().data.0[0], 20.0);
    assert!(changes.is_empty(), "{changes:?}");
    let (alone, _) = run(&kepler(), Dop853::new(), kepler_start(), 20.0, &settings(1e-6));
    assert_eq!(finish.x, alone.x);
    assert_eq!(finish.statistics.steps, alone.statistics.steps);
    assert!(finish.statistics.factorisations > 0, "the implicit method was tried");
}

#[test]
fn a_stiff_equation_is_handed_over_and_its_fast_parts_are_taken_back() {
    let (finish, changes) = chosen(&van_der_pol(), VAN_DER_POL_START, 2.0);
    assert!((finish.x[0] - VAN_DER_POL_AT_2[0]).abs() < 1e-5, "{:?}", finish.x);
    assert_eq!(changes[0].1, "Radau IIA 9");
    assert!(changes[0].0 < 0.01, "{changes:?}");
    // An explicit method alone would need a step each 1e-6 s or so.
    assert!(finish.statistics.steps < 10_000, "{}", finish.statistics);
}

#[test]
fn a_slow_approach_to_rest_stays_with_the_implicit_method() {
    // A fast decay beside a slow one: at the end nothing moves and an explicit step may pass by luck.
    let rate: Rate<2, 0> = |_, x, _| [-1e6 * (x[0] - x[1]), -x[1]];
    let (finish, changes) = chosen(&smooth(rate), [1.0, 1.0], 30.0);
    let (alone, _) = run(&smooth(rate), Radau9::new(), [1.0, 1.0], 30.0, &settings(1e-6));
    assert!(finish.statistics.steps < 10 * alone.statistics.steps + 1000, "{} {changes:?}", finish.statistics);
}
