//! The inputs of a run: numbers, or tables from CSV files.
//!
//! In: `NAME=VALUE` and `NAME=FILE.csv` texts. Out: an input for each that the model declares, in its order; those that are not
//! set are 0. What cannot be used is one line that says what to change.

use std::path::{Path, PathBuf};

use bg_model::description::InputInfo;
use bg_model::input::{Input, Table, TableError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::parameters::nearest;

/// An input setting that cannot be used.
#[derive(Debug, Error)]
pub enum InputSettingError {
    /// There is no `=`.
    #[error("--input {0}: give it as NAME=VALUE or NAME=FILE.csv, for example --input force=12")]
    NoValue(String),
    /// No input has this name.
    #[error("--input {setting}: there is no input `{name}`{}", other(.near.as_deref(), .known))]
    Unknown {
        /// The text.
        setting: String,
        /// The name that was asked for.
        name: String,
        /// The input with the most similar name.
        near: Option<String>,
        /// All inputs.
        known: String,
    },
    /// The number is not finite.
    #[error("--input {0}: must be a finite number")]
    NotFinite(String),
    /// The file cannot be read.
    #[error("--input {setting}: cannot read {}: {source}", path.display())]
    Unreadable {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// Why.
        source: csv::Error,
    },
    /// The file has no such column.
    #[error("--input {setting}: {} has no column `{column}`; it has {known}", path.display())]
    NoColumn {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
        /// Those that there are.
        known: String,
    },
    /// A field is no number.
    #[error("--input {setting}: `{field}` in line {line} of {} is not a number", path.display())]
    NotANumber {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// The field.
        field: String,
        /// Its line, counted from 1.
        line: u64,
    },
    /// The rows are no table.
    #[error("--input {setting}: {fault}")]
    Table {
        /// The text.
        setting: String,
        /// Why.
        fault: TableError,
    },
}

fn other(near: Option<&str>, known: &str) -> String {
    match near {
        Some(near) => format!("; did you mean `{near}`?"),
        None if known.is_empty() => "; the model has no inputs".to_owned(),
        None => format!("; there are {known}"),
    }
}

/// What an input is set to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// The same value at all times, in the input's unit.
    Constant(f64),
    /// The rows of a table.
    Table {
        /// Their times, s, ascending.
        times: Vec<f64>,
        /// Their values, in the input's unit.
        values: Vec<f64>,
        /// Whether a cubic spline joins them; else straight lines.
        cubic: bool,
    },
}

impl Default for Setting {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Setting {
    /// The input.
    ///
    /// # Errors
    /// The rows are no table.
    pub fn input(&self) -> Result<Input, TableError> {
        match self {
            Self::Constant(value) => Ok(Input::constant(*value)),
            Self::Table { times, values, cubic: true } => Ok(Input::table(Table::cubic(times, values)?)),
            Self::Table { times, values, cubic: false } => Ok(Input::table(Table::linear(times, values)?)),
        }
    }
}

/// What stands before the name of a file whose rows a cubic spline joins.
pub(crate) const CUBIC: &str = "cubic:";

/// The inputs of a model that declares `infos`, as `settings` say.
///
/// # Errors
/// The first setting that cannot be used.
pub fn chosen(settings: &[String], infos: &[InputInfo]) -> Result<Vec<Input>, InputSettingError> {
    let inputs = self::settings(settings, infos)?;
    Ok(inputs.iter().map(|setting| setting.input().expect("a setting was checked when it was read")).collect())
}

/// The same as values and rows of tables.
///
/// # Errors
/// The first setting that cannot be used.
pub fn settings(settings: &[String], infos: &[InputInfo]) -> Result<Vec<Setting>, InputSettingError> {
    let mut inputs = vec![Setting::default(); infos.len()];
    for setting in settings {
        let (name, value) = setting.split_once('=').ok_or_else(|| InputSettingError::NoValue(setting.clone()))?;
        let name = name.trim();
        let Some(index) = infos.iter().position(|info| info.name == name) else {
            return Err(unknown(setting, name, infos));
        };
        inputs[index] = read(setting, value.trim())?;
    }
    Ok(inputs)
}

fn unknown(setting: &str, name: &str, infos: &[InputInfo]) -> InputSettingError {
    InputSettingError::Unknown {
        setting: setting.to_owned(),
        name: name.to_owned(),
        near: nearest(name, infos.iter().map(|info| info.name)),
        known: infos.iter().map(|info| info.name).collect::<Vec<_>>().join(", "),
    }
}

/// A number, or a table from a file.
fn read(setting: &str, value: &str) -> Result<Setting, InputSettingError> {
    if let Ok(number) = value.parse::<f64>() {
        return if number.is_finite() {
            Ok(Setting::Constant(number))
        } else {
            Err(InputSettingError::NotFinite(setting.to_owned()))
        };
    }
    let (file, cubic) = match value.strip_prefix(CUBIC) {
        Some(file) => (file, true),
        None => (value, false),
    };
    // A file may have a colon in its name.
    let (path, column) = match file.rsplit_once(':') {
        Some((path, column)) if !Path::new(file).exists() => (path, Some(column)),
        _ => (file, None),
    };
    let (times, values) = rows(setting, Path::new(path), column)?;
    let table = Setting::Table { times, values, cubic };
    match table.input() {
        Ok(_) => Ok(table),
        Err(fault) => Err(InputSettingError::Table { setting: setting.to_owned(), fault }),
    }
}

/// The first column of a CSV file with a header, and the one called `column` or the second.
fn rows(setting: &str, path: &Path, column: Option<&str>) -> Result<(Vec<f64>, Vec<f64>), InputSettingError> {
    let (setting, path) = (setting.to_owned(), path.to_owned());
    let unreadable = |source| InputSettingError::Unreadable { setting: setting.clone(), path: path.clone(), source };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(&path).map_err(unreadable)?;
    let header = reader.headers().map_err(unreadable)?.clone();
    let position = match column {
        Some(column) => header.iter().position(|name| name == column),
        None => (header.len() > 1).then_some(1),
    };
    let Some(position) = position else {
        let known = header.iter().collect::<Vec<_>>().join(", ");
        let column = column.unwrap_or("of values").to_owned();
        return Err(InputSettingError::NoColumn { setting, path, column, known });
    };
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for record in reader.records() {
        let record = record.map_err(unreadable)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |place: usize| {
            let field = record.get(place).unwrap_or_default();
            field.parse::<f64>().map_err(|_| InputSettingError::NotANumber {
                setting: setting.clone(),
                path: path.clone(),
                field: field.to_owned(),
                line,
            })
        };
        times.push(number(0)?);
        values.push(number(position)?);
    }
    Ok((times, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    const INFOS: [InputInfo; 2] =
        [InputInfo { name: "force", unit: "N", doc: "" }, InputInfo { name: "torque", unit: "N*m", doc: "" }];

    fn file(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    fn fault(setting: &str) -> String {
        chosen(&[setting.to_owned()], &INFOS).unwrap_err().to_string()
    }

    #[test]
    fn numbers_and_tables_reach_their_inputs() {
        let table = file("time, a, b\n0, 1, 5\n1, 3, 6\n2, 9, 7\n");
        let path = table.path().display();
        let settings = ["torque=-2.5".to_owned(), format!("force={path}:b")];
        let inputs = chosen(&settings, &INFOS).unwrap();
        assert_eq!((inputs[0].value(0.5), inputs[1].value(9.0)), (5.5, -2.5));
        let value = |setting: String| chosen(&[setting], &INFOS).unwrap()[0].value(0.5);
        // The parabola through three rows: 1 + 2 t^2.
        assert_eq!((value(format!("force={path}")), value(format!("force=cubic:{path}"))), (2.0, 1.5));
        assert_eq!(chosen(&[], &INFOS).unwrap()[0].value(1.0), 0.0);
    }

    #[test]
    fn each_fault_is_one_line_that_says_what_to_change() {
        assert!(fault("force").contains("NAME=VALUE or NAME=FILE.csv"));
        assert_eq!(fault("forse=1"), "--input forse=1: there is no input `forse`; did you mean `force`?");
        assert_eq!(fault("zzz=1"), "--input zzz=1: there is no input `zzz`; there are force, torque");
        assert_eq!(fault("force=inf"), "--input force=inf: must be a finite number");
        assert!(fault("force=absent.csv").contains("cannot read absent.csv: "));
        let of = |text: &str, column: &str| {
            let file = file(text);
            fault(&format!("force={}{column}", file.path().display()))
        };
        assert!(of("t,a\n0,1\n1,2\n", ":b").ends_with("has no column `b`; it has t, a"));
        assert!(of("t\n0\n1\n", "").ends_with("has no column `of values`; it has t"));
        assert!(of("t,a\n0,1\n1,two\n", "").contains("`two` in line 3 of "));
        assert!(of("t,a\n0,1\n1,nan\n", "").contains("the value in row 2 of the table is NaN"));
        assert!(of("t,a\n1,1\n0,2\n", "").contains("do not ascend: row 2 has t = 0"));
        for text in ["", "t,a\n0,1\n", "t,a\n0,1\n1\n"] {
            assert!(!of(text, "").contains('\n'), "{}", of(text, ""));
        }
    }
}
