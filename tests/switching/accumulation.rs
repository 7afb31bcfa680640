//! Events without end: each of these runs stops with a named error close to where they accumulate.

use bg_model::failure::Cause;
use bg_model::nalgebra::SVector;
use bg_model::system::System;
use bond_graph_tests::switching::balls::{balls, bounces, bouncing_ball};
use bond_graph_tests::switching::case::{Request, Run, started};
use bond_graph_tests::switching::flow::Flow;
use bond_graph_tests::switching::mechanisms::{DrySliderParameters, slider};

use super::by_all;

/// The run has stopped because of `switch` within `near` of the time `t`, s, and has not taken long for it.
fn accumulates(name: &str, run: &Run, t: f64, near: f64) {
    let Some(Cause::EventsAccumulate { t: found, .. }) = run.failure else {
        panic!("{name}: {:?} at {}", run.failure, run.t)
    };
    assert_eq!(found, run.t, "{name}");
    assert!((found - t).abs() < near, "{name}: {found} for {t}");
    // A thousand at one instant, of each switch, end a run.
    assert!(run.statistics.steps < 2000 && run.events.len() < 2100, "{name}: {}", run.statistics);
}

#[test]
fn a_bouncing_ball_stops_with_an_error_where_it_comes_to_rest() {
    for zeno in balls() {
        by_all(&*zeno.problem, &Request { span: [0.0, 5.0], ..Request::default() }, |name, run| {
            accumulates(&format!("{} by {name}", zeno.name), run, zeno.end, 1e-5);
        });
    }
}

#[test]
fn its_bounces_are_right_up_to_the_last_ones() {
    let ball = bouncing_ball();
    by_all(&*ball.problem, &Request { span: [0.0, 2.999], ..Request::default() }, |name, run| {
        assert_eq!(run.failure, None, "{name}");
        let exact: Vec<f64> = bounces(40).into_iter().take_while(|t| *t < 2.999).collect();
        assert_eq!(run.events.len(), exact.len(), "{name}");
        let error = run.times().iter().zip(&exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
        // Rounding errors of the height over the speed of the last bounce, 2 mm/s.
        assert!(error < 1e-11, "{name}: {error:e}");
    });
}

#[test]
fn a_slider_that_sticks_stops_with_an_error_where_it_sticks() {
    // The last half turn ends at 0.02 m, where the spring no longer overcomes 0.03 N.
    let problem = slider(DrySliderParameters::default());
    by_all(&*problem, &Request { span: [0.0, 100.0], fixed_step: 0.05, ..Request::default() }, |name, run| {
        let near = if name == "ros2" { 1e-2 } else { 1e-5 };
        accumulates(name, run, 17.0 * std::f64::consts::PI, near);
    });
    // Stuck from the start.
    let problem = slider(DrySliderParameters { stretch: 0.02, ..DrySliderParameters::default() });
    by_all(&*problem, &Request { span: [0.0, 100.0], fixed_step: 0.05, ..Request::default() }, |name, run| {
        accumulates(name, run, 0.0, 1e-6);
    });
}

#[test]
fn a_slow_slide_is_no_hang() {
    // x falls by 0.999 within 1 s, then slowly to zero, where it slides: the rounding errors of its guard are large
    // beside what it does there in a millionth of a millionth of the run.
    for slope in [1.0, 1e-4, 1e-8] {
        let rate = move |_: f64, _: &[f64; 1], negative: &[bool; 2]| match negative {
            [_, false] => [-0.999],
            [false, true] => [-slope],
            [true, true] => [slope],
        };
        let problem = started(Flow::new(["x"], [|_, x| x[0], |t, _| 1.0 - t], rate), [1.0]);
        let end = 1.0 + 1e-3 / slope;
        let request = Request { span: [0.0, 2.0 * end], fixed_step: 0.01 * end, ..Request::default() };
        by_all(&*problem, &request, |name, run| accumulates(name, run, end, 1e-9 * end));
    }
}

/// From t = 1/2 on, the first switch takes the branch opposite to that of the second, which follows it.
struct Pair;

impl System<f64, 1, 2> for Pair {
    fn rate(&self, _: f64, _: &SVector<f64, 1>, _: &[bool; 2], dx: &mut SVector<f64, 1>) {
        dx[0] = 1.0;
    }

    fn guards(&self, t: f64, _: &SVector<f64, 1>, negative: &[bool; 2], guards: &mut SVector<f64, 2>) {
        let first = t > 0.5 && !negative[1];
        *guards = SVector::from([first, negative[0]].map(|negative| if negative { -1.0 } else { 1.0 }));
    }
}

#[test]
fn two_switches_that_push_each_other_are_no_hang() {
    let problem = started(Pair, [0.0]);
    by_all(&*problem, &Request::default(), |name, run| accumulates(name, run, 0.5, 1e-10));
}
