//! What can go wrong.
//!
//! Types and no boxed texts: a controller that shows no text has none in its flash.

use core::fmt;

use bg_model::assembly::AssemblyError;
use bg_model::fixed_step::{NotFinite, Unfit};
use bg_model::parameters::ParameterError;
use thiserror::Error;

/// Why a run cannot begin or go on.
#[derive(Debug, Error)]
pub enum Fault {
    /// Parameters that cannot be.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// A mechanism that cannot be put together.
    #[error(transparent)]
    Start(#[from] AssemblyError),
    /// A system that steps of a fixed cost do not suit.
    #[error(transparent)]
    Steps(#[from] Unfit),
    /// A state that would not be a finite number.
    #[error(transparent)]
    State(#[from] NotFinite),
    /// A place that takes no text.
    #[error(transparent)]
    Text(#[from] fmt::Error),
}
