//! The parameters of a run: defaults, then a TOML file, then `--set`, each by name and each checked.
//!
//! In: the parameters' table of the model, a file's text, `NAME=VALUE` texts. Out: checked parameters, or one line that
//! says what to change.

use std::path::{Path, PathBuf};

use bg_model::description::ParameterInfo;
use bg_model::input::Input;
use bg_model::parameters::{ParameterError, Parameters};
use thiserror::Error;

use super::quantity::{QuantityError, quantity};

/// A parameter setting that cannot be used.
#[derive(Debug, Error)]
pub enum SettingError {
    /// No parameter has this name.
    #[error("{place}: there is no parameter `{name}`{}", near_miss(.near.as_ref()))]
    Unknown {
        /// `--set` or the file.
        place: String,
        /// The name that was asked for.
        name: String,
        /// The parameter with the most similar name.
        near: Option<String>,
    },
    /// A value outside its range.
    #[error("{place}: {fault}")]
    Range {
        /// `--set` or the file.
        place: String,
        /// Which parameter, value and range.
        fault: ParameterError,
    },
    /// A `--set` without `=`.
    #[error("--set {0}: give it as NAME=VALUE, for example --set mass=2")]
    NoValue(String),
    /// A value that is no number, or in a unit that measures something else.
    #[error("{place}: the value of `{name}` {fault}")]
    NotANumber {
        /// `--set` or the file.
        place: String,
        /// The parameter's name.
        name: String,
        /// What is wrong with it.
        fault: QuantityError,
    },
    /// A file that cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A file that is no TOML.
    #[error("{} is not valid TOML: line {line}, column {column}: {message}", path.display())]
    Toml {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the parser says.
        message: String,
    },
}

fn near_miss(near: Option<&String>) -> String {
    match near {
        Some(near) => format!("; did you mean `{near}`?"),
        None => "; the command `parameters` lists them".to_owned(),
    }
}

/// A value for each parameter of a table, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    table: &'static [ParameterInfo],
    values: Vec<f64>,
}

impl Values {
    /// The defaults of `table`.
    #[must_use]
    pub fn new(table: &'static [ParameterInfo]) -> Self {
        Self { table, values: table.iter().map(|info| info.default).collect() }
    }

    /// Those of a generated struct.
    #[must_use]
    pub fn of<P: Parameters>(parameters: &P) -> Self {
        Self { table: P::table(), values: parameters.values() }
    }

    /// The table.
    #[must_use]
    pub const fn table(&self) -> &'static [ParameterInfo] {
        self.table
    }

    /// All values, in the order of the table.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The parameters with their values.
    pub fn all(&self) -> impl Iterator<Item = (&'static ParameterInfo, f64)> + use<'_> {
        self.table.iter().zip(self.values.iter().copied())
    }

    /// Those that are not at their defaults.
    pub fn changed(&self) -> impl Iterator<Item = (&'static ParameterInfo, f64)> + use<'_> {
        self.all().filter(|(info, value)| *value != info.default)
    }

    /// The value of parameter `index`.
    ///
    /// # Panics
    /// There is none.
    #[must_use]
    pub fn value(&self, index: usize) -> f64 {
        self.values[index]
    }

    /// The value of the parameter called `name`, if there is one.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        Some(self.values[self.place(name)?])
    }

    /// Sets parameter `index` without looking at its range.
    ///
    /// # Panics
    /// There is none.
    pub fn set_value(&mut self, index: usize, value: f64) {
        self.values[index] = value;
    }

    /// Sets the parameter called `name`.
    ///
    /// # Errors
    /// An unknown name, or a value outside the parameter's range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let index = self.place(name).ok_or_else(|| ParameterError::Unknown { name: name.to_owned() })?;
        self.table[index].check(value)?;
        self.values[index] = value;
        Ok(())
    }

    /// The index of the parameter called `name`.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.table.iter().position(|info| info.name == name)
    }
}

/// The values chosen for a run, and where each was chosen.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The values.
    pub values: Values,
    /// For each parameter of the table the last place that set it: a `--set` or a file; empty for a default.
    pub places: Vec<String>,
    /// The inputs in the order of the model's description; those that are missing are 0.
    pub inputs: Vec<Input>,
}

impl Chosen {
    /// The defaults of `table`, no inputs.
    #[must_use]
    pub fn new(table: &'static [ParameterInfo]) -> Self {
        Self { values: Values::new(table), places: vec![String::new(); table.len()], inputs: Vec::new() }
    }
}

/// Parameters for programs: by their names default, unit, ends of the range, meaning. An end that is open is null.
#[must_use]
pub fn json(rows: &[ParameterInfo]) -> serde_json::Value {
    let one = |info: &ParameterInfo| {
        let value = serde_json::json!({
            "default": info.default, "unit": info.unit, "lower": info.range.lower, "upper": info.range.upper,
            "range": info.range.to_string(), "doc": one_line(info.doc),
        });
        (info.name.to_owned(), value)
    };
    rows.iter().map(one).collect::<serde_json::Map<_, _>>().into()
}

/// The defaults of `table`, changed by the file and then by the `NAME=VALUE` texts in their order.
///
/// # Errors
/// The first setting that cannot be used.
pub fn merge(
    table: &'static [ParameterInfo],
    file: Option<&Path>,
    settings: &[String],
) -> Result<Chosen, SettingError> {
    let mut parameters = Chosen::new(table);
    if let Some(path) = file {
        let text = std::fs::read_to_string(path)
            .map_err(|source| SettingError::Unreadable { path: path.to_owned(), source })?;
        set_from_toml(&mut parameters, path, &text)?;
    }
    for setting in settings {
        let setting = &one_line(setting);
        let (name, value) = setting.split_once('=').ok_or_else(|| SettingError::NoValue(setting.clone()))?;
        let (name, value) = (name.trim(), value.trim());
        let place = format!("--set {setting}");
        let number = measured(&parameters, &place, name, value)?;
        set(&mut parameters, &place, name, number)?;
    }
    Ok(parameters)
}

/// The parameters as a TOML file that `--params` reads, each with its meaning as a comment.
#[must_use]
pub fn to_toml(parameters: &Values) -> String {
    let mut text = String::new();
    for (info, value) in parameters.all() {
        let unit = if info.unit.is_empty() { "1" } else { info.unit };
        text += &format!("# {} [{unit}]\n{} = {value:?}\n", one_line(info.doc), info.name);
    }
    text
}

/// The parameters as a table for the terminal: name, default, unit, meaning.
#[must_use]
pub fn table(rows: &[ParameterInfo]) -> String {
    let width =
        |text: fn(&ParameterInfo) -> String| rows.iter().map(|info| text(info).chars().count()).max().unwrap_or(0);
    let value = |info: &ParameterInfo| number(info.default);
    let (names, values, units) = (width(|i| i.name.to_owned()), width(value), width(|i| i.unit.to_owned()));
    rows.iter()
        .map(|info| {
            let line = format!(
                "  {:names$}  {:>values$} {:units$}  {}",
                info.name,
                number(info.default),
                info.unit,
                one_line(info.doc)
            );
            line.trim_end().to_owned() + "\n"
        })
        .collect()
}

/// A number as a person writes it: `1e7`, not `10000000`.
#[must_use]
pub fn number(value: f64) -> String {
    let plain = format!("{value}");
    let scientific = format!("{value:e}");
    // Six characters hold every default below 1e5 as it stands in the paper's tables.
    if plain.len() > 6 && scientific.len() < plain.len() { scientific } else { plain }
}

pub(crate) fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The number that a text gives of a parameter, in its unit. Of an unknown name any: that is the better message where
/// both are wrong.
fn measured(parameters: &Chosen, place: &str, name: &str, text: &str) -> Result<f64, SettingError> {
    let Some(index) = parameters.values.place(name) else { return Ok(0.0) };
    let fault = |fault| SettingError::NotANumber { place: place.to_owned(), name: name.to_owned(), fault };
    quantity(text, parameters.values.table()[index].unit).map_err(fault)
}

/// The bounds that `LOWER..UPPER` gives of a parameter, in its unit.
///
/// # Errors
/// A sentence.
pub fn bounds(info: &ParameterInfo, text: &str) -> Result<[f64; 2], String> {
    let form = || format!("give it as {}=LOWER..UPPER, for example {}=1e3..1e5", info.name, info.name);
    let (lower, upper) = text.split_once("..").ok_or_else(form)?;
    let number = |text: &str| quantity(text.trim(), info.unit).map_err(|fault| format!("a bound {fault}"));
    let [lower, upper] = [number(lower)?, number(upper)?];
    if lower < upper && info.range.contains(lower) && info.range.contains(upper) {
        Ok([lower, upper])
    } else {
        Err(format!("the lower bound must be below the upper one, and both {}", info.range))
    }
}

fn set_from_toml(parameters: &mut Chosen, path: &Path, text: &str) -> Result<(), SettingError> {
    let entries: toml::Table = text.parse().map_err(|fault: toml::de::Error| {
        let [line, column] = place_of(&fault, text);
        SettingError::Toml { path: path.to_owned(), line, column, message: one_line(fault.message()) }
    })?;
    set_from_table(parameters, &path.display().to_string(), &entries)
}

/// Sets the parameters that a TOML table has; a fault names `place`.
pub(crate) fn set_from_table(parameters: &mut Chosen, place: &str, entries: &toml::Table) -> Result<(), SettingError> {
    for (name, value) in entries {
        let number = match value {
            toml::Value::Float(number) => *number,
            // Every whole number that a parameter can sensibly have is exact in f64.
            toml::Value::Integer(number) => *number as f64,
            toml::Value::String(text) => measured(parameters, place, name, text)?,
            other => measured(parameters, place, name, &one_line(&other.to_string()))?,
        };
        set(parameters, place, name, number)?;
    }
    Ok(())
}

/// Line and column of a fault in the TOML text, counted from 1.
pub(crate) fn place_of(fault: &toml::de::Error, text: &str) -> [usize; 2] {
    let before = &text[..fault.span().map_or(0, |span| span.start).min(text.len())];
    [before.matches('\n').count() + 1, before.chars().rev().take_while(|&c| c != '\n').count() + 1]
}

/// Sets the parameter called `name`; a fault names `place`.
pub(crate) fn set(parameters: &mut Chosen, place: &str, name: &str, value: f64) -> Result<(), SettingError> {
    let place = place.to_owned();
    parameters.values.set(name, value).map_err(|fault| match fault {
        ParameterError::Unknown { name } => SettingError::Unknown {
            place: place.clone(),
            near: nearest(&name, parameters.values.table().iter().map(|info| info.name)),
            name: one_line(&name),
        },
        fault => SettingError::Range { place: place.clone(), fault },
    })?;
    if let Some(index) = parameters.values.place(name) {
        parameters.places[index] = place;
    }
    Ok(())
}

/// The one of `names` that is most similar to `name`, if any is similar.
pub(crate) fn nearest(name: &str, names: impl Iterator<Item = &'static str>) -> Option<String> {
    // Jaro-Winkler similarity; clap uses 0.7 for its own near misses.
    const SIMILAR: f64 = 0.7;
    let wanted = name.to_lowercase();
    names
        .map(|known| (strsim::jaro_winkler(&wanted, known), known))
        .filter(|(similarity, _)| *similarity > SIMILAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known.to_owned())
}
