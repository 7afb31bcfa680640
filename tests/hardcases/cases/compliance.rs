//! Compliant joints against a rigid reference, through the 1/k law.
//!
//! In: a mechanism with joints of stiffness k, 2 k and 4 k, damped so well that their ringing is over. Out: the limit
//! of infinite stiffness by Richardson's extrapolation, as a problem like any other, and the law itself. What a
//! mechanism with compliant joints lacks of the rigid one is a series in 1/k: (y(k) - 6 y(2 k) + 8 y(4 k)) / 3 leaves
//! its third power.

use bg_model::integrator::Integrator;
use bg_model::statistics::Statistics;

use super::case::{Case, larger};
use super::problem::{Problem, Request, Run};

/// The same mechanism with stiffness k, 2 k and 4 k.
pub struct Extrapolated(pub [Box<dyn Problem>; 3]);

impl Problem for Extrapolated {
    fn states(&self) -> usize {
        self.0[0].states()
    }

    /// The runs one after the other; the counts are the sums.
    fn run(&self, integrator: Integrator, request: &Request) -> Run {
        let mut statistics = Statistics::default();
        let mut rows = Vec::new();
        for problem in &self.0 {
            let run = problem.run(integrator, request);
            add(&mut statistics, &run.statistics);
            if run.failure.is_some() {
                return Run { rows: Vec::new(), statistics, failure: run.failure };
            }
            rows.push(run.rows);
        }
        let limit = |k: usize| {
            let [soft, firm, stiff] = [0, 1, 2].map(|stiffness| &rows[stiffness][k]);
            (0..soft.len()).map(|i| (soft[i] - 6.0 * firm[i] + 8.0 * stiff[i]) / 3.0).collect()
        };
        Run { rows: (0..rows[0].len()).map(limit).collect(), statistics, failure: None }
    }
}

fn add(sum: &mut Statistics, of: &Statistics) {
    sum.steps += of.steps;
    sum.rejected += of.rejected;
    sum.rate_evaluations += of.rate_evaluations;
    sum.series_orders += of.series_orders;
    sum.jacobian_evaluations += of.jacobian_evaluations;
    sum.factorisations += of.factorisations;
    sum.pivoted_factorisations += of.pivoted_factorisations;
}

/// How a compliant mechanism comes near the rigid one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// The errors against the rigid reference with stiffness k, 2 k and 4 k, in the case's measure.
    pub departures: [f64; 3],
    /// The error of the extrapolation.
    pub beyond: f64,
}

/// The law at the end of `case`, whose problem at stiffness k, 2 k, 4 k is `problems`.
///
/// # Panics
/// A run fails.
#[must_use]
pub fn law(case: &Case, problems: &Extrapolated, integrator: Integrator, tolerance: f64) -> Law {
    let request = Request {
        relative: tolerance,
        absolute: case.absolute * tolerance,
        fixed_step: case.fixed_step(tolerance),
        forced_step: None,
        instants: &case.instants,
        limit: 1_000_000,
    };
    let last = case.instants.len() - 1;
    let error = |problem: &dyn Problem| {
        let run = problem.run(integrator, &request);
        assert_eq!(run.failure, None, "{}", case.name);
        case.error(last, &run.rows[last])
    };
    let [soft, firm, stiff] = &problems.0;
    let departures = [error(&**soft), error(&**firm), error(&**stiff)];
    assert!(departures.iter().copied().fold(0.0, larger).is_finite());
    Law { departures, beyond: error(problems) }
}
