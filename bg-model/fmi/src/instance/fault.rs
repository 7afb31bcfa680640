//! What an instance cannot do, in sentences for the log of its host.

use bg_model::parameters::ParameterError;
use bg_model::simulation::NoNumber;
use thiserror::Error;

/// What an instance cannot do.
#[derive(Debug, Error)]
pub enum Fault {
    /// A parameter's value.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The start cannot be assembled.
    #[error("{0}")]
    Start(String),
    /// The model cannot go on from where it is.
    #[error("{0}")]
    Stopped(String),
    /// The model cannot stand in the state that it was given.
    #[error("the model cannot stand in this state: {0}; set another one, or restore a saved state")]
    Misplaced(String),
    /// A value that cannot be calculated.
    #[error(transparent)]
    NoNumber(#[from] NoNumber),
    /// Something that the interface does not allow now.
    #[error("{what} is not possible in {mode}")]
    Mode {
        /// What was asked for.
        what: &'static str,
        /// The state of the instance, in the words of the standard.
        mode: &'static str,
    },
    /// No such variable.
    #[error("there is no variable with the value reference {0}")]
    Reference(u32),
    /// A variable that is calculated.
    #[error("`{0}` is calculated and cannot be set")]
    Calculated(String),
    /// A value that is not finite.
    #[error("`{name}` is set to {value}; it must be a finite number")]
    NotFinite {
        /// The variable.
        name: String,
        /// The value.
        value: f64,
    },
    /// Arguments of different lengths.
    #[error("{what}: {found} numbers are given, {wanted} are wanted")]
    Length {
        /// Which.
        what: &'static str,
        /// What is given.
        found: usize,
        /// What is wanted.
        wanted: usize,
    },
    /// A communication point that is not where the instance is.
    #[error(
        "the step is to begin at {asked:?} s, the model is at {present:?} s: go on from there, or restore a saved state"
    )]
    CommunicationPoint {
        /// What is asked for, s.
        asked: f64,
        /// Where the instance is, s.
        present: f64,
    },
    /// A step that leads back, or nowhere.
    #[error("a step of {0:?} s is none: it must be a finite number that is not negative")]
    Step(f64),
    /// A derivative that is not known.
    #[error(
        "the derivative of `{unknown}` by `{known}` is not known; known are those of derivatives, outputs and guards \
        by states and inputs"
    )]
    Derivative {
        /// What is derived.
        unknown: String,
        /// By what.
        known: String,
    },
    /// Something that is no saved state of this model.
    #[error("this is no saved state of this model: {0}")]
    Saved(String),
    /// A delay, whose past only the unit's own steps keep.
    #[error(
        "`{0}` delays a signal, and what the signal was is kept by the unit's own steps: load the unit for \
         Co-Simulation, and go on from a state in memory, not from bytes"
    )]
    Delays(&'static str),
    /// Something that this unit does not have.
    #[error("{0}")]
    Absent(String),
}
