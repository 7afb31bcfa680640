//! One run: made, told in numbers, held against another one.

#[cfg(not(target_arch = "wasm32"))]
pub mod compare;
pub(crate) mod quantities;
pub mod recipe;
pub(crate) mod running;
#[cfg(not(target_arch = "wasm32"))]
pub mod samples;
pub mod summary;
