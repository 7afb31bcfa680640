//! What came of the cases as one table: text, JSON and a page.
//!
//! In: rows of case, integrator, tolerance and outcome; sheets of other measurements. Out: text. The page is one file
//! that needs nothing from elsewhere: a table of verdicts for each case, integrators down, tolerances across, then the
//! sheets.

use std::fmt::Write;

use serde_json::{Value, json};

use super::case::{Case, Outcome, Verdict};
use super::sheet::{Sheet, aligned, escaped};

/// One run.
pub struct Row {
    /// The case.
    pub case: &'static str,
    /// The integrator.
    pub integrator: String,
    /// The relative tolerance; a fixed-step method's steps are chosen by it.
    pub tolerance: f64,
    /// The result.
    pub outcome: Outcome,
    /// The time it took, s.
    pub seconds: f64,
}

const HEAD: [&str; 13] = [
    "case",
    "integrator",
    "rtol",
    "verdict",
    "error",
    "between",
    "steps",
    "rejected",
    "rates",
    "orders",
    "Jacobians",
    "LU",
    "ms",
];

fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.1e}") } else { "-".to_owned() }
}

fn cells(row: &Row) -> [String; HEAD.len()] {
    let Outcome { error, between, is_wrong_between, statistics, verdict } = &row.outcome;
    [
        row.case.to_owned(),
        row.integrator.clone(),
        format!("{:e}", row.tolerance),
        verdict.word().to_owned(),
        number(*error),
        number(*between) + if *is_wrong_between { "!" } else { "" },
        statistics.steps.to_string(),
        statistics.rejected.to_string(),
        statistics.rate_evaluations.to_string(),
        statistics.series_orders.to_string(),
        statistics.jacobian_evaluations.to_string(),
        statistics.factorisations.to_string(),
        format!("{:.1}", 1e3 * row.seconds),
    ]
}

/// The rows as a table of text, with a `!` after a wrong error of the dense output, and the errors that ended runs
/// below it.
#[must_use]
pub fn table(rows: &[Row]) -> String {
    let lines: Vec<Vec<String>> =
        std::iter::once(HEAD.map(str::to_owned)).chain(rows.iter().map(cells)).map(Vec::from).collect();
    let mut text = aligned(&lines, 4);
    for row in rows {
        if let Verdict::Failed(message) = &row.outcome.verdict {
            writeln!(text, "{} by {} at {:e}: {message}", row.case, row.integrator, row.tolerance).expect("a string");
        }
    }
    text
}

/// The cases, the rows and the sheets as JSON. Not-a-number is null.
#[must_use]
pub fn json(cases: &[Case], rows: &[Row], sheets: &[Sheet]) -> String {
    let cases: Vec<Value> = cases.iter().map(about).collect();
    let rows: Vec<Value> = rows.iter().map(entry).collect();
    let sheets: Vec<Value> = sheets.iter().map(Sheet::json).collect();
    format!("{:#}\n", json!({ "cases": cases, "runs": rows, "sheets": sheets }))
}

fn about(case: &Case) -> Value {
    json!({
        "name": case.name,
        "source": case.source,
        "held_against": case.held_against,
        "measure": format!("{:?}", case.measure).to_lowercase(),
        "states": case.problem.states(),
        "t_end": case.end(),
        "absolute_over_relative": case.absolute,
        "amplification": case.amplification,
        "floor": case.floor,
        "fitting": case.fitting,
    })
}

fn entry(row: &Row) -> Value {
    let Outcome { error, between, is_wrong_between, statistics, verdict } = &row.outcome;
    let failure = if let Verdict::Failed(message) = verdict { Some(message) } else { None };
    json!({
        "case": row.case,
        "integrator": row.integrator,
        "rtol": row.tolerance,
        "verdict": verdict.word(),
        "failure": failure,
        "error": error,
        "error_between": between,
        "is_wrong_between": is_wrong_between,
        "steps": statistics.steps,
        "rejected": statistics.rejected,
        "rates": statistics.rate_evaluations,
        "series_orders": statistics.series_orders,
        "jacobians": statistics.jacobian_evaluations,
        "factorisations": statistics.factorisations,
        "pivoted": statistics.pivoted_factorisations,
        "seconds": row.seconds,
    })
}

/// The page's colours and layout; light and dark as the reader prefers.
const STYLE: &str = "
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1f2328; --pencil: #59636e; --line: #d1d9e0;
  --good: #1a7f37; --fair: #9a6700; --bad: #cf222e; }
@media (prefers-color-scheme: dark) { :root { --paper: #0d1117; --ink: #e6edf3; --pencil: #9198a1; --line: #3d444d;
  --good: #3fb950; --fair: #d29922; --bad: #f85149; } }
body { margin: 0 auto; padding: 2rem 1.5rem 4rem; max-width: 1100px; background: var(--paper); color: var(--ink);
  font: 15px/1.45 system-ui, sans-serif; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .2rem; }
p { color: var(--pencil); margin: .2rem 0 .6rem; max-width: 90ch; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; width: 100%; }
th, td { text-align: left; padding: .25rem .8rem .25rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--pencil); font-weight: 500; }
small { display: block; color: var(--pencil); }
.reached { color: var(--good); } .missed, .too-costly, .too-loose, .unchecked { color: var(--fair); \
} .failed { color: var(--pencil); }
.wrong { color: var(--bad); font-weight: 700; }
";

/// The page.
#[must_use]
pub fn page(cases: &[Case], rows: &[Row], tolerances: &[f64], sheets: &[Sheet]) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Hard cases</title>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<h1>Hard cases</h1>\n<p>Each integrator on each case: verdict, error at the end, attempted steps and \
         rates. Reached: the error is within 100 times the tolerance, times the case's amplification; \
         wrong: above 1000 times, without an error being reported. Fixed-step methods have no tolerance and are not \
         judged.</p>\n"
    );
    for case in cases {
        section(&mut page, case, rows, tolerances);
    }
    sheets.iter().for_each(|sheet| page += &sheet.html());
    page + "</body>\n</html>\n"
}

fn section(page: &mut String, case: &Case, rows: &[Row], tolerances: &[f64]) {
    let mut put = |text: std::fmt::Arguments| page.write_fmt(text).expect("a string");
    put(format_args!(
        "<h2>{}</h2>\n<p>{}. {} states to t = {:e} s; {:?} error against: {}. Amplification \
        {:e}.</p>\n<table>\n<tr><th></th>",
        case.name,
        escaped(case.source),
        case.problem.states(),
        case.end(),
        case.measure,
        escaped(case.held_against),
        case.amplification
    ));
    tolerances.iter().for_each(|tolerance| put(format_args!("<th>{tolerance:e}</th>")));
    put(format_args!("</tr>\n"));
    let of_case: Vec<&Row> = rows.iter().filter(|row| row.case == case.name).collect();
    for line in of_case.chunks(tolerances.len()) {
        put(format_args!("<tr><th>{}</th>", line[0].integrator));
        line.iter().for_each(|row| put(format_args!("{}", cell(row))));
        put(format_args!("</tr>\n"));
    }
    put(format_args!("</table>\n"));
}

fn cell(row: &Row) -> String {
    let Outcome { error, statistics, verdict, .. } = &row.outcome;
    let word = verdict.word();
    let class = word.to_lowercase().replace(' ', "-");
    let title = if let Verdict::Failed(message) = verdict { escaped(message) } else { String::new() };
    let attempts = statistics.steps + statistics.rejected;
    format!(
        "<td class=\"{class}\" title=\"{title}\">{word}<small>{}, {attempts} steps, {} rates</small></td>",
        number(*error),
        statistics.rate_evaluations
    )
}
