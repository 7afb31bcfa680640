//! The inputs of a run: numbers, or tables from CSV files.
//!
//! In: what each input is set to. Out: inputs as a model takes them, and how results name them: `named`. What is
//! written on the command line is read in `read`.

mod named;
#[cfg(not(target_arch = "wasm32"))]
mod read;

use bg_model::input::{Input, Table, TableError};
use serde::{Deserialize, Serialize};

pub use named::{Named, NamedTable, lines, named, text};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use read::CUBIC;
#[cfg(not(target_arch = "wasm32"))]
pub use read::{InputSettingError, chosen_and_named, settings};

/// What an input is set to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Setting {
    /// To nothing: it is 0.
    #[default]
    NotGiven,
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
        /// The file that they are from.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        source: Option<Source>,
    },
}

/// The file that a table is from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Its path, as it was given.
    pub file: String,
    /// The name of the column of values, where the file has a head.
    pub column: Option<String>,
    /// The CRC-32 of its bytes, in eight hexadecimal digits: it guards against mistakes, not against forgery.
    pub crc32: String,
}

impl Setting {
    /// The input.
    ///
    /// # Errors
    /// The rows are no table.
    pub fn input(&self) -> Result<Input, TableError> {
        match self {
            Self::NotGiven => Ok(Input::constant(0.0)),
            Self::Constant(value) => Ok(Input::constant(*value)),
            Self::Table { times, values, cubic: true, .. } => Ok(Input::table(Table::cubic(times, values)?)),
            Self::Table { times, values, cubic: false, .. } => Ok(Input::table(Table::linear(times, values)?)),
        }
    }
}

/// The inputs of settings, each of which [`settings`] has read.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn made(settings: &[Setting]) -> Vec<Input> {
    settings.iter().map(|setting| setting.input().expect("a setting was checked when it was read")).collect()
}
