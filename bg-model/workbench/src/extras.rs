//! What a program adds to the workbench: figures, numbers, checks, texts of its own.
//!
//! In: a run. Out: what is drawn and said of it. By default every output gets a figure and a line.

use bg_model::description::Description;
use bg_model::simulation::{Column, MissingColumn, Recording};
use serde_json::json;

#[cfg(not(target_arch = "wasm32"))]
use crate::figures::{Figure, outputs};
use crate::summary::{Additions, Entry, short};

/// What a program adds to the workbench. Every method has a default that serves any mechanism.
pub trait Extras {
    /// The figures of a run of this model; `None` where it gets no figures and no overview page. Not in WebAssembly: a
    /// page draws no figures.
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

    /// The texts of the overview page.
    fn page(&self, model: &'static Description) -> Page {
        Page {
            title: model.name.to_owned(),
            introduction: model.doc.split_whitespace().collect::<Vec<_>>().join(" "),
            gallery: "Outputs".to_owned(),
            about_gallery: String::new(),
        }
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

/// The texts of the overview page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// Its title.
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
    let mut lines: Vec<(String, String)> = run.columns.iter().take(MOST).map(line).collect();
    if run.columns.len() > MOST {
        lines.push(("more outputs".to_owned(), format!("{} in the CSV file", run.columns.len() - MOST)));
    }
    let outputs = run.columns.iter().map(|column| {
        let [start, end, least, largest] = ends(&column.values);
        let numbers = json!({ "unit": column.unit, "start": start, "end": end, "least": least, "largest": largest });
        (column.name.clone(), numbers)
    });
    let value = serde_json::Value::Object(outputs.collect());
    Additions { lines, entries: vec![Entry { key: "outputs", value }], ..Additions::default() }
}

fn line(column: &Column) -> (String, String) {
    let [start, end, least, largest] = ends(&column.values).map(short);
    let unit = if column.unit == "1" { "" } else { &column.unit };
    let text = format!("{start} to {end}, between {least} and {largest} {unit}");
    (column.name.clone(), text.trim_end().to_owned())
}

/// The first and the last value, the least and the largest; not a number of a run without samples.
fn ends(values: &[f64]) -> [f64; 4] {
    let of = |value: Option<&f64>| value.copied().unwrap_or(f64::NAN);
    let fold = |choose: fn(f64, f64) -> f64| values.iter().copied().reduce(choose).unwrap_or(f64::NAN);
    [of(values.first()), of(values.last()), fold(f64::min), fold(f64::max)]
}
