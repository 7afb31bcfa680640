//! What a program adds to the workbench: figures, numbers, checks, texts of its own.
//!
//! In: a run. Out: what is drawn and said of it. By default every output gets a figure and a line.

use bg_model::description::Description;
use bg_model::simulation::{Column, MissingColumn, Peak, Peaks, Recording};
use serde_json::json;

use crate::run::summary::{Additions, Entry, short};
#[cfg(not(target_arch = "wasm32"))]
use crate::show::figures::{Figure, outputs};

/// What a program adds to the workbench. Every method has a default that serves any mechanism.
pub trait Extras {
    /// The figures of a run of this model; `None` where it gets no figures. Not in WebAssembly: a page draws no
    /// figures.
    #[cfg(not(target_arch = "wasm32"))]
    fn figures(&self, model: &'static Description) -> Option<Vec<Figure>> {
        Some(outputs::figures(model))
    }

    /// What the summary says beside what it says of every run.
    ///
    /// # Errors
    /// A column is missing.
    fn additions(&self, run: &Recording) -> Result<Additions, MissingColumn> {
        Ok(of_outputs(run))
    }

    /// The columns of the CSV file after `t`; `None` for all.
    fn columns(&self, _run: &Recording) -> Option<Vec<String>> {
        None
    }

    /// Where the value of the parameter called `name` is from, such as `paper` or `assumed`; empty where nothing is
    /// said.
    fn source(&self, _name: &str) -> &'static str {
        ""
    }

    /// The texts of the page of this model of a graph with this name.
    fn page(&self, graph: &str, model: &'static Description) -> Page {
        Page {
            title: graph.to_owned(),
            introduction: model.doc.split_whitespace().collect::<Vec<_>>().join(" "),
            gallery: "Outputs".to_owned(),
            about_gallery: String::new(),
        }
    }

    /// The instant, s, from which on a start does not count any more: from there on the peaks of the outputs are known
    /// as well ([`Column::settled`]); `None` where that is not asked for.
    fn settled(&self) -> Option<f64> {
        None
    }

    /// The interval of the samples that figures and summary are made from, s, of a run until `t_end` (s); those of the
    /// CSV file come on top.
    fn finest(&self, t_end: f64) -> f64 {
        t_end / 2500.0
    }
}

/// No additions.
#[derive(Clone, Copy, Debug)]
pub struct Plain;

impl Extras for Plain {}

/// The texts of the page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Its title, of the mechanism; the page adds the name of the scene.
    pub title: String,
    /// What stands below it.
    pub introduction: String,
    /// The heading of the figures.
    pub gallery: String,
    /// What stands below that; may be empty.
    pub about_gallery: String,
}

/// The most outputs that get a line; the others are in the JSON and the CSV file.
const MOST: usize = 24;

/// A line for each output: where it starts and ends, and between what it was.
fn of_outputs(run: &Recording) -> Additions {
    let mut lines: Vec<(String, String)> = run.columns.iter().take(MOST).map(|column| line(run, column)).collect();
    if run.columns.len() > MOST {
        lines.push(("more outputs".to_owned(), format!("{} in the CSV file", run.columns.len() - MOST)));
    }
    let outputs = run.columns.iter().map(|column| {
        let [start, end] = ends(&column.values);
        let Peaks { least, largest } = peaks(run, column);
        let numbers = json!({
            "unit": column.unit, "start": start, "end": end,
            "least": least.value, "least_at_s": least.t, "largest": largest.value, "largest_at_s": largest.t,
        });
        (column.name.clone(), numbers)
    });
    let value = serde_json::Value::Object(outputs.collect());
    Additions { lines, entries: vec![Entry { key: "outputs", value }], ..Additions::default() }
}

fn line(run: &Recording, column: &Column) -> (String, String) {
    let Peaks { least, largest } = peaks(run, column);
    let [start, end] = ends(&column.values).map(short);
    let [least, largest] = [least, largest].map(|peak| short(peak.value));
    let unit = if column.unit == "1" { "" } else { &column.unit };
    let text = format!("{start} to {end}, between {least} and {largest} {unit}");
    (column.name.clone(), text.trim_end().to_owned())
}

/// The first and the last value; not a number of a run without samples.
fn ends(values: &[f64]) -> [f64; 2] {
    [values.first(), values.last()].map(|value| value.copied().unwrap_or(f64::NAN))
}

/// The peaks of a column of a run; those of its samples where no others are known, not a number where there are none.
pub fn peaks(run: &Recording, column: &Column) -> Peaks {
    column.peaks.or_else(|| Peaks::of_samples(&run.times, &column.values)).unwrap_or_else(|| {
        let none = Peak { t: f64::NAN, value: f64::NAN };
        Peaks { least: none, largest: none }
    })
}
