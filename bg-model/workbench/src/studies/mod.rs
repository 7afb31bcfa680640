//! More than one run: sweeps, derivatives, fits, optima, recorded runs made again, errors and what they cost.

#[cfg(not(target_arch = "wasm32"))]
pub mod golden;
#[cfg(not(target_arch = "wasm32"))]
pub mod gradient;
#[cfg(not(target_arch = "wasm32"))]
pub mod identify;
#[cfg(not(target_arch = "wasm32"))]
pub mod optimize;
pub mod precision;
#[cfg(not(target_arch = "wasm32"))]
pub mod sensitivity;
#[cfg(not(target_arch = "wasm32"))]
pub mod sweep;
