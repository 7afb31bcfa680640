//! Tokens of the generated items.
//!
//! In: a [`crate::pipeline::Compiled`]. Out: tokens. Only this module quotes.

mod anchors;
mod blocks;
mod coefficients;
mod description;
mod documentation;
mod drawing;
mod elimination;
mod items;
mod members;
mod model;
mod pairs;
mod parts;
mod picture;
mod remark;
pub mod routine;
mod scopes;
mod series;
mod stub;
mod version;

pub use anchors::{anchors, anchors_with_faults};
pub use model::model;
pub use parts::{parts, question};
pub use picture::picture;
pub use remark::remarks;
pub use stub::stub;
pub use version::version;
