//! What several suites measure with.

pub mod example;
pub mod power;
pub mod record;
pub mod rotation;
