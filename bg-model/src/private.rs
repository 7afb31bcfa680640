//! What only generated code calls, under one name. It may change with every version: the macro and this crate are of one.
//!
//! Generated code calls besides: the public traits, tables and errors of this crate, the arithmetic of series, nalgebra and
//! serde.

pub use bg_macros::picture;

pub use crate::model::iteration::{Equations, newton};
pub use crate::model::linear::pivot::Pivot;
pub use crate::model::nearest::lifted;
pub use crate::model::parameters::serialized::{deserialize, serialize};
pub use crate::model::reactions::{Started, fit, kept, redundant, share};
pub use crate::model::requirement::{Requirement, require};
pub use crate::model::series::{load, store};

/// Eliminations as tables, where they are too long to be unrolled.
pub mod table {
    pub use crate::model::linear::table::{Slot, eliminate, substitute};
}
