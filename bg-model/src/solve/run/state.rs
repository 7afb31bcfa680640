//! A state by name: where a run has come to and another can start from.
//!
//! In: the states of a model at some time. Out: the same as JSON, and back for a model of the same states.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::model::description::StateInfo;

/// The states of a model at some time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// The model's name.
    pub model: String,
    /// The version of the compiler that made the model.
    pub version: String,
    /// Time, s.
    pub t: f64,
    /// Name and value of each state, in the order of the model's description, SI units.
    pub states: Vec<(String, f64)>,
}

/// A state that a model cannot start from.
#[derive(Clone, PartialEq, Error)]
pub enum StateError {
    /// It is one of another model.
    #[error("this is a state of `{found}`, not of `{expected}`")]
    OtherModel {
        /// The model that is to start.
        expected: String,
        /// The state's.
        found: String,
    },
    /// The model was compiled by another version, which may name or order its states in another way.
    #[error("this state is of a model compiled by version {found}; this one is compiled by {expected}: run it anew")]
    OtherVersion {
        /// That of the model.
        expected: String,
        /// That of the state.
        found: String,
    },
    /// The model has a state that is missing, or the other way round.
    #[error("the states do not fit: `{0}` is in one and not in the other, or in another place; the model has changed")]
    OtherStates(String),
    /// A number that cannot be.
    #[error("`{name}` is {value}, not a finite number")]
    NotFinite {
        /// The state's name, or `t`.
        name: String,
        /// Its value.
        value: f64,
    },
    /// No saved state at all.
    #[error("this is no saved state: {0}")]
    NoState(String),
}

debug_is_display!(StateError);

/// The compiler and this crate have one version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

impl State {
    /// The states `x` of `model` at `t` (s).
    pub(super) fn new(model: &str, states: &[StateInfo], t: f64, x: &[f64]) -> Self {
        let states = states.iter().zip(x).map(|(state, value)| (state.name.to_owned(), *value)).collect();
        Self { model: model.to_owned(), version: VERSION.to_owned(), t, states }
    }

    /// The value of the state called `name`, in its SI unit.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.states.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }

    /// Changes the value of the state called `name`, SI unit; gives whether there is one.
    pub fn set(&mut self, name: &str, value: f64) -> bool {
        let state = self.states.iter_mut().find(|(own, _)| own == name);
        state.map(|(_, own)| *own = value).is_some()
    }

    /// The text of a state file: JSON, every number in the shortest form that reads back to the same bits.
    ///
    /// # Errors
    /// [`StateError::NotFinite`]: JSON has no such numbers.
    pub fn to_json(&self) -> Result<String, StateError> {
        self.check_finite()?;
        let text = serde_json::to_string_pretty(self).map_err(|fault| StateError::NoState(fault.to_string()))?;
        Ok(text + "\n")
    }

    /// Reads the text of a state file.
    ///
    /// # Errors
    /// [`StateError::NoState`].
    pub fn from_json(text: &str) -> Result<Self, StateError> {
        serde_json::from_str(text).map_err(|fault| StateError::NoState(fault.to_string()))
    }

    /// The state vector for `model`, which has these states.
    pub(super) fn vector<const N: usize>(
        &self,
        model: &str,
        states: &[StateInfo],
    ) -> Result<SVector<f64, N>, StateError> {
        if self.model != model {
            return Err(StateError::OtherModel { expected: model.to_owned(), found: self.model.clone() });
        }
        if self.version != VERSION {
            return Err(StateError::OtherVersion { expected: VERSION.to_owned(), found: self.version.clone() });
        }
        let own = |index: usize| self.states.get(index).map(|(name, _)| name.as_str());
        let theirs = |index: usize| states.get(index).map(|state| state.name);
        if let Some(index) = (0..self.states.len().max(states.len())).find(|&index| own(index) != theirs(index)) {
            return Err(StateError::OtherStates(theirs(index).or(own(index)).unwrap_or_default().to_owned()));
        }
        self.check_finite()?;
        Ok(SVector::from_fn(|index, _| self.states[index].1))
    }

    fn check_finite(&self) -> Result<(), StateError> {
        let time = std::iter::once(("t", self.t));
        let mut all = time.chain(self.states.iter().map(|(name, value)| (name.as_str(), *value)));
        match all.find(|(_, value)| !value.is_finite()) {
            Some((name, value)) => Err(StateError::NotFinite { name: name.to_owned(), value }),
            None => Ok(()),
        }
    }
}
