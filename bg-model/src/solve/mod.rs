//! What drives a mechanism: integrators, events, runs, reference solutions.

pub(crate) mod event;
pub mod extended;
pub mod failure;
pub(crate) mod finish;
pub mod integrator;
pub mod run;
pub mod sensitivity;
pub mod simulation;
pub mod statistics;
pub(crate) mod stepper;
