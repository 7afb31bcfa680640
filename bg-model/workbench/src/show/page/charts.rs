//! The charts of the page: which outputs stand in one, and the energy balance.
//!
//! In: a model's outputs and a run. Out: charts of its columns. The components of a vector or a matrix are a chart, as
//! they are a figure of the run; scalars of one unit stand together where one scale shows them all.

use bg_model::description::{Description, OutputInfo};
use bg_model::simulation::Recording;

use crate::run::quantities::{extent, quantities, set_unit};

/// Curves of one unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chart<'a> {
    /// What the curves are components of; empty where each is a quantity of its own.
    pub title: String,
    /// The unit, as it is set in print; empty of a pure number.
    pub unit: String,
    /// For each curve its name here and the column of the run.
    pub curves: Vec<(String, &'a str)>,
}

/// Scalars whose spans differ by more than this factor get charts of their own.
const SCALE: f64 = 20.0;
/// The most scalars in a chart.
const MOST: usize = 4;

/// The charts of all outputs, in the order of the outputs; matrices after all others.
pub fn charts(description: &'static Description, run: &Recording) -> Vec<Chart<'static>> {
    let mut charts: Vec<(Chart, f64)> = Vec::new();
    for quantity in quantities(description) {
        let quantity: Vec<&'static OutputInfo> = quantity.iter().filter(|output| run.has(output.name)).collect();
        let Some(first) = quantity.first() else { continue };
        let span = span(run, first.name);
        let fits = |(chart, of_chart): &&mut (Chart, f64)| {
            let is_near = (span / *of_chart).max(*of_chart / span) < SCALE;
            quantity.len() == 1 && chart.title.is_empty() && chart.curves.len() < MOST && is_near
        };
        let unit = unit(first.unit);
        match charts.iter_mut().filter(|(chart, _)| chart.unit == unit).find(fits) {
            Some((chart, of_chart)) => {
                chart.curves.push((first.name.to_owned(), first.name));
                *of_chart = of_chart.max(span);
            }
            None => charts.push((of_quantity(&quantity, unit), span)),
        }
    }
    let mut charts: Vec<Chart<'_>> = charts.into_iter().map(|(chart, _)| chart).collect();
    charts.sort_by_key(|chart| chart.curves.len() > MOST);
    charts
}

fn of_quantity(quantity: &[&'static OutputInfo], unit: String) -> Chart<'static> {
    let component = |output: &OutputInfo| match output.name.strip_prefix(output.of) {
        Some(rest) if quantity.len() > 1 => rest.trim_start_matches('_').to_owned(),
        _ => output.name.to_owned(),
    };
    let title = if quantity.len() > 1 { quantity[0].of.to_owned() } else { String::new() };
    Chart { title, unit, curves: quantity.iter().map(|output| (component(output), output.name)).collect() }
}

/// The unit as it is set in print.
pub fn unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { set_unit(unit) }
}

/// How far apart the least and the largest value of a column are.
fn span(run: &Recording, column: &str) -> f64 {
    let range = extent(run.column(column).unwrap_or_default().iter().copied());
    (range.end - range.start).max(f64::MIN_POSITIVE)
}

/// Energies over a run, all from zero at its start, J, one value a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// What is stored more than at the start.
    pub stored: Vec<f64>,
    /// What sources have supplied.
    pub supplied: Vec<f64>,
    /// What is dissipated; empty where no output says it.
    pub dissipated: Vec<f64>,
    /// Supplied less stored less dissipated: zero but for errors where all three are known.
    pub rest: Vec<f64>,
}

impl Balance {
    /// The balance of a run, where it has outputs in J that are called `stored..`, `supplied..` and perhaps
    /// `dissipated..` or `lost..`.
    pub fn of(description: &Description, run: &Recording) -> Option<Self> {
        let called = |names: &[&str]| {
            let is_it = |output: &&OutputInfo| {
                output.unit == "J" && output.name == output.of && names.iter().any(|name| output.name.starts_with(name))
            };
            let column = run.column(description.outputs.iter().find(is_it)?.name)?;
            let first = *column.first()?;
            Some(column.iter().map(|value| value - first).collect::<Vec<f64>>())
        };
        let (stored, supplied) = (called(&["stored"])?, called(&["supplied"])?);
        let dissipated = called(&["dissipated", "lost"]).unwrap_or_default();
        let lost = |k: usize| dissipated.get(k).copied().unwrap_or(0.0);
        let rest = supplied.iter().zip(&stored).enumerate().map(|(k, (supplied, stored))| supplied - stored - lost(k));
        let rest = rest.collect();
        Some(Self { stored, supplied, dissipated, rest })
    }

    /// What the balance says, in a sentence.
    pub fn sentence(&self) -> String {
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let moved = [&self.stored, &self.supplied, &self.dissipated].map(|values| most(values));
        let (moved, rest) = (moved.into_iter().fold(0.0, f64::max), most(&self.rest));
        let share = if moved > 0.0 { rest / moved } else { 0.0 };
        if self.dissipated.is_empty() {
            return format!(
                "Supplied less stored is {rest:.2e} J at most, {share:.1e} of the largest energy: what is dissipated, \
                 which no output says, and the error of the integration."
            );
        }
        format!(
            "Supplied less stored less dissipated is {rest:.2e} J at most, {share:.1e} of the largest energy: the \
             error of the integration."
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bg_model::simulation::Column;
    use std::sync::LazyLock;

    const fn output(name: &'static str, of: &'static str, unit: &'static str) -> OutputInfo {
        OutputInfo { name, of, observes: of, unit }
    }

    static OUTPUTS: [OutputInfo; 9] = [
        output("force", "force", "N"),
        output("at_x", "at", "m"),
        output("at_y", "at", "m"),
        output("stored", "stored", "J"),
        output("drag", "drag", "N"),
        output("noise", "noise", "N"),
        output("supplied", "supplied", "J"),
        output("ratio", "ratio", "1"),
        output("lost", "lost", "J"),
    ];

    fn description() -> &'static Description {
        static DESCRIPTION: LazyLock<Description> =
            LazyLock::new(|| Description { name: "Test", outputs: &OUTPUTS, ..Description::default() });
        &DESCRIPTION
    }

    fn run() -> Recording {
        let ends = [
            (0.0, 100.0),
            (0.0, 1.0),
            (0.0, 1.0),
            (5.0, 8.0),
            (0.0, -40.0),
            (0.0, 0.1),
            (1.0, 6.0),
            (1.0, 2.0),
            (0.0, 1.5),
        ];
        let columns = OUTPUTS.iter().zip(ends);
        let columns =
            columns.map(|(output, (a, b))| Column { values: vec![a, b], ..Column::new(output.name, output.unit) });
        Recording { times: vec![0.0, 1.0], columns: columns.collect(), events: Vec::new() }
    }

    #[test]
    fn scalars_of_one_unit_and_scale_stand_together() {
        let charts = charts(description(), &run());
        let told: Vec<(&str, &str, String)> = charts
            .iter()
            .map(|chart| {
                let names: Vec<&str> = chart.curves.iter().map(|(name, _)| name.as_str()).collect();
                (chart.title.as_str(), chart.unit.as_str(), names.join(" "))
            })
            .collect();
        let expected = [
            ("", "N", "force drag"),
            ("at", "m", "x y"),
            ("", "J", "stored supplied lost"),
            ("", "N", "noise"),
            ("", "", "ratio"),
        ];
        assert_eq!(told, expected.map(|(title, unit, names)| (title, unit, names.to_owned())));
    }

    #[test]
    fn the_balance_counts_from_the_start() {
        let balance = Balance::of(description(), &run()).unwrap();
        assert_eq!((balance.stored[1], balance.supplied[1], balance.dissipated[1]), (3.0, 5.0, 1.5));
        assert_eq!(balance.rest, [0.0, 0.5]);
        assert!(
            balance.sentence().contains("5.00e-1 J at most, 1.0e-1 of the largest energy"),
            "{}",
            balance.sentence()
        );
    }
}
