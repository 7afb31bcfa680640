//! Switching: what every integrator makes of events whose times are known.
//!
//! The problems are in `cases`. Five things are held: event times follow the tolerance, or the order of a fixed-step
//! method, down to rounding; several events in one step are all found and in order; a graze leaves no wrong branch;
//! events at the start, at the end and at samples are no special case; events without end give an error and no hang.

mod accumulation;
mod ends;
mod grazes;
mod steps;
mod times;

use bond_graph_tests::hardcases::integrators_of_rates;
use bond_graph_tests::switching::case::{Request, Run, Switched, started};
use bond_graph_tests::switching::flow::{Flow, Guard};

/// A rounding error of sums of values of size 1; the weights of DOP853 go up to 30.
const ROUNDING: f64 = 1e-14;

/// A clock x with x(0) = 0 and x' = 1, or `rate` of the branches, watched by `guards`.
fn clock<const G: usize>(guards: [Guard; G], rate: fn(&[bool; G]) -> f64) -> Box<dyn Switched> {
    started(Flow::new(["clock"], guards, move |_, _, negative| [rate(negative)]), [0.0])
}

/// A run from 0 to `end` (s) that is one step for every integrator if no event is in its way.
fn one_step(end: f64) -> Request {
    Request { span: [0.0, end], tolerance: 1e-6, fixed_step: end, first_step: Some(end), ..Request::default() }
}

/// Runs `problem` by every integrator and hands each run with the integrator's name to `check`.
fn by_all(problem: &dyn Switched, request: &Request, mut check: impl FnMut(&str, &Run)) {
    for integrator in integrators_of_rates() {
        check(integrator.name(), &problem.run(integrator, request));
    }
}

/// The run has come to its end with events of these switches at these times, s.
fn has_events(name: &str, run: &Run, expected: &[(usize, f64)]) {
    assert_eq!(run.failure, None, "{name}");
    let switches: Vec<usize> = run.events.iter().map(|event| event.switch).collect();
    assert_eq!(switches, expected.iter().map(|(switch, _)| *switch).collect::<Vec<_>>(), "{name}: {:?}", run.events);
    for (event, (_, t)) in run.events.iter().zip(expected) {
        assert!((event.t - t).abs() < ROUNDING, "{name}: {} for {t}", event.t);
    }
}
