//! The gradient of one number of a run, by a run followed backwards.
//!
//! In: the number and its derivatives. Out: the same as a table and as CSV.

use bg_model::description::ParameterInfo;

use crate::files::table::table;
use crate::studies::sensitivity::quotient;

/// The derivative by one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Slope {
    /// The parameter.
    pub parameter: &'static ParameterInfo,
    /// Its value, in its unit.
    pub at: f64,
    /// The derivative, in the number's unit per the parameter's.
    pub derivative: f64,
}

/// The table of a gradient: the parameters with an influence, the largest for a part of the parameter first. `value` is
/// the number, in `unit`.
#[must_use]
pub fn text(value: f64, unit: &str, slopes: &[Slope]) -> String {
    let mut sorted: Vec<&Slope> = slopes.iter().filter(|slope| slope.derivative != 0.0).collect();
    sorted.sort_by(|a, b| (b.derivative * b.at).abs().total_cmp(&(a.derivative * a.at).abs()));
    let row = |slope: &&Slope| {
        let relative = slope.derivative * slope.at / value;
        [
            slope.parameter.name.to_owned(),
            format!("{:.6e}", slope.derivative),
            quotient(unit, slope.parameter.unit),
            if relative.is_finite() { format!("{relative:.4}") } else { "-".to_owned() },
        ]
    };
    let head = ["parameter", "derivative", "unit", "% for 1 %"].map(str::to_owned);
    table(&std::iter::once(head).chain(sorted.iter().map(row)).collect::<Vec<_>>())
}

/// All derivatives as CSV, and whole numbers of digits.
#[must_use]
pub fn csv(value: f64, unit: &str, slopes: &[Slope]) -> String {
    let mut text = "value,unit,parameter,parameter_unit,parameter_value,derivative\n".to_owned();
    for Slope { parameter, at, derivative } in slopes {
        text += &format!("{value:?},{unit},{},{},{at:?},{derivative:?}\n", parameter.name, parameter.unit);
    }
    text
}
