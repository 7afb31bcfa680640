//! Events against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::problems::*;
use bg_model::failure::{Cause, Quantity};
use bg_model::integrator::{Dop853, Rk4};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::system::System;

/// What the sums of a step of size 1 are off by rounding; the weights of DOP853 go up to 30.
const ROUNDING: f64 = 5e-15;

/// The crossing times of [`bilinear`] from (1, 0): a quarter of a turn, then halves of both turns in alternation.
fn crossings(t_end: f64) -> Vec<f64> {
    let halves = [FRAC_PI_2, PI].into_iter().cycle();
    let times = halves.scan(FRAC_PI_2, |t, half| Some(std::mem::replace(t, *t + half)));
    times.take_while(|t| *t < t_end).collect()
}

#[test]
fn switch_times_have_the_integrations_accuracy_and_guards_vanish_to_rounding() {
    let (finish, record) = run(&bilinear(), Dop853::new(), [1.0, 0.0], 30.0, &settings(1e-13));
    let exact = crossings(30.0);
    assert_eq!(record.events.len(), exact.len());
    assert_eq!(finish.statistics.events, exact.len() as u64);
    for ((t, x, switch, negative), exact) in record.events.iter().zip(&exact) {
        assert!((t - exact).abs() < 3e-13 * exact.max(1.0), "{t} {exact}");
        assert!(x[0].abs() <= 4.0 * f64::EPSILON, "{x}");
        assert_eq!((*switch, negative[0]), (0, x[1] < 0.0));
    }
}

#[test]
fn switch_times_follow_the_tolerance_and_not_the_interpolation() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (_, record) = run(&bilinear(), Dop853::new(), [1.0, 0.0], 30.0, &settings(tolerance));
        let exact = crossings(30.0);
        assert_eq!(record.events.len(), exact.len(), "{tolerance}");
        let error = record.event_times().iter().zip(&exact).map(|(t, exact)| (t - exact).abs()).fold(0.0, f64::max);
        assert!(error < 100.0 * tolerance, "{tolerance}: {error}");
        // Its steps are of size 1 at the loosest tolerance.
        assert!(record.events.iter().all(|(_, x, ..)| x[0].abs() <= ROUNDING));
    }
}

#[test]
fn rk4_keeps_its_order_over_events_and_its_grid() {
    let error = |step: f64| {
        let (finish, record) = run(&bilinear(), Rk4::new(step), [1.0, 0.0], 6.0, &settings(1.0));
        assert_eq!(record.events.len(), 2);
        let on_grid = |t: &&f64| ((*t / step).round() * step - *t).abs() < 1e-12;
        assert_eq!(record.steps.iter().filter(on_grid).count(), (6.0 / step).round() as usize);
        // From pi on, the solution is sin(t - pi).
        (finish.x - SVector::from([(6.0 - PI).sin(), (6.0 - PI).cos()])).norm()
    };
    let order = (error(0.05) / error(0.025)).log2();
    assert!((3.7..4.4).contains(&order), "{order}");
}

/// x' is 1, or 2 between x = 0.5 and x = 0.6.
#[test]
fn a_double_crossing_inside_one_step_is_found() {
    let system = switched([|_, x| (x[0] - 0.5) * (x[0] - 0.6)], |_, _: &SVector<f64, 1>, negative: &[bool; 1]| {
        [if negative[0] { 2.0 } else { 1.0 }]
    });
    let settings = Settings { first_step: Some(2.0), ..settings(1e-6) };
    let (finish, record) = run(&system, Dop853::new(), [0.0], 2.0, &settings);
    let times = record.event_times();
    assert_eq!(times.len(), 2);
    assert!((times[0] - 0.5).abs() < ROUNDING && (times[1] - 0.55).abs() < ROUNDING, "{times:?}");
    assert!((finish.x[0] - 2.05).abs() < ROUNDING);
    assert!(finish.statistics.steps <= 5, "{:?}", finish.statistics);
}

#[test]
fn of_two_switches_the_earlier_one_is_first_whatever_their_order() {
    type Guard = fn(f64, &[f64]) -> f64;
    let guards: [Guard; 2] = [|_, x| x[0] - 0.3, |_, x| 0.7 - x[0] * x[0]];
    for [first, second] in [[0, 1], [1, 0]] {
        let system = switched([guards[first], guards[second]], |_, _: &SVector<f64, 1>, _: &[bool; 2]| [1.0]);
        let settings = Settings { first_step: Some(3.0), ..settings(1e-6) };
        let (_, record) = run(&system, Dop853::new(), [0.0], 3.0, &settings);
        let found: Vec<(usize, bool)> = record.events.iter().map(|(_, _, k, negative)| (*k, negative[*k])).collect();
        assert_eq!(found, [(first, false), (second, true)]);
        let times = record.event_times();
        assert!((times[0] - 0.3).abs() < ROUNDING && (times[1] - 0.7_f64.sqrt()).abs() < ROUNDING, "{times:?}");
    }
}

/// Between 0.5 and 0.6 the first guard is negative, at 0.8 the second one changes, all in one step.
#[test]
fn a_dip_before_a_crossing_in_the_same_step_is_found_first() {
    type Guard = fn(f64, &[f64]) -> f64;
    let guards: [Guard; 2] = [|_, x| (x[0] - 0.5) * (x[0] - 0.6), |_, x| x[0] - 0.8];
    let system = switched(guards, |_, _: &SVector<f64, 1>, _: &[bool; 2]| [1.0]);
    let settings = Settings { first_step: Some(3.0), ..settings(1e-6) };
    let (_, record) = run(&system, Dop853::new(), [0.0], 3.0, &settings);
    let found: Vec<(usize, bool)> = record.events.iter().map(|(_, _, k, negative)| (*k, negative[*k])).collect();
    assert_eq!(found, [(0, true), (0, false), (1, false)]);
    let times = record.event_times();
    assert!(times.iter().zip([0.5, 0.6, 0.8]).all(|(t, exact)| (t - exact).abs() < ROUNDING), "{times:?}");
}

#[test]
fn simultaneous_switches_change_together() {
    let guards: [fn(f64, &[f64]) -> f64; 2] = [|_, x| x[0] - 0.5, |_, x| 3.0 * (0.5 - x[0])];
    let system = switched(guards, |_, _: &SVector<f64, 1>, _: &[bool; 2]| [1.0]);
    let (finish, record) = run(&system, Dop853::new(), [0.0], 1.0, &settings(1e-6));
    let times = record.event_times();
    assert!(times.len() == 2 && times[0] == times[1] && (times[0] - 0.5).abs() < ROUNDING, "{times:?}");
    assert_eq!(record.events[0].3, [false, true]);
    assert_eq!((finish.negative, finish.statistics.events), (vec![false, true], 2));
}

#[test]
fn a_guard_that_is_zero_at_the_start_is_decided_by_what_follows() {
    // The guard x with x' = slope + t curvature starts at zero.
    for (slope, curvature, negative) in
        [(1.0, 0.0, false), (-1.0, 0.0, true), (0.0, 1.0, false), (0.0, -1.0, true), (0.0, 0.0, false)]
    {
        let system = switched([|_, x| x[0]], move |t: f64, _: &SVector<f64, 1>, _: &[bool; 1]| [slope + t * curvature]);
        let (finish, record) = run(&system, Dop853::new(), [0.0], 1.0, &settings(1e-8));
        assert_eq!(record.samples[0].2, [negative], "{slope} {curvature}");
        assert_eq!((finish.negative, finish.statistics.events), (vec![negative], 0), "{slope} {curvature}");
    }
}

#[test]
fn a_zero_guard_at_the_start_asks_the_flow_of_its_branch() {
    // Pushed to the negative side in the negative branch and at rest in the other one: the positive branch holds.
    // Pushed to the negative side by both: the negative branch.
    for (positive_rate, negative) in [(0.0, false), (1.0, false), (-1.0, true)] {
        let system = switched([|_, x| x[0]], move |_, _: &SVector<f64, 1>, negative: &[bool; 1]| {
            [if negative[0] { -2.0 } else { positive_rate }]
        });
        let (finish, _) = run(&system, Dop853::new(), [0.0], 1.0, &settings(1e-8));
        assert_eq!(finish.negative, [negative], "{positive_rate}");
    }
}

#[test]
fn a_graze_neither_hangs_nor_leaves_a_wrong_branch() {
    // The guard 1 + depth - sin t touches zero or passes it narrowly; its branch has no influence on the rate.
    type Guard = fn(f64, &[f64]) -> f64;
    let depths: [(Guard, usize); 5] = [
        (|_, x| 1.0 + 1e-3 - x[0], 0),
        (|_, x| 1.0 + 1e-12 - x[0], 0),
        (|_, x| 1.0 - 1e-3 - x[0], 2),
        (|_, x| 1.0 - 1e-6 - x[0], 2),
        (|_, x| 1.0 - x[0], usize::MAX),
    ];
    for (index, (guard, expected)) in depths.into_iter().enumerate() {
        let system = switched([guard], |_, x: &SVector<f64, 2>, _: &[bool; 1]| [x[1], -x[0]]);
        let (finish, record) = run(&system, Dop853::new(), [0.0, 1.0], 3.0, &settings(1e-13));
        assert_eq!(finish.negative, [false], "case {index}");
        if expected == usize::MAX {
            assert!(record.events.len() <= 4 && record.events.len() % 2 == 0, "{:?}", record.events);
        } else {
            assert_eq!(record.events.len(), expected, "case {index}");
        }
    }
}

#[test]
fn an_event_at_the_end_of_the_run_is_no_obstacle() {
    for t_end in [FRAC_PI_2, FRAC_PI_2.next_up(), FRAC_PI_2.next_down(), FRAC_PI_2 + 1e-13, FRAC_PI_2 - 1e-13] {
        let (finish, record) = run(&bilinear(), Dop853::new(), [1.0, 0.0], t_end, &settings(1e-12));
        assert_eq!(finish.t, t_end);
        assert!((finish.x - SVector::from([0.0, -1.0])).norm() < 1e-11);
        assert!(record.events.len() <= 1 && record.samples.last().unwrap().0 == t_end);
    }
    let system = switched([|t, _| 1.0 - t], |_, _: &SVector<f64, 1>, _: &[bool; 1]| [1.0]);
    let (finish, _) = run(&system, Dop853::new(), [0.0], 1.0, &settings(1e-8));
    assert!(finish.t == 1.0 && (finish.x[0] - 1.0).abs() < ROUNDING);
}

#[test]
fn chatter_ends_with_the_switch_and_the_time() {
    let guards: [fn(f64, &[f64]) -> f64; 2] = [|_, _| 1.0, |_, x| x[0]];
    let system =
        switched(guards, |_, _: &SVector<f64, 1>, negative: &[bool; 2]| [if negative[1] { 1.0 } else { -1.0 }]);
    let span = Span { t0: 0.0, t_end: 3.0 };
    let start = SVector::from([1.25]);
    for failure in [
        integrate(&system, &mut Dop853::new(), &start, span, &settings(1e-8), &mut ()).unwrap_err(),
        integrate(&system, &mut Rk4::new(0.01), &start, span, &settings(1e-8), &mut ()).unwrap_err(),
    ] {
        let Cause::EventsAccumulate { switch, t, .. } = failure.cause else { panic!("{failure}") };
        assert_eq!(switch, 1);
        assert!((t - 1.25).abs() < 1e-12 && failure.last.t == t && failure.last.x[0].abs() < 1e-15, "{failure}");
        assert!(failure.to_string().contains("switch 1"), "{failure}");
    }
}

/// A mass on a spring, pushed and with friction that depends on the direction of the slip; it slips through.
#[test]
fn the_branch_agrees_with_the_guard_at_every_step_at_loose_tolerances() {
    let system = switched([|_, x| x[1]], |t: f64, x: &SVector<f64, 2>, negative: &[bool; 1]| {
        let resistance = if negative[0] { 3.0 } else { 0.3 };
        [x[1], 40.0 * libm::sin(3.1 * t) - 25.0 * x[0] - resistance * x[1]]
    });
    let (_, reference) = run(&system, Dop853::new(), [0.5, 0.0], 40.0, &settings(1e-12));
    assert!(reference.events.len() > 30);
    for tolerance in [1e-1, 1e-2, 1e-3, 1e-5] {
        let (_, record) = run(&system, Dop853::new(), [0.5, 0.0], 40.0, &settings(tolerance));
        for (t, x, negative) in &record.samples {
            assert!((x[1] < 0.0) == negative[0] || x[1].abs() < 1e-12, "{tolerance}: t = {t}, v = {}", x[1]);
        }
        if tolerance < 2e-3 {
            assert_eq!(record.events.len(), reference.events.len(), "{tolerance}");
        }
    }
}

#[test]
fn a_guard_that_jumps_with_time_is_found_at_the_jump() {
    let system = switched([|t, _| if t < 0.7 { 1.0 } else { -0.5 }], |_, _: &SVector<f64, 1>, negative: &[bool; 1]| {
        [if negative[0] { -1.0 } else { 1.0 }]
    });
    let (finish, record) = run(&system, Dop853::new(), [0.0], 1.0, &settings(1e-8));
    assert_eq!(record.events.len(), 1);
    assert!((record.events[0].0 - 0.7).abs() < 1e-15 && (finish.x[0] - 0.4).abs() < 1e-14, "{record:?}");
}

#[test]
fn samples_at_an_event_carry_the_branch_before_it() {
    let system = switched([|t, _| t - 0.5], |_, _: &SVector<f64, 1>, _: &[bool; 1]| [1.0]);
    let settings = Settings { samples: Samples::Every(0.25), ..settings(1e-8) };
    let (_, record) = run(&system, Dop853::new(), [0.0], 1.0, &settings);
    let branches: Vec<(f64, bool)> = record.samples.iter().map(|(t, _, negative)| (*t, negative[0])).collect();
    assert_eq!(branches, [(0.0, true), (0.25, true), (0.5, true), (0.75, false), (1.0, false)]);
}

/// A clock whose second guard is one of two constants, chosen by the first switch.
struct Pushed;

impl System<f64, 1, 2> for Pushed {
    fn rate(&self, _: f64, _: &SVector<f64, 1>, negative: &[bool; 2], dx: &mut SVector<f64, 1>) {
        dx[0] = if negative[1] { 2.0 } else { 1.0 };
    }
    fn guards(&self, t: f64, _: &SVector<f64, 1>, negative: &[bool; 2], guards: &mut SVector<f64, 2>) {
        *guards = SVector::from([t - 0.5, if negative[0] { 1.0 } else { -1.0 }]);
    }
}

#[test]
fn a_switch_that_another_one_pushes_over_follows_at_once() {
    let (finish, record) = run(&Pushed, Dop853::new(), [0.0], 1.0, &settings(1e-8));
    let events: Vec<_> = record.events.iter().map(|(_, _, k, negative)| (*k, *negative)).collect();
    assert_eq!(events, [(0, [false, true]), (1, [false, true])]);
    assert_eq!(record.samples[0].2, [true, false]);
    assert!((finish.x[0] - 1.5).abs() < ROUNDING);
}

#[test]
fn a_guard_that_is_no_number_ends_the_run_with_its_switch() {
    let guards: [fn(f64, &[f64]) -> f64; 2] = [|_, _| 1.0, |t, _| (0.5 - t).sqrt() + 1.0];
    let system = switched(guards, |_, _: &SVector<f64, 1>, _: &[bool; 2]| [1.0]);
    let span = Span { t0: 0.0, t_end: 1.0 };
    let failure =
        integrate(&system, &mut Rk4::new(0.125), &SVector::from([0.0]), span, &settings(1e-8), &mut ()).unwrap_err();
    let is_guard = matches!(failure.cause, Cause::NonFinite { quantity: Quantity::Guard, index: 1, .. });
    assert!(is_guard && failure.last.t <= 0.5, "{failure}");
}

/// Events at the zeros of guards that were a million million times as large before.
#[test]
fn a_guard_that_was_large_before_is_located_as_exactly_as_any() {
    type Guard = fn(f64, &[f64]) -> f64;
    fn large_before(t: f64) -> f64 {
        1e12 * libm::exp(-40.0 * t) + 1.0
    }
    let guards: [(Guard, &[f64]); 5] = [
        (|t, x| large_before(t) * (x[0] - 1.0), &[1.0]),
        // An event while it is large leaves a remainder that is large as well.
        (|t, x| large_before(t) * (x[0] - 0.01) * (x[0] - 1.0), &[0.01, 1.0]),
        (|t, x| large_before(t) * (x[0] - 0.0123) * (x[0] - 1.0) * (x[0] - 1.0005), &[0.0123, 1.0, 1.0005]),
        // A dip by 1e-6 between its zeros.
        (|t, x| large_before(t) * (x[0] - 1.0) * (x[0] - 1.002), &[1.0, 1.002]),
        // Large once in a while.
        (|t, x| (1e12 * libm::exp(-1e4 * (t - 0.5) * (t - 0.5)) + 1.0) * (x[0] - 1.25), &[1.25]),
    ];
    for (index, (guard, expected)) in guards.into_iter().enumerate() {
        let system = switched([guard], |_, _: &SVector<f64, 1>, _: &[bool; 1]| [1.0]);
        for (first_step, largest_step) in [(None, f64::INFINITY), (None, 0.02), (Some(0.3), 0.3)] {
            let settings = Settings { first_step, largest_step, ..settings(1e-8) };
            let (_, record) = run(&system, Dop853::new(), [0.0], 2.0, &settings);
            let times = record.event_times();
            assert_eq!(times.len(), expected.len(), "guard {index}, {largest_step}: {times:?}");
            for (t, exact) in times.iter().zip(expected) {
                assert!((t - exact).abs() < 2.0 * ROUNDING, "guard {index}, {largest_step}: {t} for {exact}");
            }
        }
    }
}

/// What a large guard leaves in the way of the branches after it: nothing.
#[test]
fn the_branch_after_a_guard_was_large_is_right_at_once() {
    // A mass between two springs, the guard's factor falls by twelve decades.
    let system =
        switched([|t, x| (1e12 * libm::exp(-3.0 * t) + 1.0) * x[0]], |_, x: &SVector<f64, 2>, negative: &[bool; 1]| {
            [x[1], if negative[0] { -4.0 * x[0] } else { -x[0] }]
        });
    let (_, record) = run(&system, Dop853::new(), [1.0, 0.0], 30.0, &settings(1e-12));
    let (_, plain) = run(&bilinear(), Dop853::new(), [1.0, 0.0], 30.0, &settings(1e-12));
    assert_eq!(record.events.len(), plain.events.len());
    for ((t, x, ..), (exact, ..)) in record.events.iter().zip(&plain.events) {
        assert!((t - exact).abs() < 1e-11 && x[0].abs() < 1e-14, "{t} for {exact}, {x}");
    }
}
