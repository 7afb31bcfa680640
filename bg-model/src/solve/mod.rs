//! What drives a mechanism: integrators, events, runs, reference solutions.

pub(crate) mod event;
#[cfg(feature = "std")]
pub mod extended;
pub mod failure;
pub(crate) mod finish;
pub mod fixed_step;
pub mod integrator;
#[cfg(feature = "std")]
pub mod run;
#[cfg(feature = "std")]
pub mod sensitivity;
pub mod simulation;
pub mod statistics;
pub(crate) mod stepper;
