//! Guards that touch zero.

use super::{by_all, clock, one_step};
use bond_graph_tests::switching::case::{Request, started};
use bond_graph_tests::switching::flow::{Flow, Guard};

/// A valley with its bottom at 0.6, this much above zero.
fn valley(x: f64, height: f64) -> f64 {
    let square = (x - 0.6) * (x - 0.6);
    square * (1.0 + square) + height
}

/// Half the width of the valley at zero, if it is this deep.
fn half_width(depth: f64) -> f64 {
    (2.0 * depth / (1.0 + (1.0 + 4.0 * depth).sqrt())).sqrt()
}

const VALLEYS: [(f64, Guard); 8] = [
    (1e-3, |_, x| valley(x[0], 1e-3)),
    (1e-12, |_, x| valley(x[0], 1e-12)),
    (1e-17, |_, x| valley(x[0], 1e-17)),
    (0.0, |_, x| valley(x[0], 0.0)),
    (-1e-17, |_, x| valley(x[0], -1e-17)),
    (-1e-12, |_, x| valley(x[0], -1e-12)),
    (-1e-9, |_, x| valley(x[0], -1e-9)),
    (-1e-3, |_, x| valley(x[0], -1e-3)),
];
/// A dip that is shallower than this part of the guard's largest value, 0.5, may be taken for a touch: a state that is
/// wrong by as much has a dip or has none. What the branch would have done is then missing, here half the width of the
/// dip.
const SHALLOW: f64 = 1e-10;

#[test]
fn a_touch_leaves_the_branch_and_a_dip_is_met_twice() {
    for (height, guard) in VALLEYS {
        // Twice as fast below zero.
        let problem = clock([guard], |negative| if negative[0] { 2.0 } else { 1.0 });
        by_all(&*problem, &one_step(1.0), |name, run| {
            let (events, depth) = (run.events.len(), -height);
            assert_eq!((&run.failure, run.negative.as_slice()), (&None, &[false][..]), "{height:e} by {name}");
            assert_eq!(events % 2, 0, "{height:e} by {name}: {:?}", run.events);
            let gain = half_width(depth.max(0.0));
            let missing = if depth > 0.0 && depth < SHALLOW { gain } else { 0.0 };
            let error = (run.x[0] - 1.0 - gain).abs();
            // At the shallowest dip that is met the guard has a slope of 6e-5 1/s.
            assert!(error <= 1e-11 + 1.01 * missing, "{height:e} by {name}: {error:e}, {events} events");
            let is_expected = if depth > SHALLOW { events == 2 } else { events == 0 || depth.abs() < SHALLOW };
            assert!(is_expected && events <= 4, "{height:e} by {name}: {:?}", run.events);
        });
    }
}

#[test]
fn a_dip_that_begins_a_step_shortens_it() {
    // The crossing is met, and the one back is in the next step, of which it is the first millionth.
    let problem = clock([|_, x| (x[0] - 0.55) * (x[0] - 0.55) - 1e-12], |negative| if negative[0] { 2.0 } else { 1.0 });
    by_all(&*problem, &one_step(1.0), |name, run| {
        assert_eq!((&run.failure, run.negative.as_slice()), (&None, &[false][..]), "{name}");
        assert!(run.x[0] - 1.0 < 1.1e-6 && run.statistics.steps < 30, "{name}: {}, {}", run.x[0], run.statistics);
    });
}

#[test]
fn a_touch_from_below_leaves_the_branch() {
    let problem = clock([|_, x| -(x[0] - 0.5) * (x[0] - 0.5)], |_| 1.0);
    by_all(&*problem, &one_step(1.0), |name, run| {
        assert_eq!(run.failure, None, "{name}");
        assert!(run.negative == [true] && run.events.len() <= 4, "{name}: {:?}", run.events);
    });
}

#[test]
fn a_cube_passes_its_zero_once() {
    let problem = clock([|_, x| (0.5 - x[0]) * (0.5 - x[0]) * (0.5 - x[0])], |_| 1.0);
    by_all(&*problem, &one_step(1.0), |name, run| {
        assert_eq!(run.failure, None, "{name}");
        assert!(run.negative == [true] && run.events.len() == 1, "{name}: {:?}", run.events);
        // The cube is rounding within 2e-5 of its zero.
        assert!((run.events[0].t - 0.5).abs() < 2e-5, "{name}: {:?}", run.events);
    });
}

#[test]
fn an_oscillation_that_touches_every_turn_stays_in_its_branch() {
    for guard in [(|_, x| 1.0 + 1e-9 - x[0]) as Guard, |_, x| 1.0 - x[0]] {
        let rate = |_: f64, x: &[f64; 2], _: &[bool; 1]| [x[1], -x[0]];
        let problem = started(Flow::new(["x", "v"], [guard], rate), [0.0, 1.0]);
        let request = Request { span: [0.0, 60.0], tolerance: 1e-10, fixed_step: 0.05, ..Request::default() };
        by_all(&*problem, &request, |name, run| {
            assert_eq!(run.failure, None, "{name}");
            assert!(run.negative == [false] && run.events.len() <= 40, "{name}: {} events", run.events.len());
        });
    }
}
