//! A state by name: where a run has come to and another can start from.
//!
//! In: the states of a model at some time, the branches of its switches where they are known. Out: the same as JSON,
//! and back for a model of the same states.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::model::description::Description;
use crate::model::standing::Misplaced;
use crate::solve::simulation::Beginning;

/// The states of a model at some time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// The format of a state file: [`State::FORMAT`].
    pub format: u32,
    /// The model's name.
    pub model: String,
    /// The version of the compiler that made the model.
    pub version: String,
    /// Time, s.
    pub t: f64,
    /// Name and value of each state, in the order of the model's description, SI units.
    pub states: Vec<(String, f64)>,
    /// The largest absolute value that each of them has had in the runs that led here: what rounding may have left of
    /// it, and how a run that goes on measures its errors, is a part of that.
    pub largest: Vec<f64>,
    /// Name and branch of each switch, in the order of the model's description: whether it is that of the negative
    /// guard, such as sliding, or being clear of a stop. None where they are not known: a run finds them.
    pub branches: Option<Vec<(String, bool)>>,
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
    /// It was saved in another format.
    #[error(
        "this state was saved in format {found}, which does not say what sticks or rests; \
         this version reads format {expected}: make the run that led to it anew",
        expected = State::FORMAT
    )]
    OtherFormat {
        /// The state's.
        found: u64,
    },
    /// The model has a switch that is missing, or the other way round.
    #[error(
        "the switches do not fit: `{0}` is in one and not in the other, or in another place; the model has changed"
    )]
    OtherSwitches(String),
    /// The model cannot stand there.
    #[error("a run cannot start from this state: {0}; correct the state, or make the run that led to it anew")]
    Misplaced(#[from] Misplaced),
    /// A number that cannot be.
    #[error("`{name}` is {value}, not a finite number")]
    NotFinite {
        /// The state's name, or `t`.
        name: String,
        /// Its value.
        value: f64,
    },
    /// The model delays signals, whose past is in no saved state.
    #[error(
        "`{0}` delays a signal, and this state does not have what the signal was before; make one run from the start \
         to the end"
    )]
    Delays(String),
    /// No saved state at all.
    #[error("this is no saved state: {0}")]
    NoState(String),
}

debug_is_display!(StateError);

/// The compiler and this crate have one version.
const VERSION: &str = env!("CARGO_PKG_VERSION");

impl State {
    /// The format of the files: 2 since branches are saved.
    pub const FORMAT: u32 = 2;

    /// The states `x` of a model at `t` (s), which have been as large as `largest`, and the branches of its switches
    /// where they are known.
    pub(super) fn new(of: &Description, t: f64, x: &[f64], largest: &[f64], negative: Option<&[bool]>) -> Self {
        let states = of.states.iter().zip(x).map(|(state, value)| (state.name.to_owned(), *value)).collect();
        let named = |negative: &[bool]| {
            of.switches.iter().map(|switch| switch.name.to_owned()).zip(negative.iter().copied()).collect()
        };
        let (model, version) = (of.name.to_owned(), VERSION.to_owned());
        Self {
            format: Self::FORMAT,
            model,
            version,
            t,
            states,
            largest: largest.to_vec(),
            branches: negative.map(named),
        }
    }

    /// The value of the state called `name`, in its SI unit.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<f64> {
        self.states.iter().find(|(own, _)| own == name).map(|(_, value)| *value)
    }

    /// Changes the value of the state called `name`, SI unit; gives whether there is one. The branches of switches are
    /// not known any more then: a run that starts from here finds them.
    pub fn set(&mut self, name: &str, value: f64) -> bool {
        let Some(index) = self.states.iter().position(|(own, _)| own == name) else { return false };
        self.states[index].1 = value;
        self.branches = None;
        true
    }

    /// The values of the states, in the order of the model's description.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.states.iter().map(|(_, value)| *value).collect()
    }

    /// The branches of the switches where they are known, in the order of the model's description.
    #[must_use]
    pub fn negative(&self) -> Option<Vec<bool>> {
        self.branches.as_ref().map(|branches| branches.iter().map(|(_, negative)| *negative).collect())
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
    /// [`StateError::NoState`], [`StateError::OtherFormat`].
    pub fn from_json(text: &str) -> Result<Self, StateError> {
        let no_state = |fault: serde_json::Error| StateError::NoState(fault.to_string());
        let head: Head = serde_json::from_str(text).map_err(no_state)?;
        if head.format != u64::from(Self::FORMAT) {
            return Err(StateError::OtherFormat { found: head.format });
        }
        serde_json::from_str(text).map_err(no_state)
    }

    /// The state for a model.
    pub(super) fn beginning(&self, of: &Description) -> Result<Beginning, StateError> {
        let Description { name: model, states, switches, .. } = *of;
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
        if let Some(branches) = &self.branches {
            let own = |index: usize| branches.get(index).map(|(name, _)| name.as_str());
            let theirs = |index: usize| switches.get(index).map(|switch| switch.name);
            if let Some(index) = (0..branches.len().max(switches.len())).find(|&index| own(index) != theirs(index)) {
                return Err(StateError::OtherSwitches(theirs(index).or(own(index)).unwrap_or_default().to_owned()));
            }
        }
        self.check_finite()?;
        let x = DVector::from_vec(self.values());
        let largest =
            DVector::from_fn(x.len(), |index, _| self.largest.get(index).map_or(x[index], |value| *value).abs());
        Ok(Beginning { x, largest, negative: self.negative() })
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

/// What says how the rest of a state file is to be read.
#[derive(Deserialize)]
struct Head {
    /// 1 is that of files without it.
    #[serde(default = "first_format")]
    format: u64,
    /// Which every state file has.
    #[serde(rename = "model")]
    _model: String,
}

const fn first_format() -> u64 {
    1
}
