#![doc = include_str!("../README.md")]

pub mod identify;
pub mod linear;
#[cfg(not(target_arch = "wasm32"))]
pub mod npz;
pub mod thinning;
