//! Observed orders of the methods, with equal steps on a joint whose motion is known.
//!
//! In: an integrator and the joint. Out: the largest error of the velocity at the ends of the steps, for 10 to 320
//! steps in 1 s, and the orders that follow. On the stiff joint the order is what a method has left of its classical
//! one (order reduction, A. Prothero, A. Robinson 1974). It shows in the velocity: positions are divided by the
//! stiffness.

use bg_model::integrator::Integrator;

use super::case::larger;
use super::problem::{self, Request};
use super::singular::StiffJoint;

/// The numbers of steps.
pub const COUNTS: [u32; 6] = [10, 20, 40, 80, 160, 320];

/// Errors of the velocity with equal steps, one for each of [`COUNTS`]; not a number where the run failed.
#[must_use]
pub fn velocity_errors(joint: StiffJoint, integrator: Integrator) -> [f64; COUNTS.len()] {
    let problem = problem::states(joint, [0.0, 2.5, 1.0]);
    COUNTS.map(|count| {
        let step = 1.0 / f64::from(count);
        let instants: Vec<f64> = (1..=count).map(|k| f64::from(k) / f64::from(count)).collect();
        // Tolerances that accept every step make a method with error control one of equal steps.
        let request = Request {
            relative: 1.0,
            absolute: 1e30,
            fixed_step: step,
            forced_step: Some(step),
            instants: &instants,
            limit: 100_000,
        };
        let run = problem.run(integrator, &request);
        let is_whole = run.failure.is_none() && run.statistics.steps == u64::from(count);
        let error = |(t, row): (&f64, &Vec<f64>)| (row[1] - StiffJoint::exact(*t)[1]).abs();
        if is_whole { instants.iter().zip(&run.rows).map(error).fold(0.0, larger) } else { f64::NAN }
    })
}

/// The orders between neighbouring numbers of steps.
#[must_use]
pub fn orders(errors: [f64; COUNTS.len()]) -> [f64; COUNTS.len() - 1] {
    std::array::from_fn(|k| libm::log2(errors[k] / errors[k + 1]))
}

/// The order between 10 and 160 steps as a whole, which hangs less on a single error.
#[must_use]
pub fn mean_order(errors: [f64; COUNTS.len()]) -> f64 {
    libm::log2(errors[0] / errors[4]) / 4.0
}
