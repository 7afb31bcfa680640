//! Parameters by name: what a command line or a file needs beside the generated struct's fields.

pub(crate) mod serialized;

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec::Vec;

use thiserror::Error;

use crate::model::description::{ParameterInfo, Range};
use crate::model::requirement::Impossible;

/// A generated parameter struct, seen by name.
pub trait Parameters: Clone + Default {
    /// The parameters' table, in the order of declaration.
    fn table() -> &'static [ParameterInfo];

    /// The value of parameter `index` of the table, in its unit.
    fn value(&self, index: usize) -> f64;

    /// Sets parameter `index` of the table without looking at its range.
    fn set_value(&mut self, index: usize, value: f64);

    /// The values of all parameters, in the order of the table.
    fn values(&self) -> Vec<f64> {
        (0..Self::table().len()).map(|index| self.value(index)).collect()
    }

    /// Parameters of these values, in the order of the table, without looking at ranges; those that are missing keep
    /// their defaults.
    #[must_use]
    fn of_values(values: &[f64]) -> Self {
        let mut parameters = Self::default();
        values.iter().enumerate().for_each(|(index, &value)| parameters.set_value(index, value));
        parameters
    }

    /// The value of the parameter called `name`, if there is one.
    fn get(&self, name: &str) -> Option<f64> {
        let index = Self::table().iter().position(|p| p.name == name)?;
        Some(self.value(index))
    }

    /// Sets the parameter called `name`.
    ///
    /// # Errors
    /// An unknown name, or a value outside the parameter's range.
    fn set(&mut self, name: &str, value: f64) -> Result<(), ParameterError> {
        let Some(index) = Self::table().iter().position(|p| p.name == name) else {
            return Err(ParameterError::Unknown { name: name.to_owned() });
        };
        Self::table()[index].check(value)?;
        self.set_value(index, value);
        Ok(())
    }

    /// Checks every value against its range.
    ///
    /// # Errors
    /// The first value outside its range.
    fn validate(&self) -> Result<(), ParameterError> {
        Self::table().iter().enumerate().try_for_each(|(index, parameter)| parameter.check(self.value(index)))
    }
}

/// A parameter that cannot be.
#[derive(Clone, PartialEq, Error)]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("there is no parameter `{name}`")]
    Unknown {
        /// The name that was asked for.
        name: String,
    },
    /// The value is not a finite number inside the parameter's range.
    #[error("parameter `{name}` = {value} {unit} is out of range: it must be {range}")]
    OutOfRange {
        /// The parameter's name.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// The parameter's unit.
        unit: &'static str,
        /// What is allowed.
        range: Range,
    },
    /// A value that the parameters give cannot be, such as a mass that is not above 0.
    #[error(transparent)]
    Impossible(#[from] Impossible),
}

debug_is_display!(ParameterError);

impl ParameterInfo {
    /// Checks `value` against the parameter's range.
    ///
    /// # Errors
    /// It is not a finite number inside.
    pub fn check(&self, value: f64) -> Result<(), ParameterError> {
        if self.range.contains(value) {
            return Ok(());
        }
        Err(ParameterError::OutOfRange { name: self.name, value, unit: self.unit, range: self.range })
    }
}

impl Range {
    /// Whether `value` is finite and inside.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        let above = if self.lower_included { value >= self.lower } else { value > self.lower };
        let below = if self.upper_included { value <= self.upper } else { value < self.upper };
        value.is_finite() && above && below
    }
}

impl core::fmt::Display for Range {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("a finite number")?;
        if self.lower.is_finite() {
            write!(f, ", {} {}", if self.lower_included { "at least" } else { "above" }, self.lower)?;
        }
        if self.upper.is_finite() {
            write!(f, ", {} {}", if self.upper_included { "at most" } else { "below" }, self.upper)?;
        }
        Ok(())
    }
}
