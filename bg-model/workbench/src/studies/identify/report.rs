//! What an identification found, as text for the terminal and as parameters for the next run.
//!
//! In: an [`Identified`] and the data. Out: tables of parameters, correlations and columns; what the data do not
//! determine, by name.

use bg_model::description::OutputInfo;

use bg_analysis::identify::Estimate;
use serde_json::{Value, json};

use super::{Column, Data, Identified, Left, Measured, NoNoise};
use crate::files::table::{aligned, table};

/// Correlations above this are pointed out.
const STRONG: f64 = 0.95;
/// What to do where what is left is no noise.
const ADVICE: &str = "so the parameters have no intervals: this model or this minimum is not the right one; \
                      fit what else may differ, or start elsewhere with --set";

/// The report.
#[must_use]
pub fn text(found: &Identified, data: &Data, outputs: &'static [OutputInfo]) -> String {
    let end = match (found.has_converged, found.leaves_noise()) {
        (false, _) => "did not converge",
        (true, true) => "converged",
        (true, false) => "converged, but what is left is no noise,",
    };
    let from = if found.starts > 1 { format!(", from {} starts", found.starts) } else { String::new() };
    let mut text = format!(
        "{} parameters from {} values in {} columns: {end} after {} runs, {} of them with derivatives{from}\n\n{}",
        found.estimates.len(),
        data.count(),
        data.columns.len(),
        found.evaluations,
        found.derivatives,
        parameters(found)
    );
    for estimate in found.estimates.iter().filter(|estimate| estimate.is_held) {
        text += &format!(
            "`{}` is at its bound: the data want it beyond; give other bounds with --bounds\n",
            estimate.variable.info.name
        );
    }
    for parts in &found.undetermined {
        text += &undetermined(parts);
    }
    if found.estimates.len() > 1 {
        text += &format!("\ncorrelations of the errors\n{}", correlations(found));
        text += &strong(found);
    }
    text += &format!("\n{}", columns(found, data, outputs));
    text += &no_noise(found, data);
    if !data.ignored.is_empty() {
        text += &format!("columns that measure no output asked for: {}\n", data.ignored.join(", "));
    }
    text
}

/// The same for programs. What is not known is null.
#[must_use]
pub fn json(found: &Identified, data: &Data, outputs: &'static [OutputInfo]) -> Value {
    let parameter = |estimate: &Estimate| {
        let Estimate { variable, value, interval, is_held } = estimate;
        json!({
            "name": variable.info.name, "unit": variable.info.unit, "value": value, "interval": interval,
            "start": variable.start, "at_bound": is_held,
        })
    };
    let column = |(column, measured): (&Column, &Measured)| {
        let Left { size, spread, correlation, lag, fault } = &column.left;
        let output = &outputs[column.output];
        json!({
            "column": measured.name, "output": output.name, "unit": output.unit, "left": size, "spread": spread,
            "correlation": correlation, "lag": lag, "is_noise": fault.is_none(),
        })
    };
    let rows = found.correlations.row_iter();
    json!({
        "converged": found.has_converged,
        "leaves_noise": found.leaves_noise(),
        "parameters": found.estimates.iter().map(parameter).collect::<Vec<_>>(),
        "correlations": rows.map(|row| row.iter().copied().collect::<Vec<f64>>()).collect::<Vec<_>>(),
        "undetermined": found.undetermined,
        "columns": found.columns.iter().zip(&data.columns).map(column).collect::<Vec<_>>(),
        "runs": found.evaluations,
        "runs_with_derivatives": found.derivatives,
        "starts": found.starts,
    })
}

fn parameters(found: &Identified) -> String {
    let head = ["parameter", "unit", "found", "95 % from", "to", "+-, %", "started at"].map(str::to_owned);
    let rows = found.estimates.iter().map(|estimate| {
        let ends = estimate.interval.map_or_else(
            || ["-", "-", "-"].map(str::to_owned),
            |[lower, upper]| {
                let half = 50.0 * (upper - lower) / estimate.value.abs();
                [format!("{lower:.6e}"), format!("{upper:.6e}"), format!("{half:.2e}")]
            },
        );
        let [lower, upper, half] = ends;
        let info = estimate.variable.info;
        let value = format!("{:.6e}", estimate.value);
        [
            info.name.to_owned(),
            info.unit.to_owned(),
            value,
            lower,
            upper,
            half,
            format!("{:.6e}", estimate.variable.start),
        ]
    });
    table(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}

/// A sentence on what the data leave open.
fn undetermined(parts: &[(&str, f64)]) -> String {
    match parts {
        [(name, _)] => format!(
            "`{name}` cannot be identified: it does not move what was measured; fix it, or measure another output\n"
        ),
        several => {
            let names: Vec<String> = several.iter().map(|(name, part)| format!("`{name}` by {part:+.2} %")).collect();
            format!(
                "these cannot be told apart: {} together move nothing that was measured; fix one of them\n",
                names.join(", ")
            )
        }
    }
}

fn correlations(found: &Identified) -> String {
    let names: Vec<String> = found.estimates.iter().map(|estimate| estimate.variable.info.name.to_owned()).collect();
    let head = std::iter::once(String::new()).chain(names.iter().cloned()).collect::<Vec<_>>();
    let row = |(i, name): (usize, &String)| {
        let cell = |j: usize| {
            let value = found.correlations[(i, j)];
            if value.is_nan() { "-".to_owned() } else { format!("{value:.3}") }
        };
        std::iter::once(name.clone()).chain((0..names.len()).map(cell)).collect::<Vec<_>>()
    };
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(names.iter().enumerate().map(row)).collect();
    aligned(&rows)
}

/// What is nearly one parameter.
fn strong(found: &Identified) -> String {
    let count = found.estimates.len();
    let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
    let is_strong = |&(i, j): &(usize, usize)| found.correlations[(i, j)].abs() > STRONG;
    let name = |k: usize| found.estimates[k].variable.info.name;
    pairs
        .filter(is_strong)
        .map(|(i, j)| {
            format!("`{}` and `{}` can hardly be told apart: what one loses the other gains\n", name(i), name(j))
        })
        .collect()
}

fn columns(found: &Identified, data: &Data, outputs: &'static [OutputInfo]) -> String {
    let noise = if found.leaves_noise() { "noise found" } else { "left" };
    let head = ["column", "output", "values", noise, "unit", "% of spread", "correlated", "at lag"].map(str::to_owned);
    let rows = found.columns.iter().zip(&data.columns).map(|(column, measured)| {
        let output = &outputs[column.output];
        let count = measured.values.iter().flatten().count().to_string();
        let Left { size, spread, correlation, lag, .. } = column.left;
        [
            measured.name.clone(),
            output.name.to_owned(),
            count,
            format!("{size:.3e}"),
            output.unit.to_owned(),
            percent(size / spread),
            format!("{correlation:.2}"),
            lag.to_string(),
        ]
    });
    table(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}

/// A sentence on each column of which more than noise is left.
fn no_noise(found: &Identified, data: &Data) -> String {
    let sentence = |(column, measured): (&Column, &Measured)| {
        let Left { size, spread, correlation, lag, fault } = column.left;
        let why = match fault? {
            NoNoise::Correlated => format!("is correlated by {correlation:.2} over {}", samples(lag)),
            NoNoise::Large => "is more than a constant would leave".to_owned(),
        };
        let part = percent(size / spread);
        Some(format!("what is left of `{}`, {part} % of its spread, {why}: no noise\n", measured.name))
    };
    let sentences: String = found.columns.iter().zip(&data.columns).filter_map(sentence).collect();
    if sentences.is_empty() { sentences } else { format!("{sentences}{ADVICE}\n") }
}

/// A part as per cents, of which small ones keep two digits.
fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    if percent >= 0.1 { format!("{percent:.1}") } else { format!("{percent:.1e}") }
}

fn samples(lag: usize) -> String {
    if lag == 1 { "one sample".to_owned() } else { format!("{lag} samples") }
}

/// The parameters found, as a file for `--params`.
#[must_use]
pub fn toml(found: &Identified) -> String {
    let line = |estimate: &super::Estimate| {
        let info = estimate.variable.info;
        let unit = if info.unit.is_empty() { "1" } else { info.unit };
        let interval = estimate.interval.map_or_else(
            || {
                if found.leaves_noise() {
                    "not determined by the data"
                } else {
                    "no interval: what is left is no noise"
                }
                .to_owned()
            },
            |[lower, upper]| format!("95 %: {lower:.6e} to {upper:.6e}"),
        );
        format!("# [{unit}] {interval}\n{} = {:?}\n", info.name, estimate.value)
    };
    found.estimates.iter().map(line).collect()
}
