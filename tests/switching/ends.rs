//! Events at the start, at the end and at samples.

use std::f64::consts::FRAC_PI_2;

use super::{by_all, clock, one_step};
use bond_graph_tests::switching::case::{Request, started};
use bond_graph_tests::switching::flow::Flow;
use bond_graph_tests::switching::oscillators::bilinear;

#[test]
fn a_guard_that_is_zero_at_the_start_is_decided_by_what_follows() {
    // The guard x with x' = slope + t curvature.
    for (slope, curvature, negative) in
        [(1.0, 0.0, false), (-1.0, 0.0, true), (0.0, 1.0, false), (0.0, -1.0, true), (0.0, 0.0, false)]
    {
        let rate = move |t: f64, _: &[f64; 1], _: &[bool; 1]| [slope + t * curvature];
        let problem = started(Flow::new(["x"], [|_, x| x[0]], rate), [0.0]);
        by_all(&*problem, &Request { samples: vec![0.0, 1.0], ..Request::default() }, |name, run| {
            assert_eq!(run.failure, None, "{slope}, {curvature} by {name}");
            assert!(run.events.is_empty(), "{slope}, {curvature} by {name}: {:?}", run.events);
            assert_eq!(run.samples, [(0.0, vec![negative]), (1.0, vec![negative])], "{slope}, {curvature} by {name}");
        });
    }
}

#[test]
fn in_an_empty_span_a_guard_that_is_zero_has_a_branch() {
    for (t, rate, negative) in [(0.0, -1.0, true), (0.0, 1.0, false), (0.0, 0.0, false), (7.0, -1.0, true)] {
        let problem = started(Flow::new(["x"], [|_, x| x[0]], move |_, _: &[f64; 1], _| [rate]), [0.0]);
        by_all(&*problem, &Request { span: [t, t], samples: vec![t], ..Request::default() }, |name, run| {
            assert_eq!(run.failure, None, "{name}");
            assert_eq!(run.samples, [(t, vec![negative])], "{t} {rate} by {name}");
        });
    }
}

#[test]
fn an_event_at_the_end_is_an_event_or_none_and_the_state_is_right() {
    let problem = bilinear().problem;
    for end in [FRAC_PI_2, FRAC_PI_2.next_up(), FRAC_PI_2.next_down(), FRAC_PI_2 + 1e-13, FRAC_PI_2 - 1e-13] {
        let request = Request { span: [0.0, end], tolerance: 1e-12, samples: vec![end], ..Request::default() };
        by_all(&*problem, &request, |name, run| {
            assert!(run.failure.is_none() && run.t == end && run.events.len() <= 1, "{name}: {:?}", run.failure);
            assert_eq!(run.samples.len(), 1, "{name}");
            // ROS2 with a hundredth of a second a step is that wrong.
            let bound = if name == "ros2" { 1e-4 } else { 1e-9 };
            assert!(run.x[0].abs() < bound && (run.x[1] + 1.0).abs() < bound, "{name}: {:?}", run.x);
        });
    }
}

#[test]
fn an_event_just_before_the_end_is_told_and_one_at_the_end_is_not() {
    let problem = clock([|_, x| x[0] - 0.5], |_| 1.0);
    for (end, count) in [(0.5_f64.next_down(), 0), (0.5 + 1e-9, 1)] {
        by_all(&*problem, &one_step(end), |name, run| {
            assert!(run.failure.is_none() && run.t == end, "{name}: {:?}", run.failure);
            assert_eq!(run.events.len(), count, "{end} by {name}: {:?}", run.events);
        });
    }
    // At the instant itself the guard is zero and has not changed its sign: the run that goes on will.
    by_all(&*problem, &one_step(0.5), |name, run| {
        assert!(run.failure.is_none() && run.t == 0.5, "{name}: {:?}", run.failure);
        assert!(run.events.is_empty() && run.negative == [true], "{name}: {:?}", run.events);
    });
}

#[test]
fn a_run_that_goes_on_from_a_switching_instant_has_the_right_branch() {
    let problem = clock([|t, _| t - 0.5], |negative| if negative[0] { -1.0 } else { 1.0 });
    by_all(&*problem, &Request { span: [0.5, 1.0], samples: vec![0.5], ..Request::default() }, |name, run| {
        assert!(run.failure.is_none() && run.events.is_empty(), "{name}: {:?} {:?}", run.failure, run.events);
        assert_eq!(run.samples, [(0.5, vec![false])], "{name}");
        assert!((run.x[0] - 0.5).abs() < 1e-14, "{name}: {}", run.x[0]);
    });
}

#[test]
fn a_sample_at_an_event_comes_once_with_the_branch_before_it() {
    let problem = clock([|t, _| t - 0.5], |_| 1.0);
    let request = Request { samples: vec![0.25, 0.5, 0.75], ..one_step(1.0) };
    by_all(&*problem, &request, |name, run| {
        assert_eq!(run.samples, [(0.25, vec![true]), (0.5, vec![true]), (0.75, vec![false])], "{name}");
    });
}
