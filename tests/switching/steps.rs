//! Several events in what would be one step.

use std::f64::consts::PI;

use bond_graph_tests::hardcases::integrator;
use bond_graph_tests::switching::case::Request;
use bond_graph_tests::switching::flow::Guard;

use super::{by_all, clock, has_events, one_step};

#[test]
fn two_guards_at_different_times_are_met_in_order() {
    let (first, second) = (0.3, 0.7_f64.sqrt());
    let problem = clock([|_, x| 0.7 - x[0] * x[0], |_, x| x[0] - 0.3], |_| 1.0);
    by_all(&*problem, &one_step(3.0), |name, run| {
        has_events(name, run, &[(1, first), (0, second)]);
        assert!(run.statistics.steps <= 6, "{name}: {}", run.statistics);
    });
}

#[test]
fn two_guards_at_the_same_time_change_together() {
    // Of the state, of the time, of a square, all zero at 1/2.
    let problem = clock([|_, x| x[0] - 0.5, |t, _| 3.0 * (0.5 - t), |_, x| 0.25 - x[0] * x[0]], |_| 1.0);
    by_all(&*problem, &one_step(1.0), |name, run| {
        has_events(name, run, &[(0, 0.5), (1, 0.5), (2, 0.5)]);
        assert_eq!(run.negative, [false, true, true], "{name}");
        assert!(run.events.iter().all(|event| (event.t - run.events[0].t).abs() < 1e-15), "{name}: {:?}", run.events);
    });
}

#[test]
fn two_guards_that_are_hardly_apart_are_met_in_order() {
    let guards: [(f64, Guard); 4] = [
        (1e-3, |_, x| 0.5 + 1e-3 - x[0]),
        (1e-6, |_, x| 0.5 + 1e-6 - x[0]),
        (1e-9, |_, x| 0.5 + 1e-9 - x[0]),
        (1e-13, |_, x| 0.5 + 1e-13 - x[0]),
    ];
    for (apart, later) in guards {
        let problem = clock([later, |_, x| 0.5 - x[0]], |_| 1.0);
        by_all(&*problem, &one_step(1.0), |name, run| {
            has_events(name, run, &[(1, 0.5), (0, 0.5 + apart)]);
        });
    }
}

#[test]
fn one_guard_there_and_back_in_one_step_is_met_twice() {
    // Twice as fast between x = 0.5 and x = 0.6.
    let problem = clock([|_, x| (x[0] - 0.5) * (x[0] - 0.6)], |negative| if negative[0] { 2.0 } else { 1.0 });
    by_all(&*problem, &one_step(2.0), |name, run| {
        has_events(name, run, &[(0, 0.5), (0, 0.55)]);
        assert!((run.x[0] - 2.05).abs() < 1e-14, "{name}: {}", run.x[0]);
    });
}

#[test]
fn one_guard_is_met_as_often_as_it_crosses() {
    // Four crossings, two of them a fiftieth of the step apart.
    let guard = |_: f64, x: &[f64]| (x[0] - 0.2) * (x[0] - 0.22) * (x[0] - 0.6) * (x[0] - 0.9);
    let problem = clock([guard], |_| 1.0);
    by_all(&*problem, &one_step(1.0), |name, run| {
        has_events(name, run, &[(0, 0.2), (0, 0.22), (0, 0.6), (0, 0.9)]);
    });
}

/// A known limit: a guard that waves faster than the steps, which nothing in the rates makes shorter, is not seen. The
/// largest step must then be below a quarter of its period.
#[test]
fn a_wave_that_no_state_shows_needs_a_largest_step() {
    let rate = |negative: &[bool; 1]| if negative[0] { -1.0 } else { 1.0 };
    let problem = clock([|t, _| libm::sin(20.0 * t + 1.0)], rate);
    let half = PI / 20.0;
    let expected: Vec<(usize, f64)> = (0..19).map(|k| (0, half * f64::from(k + 1) - 0.05)).collect();
    let request = Request { span: [0.0, 3.0], fixed_step: half / 2.0, ..Request::default() };
    by_all(&*problem, &Request { largest_step: half / 2.0, ..request.clone() }, |name, run| {
        has_events(name, run, &expected);
    });
    by_all(&*problem, &request, |name, run| {
        let is_seen = integrator(name).has_fixed_step();
        assert_eq!(run.events.len() == expected.len(), is_seen, "{name}: {} events", run.events.len());
    });
}
