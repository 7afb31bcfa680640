//! The solvers: what each offers to the comparison, one file for each source of them.

mod differential;
mod diffsol;
mod explicit;
pub mod ours;
pub mod python;

use std::time::Duration;

use clap::ValueEnum;
use serde::{Deserialize, Serialize};

use crate::poses::Poses;
use crate::problem::Problem;

/// Where solvers come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// The methods of bg-model on the generated scene `Paper`
    Ours,
    /// The methods of bg-model on the generated scene `Motion`, which integrates what the others do: no energies
    Motion,
    /// The methods of bg-model on the right-hand side written by hand
    ByHand,
    /// The crate diffsol
    Diffsol,
    /// The crate ode_solvers
    OdeSolvers,
    /// The crate differential-equations
    DifferentialEquations,
    /// heyoka, from Python
    Heyoka,
    /// CVODE of SUNDIALS, the library in the Python package scikit-sundae
    Cvode,
    /// CasADi, from Python
    Casadi,
}

/// A solver as a row of tables and a line of the diagram.
#[derive(Clone, Debug, Serialize)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Where it comes from.
    pub source: Source,
    /// Whether it locates the switches of the cutting law.
    pub locates_events: bool,
    /// What its settings mean.
    pub setting: Setting,
}

/// What the number means that a solver is run with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Setting {
    /// The relative tolerance.
    Tolerance,
    /// The step, s.
    Step,
}

/// What a run took and gave.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Time on the wall clock, of the integration with its samples.
    pub wall: Duration,
    /// The poses at the samples.
    pub poses: Poses,
    /// What it cost, as far as the solver counts it.
    pub work: Work,
    /// Time of compilation before the run, not part of `wall`, of solvers that compile the model themselves.
    pub compiled: Option<Duration>,
}

/// Counts of a run; nothing where the solver does not say.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
#[serde(default)]
pub struct Work {
    /// Accepted steps.
    pub steps: Option<u64>,
    /// Rejected steps.
    pub rejected: Option<u64>,
    /// Evaluations of the rate.
    pub rates: Option<u64>,
    /// Switches located.
    pub events: Option<u64>,
}

/// A solver that can be run.
pub trait Solver {
    /// What it is.
    fn line(&self) -> &Line;

    /// The settings to run it with, the coarsest first.
    fn settings(&self) -> &[f64];

    /// The run with one of its settings, or why it does not get to the end.
    fn run(&mut self, setting: f64) -> Result<Run, String>;
}

/// The solvers of `sources` that are part of this program.
pub fn in_rust<'a>(problem: &'a Problem, sources: &[Source]) -> Vec<Box<dyn Solver + 'a>> {
    let all = [ours::all(problem), diffsol::all(problem), explicit::all(problem), differential::all(problem)];
    all.into_iter().flatten().filter(|solver| sources.contains(&solver.line().source)).collect()
}

/// A solver made of a function of its setting.
struct Entry<F> {
    line: Line,
    settings: Vec<f64>,
    run: F,
}

impl<F: FnMut(f64) -> Result<Run, String>> Solver for Entry<F> {
    fn line(&self) -> &Line {
        &self.line
    }

    fn settings(&self) -> &[f64] {
        &self.settings
    }

    fn run(&mut self, setting: f64) -> Result<Run, String> {
        (self.run)(setting)
    }
}

/// The solver `name` with relative tolerances 10^-`exponents`.
fn by_tolerance<'a>(
    source: Source,
    name: &str,
    locates_events: bool,
    exponents: std::ops::RangeInclusive<i32>,
    run: impl FnMut(f64) -> Result<Run, String> + 'a,
) -> Box<dyn Solver + 'a> {
    let line = Line { name: name.to_owned(), source, locates_events, setting: Setting::Tolerance };
    // Three each decade, as precise as written.
    let texts = exponents.flat_map(|exponent| {
        [format!("1e-{exponent}"), format!("5e-{}", exponent + 1), format!("2e-{}", exponent + 1)]
    });
    let settings = texts.map(|text| text.parse().expect("a number")).collect();
    Box::new(Entry { line, settings, run })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::poses::{largest_difference, reference};

    #[test]
    fn solvers_of_every_crate_converge_to_the_same_motion() {
        let (problem, reference) = (Problem::paper(), reference().unwrap());
        let mut solvers = in_rust(&problem, Source::value_variants());
        let tight = [
            ("DOP853", 1e-10),
            ("DOP853 by hand, plain", 1e-10),
            ("DOP853 by hand, tuned", 1e-10),
            ("diffsol Tsit45", 1e-10),
            ("ode_solvers Dop853", 1e-11),
            ("differential-equations dop853", 1e-10),
            ("differential-equations rkv656e", 1e-7),
        ];
        for (name, setting) in tight {
            let solver = solvers.iter_mut().find(|solver| solver.line().name == name).unwrap();
            let run = solver.run(setting).unwrap();
            let error = largest_difference(&run.poses, &reference.poses);
            assert!(error < 1e-9, "{name}: {error:e}");
            assert_eq!(run.work.events, solver.line().locates_events.then_some(60), "{name}");
        }
    }
}
