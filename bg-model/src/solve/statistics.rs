//! Statistics: what a run has cost.

use core::fmt;

/// Counts of a run.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Attempts that were rejected: by the error estimate, or because a number was not finite.
    pub rejected: u64,
    /// Accepted steps of explicit methods in which rounding of the states may make a larger error estimate than the
    /// tolerances allow, by a look at every 64th step where the relative tolerance is at most 1e-10. A looser tolerance
    /// gives as good a result.
    pub rounded: u64,
    /// Evaluations of the rate, but for those of Jacobians by differences.
    pub rate_evaluations: u64,
    /// Those of `rate_evaluations` that served the dense output only.
    pub dense_evaluations: u64,
    /// Evaluations of the Jacobian. The `N` + 2 rates of one by differences are not among the `rate_evaluations`.
    pub jacobian_evaluations: u64,
    /// Factorisations of I - c J, real and complex ones alike.
    pub factorisations: u64,
    /// Those of `factorisations` that were made with row exchanges because a pivot in the planned order was too small.
    pub pivoted_factorisations: u64,
    /// Orders of Taylor series, each of which costs two to five rates.
    pub series_orders: u64,
    /// Evaluations of the guards, each of all guards at once, and of the condition that ends the run.
    pub guard_evaluations: u64,
    /// Changes of a switch's branch after the start.
    pub events: u64,
    /// The smallest accepted step, s, those shortened to an event or to the end included; 0 before the first step.
    pub smallest_step: f64,
    /// The largest accepted step, s.
    pub largest_step: f64,
}

impl Statistics {
    /// Whether the tolerances were below rounding in more than a tenth of the steps.
    #[must_use]
    pub fn is_at_rounding(&self) -> bool {
        10 * self.rounded > self.steps
    }

    /// Adds what another part of a run has cost.
    pub fn add(&mut self, more: &Self) {
        self.smallest_step = match (self.steps, more.steps) {
            (_, 0) => self.smallest_step,
            (0, _) => more.smallest_step,
            _ => self.smallest_step.min(more.smallest_step),
        };
        self.largest_step = self.largest_step.max(more.largest_step);
        self.steps += more.steps;
        self.rejected += more.rejected;
        self.rounded += more.rounded;
        self.rate_evaluations += more.rate_evaluations;
        self.dense_evaluations += more.dense_evaluations;
        self.jacobian_evaluations += more.jacobian_evaluations;
        self.factorisations += more.factorisations;
        self.pivoted_factorisations += more.pivoted_factorisations;
        self.series_orders += more.series_orders;
        self.guard_evaluations += more.guard_evaluations;
        self.events += more.events;
    }

    /// Records an accepted step of size `h` (s).
    pub(crate) fn record(&mut self, h: f64) {
        self.smallest_step = if self.steps == 0 { h } else { self.smallest_step.min(h) };
        self.largest_step = self.largest_step.max(h);
        self.steps += 1;
    }
}

impl fmt::Display for Statistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} steps ({:.3e} to {:.3e} s), {} rejected, {} rates ({} for dense output), {} guards, {} events",
            self.steps,
            self.smallest_step,
            self.largest_step,
            self.rejected,
            self.rate_evaluations,
            self.dense_evaluations,
            self.guard_evaluations,
            self.events
        )?;
        if self.rounded > 0 {
            write!(f, ", {} steps with tolerances below rounding", self.rounded)?;
        }
        if self.factorisations > 0 {
            let (jacobians, factorisations) = (self.jacobian_evaluations, self.factorisations);
            write!(
                f,
                ", {jacobians} Jacobians, {factorisations} factorisations ({} pivoted)",
                self.pivoted_factorisations
            )?;
        }
        if self.series_orders > 0 {
            write!(f, ", {} orders of Taylor series", self.series_orders)?;
        }
        Ok(())
    }
}
