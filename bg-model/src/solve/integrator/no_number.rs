//! A rate that is no number is seen, whichever state's it is and whenever it is asked for.
//!
//! In: each method, a smooth system one of whose rates is no number in one evaluation. Out: no step that goes on with
//! another state than without that.

use core::cell::Cell;

use super::{Flow, Integrator, Method, PointRef, Scale, Tolerances, is_finite};
use crate::model::dynamics::Dynamics;
use crate::solve::statistics::Statistics;

/// More than two vectors, and some beside them.
const STATES: usize = 19;
const STEP: f64 = 0.05;

/// States that relax, driven in time, with one evaluation in which one rate is no number.
struct Faulty {
    evaluations: Cell<usize>,
    at: Option<(usize, usize)>,
}

impl Dynamics for Faulty {
    fn states(&self) -> usize {
        STATES
    }

    fn rate(&self, t: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        for (k, (dx, x)) in dx.iter_mut().zip(x).enumerate() {
            *dx = libm::sin(t + 0.1 * k as f64) - x;
        }
        let evaluation = self.evaluations.replace(self.evaluations.get() + 1);
        if let Some((_, state)) = self.at.filter(|at| at.0 == evaluation) {
            dx[state] = f64::NAN;
        }
    }
}

/// A step: its end where it satisfies the tolerances with finite numbers, and how many rates it has taken.
type Step = (Option<[f64; STATES]>, usize);

fn attempt(integrator: Integrator, at: Option<(usize, usize)>) -> Step {
    let system = Faulty { evaluations: Cell::new(0), at };
    let (mut statistics, mut method) = (Statistics::default(), integrator.method(STEP));
    let flow = Flow::new(&system, &[], &mut statistics);
    let (x, mut rate, mut end) = ([0.3; STATES], [0.0; STATES], [0.0; STATES]);
    Faulty { evaluations: Cell::new(0), at: None }.rate(0.0, &x, &[], &mut rate);
    method.fit(STATES);
    let start = PointRef { t: 0.0, x: &x, rate: &rate };
    let error = method.attempt(&flow, start, STEP, &Scale::new(&Tolerances::new(1e-3, 1e-3), STATES), &mut end);
    ((error <= 1.0 && is_finite(&end)).then_some(end), system.evaluations.get())
}

#[test]
fn a_rate_that_is_no_number_is_seen_in_every_state_and_evaluation() {
    for integrator in Integrator::ALL.into_iter().filter(|integrator| !integrator.needs_series()) {
        let (expected, evaluations) = attempt(integrator, None);
        assert!(expected.is_some() && evaluations > 2, "{integrator}: {evaluations} rates");
        for evaluation in 0..evaluations {
            for state in 0..STATES {
                let (end, taken) = attempt(integrator, Some((evaluation, state)));
                // What a derivative needs is asked for again at another distance; one by the time that a method has no
                // use for changes nothing.
                let is_seen = end.is_none() || taken > evaluations || end == expected;
                assert!(is_seen, "{integrator}: rate {state} in evaluation {evaluation} of {evaluations}");
            }
        }
    }
}
