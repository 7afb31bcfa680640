//! How exact a run is, and what that costs: reference solutions, the distance of a run from them, measurements.

pub mod errors;
pub mod measure;
#[cfg(not(target_arch = "wasm32"))]
pub mod report;

pub use crate::ask::reference;
pub use crate::program::case;
