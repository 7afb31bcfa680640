//! Tokens of the generated items.
//!
//! In: [`crate::StateEquations`] with their programs. Out: tokens. Only this module quotes.

mod description;
mod items;
mod model;
pub mod routine;
mod stub;

pub use model::model;
pub use stub::stub;
