//! Run time of `bond_graph!` models: the traits they implement, integrators that drive them, events, the assembly of the
//! start pose and the description of what a model consists of.

pub mod assembly;
pub mod description;
mod event;
pub mod failure;
pub mod input;
pub mod integrator;
pub mod parameters;
pub mod scalar;
pub mod simulation;
pub mod statistics;
pub mod system;

pub use bg_macros::bond_graph;
pub use nalgebra;
pub use serde;
