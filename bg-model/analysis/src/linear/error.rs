//! Why there is no equilibrium or no linear model.

use bg_model::assembly::AssemblyError;
use bg_model::parameters::ParameterError;
use thiserror::Error;

/// A mechanism without an equilibrium, or that cannot be linearised.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LinearError {
    /// The start pose cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The model cannot be made with the values that its inputs have at that time.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A derivative is not finite.
    #[error(
        "the rate of `{of}` has no finite derivative by {by} at t = {t:?} s: linearise at another state, or smooth the \
         law that it depends on there, such as a square root at zero by `root`"
    )]
    NotFinite {
        /// The state whose rate it is.
        of: String,
        /// What it is derived by: a state or an input, with its name.
        by: String,
        /// The time, s.
        t: f64,
    },
    /// A rate is not finite.
    #[error("the rate of `{of}` is {value:?} at t = {t:?} s: give a start, or inputs, at which it is a number")]
    BadRate {
        /// The state whose rate it is.
        of: String,
        /// Its value.
        value: f64,
        /// The time, s.
        t: f64,
    },
    /// No equilibrium was found.
    #[error(
        "there is no equilibrium near the start: {} by {rate:.4e} {unit} where the search ended; {action}",
        still_changes(.what)
    )]
    NoEquilibrium {
        /// The state that changes most, in the measure of its largest rate during the search.
        what: String,
        /// Its rate: of a momentum the force or torque that is left.
        rate: f64,
        /// The unit of the rate.
        unit: String,
        /// What to do.
        action: &'static str,
    },
    /// The eigenvalues were not found.
    #[error("the eigenvalues were not found: the QR algorithm does not converge; look at A for values that cannot be")]
    NoEigenvalues,
    /// An input or output that the model does not have.
    #[error("there is no {kind} `{name}`; the {kind}s are {known}")]
    Unknown {
        /// `input` or `output`.
        kind: &'static str,
        /// The name that was asked for.
        name: String,
        /// Those that there are.
        known: String,
    },
}

fn still_changes(what: &str) -> String {
    format!("`{what}` still changes")
}
