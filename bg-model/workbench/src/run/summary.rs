//! The summary of a run, for people and as JSON.
//!
//! In: a run, and what the program adds. Out: the numbers that say whether the run is to be trusted and what the
//! machine does.

use std::fmt;
use std::path::PathBuf;

use bg_model::integrator::{Change, Integrator};
use bg_model::run::{Request, Trajectory};
use serde::{Serialize, Serializer};

use crate::ask::inputs::{self, Named};
use crate::ask::parameters::number;
use crate::run::recipe::Recipe;

/// A statement about a run and what the run says to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// The figures it is about, such as `Fig. 4`.
    pub figure: &'static str,
    /// The statement.
    pub statement: &'static str,
    /// What was measured, with units.
    pub measured: String,
    /// Whether it holds.
    pub holds: bool,
}

/// A number that a program adds to the summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name in JSON, with the unit at its end.
    pub key: &'static str,
    /// Its value in JSON.
    pub value: serde_json::Value,
}

/// What a program adds to the summary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Additions {
    /// Lines for people: a name and a text with unit.
    pub lines: Vec<(String, String)>,
    /// The same for programs.
    pub entries: Vec<Entry>,
    /// Statements about the run, and above them what they are.
    pub checks: Vec<Check>,
    /// What the checks are, such as `What the paper says its figures show`.
    pub heading: &'static str,
}

/// What a run gives in numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// The program and its version; empty where nothing is said.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub program: String,
    /// The scene.
    pub scene: String,
    /// The parameters that differ from their defaults, as `name = value unit`.
    pub changed_parameters: Vec<String>,
    /// The inputs.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Named>,
    /// The end that was asked for, s.
    pub t_end_s: f64,
    /// The start, s, of a run that goes on from a saved state; else nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    /// The last sample, s.
    pub reached_s: f64,
    /// The integrators that made the steps, with the time from which on.
    pub integrators: Vec<String>,
    /// The method by which `auto` made the longest part, for `--hint`; none where another integrator was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<&'static str>,
    /// The step of a fixed-step method, s; such a method has no tolerances.
    pub fixed_step_s: Option<f64>,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance, SI units; none where the sizes of the states give it.
    pub atol: Option<f64>,
    /// Why the run stopped before its end, if it did.
    pub failure: Option<String>,
    /// Which rigid joints hold what others hold already.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub redundant: Vec<String>,
    /// The kinetic energy that impulses of rigid joints took at the start, J, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impulse_energy_j: Option<f64>,
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
    /// The states whose errors were never controlled.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub uncontrolled: Vec<&'static str>,
    /// Switchings of the stroke.
    pub events: u64,
    /// The longest time between two samples, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sample_step_s: Option<f64>,
    /// Time on the wall clock, s; zero where there is none.
    pub wall_time_s: f64,
    /// Simulated time over wall time.
    pub times_real_time: f64,
    /// What the program adds.
    #[serde(flatten, serialize_with = "as_map")]
    entries: Vec<Entry>,
    #[serde(skip)]
    lines: Vec<(String, String)>,
    #[serde(skip)]
    heading: &'static str,
    /// Statements about the run.
    pub checks: Vec<Check>,
    /// All that the bits of the run depend on; by it the run can be made again.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recipe: Option<Recipe>,
    /// The files written.
    #[serde(serialize_with = "as_text")]
    pub files: Vec<PathBuf>,
}

/// Paths as JSON can hold them: bytes that are no text are shown as U+FFFD.
fn as_text<S: Serializer>(paths: &[PathBuf], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(paths.iter().map(|path| path.display().to_string()))
}

fn as_map<S: Serializer>(entries: &[Entry], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|Entry { key, value }| (key, value)))
}

impl Summary {
    /// Summarises a run of the scene called `scene`; `failure` says why it stopped before its end, if it did. The
    /// program, files, changed parameters, inputs and the recipe are added by the caller.
    #[must_use]
    pub fn new(scene: &str, run: &Trajectory, failure: Option<String>, additions: Additions) -> Self {
        let Request { method, fixed_step, t_end, rtol, .. } = run.request;
        let statistics = &run.statistics;
        let from = run.methods.first().map_or(0.0, |first| first.t);
        let reached = run.times.last().copied().unwrap_or(from);
        let wall = run.wall.as_secs_f64();
        Self {
            program: String::new(),
            scene: scene.to_owned(),
            changed_parameters: Vec::new(),
            inputs: Vec::new(),
            t_end_s: t_end,
            from_s: (from != 0.0).then_some(from),
            reached_s: reached,
            integrators: integrators(method, &run.methods),
            hint: run.hint().map(Integrator::name),
            fixed_step_s: method.has_fixed_step().then_some(fixed_step),
            rtol,
            atol: run.request.atol,
            failure,
            redundant: run.redundant.iter().map(ToString::to_string).collect(),
            impulse_energy_j: (run.impulse_energy != 0.0).then_some(run.impulse_energy),
            states: run.last.states.len(),
            steps: statistics.steps,
            rejected: statistics.rejected,
            rate_evaluations: statistics.rate_evaluations,
            series_orders: statistics.series_orders,
            jacobian_evaluations: statistics.jacobian_evaluations,
            factorisations: statistics.factorisations,
            pivoted_factorisations: statistics.pivoted_factorisations,
            steps_below_rounding: statistics.rounded,
            is_at_rounding: statistics.is_at_rounding(),
            uncontrolled: run.uncontrolled.clone(),
            events: statistics.events,
            sample_step_s: longest_step(&run.times),
            wall_time_s: wall,
            times_real_time: (reached - from) / wall,
            entries: additions.entries,
            lines: additions.lines,
            heading: additions.heading,
            checks: additions.checks,
            recipe: None,
            files: Vec::new(),
        }
    }

    /// The summary as JSON.
    #[must_use]
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a summary has text keys only") + "\n"
    }

    /// What the checks are.
    #[must_use]
    pub const fn heading(&self) -> &'static str {
        self.heading
    }

    /// The numbers as pairs of a name and a text with unit, in the order of reading.
    #[must_use]
    pub fn lines(&self) -> Vec<(&str, String)> {
        let mut lines = vec![("scene", self.scene.clone())];
        let time = if self.failure.is_some() {
            format!("{} s of {} s: the run failed", self.reached_s, self.t_end_s)
        } else {
            match self.from_s {
                Some(from) => format!("from {from} s to {} s", self.t_end_s),
                None => format!("{} s", self.t_end_s),
            }
        };
        lines.push(("simulated time", time));
        let changed = if self.changed_parameters.is_empty() {
            "all at their defaults".to_owned()
        } else {
            self.changed_parameters.join(", ")
        };
        lines.push(("parameters", changed));
        lines.extend(inputs::lines(&self.inputs, [self.from_s.unwrap_or(0.0), self.reached_s]));
        lines.push(("integrator", self.integrators.join(", ")));
        lines.push(match self.fixed_step_s {
            Some(step) => ("fixed step", format!("{step:e} s")),
            None => {
                let absolute = self.atol.map_or_else(
                    || "absolute by the sizes of the states".to_owned(),
                    |atol| format!("absolute {} (SI)", tolerance(atol)),
                );
                ("tolerances", format!("relative {}, {absolute}", tolerance(self.rtol)))
            }
        });
        lines.push(("states", self.states.to_string()));
        lines.extend(
            self.redundant.iter().map(|joint| ("shared reactions", format!("{joint}; they have the least norm"))),
        );
        if let Some(energy) = self.impulse_energy_j {
            lines.push(("impulses at the start", format!("take {energy:.4e} J of kinetic energy")));
        }
        lines.push(("steps", format!("{} accepted, {} rejected", self.steps, self.rejected)));
        if self.is_at_rounding {
            let share = 100.0 * self.steps_below_rounding as f64 / self.steps as f64;
            let text = format!(
                "in {share:.0} % of the steps the tolerances are below rounding: larger ones give as good a result"
            );
            lines.push(("limit of rounding", text));
        }
        if !self.uncontrolled.is_empty() {
            let help = if self.atol.is_some() { "leave out --atol" } else { "take a smaller --rtol" };
            let states = self.uncontrolled.join(", ");
            let text = format!("{states}: smaller than the absolute tolerance all the time; {help}");
            lines.push(("errors not controlled", text));
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
        // Zero where no clock was looked at.
        if self.wall_time_s > 0.0 {
            let wall = format!("{:.3} s, {:.1} times faster than real time", self.wall_time_s, self.times_real_time);
            lines.push(("wall time", wall));
        }
        if let Some(step) = self.sample_step_s {
            let text = format!("at most {} s apart; ranges are those of the solution between them, too", short(step));
            lines.push(("samples", text));
        }
        if !self.program.is_empty() {
            lines.push(("program", self.program.clone()));
        }
        lines.extend(self.recipe.as_ref().and_then(Recipe::origin).map(|origin| ("model", origin)));
        lines.extend(self.lines.iter().map(|(name, text)| (name.as_str(), text.clone())));
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
            writeln!(f, "\n{}: {held} of {} statements hold", self.heading, self.checks.len())?;
        }
        for Check { figure, statement, measured, holds } in &self.checks {
            let verdict = if *holds { "holds" } else { "does not hold" };
            writeln!(f, "  {figure:11}  {statement} {verdict}\n               {measured}")?;
        }
        Ok(())
    }
}

/// The longest time between two of the samples at `times` (s); none of a single one.
pub(crate) fn longest_step(times: &[f64]) -> Option<f64> {
    times.windows(2).map(|pair| pair[1] - pair[0]).reduce(f64::max)
}

/// Six digits, plain where that is short.
pub(crate) fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    number(rounded)
}

/// A tolerance to twelve digits: a tenth of 1e-10 reads 1e-11, not 1.0000000000000001e-11.
fn tolerance(value: f64) -> String {
    let rounded = format!("{value:.11e}").parse().unwrap_or(value);
    format!("{rounded:e}")
}

/// The methods in the order of their turns, the first three of them, and why each was taken where `auto` chose.
fn integrators(asked: Integrator, methods: &[Change]) -> Vec<String> {
    const SHOWN: usize = 3;
    let text = |(index, Change { t, method, reason }): (usize, &Change)| match (index, asked) {
        (0, Integrator::Auto) if methods.len() == 1 => format!("{method} (auto found none better)"),
        (0, _) => (*method).to_owned(),
        _ => format!("from {t:.4} s {method} ({reason})"),
    };
    let mut texts: Vec<String> = methods.iter().enumerate().take(SHOWN).map(text).collect();
    if methods.len() > SHOWN {
        let more = methods.len() - SHOWN;
        texts.push(format!("{more} more {}", if more == 1 { "change" } else { "changes" }));
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::integrator::Reason;

    #[test]
    fn the_summary_says_which_methods_made_the_steps_and_why() {
        let first = Change { t: 0.0, method: "DOP853", reason: Reason::First };
        assert_eq!(integrators(Integrator::Dop853, &[first]), ["DOP853"]);
        assert_eq!(integrators(Integrator::Auto, &[first]), ["DOP853 (auto found none better)"]);
        let later = |reason| Change { t: 0.25, method: "Radau IIA 9", reason };
        let all = [first, later(Reason::Longer(16.0)), later(Reason::Further(1.123)), later(Reason::Cheaper)];
        let texts = integrators(Integrator::Auto, &all);
        let expected = [
            "DOP853",
            "from 0.2500 s Radau IIA 9 (steps 16 times as long)",
            "from 0.2500 s Radau IIA 9 (12 % further with the same work)",
            "1 more change",
        ];
        assert_eq!(texts, expected);
    }

    #[test]
    fn samples_are_apart_by_the_longest_of_their_steps() {
        assert_eq!(longest_step(&[0.0, 0.25, 0.375, 1.0, 1.5]), Some(0.625));
        assert_eq!((longest_step(&[2.0]), longest_step(&[])), (None, None));
        assert_eq!(short(0.1 + 0.2), "0.3");
    }

    #[test]
    fn a_tolerance_reads_as_it_was_meant() {
        assert_eq!([1e-10 / 10.0, 1e-8 / 10.0, 2.5e-7, 1.0].map(tolerance), ["1e-11", "1e-9", "2.5e-7", "1e0"]);
    }
}
