//! What several suites measure with.

pub mod power;
pub mod record;
pub mod rotation;
