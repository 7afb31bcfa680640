//! How results name the inputs of a run.
//!
//! In: what the inputs are set to, and over which time the run is. Out: a value with its unit, or a file with its
//! CRC-32, for each; the inputs that were not given; what is held where a run goes beyond the rows of a table.

use bg_model::description::InputInfo;
use serde::Serialize;

use super::{Setting, Source};
use crate::ask::parameters::number;

/// An input as results name it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Named {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Whether it was given; else it is 0.
    pub is_given: bool,
    /// Its value, where that is the same at all times. It has neither this nor a table where a function gives it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// The table that it follows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<NamedTable>,
}

/// The table that an input follows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedTable {
    /// The file that it is from.
    #[serde(flatten)]
    pub source: Option<Source>,
    /// Whether a cubic spline joins the rows; else straight lines.
    pub cubic: bool,
    /// How many rows there are.
    pub rows: usize,
    /// Time (s) and value of the first row; the value holds before it.
    pub first: [f64; 2],
    /// Time (s) and value of the last row; the value holds after it.
    pub last: [f64; 2],
}

/// The inputs that a model declares as `infos`, set so; those that are missing were not given.
#[must_use]
pub fn named(settings: &[Setting], infos: &[InputInfo]) -> Vec<Named> {
    let of = |(index, info): (usize, &InputInfo)| one(settings.get(index).unwrap_or(&Setting::NotGiven), info);
    infos.iter().enumerate().map(of).collect()
}

fn one(setting: &Setting, info: &InputInfo) -> Named {
    let (value, table) = match setting {
        Setting::NotGiven => (Some(0.0), None),
        Setting::Constant(value) => (Some(*value), None),
        Setting::Function(_) => (None, None),
        Setting::Table { times, values, cubic, source } => (None, table(times, values, *cubic, source.as_ref())),
    };
    Named { name: info.name, unit: info.unit, is_given: *setting != Setting::NotGiven, value, table }
}

fn table(times: &[f64], values: &[f64], cubic: bool, source: Option<&Source>) -> Option<NamedTable> {
    let first = [*times.first()?, *values.first()?];
    let last = [*times.last()?, *values.last()?];
    Some(NamedTable { source: source.cloned(), cubic, rows: times.len(), first, last })
}

/// Names and texts of what is to be said of the inputs of a run from `span[0]` to `span[1]` (s).
#[must_use]
pub fn lines(inputs: &[Named], span: [f64; 2]) -> Vec<(&'static str, String)> {
    let given = inputs.iter().filter_map(|input| Some(("input", input.sentence()?)));
    let mut lines: Vec<(&str, String)> = given.collect();
    lines.extend(inputs.iter().filter_map(|input| Some(("input held", input.held(span)?))));
    let missing: Vec<&str> = inputs.iter().filter(|input| !input.is_given).map(|input| input.name).collect();
    if !missing.is_empty() {
        let are = if missing.len() == 1 { "is 0; set it" } else { "are 0; set them" };
        let text = format!("{} {are} with --input NAME=VALUE or NAME=FILE.csv", missing.join(", "));
        lines.push(("inputs not given", text));
    }
    lines
}

/// The same as lines of a text, after an empty one; nothing of a model without inputs.
#[must_use]
pub fn text(inputs: &[Named], span: [f64; 2]) -> String {
    let lines = lines(inputs, span).into_iter().map(|(name, text)| format!("{name}: {text}\n"));
    let text: String = lines.collect();
    if text.is_empty() { text } else { format!("\n{text}") }
}

impl Named {
    /// What it is set to; nothing where it was not given.
    fn sentence(&self) -> Option<String> {
        let what = || match (&self.table, self.value) {
            (Some(table), _) => table.sentence(),
            (None, Some(value)) => self.quantity(value),
            (None, None) => "a function of time".to_owned(),
        };
        self.is_given.then(|| format!("{} = {}", self.name, what()))
    }

    /// What a table holds in the parts of a run that are outside its rows; nothing where there are none.
    fn held(&self, [start, end]: [f64; 2]) -> Option<String> {
        let NamedTable { first, last, .. } = self.table.as_ref()?;
        let part = |is_outside: bool, [t, value]: &[f64; 2], place: &str| {
            is_outside.then(|| format!("{} {place} at {} s", self.quantity(*value), number(*t)))
        };
        let before = part(start < first[0], first, "before the first row");
        let after = part(end > last[0], last, "after the last row");
        let parts: Vec<String> = before.into_iter().chain(after).collect();
        (!parts.is_empty()).then(|| format!("{} = {}", self.name, parts.join(", ")))
    }

    fn quantity(&self, value: f64) -> String {
        format!("{} {}", number(value), self.unit).trim_end().to_owned()
    }
}

impl NamedTable {
    fn sentence(&self) -> String {
        let Self { source, cubic, rows, first, last } = self;
        let spline = if *cubic { ", a cubic spline" } else { "" };
        let rows = format!("{rows} rows from {} to {} s{spline}", number(first[0]), number(last[0]));
        match source {
            None => format!("a table: {rows}"),
            Some(Source { file, column, crc32 }) => {
                let column = column.as_ref().map_or_else(String::new, |column| format!(", column `{column}`"));
                format!("{file}{column}: {rows}, CRC-32 {crc32}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Function;
    use super::*;

    const INFOS: [InputInfo; 3] = [
        InputInfo { name: "force", unit: "N", doc: "" },
        InputInfo { name: "torque", unit: "N*m", doc: "" },
        InputInfo { name: "share", unit: "", doc: "" },
    ];

    fn table(source: Option<Source>) -> Setting {
        Setting::Table { times: vec![0.5, 1.0, 2.0], values: vec![3.0, 4.0, -9.0], cubic: source.is_none(), source }
    }

    #[test]
    fn each_input_is_named_with_value_or_file_and_what_was_not_given_as_such() {
        let source = Source { file: "load.csv".to_owned(), column: Some("b".to_owned()), crc32: "0a1b2c3d".to_owned() };
        let inputs = named(&[Setting::Constant(0.0), table(Some(source))], &INFOS);
        let told = text(&inputs, [0.5, 2.0]);
        let expected = "\ninput: force = 0 N\n\
                        input: torque = load.csv, column `b`: 3 rows from 0.5 to 2 s, CRC-32 0a1b2c3d\n\
                        inputs not given: share is 0; set it with --input NAME=VALUE or NAME=FILE.csv\n";
        assert_eq!(told, expected);
        let json = serde_json::to_value(&inputs).unwrap();
        assert_eq!(json[0], serde_json::json!({ "name": "force", "unit": "N", "is_given": true, "value": 0.0 }));
        assert_eq!((&json[1]["table"]["file"], &json[1]["table"]["crc32"]), (&"load.csv".into(), &"0a1b2c3d".into()));
        assert_eq!((&json[2]["is_given"], &json[2]["value"]), (&false.into(), &0.0.into()));
        assert_eq!(text(&[], [0.0, 1.0]), "");
        let wave = named(&[Setting::Function(Function::new(f64::sin))], &INFOS[..1]);
        assert_eq!(text(&wave, [0.0, 1.0]), "\ninput: force = a function of time\n");
    }

    #[test]
    fn what_is_held_is_said_where_a_run_goes_beyond_the_rows_and_only_there() {
        let inputs = named(&[table(None)], &INFOS[..1]);
        let held = |span| inputs[0].held(span);
        assert_eq!(held([0.5, 2.0]), None);
        assert_eq!(held([0.0, 2.0]).unwrap(), "force = 3 N before the first row at 0.5 s");
        assert_eq!(held([1.0, 2.5]).unwrap(), "force = -9 N after the last row at 2 s");
        let both = "force = 3 N before the first row at 0.5 s, -9 N after the last row at 2 s";
        assert_eq!(held([0.0, 5.0]).unwrap(), both);
        assert_eq!(inputs[0].sentence().unwrap(), "force = a table: 3 rows from 0.5 to 2 s, a cubic spline");
    }

    #[test]
    fn a_setting_reads_back_from_json() {
        let source = Source { file: "load.csv".to_owned(), column: None, crc32: String::new() };
        for setting in [Setting::NotGiven, Setting::Constant(2.5), table(None), table(Some(source))] {
            let json = serde_json::to_string(&setting).unwrap();
            assert_eq!(serde_json::from_str::<Setting>(&json).unwrap(), setting, "{json}");
        }
    }
}
