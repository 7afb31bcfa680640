//! Inputs as they are written on the command line.
//!
//! In: `NAME=VALUE` and `NAME=FILE.csv` texts. Out: a setting for each input that the model declares, in its order.
//! What cannot be used is one line that says what to change.

use std::path::{Path, PathBuf};

use bg_model::description::InputInfo;
use bg_model::input::{Input, TableError};
use csv::StringRecord;
use thiserror::Error;

use super::{Named, Setting, Source, made, named};
use crate::ask::parameters::nearest;
use crate::ask::quantity::{Conversion, QuantityError, quantity};
use crate::files::crc32;
use crate::files::head::{Head, head, name_and_unit};

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
    /// A column is asked for by its name, of a file without names.
    #[error(
        "--input {setting}: {} has no column `{column}`, since its first line has numbers, not names; write a first \
         line with the columns' names",
        path.display()
    )]
    NoHead {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
    },
    /// The first line is neither a head nor a row.
    #[error(
        "--input {setting}: the first line of {} has both a name, `{name}`, and a number, `{number}`; give all columns \
         names, or none",
        path.display()
    )]
    MixedHead {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// Its first field that is no number.
        name: String,
        /// Its first one that is.
        number: String,
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
    /// The unit in a column's head is not one of what the column has.
    #[error("--input {setting}: {}, column `{column}`: {fault}", path.display())]
    Unit {
        /// The text.
        setting: String,
        /// The file.
        path: PathBuf,
        /// The column.
        column: String,
        /// Why.
        fault: Box<QuantityError>,
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

/// What stands before the name of a file whose rows a cubic spline joins.
pub(crate) const CUBIC: &str = "cubic:";

/// The inputs of a model that declares `infos`, as `settings` say, and how results name them.
///
/// # Errors
/// The first setting that cannot be used.
pub fn chosen_and_named(
    settings: &[String],
    infos: &[InputInfo],
) -> Result<(Vec<Input>, Vec<Named>), InputSettingError> {
    let settings = self::settings(settings, infos)?;
    Ok((made(&settings), named(&settings, infos)))
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
        inputs[index] = read(setting, value.trim(), infos[index].unit)?;
    }
    Ok(inputs)
}

/// Sets the input called `name` of a model that declares `infos`, where the settings are not written.
///
/// # Errors
/// There is no such input, or the rows are no table.
pub fn set(
    settings: &mut [Setting],
    (name, setting): (&str, &Setting),
    infos: &[InputInfo],
) -> Result<(), InputSettingError> {
    let written = || format!("{name}=[..]");
    let index = infos.iter().position(|info| info.name == name).ok_or_else(|| unknown(&written(), name, infos))?;
    setting.input().map_err(|fault| InputSettingError::Table { setting: written(), fault })?;
    settings[index] = setting.clone();
    Ok(())
}

fn unknown(setting: &str, name: &str, infos: &[InputInfo]) -> InputSettingError {
    InputSettingError::Unknown {
        setting: setting.to_owned(),
        name: name.to_owned(),
        near: nearest(name, infos.iter().map(|info| info.name)),
        known: infos.iter().map(|info| info.name).collect::<Vec<_>>().join(", "),
    }
}

/// A number, with a unit or in that of the input, or a table from a file.
fn read(setting: &str, value: &str, unit: &str) -> Result<Setting, InputSettingError> {
    if let Ok(number) = quantity(value, unit) {
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
    let table = table(setting, Path::new(path), column, cubic, unit)?;
    match table.input() {
        Ok(_) => Ok(table),
        Err(fault) => Err(InputSettingError::Table { setting: setting.to_owned(), fault }),
    }
}

/// The first column of a CSV file, and the one called `column` or the second. A first line of numbers is a row, one of
/// names the head; columns that have a unit there, as in `load [kN]`, become s and the unit `declared`.
fn table(
    setting: &str,
    path: &Path,
    column: Option<&str>,
    cubic: bool,
    declared: &str,
) -> Result<Setting, InputSettingError> {
    let (setting, path) = (setting.to_owned(), path.to_owned());
    let unreadable = |source| InputSettingError::Unreadable { setting: setting.clone(), path: path.clone(), source };
    let bytes = std::fs::read(&path).map_err(|fault| unreadable(fault.into()))?;
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).has_headers(false).from_reader(bytes.as_slice());
    let mut records = reader.records().peekable();
    let first = match records.peek() {
        Some(Ok(record)) => record.clone(),
        _ => StringRecord::new(),
    };
    let has_head = match head(&first) {
        Head::Names => true,
        Head::Numbers => false,
        Head::Mixed { name, number } => {
            return Err(InputSettingError::MixedHead { setting, path, name, number });
        }
    };
    let heads: Vec<(&str, Option<&str>)> = first.iter().map(name_and_unit).collect();
    let position = match column {
        Some(column) if has_head => (0..heads.len()).find(|&place| heads[place].0 == column || &first[place] == column),
        Some(column) => {
            return Err(InputSettingError::NoHead { setting, path, column: column.to_owned() });
        }
        None => (first.len() > 1).then_some(1),
    };
    let Some(position) = position else {
        let known = heads.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        let column = column.unwrap_or("of values").to_owned();
        return Err(InputSettingError::NoColumn { setting, path, column, known });
    };
    let conversion = |place: usize, declared: &str| {
        let (name, unit) = heads[place];
        Conversion::between(unit.unwrap_or(declared), declared).map_err(|fault| InputSettingError::Unit {
            setting: setting.clone(),
            path: path.clone(),
            column: name.to_owned(),
            fault: Box::new(fault),
        })
    };
    let (time, value) = (conversion(0, "s")?, conversion(position, declared)?);
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for record in records.skip(usize::from(has_head)) {
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
        times.push(time.of(number(0)?));
        values.push(value.of(number(position)?));
    }
    let column = has_head.then(|| heads[position].0.to_owned());
    let source = Source { file: path.display().to_string(), column, crc32: crc32(&bytes) };
    Ok(Setting::Table { times, values, cubic, source: Some(source) })
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

    fn chosen(settings: &[String]) -> Result<Vec<Input>, InputSettingError> {
        chosen_and_named(settings, &INFOS).map(|(inputs, _)| inputs)
    }

    fn fault(setting: &str) -> String {
        chosen(&[setting.to_owned()]).unwrap_err().to_string()
    }

    #[test]
    fn numbers_and_tables_reach_their_inputs() {
        let table = file("time, a, b\n0, 1, 5\n1, 3, 6\n2, 9, 7\n");
        let path = table.path().display();
        let settings = ["torque=-2.5".to_owned(), format!("force={path}:b")];
        let inputs = chosen(&settings).unwrap();
        assert_eq!((inputs[0].value(0.5), inputs[1].value(9.0)), (5.5, -2.5));
        let value = |setting: String| chosen(&[setting]).unwrap()[0].value(0.5);
        // The parabola through three rows: 1 + 2 t^2.
        assert_eq!((value(format!("force={path}")), value(format!("force=cubic:{path}"))), (2.0, 1.5));
        assert_eq!(chosen(&[]).unwrap()[0].value(1.0), 0.0);
    }

    #[test]
    fn columns_with_units_in_their_heads_are_converted() {
        let table = file("time [ms], pull [kN], turn [N*mm]\n0, 1, 5\n500, 3, 6\n");
        let path = table.path().display();
        let inputs = chosen(&[format!("force={path}"), format!("torque={path}:turn")]).unwrap();
        assert_eq!((inputs[0].value(0.25), inputs[1].value(0.5)), (2000.0, 0.006));
        let fault = fault(&format!("force={path}:turn"));
        assert!(fault.ends_with("column `turn`: must be in N or a unit like it, and `N*mm` is none"), "{fault}");
    }

    #[test]
    fn a_first_line_of_numbers_is_a_row() {
        let rows = |text: &str, column: &str| {
            let file = file(text);
            let of = settings(&[format!("force={}{column}", file.path().display())], &INFOS);
            match of.map(|all| all[0].clone()).map_err(|fault| fault.to_string())? {
                Setting::Table { times, values, source, .. } => Ok((times, values, source.unwrap().column)),
                other => panic!("{other:?}"),
            }
        };
        let two = |column: Option<&str>| Ok((vec![0.0, 1.0], vec![40.0, 50.0], column.map(str::to_owned)));
        for text in ["0,40\n1,50\n", " 0.0 , +4e1\n1,50", "\u{feff}0,40\r\n1,50\r\n"] {
            assert_eq!(rows(text, ""), two(None), "{text}");
        }
        for text in ["t,w\n0,40\n1,50\n", ",w\n0,40\n1,50\n", "\u{feff}t,w\n0,40\n1,50\n"] {
            assert_eq!(rows(text, ""), two(Some("w")), "{text}");
        }
        for text in ["t,2020\n0,40\n1,50\n", "0,w\n1,50\n2,60\n", "0,40,N\n1,50,N\n"] {
            let fault: String = rows(text, "").unwrap_err();
            assert!(
                fault.contains("has both a name, `") && fault.ends_with("give all columns names, or none"),
                "{fault}"
            );
        }
        assert!(
            rows("0,40\n1,50\n", ":w").unwrap_err().contains("has no column `w`, since its first line has numbers")
        );
        assert!(rows("0,\n1,50\n", "").unwrap_err().contains("`` in line 1 of "));
    }

    #[test]
    fn a_table_knows_its_file_by_the_crc_32_of_all_bytes() {
        // The check value of CRC-32/ISO-HDLC of the catalogue at https://reveng.sourceforge.io/crc-catalogue/.
        assert_eq!(crc32(b"123456789"), "cbf43926");
        let crc_of = |text: &str| {
            let file = file(text);
            let all = settings(&[format!("force={}", file.path().display())], &INFOS).unwrap();
            let Setting::Table { source: Some(source), .. } = all[0].clone() else { panic!("{all:?}") };
            assert_eq!(source.file, file.path().display().to_string());
            source.crc32
        };
        assert_eq!(crc_of("0,40\n1,50\n"), crc32(b"0,40\n1,50\n"));
        assert_ne!(crc_of("0,40\n1,50\n"), crc_of("0,40\n1,51\n"));
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
        assert!(of("t,a\n", "").ends_with("the table has 0 rows; give at least two"));
        for text in ["", "t,a\n0,1\n", "t,a\n0,1\n1\n"] {
            assert!(!of(text, "").contains('\n'), "{}", of(text, ""));
        }
    }
}
