//! How exact a run is, and what that costs: reference solutions, the distance of a run from them, measurements.

pub mod case;
pub mod errors;
pub mod measure;
pub mod reference;
#[cfg(not(target_arch = "wasm32"))]
pub mod report;
