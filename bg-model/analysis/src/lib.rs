#![doc = include_str!("../README.md")]

pub mod criterion;
pub mod identify;
pub mod linear;
#[cfg(not(target_arch = "wasm32"))]
pub mod npz;
#[cfg(not(target_arch = "wasm32"))]
pub mod optimize;
pub mod samples;
#[cfg(not(target_arch = "wasm32"))]
pub mod spectrum;
pub mod thinning;
