//! The exact counts of a run.
//!
//! In: the statistics of a run. Out: its counts as a file has them, and those that differ between two runs.

use bg_model::statistics::Statistics;
use serde::{Deserialize, Serialize};

/// The counts of a run, as [`Statistics`] has them. They are the same on every machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counts {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Steps with tolerances below rounding.
    pub rounded: u64,
    /// Evaluations of the rate.
    pub rate_evaluations: u64,
    /// Those of them that served the dense output.
    pub dense_evaluations: u64,
    /// Evaluations of the Jacobian.
    pub jacobian_evaluations: u64,
    /// Factorisations of I - c J.
    pub factorisations: u64,
    /// Those of them with row exchanges.
    pub pivoted_factorisations: u64,
    /// Orders of Taylor series.
    pub series_orders: u64,
    /// Evaluations of the guards.
    pub guard_evaluations: u64,
    /// Events.
    pub events: u64,
}

impl From<&Statistics> for Counts {
    fn from(of: &Statistics) -> Self {
        Self {
            steps: of.steps,
            rejected: of.rejected,
            rounded: of.rounded,
            rate_evaluations: of.rate_evaluations,
            dense_evaluations: of.dense_evaluations,
            jacobian_evaluations: of.jacobian_evaluations,
            factorisations: of.factorisations,
            pivoted_factorisations: of.pivoted_factorisations,
            series_orders: of.series_orders,
            guard_evaluations: of.guard_evaluations,
            events: of.events,
        }
    }
}

impl Counts {
    /// What is counted, in words, and how many.
    #[must_use]
    pub const fn named(&self) -> [(&'static str, u64); 11] {
        [
            ("steps", self.steps),
            ("rejected steps", self.rejected),
            ("steps below rounding", self.rounded),
            ("rates", self.rate_evaluations),
            ("rates for dense output", self.dense_evaluations),
            ("Jacobians", self.jacobian_evaluations),
            ("factorisations", self.factorisations),
            ("pivoted factorisations", self.pivoted_factorisations),
            ("orders of Taylor series", self.series_orders),
            ("guard evaluations", self.guard_evaluations),
            ("events", self.events),
        ]
    }
}
