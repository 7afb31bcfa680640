//! Measuring: every solver at every setting, in rounds, so that a disturbance of the machine hits all alike.
//!
//! In: the solvers, the reference, how many rounds. Out: for each solver its points: error, times, counts.

use serde::Serialize;

use crate::poses::{self, Reference};
use crate::solvers::{Line, Solver, Work};

/// How it is measured.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Runs of each solver at each setting.
    pub rounds: usize,
    /// The longest run, s: a solver that takes longer is not run with its finer settings.
    pub longest: f64,
}

/// A solver's points.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    /// The solver.
    #[serde(flatten)]
    pub line: Line,
    /// In the order of its settings.
    pub points: Vec<Point>,
    /// What went wrong at which setting.
    pub faults: Vec<String>,
}

/// A solver at a setting.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// The setting: relative tolerance or step, s.
    pub setting: f64,
    /// The largest error of a pose at a sample, m or rad.
    pub error: f64,
    /// The time of each run, ms.
    pub times: Vec<f64>,
    /// Time of compilation before, s.
    pub compiled: Option<f64>,
    /// Counts.
    pub work: Work,
}

impl Point {
    /// The least time, ms.
    pub fn least(&self) -> f64 {
        self.times.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The median of the times, ms: the larger middle one of an even number.
    pub fn median(&self) -> f64 {
        let mut times = self.times.clone();
        times.sort_unstable_by(f64::total_cmp);
        times[times.len() / 2]
    }
}

/// Runs everything. `progress` is told what is done.
pub fn measure(
    solvers: &mut [Box<dyn Solver + '_>],
    reference: &Reference,
    plan: Plan,
    mut progress: impl FnMut(&str),
) -> Vec<Series> {
    let mut all = Vec::new();
    for solver in solvers.iter_mut() {
        progress(&solver.line().name);
        all.push(first_round(solver.as_mut(), reference, plan.longest));
    }
    for round in 2..=plan.rounds {
        progress(&format!("round {round} of {}", plan.rounds));
        for (solver, series) in solvers.iter_mut().zip(&mut all) {
            for point in &mut series.points {
                match solver.run(point.setting) {
                    Ok(run) => point.times.push(run.wall.as_secs_f64() * 1e3),
                    Err(fault) => series.faults.push(format!("at {:e} in round {round}: {fault}", point.setting)),
                }
            }
        }
    }
    all
}

/// Each setting once, with the error.
fn first_round(solver: &mut dyn Solver, reference: &Reference, longest: f64) -> Series {
    let mut series = Series { line: solver.line().clone(), points: Vec::new(), faults: Vec::new() };
    for setting in solver.settings().to_vec() {
        match solver.run(setting) {
            Ok(run) => {
                let wall = run.wall.as_secs_f64();
                series.points.push(Point {
                    setting,
                    error: poses::largest_difference(&run.poses, &reference.poses),
                    times: vec![wall * 1e3],
                    compiled: run.compiled.map(|time| time.as_secs_f64()),
                    work: run.work,
                });
                if wall > longest {
                    break;
                }
            }
            Err(fault) => series.faults.push(format!("at {setting:e}: {fault}")),
        }
    }
    series
}
