#![doc = include_str!("../README.md")]

pub mod identify;
pub mod linear;
pub mod npz;
pub mod thinning;
