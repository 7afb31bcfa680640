//! What the page sets, as its script reads it: the first run's order, and the parameters that can be tuned.

use serde::Serialize;

use super::charts::unit;
use super::report::Report;
use crate::ask::parameters::one_line;
use crate::show::page::order::Order;

#[derive(Serialize)]
struct Settings<'a> {
    order: &'a Order,
    parameters: Vec<Tunable<'a>>,
}

/// A parameter that can be tuned. The script gives it a slider.
#[derive(Serialize)]
struct Tunable<'a> {
    name: &'a str,
    unit: String,
    meaning: String,
    default: f64,
    value: f64,
    /// The ends of what is allowed; `null` where there is none.
    lower: Option<f64>,
    upper: Option<f64>,
    /// Whether the ends themselves are allowed.
    includes: [bool; 2],
}

/// JSON in which nothing ends the `<script>` that it stands in: the order, and those of the report's parameters that
/// its scene leaves tunable.
pub fn json(order: &Order, report: &Report<'_>) -> String {
    let is_tunable = |name: &str| report.description.parameters.iter().any(|info| info.name == name);
    let tunable = report.parameters.iter().filter(|parameter| is_tunable(parameter.info.name));
    let parameters = tunable.map(|parameter| {
        let info = &parameter.info;
        let range = &info.range;
        Tunable {
            name: info.name,
            unit: unit(info.unit),
            meaning: one_line(info.doc),
            default: info.default,
            value: parameter.value,
            lower: Some(range.lower).filter(|end| end.is_finite()),
            upper: Some(range.upper).filter(|end| end.is_finite()),
            includes: [range.lower_included, range.upper_included],
        }
    });
    let settings = Settings { order, parameters: parameters.collect() };
    serde_json::to_string(&settings).expect("settings have text keys only").replace('<', "\\u003c")
}
