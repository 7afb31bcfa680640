//! Every parameter of the paper's case at 1e-12, at 1e12 and at the ends of its range, one at a time: a right answer or
//! a named error.
//!
//! In: the length of a run and a limit of steps. Out: for each parameter and value the result. An answer is right where
//! the default at a relative tolerance of 1e-6 agrees with Radau IIA 5 at 1e-8, and where the energies balance, both to
//! [`AGREEMENT`]. An answer that only one of the two gives counts by its energy balance, and is marked so.

use bg_model::parameters::Parameters;
use hacksaw::mechanism::PaperParameters;

use super::machine::{Scale, planar_names, try_planar};
use super::request;
use crate::hardcases::case::larger;
use crate::hardcases::integrator;

/// The allowed difference of poses over the larger of 1 and the pose, and imbalance over the energies.
pub const AGREEMENT: f64 = 1e-4;

/// What came of a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Two integrators agree and the energies balance.
    Right,
    /// The energies balance; the check did not come to its end, for this reason.
    Unchecked(String),
    /// The run, or the assembly, says why not.
    Refused(String),
    /// An answer that does not hold, and no error.
    Wrong,
}

/// A parameter at an extreme.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The parameter.
    pub name: &'static str,
    /// Its value in its SI unit.
    pub value: f64,
    /// The result.
    pub answer: Answer,
    /// The largest difference of a pose between the two integrators, over the larger of 1 and the pose.
    pub difference: f64,
    /// |stored - supplied + dissipated| over the sum of the energies.
    pub imbalance: f64,
    /// Attempted steps of the default.
    pub attempts: u64,
}

/// All parameters at all these values, up to `end` (s) within `limit` attempted steps.
#[must_use]
pub fn extremes(end: f64, limit: u64, mut progress: impl FnMut(&str)) -> Vec<Extreme> {
    let mut found = Vec::new();
    for info in PaperParameters::table() {
        progress(info.name);
        let ends = [info.range.lower, info.range.upper];
        let values = [1e-12, 1e12].into_iter().chain(ends).filter(|value| value.is_finite());
        found.extend(values.map(|value| extreme(info.name, value, end, limit)));
    }
    found
}

/// One parameter at `value`.
#[must_use]
pub fn extreme(name: &'static str, value: f64, end: f64, limit: u64) -> Extreme {
    let nothing =
        Extreme { name, value, answer: Answer::Wrong, difference: f64::NAN, imbalance: f64::NAN, attempts: 0 };
    let problem = match try_planar(&[(name, value)], Scale::Present) {
        Ok(problem) => problem,
        Err(fault) => return Extreme { answer: Answer::Refused(fault), ..nothing },
    };
    let instants = [end];
    let run = |by: &str, tolerance: f64, limit: u64| problem.run(integrator(by), &request(tolerance, &instants, limit));
    let of = run("auto", 1e-6, limit);
    let attempts = of.statistics.steps + of.statistics.rejected;
    if let Some(cause) = of.failure {
        return Extreme { answer: Answer::Refused(cause.to_string()), attempts, ..nothing };
    }
    let check = run("radau5", 1e-8, 4 * limit);
    let row = &of.rows[0];
    let imbalance = imbalance(row);
    let difference = check.rows.first().map_or(f64::NAN, |check| difference(row, check));
    let answer = match check.failure {
        _ if imbalance.is_nan() || imbalance > AGREEMENT => Answer::Wrong,
        Some(cause) => Answer::Unchecked(cause.to_string()),
        None if difference <= AGREEMENT => Answer::Right,
        None => Answer::Wrong,
    };
    Extreme { answer, difference, imbalance, attempts, ..nothing }
}

fn imbalance(row: &[f64]) -> f64 {
    row[planar_names().len()].abs()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let poses = a.iter().zip(b).take(planar_names().len());
    poses.map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).fold(0.0, larger)
}
