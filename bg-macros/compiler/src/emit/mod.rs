//! Tokens of the generated items.
//!
//! In: a [`crate::pipeline::Compiled`]. Out: tokens. Only this module quotes.

mod blocks;
mod description;
mod documentation;
mod drawing;
mod elimination;
mod items;
mod model;
mod pairs;
mod parts;
mod picture;
pub mod routine;
mod series;
mod stub;

pub use model::model;
pub use parts::{parts, question};
pub use picture::picture;
pub use stub::stub;
