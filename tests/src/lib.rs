//! Suites across the crates: models in the macro, how they are run, and what the suites under `tests/` measure with.

pub mod examples;
pub mod fuzz;
pub mod hard_hacksaw;
pub mod hardcases;
pub mod linear;
pub mod long_term;
pub mod power;
pub mod record;
pub mod rotation;
pub mod switching;
