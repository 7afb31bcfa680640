//! The measurements as a table, as JSON and as diagrams.
//!
//! In: entries. Out: text, files. A diagram for each case: error over wall time, and error over evaluations of the
//! rate, which do not depend on the machine.

use super::measure::{Counts, Entry};
use crate::files::RunFolder;
use crate::show::figures::{Curve, FigureError, work_precision};
use crate::show::output::OutputError;
use crate::show::tables;

/// The entries as a table, one line each.
#[must_use]
pub fn table(entries: &[Entry]) -> String {
    const HEAD: [&str; 18] = [
        "case",
        "integrator",
        "rtol or step",
        "pose error",
        "L2",
        "momenta",
        "L2",
        "forces",
        "L2",
        "ms",
        "median",
        "steps",
        "rejected",
        "rates",
        "orders",
        "Jacobians",
        "LU",
        "events",
    ];
    let rows = entries.iter().map(|entry| {
        let Counts { steps, rejected, rates, orders, jacobians, factorisations, pivoted, events } = entry.counts;
        let [poses, momenta, forces] = match &entry.errors {
            Some(errors) => [errors.poses, errors.momenta, errors.forces],
            None => [None; 3],
        };
        let numbers = [poses, momenta, forces].into_iter().flat_map(|measure| {
            let number = |value: f64| format!("{value:.1e}");
            measure.map_or(["-".to_owned(), "-".to_owned()], |measure| [number(measure.largest), number(measure.l2)])
        });
        let factorisations =
            if pivoted > 0 { format!("{factorisations} ({pivoted} pivoted)") } else { factorisations.to_string() };
        let mut row = vec![
            entry.case.clone(),
            entry.integrator.clone(),
            format!("{:e}", entry.rtol.or(entry.fixed_step_s).unwrap_or(f64::NAN)),
        ];
        row.extend(numbers);
        row.extend([entry.wall_minimum_s, entry.wall_median_s].map(|seconds| format!("{:.2}", seconds * 1e3)));
        row.extend([steps, rejected, rates, orders, jacobians].map(|count| count.to_string()));
        row.extend([factorisations, events.to_string()]);
        let row: [String; HEAD.len()] = row.try_into().expect("a cell for each head");
        row
    });
    let mut text = tables::table(&std::iter::once(HEAD.map(str::to_owned)).chain(rows).collect::<Vec<_>>());
    for entry in entries {
        if let Some(failure) = &entry.failure {
            text += &format!("{} by {}: {failure}\n", entry.case, entry.integrator);
        }
    }
    text
}

/// Why entries can be written as JSON.
pub const IS_JSON: &str = "entries have text keys only";

const TEXT: &str = "precision.txt";
const JSON: &str = "precision.json";

fn diagram(case: &str, cost: &str) -> String {
    format!("precision_{case}_{cost}.svg")
}

/// The names of all files that measurements of these cases may give.
#[must_use]
pub fn names<'c>(cases: impl IntoIterator<Item = &'c str>) -> Vec<String> {
    let diagrams = cases.into_iter().flat_map(|case| COSTS.map(|(cost, ..)| diagram(case, cost)));
    [TEXT, JSON].map(str::to_owned).into_iter().chain(diagrams).collect()
}

/// Writes `precision.txt`, `precision.json` and the diagrams into `folder`; gives the number of files.
///
/// # Errors
/// A file that cannot be written, a diagram that cannot be drawn.
pub fn write(mut folder: RunFolder, entries: &[Entry]) -> Result<usize, OutputError> {
    let json = serde_json::to_string_pretty(entries).expect(IS_JSON);
    folder.write_text(TEXT, &table(entries))?;
    folder.write_text(JSON, &(json + "\n"))?;
    let mut cases: Vec<&str> = entries.iter().map(|entry| entry.case.as_str()).collect();
    cases.dedup();
    for case in cases {
        let of_case: Vec<&Entry> = entries.iter().filter(|entry| entry.case == case).collect();
        for (name, axis, cost) in COSTS {
            let heading = format!("Work and precision: {case}");
            match work_precision(&heading, "largest pose error, m or rad", axis, &curves(&of_case, cost)) {
                Ok(svg) => folder.write_text(&diagram(case, name), &svg)?,
                Err(FigureError::Empty) => {}
                Err(source) => return Err(OutputError::Diagram { name: case.to_owned(), source }),
            }
        }
    }
    Ok(folder.publish()?.len())
}

type Cost = fn(&Entry) -> f64;
/// Name in the file's name, axis, value.
const COSTS: [(&str, &str, Cost); 2] = [
    ("time", "wall time, ms (least of the repeats)", |entry| entry.wall_minimum_s * 1e3),
    ("rates", "evaluations of the rate and orders of Taylor series", |entry| {
        (entry.counts.rates + entry.counts.orders) as f64
    }),
];

/// A curve for each integrator, in the order of the entries.
fn curves(entries: &[&Entry], cost: Cost) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for entry in entries {
        if curves.last().is_none_or(|curve| curve.name != entry.integrator) {
            curves.push(Curve { name: entry.integrator.clone(), points: Vec::new() });
        }
        if let (Some(curve), Some(poses)) = (curves.last_mut(), entry.errors.and_then(|errors| errors.poses)) {
            curve.points.push((poses.largest, cost(entry)));
        }
    }
    curves
}
