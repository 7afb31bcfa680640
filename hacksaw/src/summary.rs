//! The summary of a run, for people and as JSON.
//!
//! In: a simulation and its checks. Out: the numbers that say whether the run is to be trusted and what the saw does.

use std::fmt;
use std::path::PathBuf;

use bg_model::integrator::Change;
use serde::{Serialize, Serializer};

use crate::checks::Check;
use crate::run::{RunSettings, Simulation};
use crate::trajectory::{Trajectory, TrajectoryError};

/// What a run gives in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The scene.
    pub scene: String,
    /// The parameters that differ from their defaults, as `name = value unit`.
    pub changed_parameters: Vec<String>,
    /// The end that was asked for, s.
    pub t_end_s: f64,
    /// The last sample, s.
    pub reached_s: f64,
    /// The integrators that made the steps, with the time from which on.
    pub integrators: Vec<String>,
    /// The step of a fixed-step method, s; such a method has no tolerances.
    pub fixed_step_s: Option<f64>,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance, SI units.
    pub atol: f64,
    /// Why the run stopped before its end, if it did.
    pub failure: Option<String>,
    /// States integrated.
    pub states: usize,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Evaluations of the rate function.
    pub rate_evaluations: u64,
    /// Orders of Taylor series.
    pub series_orders: u64,
    /// Evaluations of the Jacobian.
    pub jacobian_evaluations: u64,
    /// Factorisations of I - c J.
    pub factorisations: u64,
    /// Those of them that needed row exchanges.
    pub pivoted_factorisations: u64,
    /// Steps in which the tolerances are below what rounding makes of the error.
    pub steps_below_rounding: u64,
    /// Whether these are so many that larger tolerances would serve as well.
    pub is_at_rounding: bool,
    /// Switchings of the stroke.
    pub events: u64,
    /// Time on the wall clock, s.
    pub wall_time_s: f64,
    /// Simulated time over wall time.
    pub times_real_time: f64,
    /// Energy supplied until the end, J; this and the next three where the scene has the energies.
    pub supplied_energy_j: Option<f64>,
    /// Energy dissipated until the end, J.
    pub dissipated_energy_j: Option<f64>,
    /// Largest |stored - stored(0) - supplied + dissipated| over the samples, J.
    pub energy_residual_j: Option<f64>,
    /// The same over the energy supplied until the end, if there is any.
    pub energy_residual: Option<f64>,
    /// The joint with the largest gap, and that gap, m, where the scene has gaps.
    pub largest_gap: Option<(String, f64)>,
    /// Mean, lowest and highest crank speed from [`SETTLED`] on, or over a shorter run as a whole, rad/s, where the scene has
    /// the speed.
    pub crank_speed_rad_per_s: Option<[f64; 3]>,
    /// The paper's statements; none where the scene lacks the columns they are about.
    pub checks: Vec<Check>,
    /// The files written.
    #[serde(serialize_with = "as_text")]
    pub files: Vec<PathBuf>,
}

/// Paths as JSON can hold them: bytes that are no text are shown as U+FFFD.
fn as_text<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|path| path.display().to_string()))
}

/// The crank's speed is averaged from here on, s: then the paper's case has settled.
pub const SETTLED: f64 = 2.0;

/// The joints whose gaps are outputs: the pins and the slot.
const JOINTS: [(&str, &str); 5] =
    [("gap_12", "pin O2"), ("gap_23", "pin A"), ("gap_34", "pin B"), ("gap_15", "pin O5"), ("gap_45", "slot")];

impl Summary {
    /// Summarises a run of the scene called `scene`. Files and changed parameters are added by the caller.
    ///
    /// # Errors
    /// The trajectory lacks a column that belongs to one it has.
    pub fn new(
        scene: &str,
        simulation: &Simulation,
        settings: &RunSettings,
        checks: Vec<Check>,
    ) -> Result<Self, TrajectoryError> {
        let (trajectory, effort) = (&simulation.trajectory, &simulation.effort);
        let statistics = &effort.statistics;
        let reached = trajectory.times.last().copied().unwrap_or(0.0);
        let wall = effort.wall.as_secs_f64();
        let energy = trajectory.has("supplied_energy").then(|| Energy::of(trajectory)).transpose()?;
        let with_supply = energy.as_ref().filter(|energy| energy.supplied != 0.0);
        Ok(Self {
            scene: scene.to_owned(),
            changed_parameters: Vec::new(),
            t_end_s: settings.t_end,
            reached_s: reached,
            integrators: integrators(&effort.methods),
            fixed_step_s: settings.method.has_fixed_step().then_some(settings.fixed_step),
            rtol: settings.rtol,
            atol: settings.atol,
            failure: simulation.failure.clone(),
            states: effort.states,
            steps: statistics.steps,
            rejected: statistics.rejected,
            rate_evaluations: statistics.rate_evaluations,
            series_orders: statistics.series_orders,
            jacobian_evaluations: statistics.jacobian_evaluations,
            factorisations: statistics.factorisations,
            pivoted_factorisations: statistics.pivoted_factorisations,
            steps_below_rounding: statistics.rounded,
            is_at_rounding: statistics.is_at_rounding(),
            events: statistics.events,
            wall_time_s: wall,
            times_real_time: reached / wall,
            energy_residual: with_supply.map(|energy| energy.residual / energy.supplied.abs()),
            supplied_energy_j: energy.as_ref().map(|energy| energy.supplied),
            dissipated_energy_j: energy.as_ref().map(|energy| energy.dissipated),
            energy_residual_j: energy.as_ref().map(|energy| energy.residual),
            largest_gap: largest_gap(trajectory)?,
            crank_speed_rad_per_s: crank_speed(trajectory)?,
            checks,
            files: Vec::new(),
        })
    }

    /// The numbers as pairs of a name and a text with unit, in the order of reading.
    #[must_use]
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![("scene", self.scene.clone())];
        let time = if self.failure.is_some() {
            format!("{} s of {} s: the run failed", self.reached_s, self.t_end_s)
        } else {
            format!("{} s", self.t_end_s)
        };
        lines.push(("simulated time", time));
        let changed = if self.changed_parameters.is_empty() {
            "all at their defaults".to_owned()
        } else {
            self.changed_parameters.join(", ")
        };
        lines.push(("parameters", changed));
        lines.push(("integrator", self.integrators.join(", ")));
        lines.push(match self.fixed_step_s {
            Some(step) => ("fixed step", format!("{step:e} s")),
            None => {
                ("tolerances", format!("relative {}, absolute {} (SI)", tolerance(self.rtol), tolerance(self.atol)))
            }
        });
        lines.push(("states", self.states.to_string()));
        lines.push(("steps", format!("{} accepted, {} rejected", self.steps, self.rejected)));
        if self.is_at_rounding {
            let share = 100.0 * self.steps_below_rounding as f64 / self.steps as f64;
            let text = format!(
                "in {share:.0} % of the steps the tolerances are below rounding: larger ones give as good a result"
            );
            lines.push(("limit of rounding", text));
        }
        lines.push(("rate evaluations", self.rate_evaluations.to_string()));
        if self.series_orders > 0 {
            lines.push(("orders of Taylor series", self.series_orders.to_string()));
        }
        if self.factorisations > 0 {
            let pivoted = match self.pivoted_factorisations {
                0 => String::new(),
                count => format!(", {count} of them with row exchanges"),
            };
            let (jacobians, factorisations) = (self.jacobian_evaluations, self.factorisations);
            lines.push(("Jacobians", format!("{jacobians}, {factorisations} factorisations{pivoted}")));
        }
        lines.push(("switching events", self.events.to_string()));
        let wall = format!("{:.3} s, {:.1} times faster than real time", self.wall_time_s, self.times_real_time);
        lines.push(("wall time", wall));
        if let (Some(supplied), Some(dissipated)) = (self.supplied_energy_j, self.dissipated_energy_j) {
            lines.push(("energy", format!("{supplied:.6} J supplied, {dissipated:.6} J dissipated")));
        }
        if let Some(joule) = self.energy_residual_j {
            let residual = match self.energy_residual {
                Some(part) => format!("{part:.2e} of the energy supplied ({joule:.2e} J)"),
                None => format!("{joule:.2e} J; no energy was supplied"),
            };
            lines.push(("energy balance residual", residual));
        }
        if let Some((joint, gap)) = &self.largest_gap {
            lines.push(("largest joint gap", format!("{gap:.3e} m, {joint}")));
        }
        if let Some([mean, low, high]) = self.crank_speed_rad_per_s {
            let from = if self.reached_s > SETTLED { SETTLED } else { 0.0 };
            let speed = format!("{mean:.2} rad/s in the mean, {low:.2} to {high:.2} rad/s, from {from} s on");
            lines.push(("crank speed", speed));
        }
        lines
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.lines();
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, text) in &lines {
            writeln!(f, "{name:width$}  {text}")?;
        }
        if !self.checks.is_empty() {
            let held = self.checks.iter().filter(|check| check.holds).count();
            writeln!(f, "\nWhat the paper says its figures show: {held} of {} statements hold", self.checks.len())?;
        }
        for Check { figure, statement, measured, holds } in &self.checks {
            let verdict = if *holds { "holds" } else { "does not hold" };
            writeln!(f, "  {figure:11}  {statement} {verdict}\n               {measured}")?;
        }
        Ok(())
    }
}

/// A tolerance to twelve digits: a tenth of 1e-10 reads 1e-11, not 1.0000000000000001e-11.
fn tolerance(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    format!("{rounded:e}")
}

/// The energy balance of a run.
struct Energy {
    supplied: f64,
    dissipated: f64,
    residual: f64,
}

impl Energy {
    fn of(trajectory: &Trajectory) -> Result<Self, TrajectoryError> {
        let stored = trajectory.series("stored_energy")?;
        let supplied = trajectory.series("supplied_energy")?;
        let dissipated = trajectory.series("dissipated_energy")?;
        let residual = |k: usize| (stored[k] - stored[0] - (supplied[k] - dissipated[k])).abs();
        Ok(Self {
            supplied: supplied.last().copied().unwrap_or(0.0),
            dissipated: dissipated.last().copied().unwrap_or(0.0),
            residual: (0..stored.len()).map(residual).fold(0.0, f64::max),
        })
    }
}

fn largest_gap(trajectory: &Trajectory) -> Result<Option<(String, f64)>, TrajectoryError> {
    let mut largest: Option<(String, f64)> = None;
    for (column, joint) in JOINTS.into_iter().filter(|(column, _)| trajectory.has(column)) {
        for gap in trajectory.series(column)? {
            if largest.as_ref().is_none_or(|(_, most)| gap > *most) {
                largest = Some((joint.to_owned(), gap));
            }
        }
    }
    Ok(largest)
}

fn crank_speed(trajectory: &Trajectory) -> Result<Option<[f64; 3]>, TrajectoryError> {
    if !trajectory.has("crank_speed") {
        return Ok(None);
    }
    let (speed, times) = (trajectory.series("crank_speed")?, &trajectory.times);
    let settled = times.partition_point(|&t| t < SETTLED);
    let from = if settled + 1 < speed.len() { settled } else { 0 };
    let (speed, times) = (&speed[from..], &times[from..]);
    let Some(&first) = speed.first() else { return Ok(None) };
    // The trapezoidal rule: samples need not be equally far apart.
    let area: f64 = (1..speed.len()).map(|k| (times[k] - times[k - 1]) * (speed[k] + speed[k - 1]) / 2.0).sum();
    let duration = times[times.len() - 1] - times[0];
    let mean = if duration > 0.0 { area / duration } else { first };
    let (low, high) = speed.iter().fold((first, first), |(low, high), &value| (low.min(value), high.max(value)));
    Ok(Some([mean, low, high]))
}

/// The methods in the order of their turns, the first three of them.
fn integrators(methods: &[Change]) -> Vec<String> {
    const SHOWN: usize = 3;
    let name = |(index, change): (usize, &Change)| match index {
        0 => change.method.to_owned(),
        _ => format!("{} from {:.4} s", change.method, change.t),
    };
    let mut names: Vec<String> = methods.iter().enumerate().take(SHOWN).map(name).collect();
    if methods.len() > SHOWN {
        names.push(format!("{} more changes", methods.len() - SHOWN));
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Effort;
    use crate::trajectory::Column;

    #[test]
    fn numbers_come_from_the_columns() {
        let names = ["stored_energy", "supplied_energy", "dissipated_energy", "crank_speed"];
        let columns = names.into_iter().chain(JOINTS.map(|(column, _)| column));
        let columns = columns.map(|name| Column { name: name.to_owned(), unit: String::new() }).collect();
        let mut trajectory = Trajectory::new(columns);
        trajectory.push(0.0, vec![5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        trajectory.push(2.0, vec![8.0, 4.0, 1.5, 40.0, 1e-4, 0.0, 3e-4, 0.0, 0.0]);
        trajectory.push(3.0, vec![9.0, 10.0, 6.0, 60.0, 0.0, 0.0, 0.0, 2e-4, 0.0]);
        let simulation = Simulation { trajectory, effort: Effort::default(), failure: None };
        let settings = RunSettings { t_end: 3.0, ..RunSettings::default() };
        let summary = Summary::new("paper", &simulation, &settings, Vec::new()).unwrap();
        assert_eq!(summary.energy_residual_j, Some(0.5));
        assert_eq!(summary.energy_residual, Some(0.05));
        assert_eq!(summary.largest_gap, Some(("pin B".to_owned(), 3e-4)));
        assert_eq!(summary.crank_speed_rad_per_s, Some([50.0, 40.0, 60.0]));
    }

    #[test]
    fn a_tolerance_reads_as_it_was_meant() {
        assert_eq!([1e-10 / 10.0, 1e-8 / 10.0, 2.5e-7, 1.0].map(tolerance), ["1e-11", "1e-9", "2.5e-7", "1e0"]);
    }

    #[test]
    fn a_scene_without_the_columns_has_no_lines_of_them() {
        let column = Column { name: "crank_angle".to_owned(), unit: "rad".to_owned() };
        let mut trajectory = Trajectory::new(vec![column]);
        trajectory.push(0.0, vec![0.0]);
        let simulation = Simulation { trajectory, effort: Effort::default(), failure: None };
        let settings = RunSettings { t_end: 1.0, ..RunSettings::default() };
        let summary = Summary::new("angles", &simulation, &settings, Vec::new()).unwrap();
        let names: Vec<_> = summary.lines().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names[0], "scene");
        assert!(!names.iter().any(|name| name.contains("energy") || name.contains("gap") || name.contains("speed")));
    }
}
