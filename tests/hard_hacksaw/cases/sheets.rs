//! The hacksaw's measurements as tables for the report.
//!
//! In: nothing; `progress` is told what is run. Out: sheets.

use bg_model::failure::Cause;
use serde_json::{Value, json};

use super::cases::{DISTURBANCE, disturbed};
use super::disturbed::departure;
use super::ending::endings;
use super::endurance::endurance;
use super::extremes::{Answer, Extreme, extremes};
use super::machine::spatial_names;
use super::request;
use super::sampling::sampled;
use crate::hardcases::sheet::Sheet;
use crate::hardcases::{integrator, integrators};

/// What is told while a sheet is made.
pub type Progress<'a> = &'a mut dyn FnMut(&str);

/// Departures from the plane over the disturbance that the start had.
#[must_use]
pub fn growth(progress: Progress) -> Sheet {
    let case = disturbed();
    let names = spatial_names();
    let mut rows = Vec::new();
    for name in ["auto", "radau9", "radau5", "rodas5p"] {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            progress(&format!("{name} {tolerance:e}"));
            let run = case.problem.run(integrator(name), &request(tolerance, &case.instants, 400_000));
            let largest = run.rows.iter().map(|row| departure(&names, row)).fold(0.0, f64::max);
            let last = run.rows.last().map_or(f64::NAN, |row| departure(&names, row));
            rows.push(vec![
                json!(name),
                json!(tolerance),
                json!(largest / DISTURBANCE),
                json!(last / DISTURBANCE),
                json!(run.statistics.steps),
                message(run.failure.as_ref()),
            ]);
        }
    }
    Sheet {
        name: "hacksaw-out-of-plane",
        about: "the symmetric mechanism in space, disturbed by 1e-12 out of its plane: the largest and the last \
                departure over 5 s, over the disturbance",
        head: &["integrator", "rtol", "largest", "last", "steps", "failure"],
        rows,
    }
}

/// Samples finer than the steps.
#[must_use]
pub fn sampling(progress: Progress) -> Sheet {
    let mut rows = Vec::new();
    for by in integrators() {
        for tolerance in [1e-4, 1e-6, 1e-8] {
            progress(&format!("{} {tolerance:e}", by.name()));
            let head = [json!(by.name()), json!(tolerance)];
            let rest = match sampled(*by, tolerance, 0.02) {
                Ok(of) => {
                    let values = [of.ends, of.between, of.between / of.ends, of.jump].map(|value| json!(value));
                    [&[json!(of.steps)], &values[..], &[Value::Null]].concat()
                }
                Err(cause) => [&[const { Value::Null }; 5][..], &[message(Some(&cause))]].concat(),
            };
            rows.push([&head[..], &rest].concat());
        }
    }
    Sheet {
        name: "hacksaw-fine-samples",
        about: "the paper's case for 0.02 s with samples 1e-6 s apart: the largest pose error at the steps' ends and \
                at the samples, and the largest jump of a pose at a step's end; fixed steps are of 1e-4 s",
        head: &["integrator", "rtol", "steps", "ends", "between", "ratio", "jump", "failure"],
        rows,
    }
}

/// Ends at switching instants.
#[must_use]
pub fn ending(progress: Progress) -> Sheet {
    let mut rows = Vec::new();
    for by in integrators() {
        progress(by.name());
        for of in endings(*by, 1e-8, 0.5, 4) {
            let failure = message(of.failure.as_ref());
            let numbers = [json!(of.end), json!(of.difference), json!(of.events)];
            rows.push([vec![json!(by.name()), json!(of.switching)], numbers.to_vec(), vec![failure]].concat());
        }
    }
    Sheet {
        name: "hacksaw-ends-at-switchings",
        about: "runs that end at a switching instant, one rounding before and one after it: the difference of the end \
                to the same instant of a longer run, and the switchings told",
        head: &["integrator", "switching", "end", "difference", "events", "failure"],
        rows,
    }
}

/// 1000 s.
#[must_use]
pub fn endurance_of(seconds: u32, progress: Progress) -> Sheet {
    let mut rows = Vec::new();
    for (name, tolerance) in [("auto", 1e-8), ("dop853", 1e-6), ("cfmr7", 1e-6)] {
        let memory = resident();
        let of = endurance(integrator(name), tolerance, seconds, |t| {
            if t % 100.0 == 0.0 {
                progress(&format!("{name} {t} s"));
            }
        });
        rows.push(vec![
            json!(name),
            json!(tolerance),
            json!(of.imbalance),
            json!(of.orthogonality),
            json!(format!("{:?}", of.events)),
            json!(of.statistics.steps),
            json!(resident().zip(memory).map(|(after, before)| after - before)),
            message(of.failure.as_ref()),
        ]);
    }
    Sheet {
        name: "hacksaw-endurance",
        about: "the paper's case for 1000 s: the largest imbalance over the energies, orthogonality, switchings in \
                each fifth, and by how much the memory in use has grown",
        head: &["integrator", "rtol", "imbalance", "orthogonality", "events", "steps", "kB more", "failure"],
        rows,
    }
}

/// Memory in use, kB, where the system tells it.
fn resident() -> Option<i64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// Parameters at their extremes.
#[must_use]
pub fn extreme_parameters(end: f64, limit: u64, progress: Progress) -> Sheet {
    Sheet {
        name: "hacksaw-extreme-parameters",
        about: "every parameter of the paper's case at 1e-12, 1e12 and the ends of its range, one at a time",
        head: &["parameter", "value", "answer", "difference", "imbalance", "attempts", "message"],
        rows: extremes(end, limit, progress).iter().map(line).collect(),
    }
}

fn line(of: &Extreme) -> Vec<Value> {
    let (answer, message) = match &of.answer {
        Answer::Right => ("right", Value::Null),
        Answer::Unchecked(why) => ("unchecked", json!(why)),
        Answer::Refused(why) => ("refused", json!(why)),
        Answer::Wrong => ("WRONG", Value::Null),
    };
    let numbers = [json!(of.difference), json!(of.imbalance), json!(of.attempts)];
    [vec![json!(of.name), json!(of.value), json!(answer)], numbers.to_vec(), vec![message]].concat()
}

fn message(cause: Option<&Cause>) -> Value {
    cause.map_or(Value::Null, |cause| json!(cause.to_string()))
}
