//! A hard case: what is run, what it is held against, and the result of a run.
//!
//! In: a case, an integrator and a tolerance. Out: the error reached, the counts and a verdict, whatever the number of
//! states. The error is taken at the end of the run, where a step ends; what the dense output gave at the instants
//! before it is kept apart.
//!
//! What counts as wrong: an error above [`WRONG`] times the tolerance, times the case's `amplification`, without a word
//! from the integrator. The amplification is how much the measure magnifies a relative disturbance of the state on the
//! way, a property of the equations: no method can do without it. It is 1 but for orbits, a strong ring and free
//! bodies.

use bg_model::failure::{BadInput, Cause};
use bg_model::integrator::Integrator;
use bg_model::statistics::Statistics;

use super::problem::{Problem, Request};

/// An error up to this multiple of the tolerance, times the amplification, is reached.
pub const REACHED: f64 = 100.0;
/// An error above this multiple of the tolerance, times the amplification, is wrong.
pub const WRONG: f64 = 1e3;

/// How an error is measured; the largest over the components counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Each component's deviation over the size of its reference.
    Relative,
    /// Each component's deviation over its largest reference, over all instants.
    Scaled,
    /// The deviation itself, in the component's unit.
    Absolute,
}

/// A case of published definition with its reference.
pub struct Case {
    /// The name, one word.
    pub name: &'static str,
    /// Where its definition and its numbers are published.
    pub source: &'static str,
    /// What the reference is.
    pub held_against: &'static str,
    /// How the error is measured.
    pub measure: Measure,
    /// The absolute tolerance over the relative one, in the unit of the smallest state.
    pub absolute: f64,
    /// How much the measure magnifies a relative disturbance of the state during the run, a power of ten.
    pub amplification: f64,
    /// The error below which the reference, or `f64` itself, says nothing.
    pub floor: f64,
    /// The instants of the reference, ascending; the run starts at 0 and ends with the last.
    pub instants: Vec<f64>,
    /// What is observed at each of them.
    pub reference: Vec<Vec<f64>>,
    /// The relative tolerance of the suite.
    pub moderate: f64,
    /// The integrators that are made for such a case, by name.
    pub fitting: &'static [&'static str],
    /// What is run.
    pub problem: Box<dyn Problem>,
}

/// How a run is judged.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The error is within [`REACHED`] times the tolerance, amplified, or below the floor.
    Reached,
    /// Not that, yet not [`Verdict::Wrong`] either.
    Missed,
    /// The error is above [`WRONG`] times the tolerance, amplified, and nothing was said.
    Wrong,
    /// [`REACHED`] times the tolerance, amplified, is no less than 1: the case cannot be judged at this tolerance.
    TooLoose,
    /// A fixed-step method came to the end: it has no tolerance to be held to.
    Unchecked,
    /// The limit of steps was reached.
    TooCostly,
    /// The integrator needs a Taylor series that the hand-written problem does not have.
    NoSeries,
    /// The run ended with this error.
    Failed(String),
}

impl Verdict {
    /// One word.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::Missed => "missed",
            Self::Wrong => "WRONG",
            Self::TooLoose => "too loose",
            Self::Unchecked => "unchecked",
            Self::TooCostly => "too costly",
            Self::NoSeries => "no series",
            Self::Failed(_) => "failed",
        }
    }
}

/// What came of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The error at the end; not a number where the end was not reached.
    pub error: f64,
    /// The largest error at the instants before the end, by dense output.
    pub between: f64,
    /// Whether that is above [`WRONG`] times the tolerance, amplified.
    pub is_wrong_between: bool,
    /// What it cost.
    pub statistics: Statistics,
    /// How it is judged.
    pub verdict: Verdict,
}

impl Case {
    /// The same case up to instant `t` at most.
    #[must_use]
    pub fn until(mut self, t: f64) -> Self {
        let count = self.instants.iter().filter(|instant| **instant <= t).count();
        self.instants.truncate(count);
        self.reference.truncate(count);
        self
    }

    /// The end of the span.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.instants.last().copied().unwrap_or(0.0)
    }

    /// The step of a fixed-step method that stands for the relative tolerance `tolerance`: 100 steps for a tolerance of
    /// 1, and so many more that a method of order 4 would follow.
    #[must_use]
    pub fn fixed_step(&self, tolerance: f64) -> f64 {
        self.end() / (100.0 * libm::pow(tolerance, -0.25)).round()
    }

    /// Runs the case with `integrator` at the relative tolerance `tolerance`, within `limit` attempted steps.
    #[must_use]
    pub fn run(&self, integrator: Integrator, tolerance: f64, limit: u64) -> Outcome {
        let request = Request {
            relative: tolerance,
            absolute: self.absolute * tolerance,
            fixed_step: self.fixed_step(tolerance),
            forced_step: None,
            instants: &self.instants,
            limit,
        };
        let run = self.problem.run(integrator, &request);
        let last = self.instants.len() - 1;
        let error = run.rows.get(last).map_or(f64::NAN, |row| self.error(last, row));
        let between = run.rows.iter().take(last).enumerate().map(|(k, row)| self.error(k, row)).fold(0.0, larger);
        let verdict = match &run.failure {
            None if integrator.has_fixed_step() => Verdict::Unchecked,
            None => self.judge(error, tolerance),
            Some(Cause::TooManySteps { .. }) => Verdict::TooCostly,
            Some(Cause::BadInput(BadInput::NoSeries { .. })) => Verdict::NoSeries,
            Some(cause) => Verdict::Failed(cause.to_string()),
        };
        let is_wrong_between = !integrator.has_fixed_step() && self.judge(between, tolerance) == Verdict::Wrong;
        Outcome { error, between, is_wrong_between, statistics: run.statistics, verdict }
    }

    /// The error of what was observed at instant `k`.
    #[must_use]
    pub fn error(&self, k: usize, row: &[f64]) -> f64 {
        assert_eq!(row.len(), self.reference[k].len(), "{}: as many components as the reference", self.name);
        let size = |i: usize| match self.measure {
            Measure::Relative => self.reference[k][i].abs(),
            Measure::Scaled => self.reference.iter().map(|row| row[i].abs()).fold(0.0, f64::max),
            Measure::Absolute => 1.0,
        };
        row.iter().zip(&self.reference[k]).enumerate().map(|(i, (a, b))| (a - b).abs() / size(i)).fold(0.0, larger)
    }

    fn judge(&self, error: f64, tolerance: f64) -> Verdict {
        let times = |factor: f64| (factor * self.amplification * tolerance).max(self.floor);
        match error {
            _ if times(REACHED) >= 1.0 => Verdict::TooLoose,
            error if error <= times(REACHED) => Verdict::Reached,
            error if error <= times(WRONG) => Verdict::Missed,
            _ => Verdict::Wrong,
        }
    }
}

/// The larger of two, of which not-a-number is the largest.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
