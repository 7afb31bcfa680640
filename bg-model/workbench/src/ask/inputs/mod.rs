//! The inputs of a run: numbers, tables, functions of another program.
//!
//! In: what each input is set to. Out: inputs as a model takes them, and how results name them: `named`. What is
//! written on the command line is read in `read`.

mod named;
#[cfg(not(target_arch = "wasm32"))]
mod read;

use std::fmt::{self, Debug, Formatter};
use std::sync::Arc;

use bg_model::input::{Input, Table, TableError};
use serde::{Deserialize, Serialize};

pub use named::{Named, NamedTable, lines, named, text};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use read::CUBIC;
#[cfg(not(target_arch = "wasm32"))]
pub use read::{InputSettingError, chosen_and_named, set, settings};

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
    /// What a function gives; none is written into files.
    #[serde(skip)]
    Function(Function),
}

/// A function of time that another program has: the value at t (s), in the input's unit.
#[derive(Clone)]
pub struct Function(Arc<dyn Fn(f64) -> f64 + Send + Sync>);

impl Function {
    /// That of `value`, which gives the same whenever it is asked for the same time.
    pub fn new(value: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Self {
        Self(Arc::new(value))
    }
}

impl PartialEq for Function {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Debug for Function {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("a function")
    }
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
            Self::Function(Function(value)) => {
                let value = Arc::clone(value);
                Ok(Input::function(move |t| value(t)))
            }
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
