//! What the summary says of a hacksaw beside what it says of every run: energy, gaps of the joints, speed of the crank.
//!
//! In: a run. Out: lines for people, entries for JSON; of what a scene does not have, no line and a null.

use bg_model::simulation::{MissingColumn, Peaks, Recording};
use bg_workbench::extras::peaks;
use bg_workbench::summary::Entry;
use serde_json::json;

/// The crank's speed is averaged from here on, s: then the paper's case has settled.
pub const SETTLED: f64 = 2.0;

/// The joints whose gaps are outputs, the pins and the slot: the output, in m, and what the summary calls the joint.
pub const JOINTS: [(&str, &str); 5] =
    [("gap_12", "pin O2"), ("gap_23", "pin A"), ("gap_34", "pin B"), ("gap_15", "pin O5"), ("gap_45", "slot")];

/// The outputs of the energy balance, J.
const ENERGIES: [&str; 3] = ["stored_energy", "supplied_energy", "dissipated_energy"];

/// Lines and entries of a run.
pub type Said = (Vec<(String, String)>, Vec<Entry>);

/// What is said of a run.
///
/// # Errors
/// The run lacks a column that belongs to one it has.
pub fn of_paper(run: &Recording) -> Result<Said, MissingColumn> {
    let has_energy = ENERGIES.iter().all(|name| run.has(name));
    let energy = has_energy.then(|| Energy::of(run)).transpose()?;
    let part = energy.as_ref().filter(|energy| energy.supplied != 0.0);
    let part = part.map(|energy| energy.residual / energy.supplied.abs());
    let (gap, speed) = (largest_gap(run), crank_speed(run));
    let mut lines: Vec<(&str, String)> = Vec::new();
    if let Some(Energy { supplied, dissipated, residual: joule }) = energy {
        lines.push(("energy", format!("{supplied:.6} J supplied, {dissipated:.6} J dissipated")));
        let residual = match part {
            Some(part) => format!("{part:.2e} of the energy supplied ({joule:.2e} J)"),
            None => format!("{joule:.2e} J; no energy was supplied"),
        };
        lines.push(("energy balance residual", residual));
    }
    if let Some((joint, gap)) = &gap {
        lines.push(("largest joint gap", format!("{gap:.3e} m, {joint}")));
    }
    if let Some(([mean, low, high], from)) = speed {
        let speed = format!("{mean:.2} rad/s in the mean, {low:.2} to {high:.2} rad/s, from {from} s on");
        lines.push(("crank speed", speed));
    }
    let entry = |key, value| Entry { key, value };
    let entries = vec![
        entry("supplied_energy_j", json!(energy.as_ref().map(|energy| energy.supplied))),
        entry("dissipated_energy_j", json!(energy.as_ref().map(|energy| energy.dissipated))),
        entry("energy_residual_j", json!(energy.as_ref().map(|energy| energy.residual))),
        entry("energy_residual", json!(part)),
        entry("largest_gap", json!(gap)),
        entry("crank_speed_rad_per_s", json!(speed.map(|(speed, _)| speed))),
    ];
    Ok((lines.into_iter().map(|(name, text)| (name.to_owned(), text)).collect(), entries))
}

/// The energy balance of a run.
struct Energy {
    supplied: f64,
    dissipated: f64,
    residual: f64,
}

impl Energy {
    fn of(run: &Recording) -> Result<Self, MissingColumn> {
        let [stored, supplied, dissipated] = ENERGIES.map(|name| run.values(name));
        let (stored, supplied, dissipated) = (stored?, supplied?, dissipated?);
        let residual = |k: usize| (stored[k] - stored[0] - (supplied[k] - dissipated[k])).abs();
        Ok(Self {
            supplied: supplied.last().copied().unwrap_or(0.0),
            dissipated: dissipated.last().copied().unwrap_or(0.0),
            residual: (0..stored.len()).map(residual).fold(0.0, f64::max),
        })
    }
}

fn largest_gap(run: &Recording) -> Option<(String, f64)> {
    let mut largest: Option<(String, f64)> = None;
    for (name, joint) in JOINTS {
        let Some(column) = run.columns.iter().find(|column| column.name == name) else { continue };
        let gap = peaks(run, column).largest.value;
        if largest.as_ref().is_none_or(|(_, most)| gap > *most) {
            largest = Some((joint.to_owned(), gap));
        }
    }
    largest
}

/// The mean of the crank's speed, its least and its largest value, rad/s, and from when on, s; none where it is no
/// output.
fn crank_speed(run: &Recording) -> Option<([f64; 3], f64)> {
    let column = run.columns.iter().find(|column| column.name == "crank_speed")?;
    let settled = run.times.partition_point(|&t| t < SETTLED);
    let (from, first) = if settled + 1 < run.times.len() { (SETTLED, settled) } else { (0.0, 0) };
    let (speed, times) = (&column.values[first..], &run.times[first..]);
    // The trapezoidal rule: samples need not be equally far apart.
    let area: f64 = (1..speed.len()).map(|k| (times[k] - times[k - 1]) * (speed[k] + speed[k - 1]) / 2.0).sum();
    let duration = times.last()? - times.first()?;
    let mean = if duration > 0.0 { area / duration } else { *speed.first()? };
    let Peaks { least, largest } = if first == 0 {
        peaks(run, column)
    } else {
        // Where nobody has looked between the samples, they are what is known.
        column.settled.or_else(|| Peaks::of_samples(times, speed))?
    };
    Some(([mean, least.value, largest.value], from))
}
