//! The tables: the least time for an error, all points as Markdown and as CSV.

use crate::measure::{Point, Series};
use crate::solvers::Setting;

/// The errors of the summary's columns, m or rad.
pub const ERRORS: [f64; 6] = [1e-3, 1e-6, 3e-7, 1e-8, 1e-10, 1e-12];

/// The fastest point of a series whose error is at most `error`.
pub fn fastest(series: &Series, error: f64) -> Option<&Point> {
    series.points.iter().filter(|point| point.error <= error).min_by(|a, b| a.least().total_cmp(&b.least()))
}

/// One row for each solver: the least time, ms, with which it gets below each error, and the error it then has.
pub fn summary(series: &[Series]) -> String {
    let mut head = vec!["solver".to_owned(), "switches".to_owned(), "smallest error".to_owned()];
    head.extend(ERRORS.iter().map(|error| format!("{error:.0e}")));
    let mut rows = vec![head];
    for series in series {
        let mut row =
            vec![series.line.name.clone(), switches(series).to_owned(), format!("{:.0e}", smallest_error(series))];
        row.extend(ERRORS.iter().map(|&error| match fastest(series, error) {
            Some(point) => format!("{:.1} ({:.0e})", point.least(), point.error),
            None => "–".to_owned(),
        }));
        rows.push(row);
    }
    let faults =
        series.iter().flat_map(|series| series.faults.iter().map(|fault| format!("{} {fault}", series.line.name)));
    let faults: Vec<String> = faults.collect();
    let faults = if faults.is_empty() { String::new() } else { format!("\nFailed: {}.\n", faults.join("; ")) };
    format!(
        "Least time, ms, for 5 s with an error of at most .. (and the error then), m or rad:\n\n{}{faults}",
        markdown(&rows)
    )
}

/// Every point, as Markdown.
pub fn points(series: &[Series]) -> String {
    let head = ["solver", "setting", "error", "ms least", "ms median", "steps", "rejected", "rates", "events"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for series in series {
        rows.extend(series.points.iter().map(|point| row(series, point)));
    }
    markdown(&rows)
}

/// Every point, as CSV.
pub fn csv(series: &[Series]) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head = [
        "solver",
        "locates_events",
        "setting",
        "value",
        "error",
        "ms_least",
        "ms_median",
        "runs",
        "compile_s",
        "steps",
        "rejected",
        "rates",
        "events",
    ];
    let text = |value: Option<u64>| value.map(|value| value.to_string()).unwrap_or_default();
    let mut records = vec![head.map(str::to_owned)];
    for series in series {
        for point in &series.points {
            let work = point.work;
            records.push([
                series.line.name.clone(),
                series.line.locates_events.to_string(),
                setting(series).to_owned(),
                format!("{:e}", point.setting),
                format!("{:e}", point.error),
                point.least().to_string(),
                point.median().to_string(),
                point.times.len().to_string(),
                point.compiled.map(|time| time.to_string()).unwrap_or_default(),
                text(work.steps),
                text(work.rejected),
                text(work.rates),
                text(work.events),
            ]);
        }
    }
    for record in records {
        writer.write_record(record).map_err(|fault| fault.to_string())?;
    }
    String::from_utf8(writer.into_inner().map_err(|fault| fault.to_string())?).map_err(|fault| fault.to_string())
}

fn row(series: &Series, point: &Point) -> Vec<String> {
    let count = |value: Option<u64>| value.map_or("–".to_owned(), |value| value.to_string());
    let events = if series.line.locates_events { count(point.work.events) } else { "not located".to_owned() };
    vec![
        series.line.name.clone(),
        format!("{} {:e}", setting(series), point.setting),
        format!("{:.2e}", point.error),
        format!("{:.2}", point.least()),
        format!("{:.2}", point.median()),
        count(point.work.steps),
        count(point.work.rejected),
        count(point.work.rates),
        events,
    ]
}

/// The smallest error that a solver reaches at any of its settings: whether it converges to the same motion.
fn smallest_error(series: &Series) -> f64 {
    series.points.iter().map(|point| point.error).fold(f64::INFINITY, f64::min)
}

fn switches(series: &Series) -> &'static str {
    if series.line.locates_events { "located" } else { "in the rate" }
}

fn setting(series: &Series) -> &'static str {
    match series.line.setting {
        Setting::Tolerance => "rtol",
        Setting::Step => "step",
    }
}

/// Rows as a Markdown table, the first one its head.
fn markdown(rows: &[Vec<String>]) -> String {
    let line = |row: &Vec<String>| format!("| {} |\n", row.join(" | "));
    let rule = format!("|{}\n", "---|".repeat(rows[0].len()));
    let body: String = rows[1..].iter().map(line).collect();
    format!("{}{rule}{body}", line(&rows[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solvers::{Line, Source, Work};

    #[test]
    fn the_fastest_point_need_not_be_the_coarsest() {
        let point = |setting, error, time| Point {
            setting,
            error,
            times: vec![9.0, time],
            compiled: None,
            work: Work::default(),
        };
        let line =
            Line { name: "a".to_owned(), source: Source::Ours, locates_events: true, setting: Setting::Tolerance };
        let points =
            vec![point(1e-3, 1e-2, 1.0), point(1e-4, 1e-5, 4.0), point(1e-5, 1e-6, 3.0), point(1e-6, f64::NAN, 2.0)];
        let series = Series { line, points, faults: Vec::new() };
        assert_eq!(fastest(&series, 1e-4).map(|point| point.setting), Some(1e-5));
        assert_eq!(fastest(&series, 1e-1).map(|point| point.setting), Some(1e-3));
        assert!(fastest(&series, 1e-7).is_none());
        assert_eq!(smallest_error(&series), 1e-6);
    }
}
