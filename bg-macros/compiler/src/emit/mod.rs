//! Tokens of the generated items.
//!
//! In: [`crate::StateEquations`] with their programs. Out: tokens. Only this module quotes.

mod description;
mod elimination;
mod items;
mod model;
mod pairs;
mod programs;
pub mod routine;
mod series;
mod stub;

pub use model::{Parts, model};
pub use stub::stub;
