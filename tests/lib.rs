//! Suites across the crates: a folder for each suite, with its cases, its data and its verdict (`main.rs`). This
//! library is what suites, benchmarks and examples share: the models, and the cases that are run by more than a suite.

#[path = "fuzz/cases/mod.rs"]
pub mod fuzz;
#[path = "hard_hacksaw/cases/mod.rs"]
pub mod hard_hacksaw;
#[path = "hardcases/cases/mod.rs"]
pub mod hardcases;
#[path = "linear/cases/mod.rs"]
pub mod linear;
#[path = "long_term/cases/mod.rs"]
pub mod long_term;
pub mod models;
pub mod support;
#[path = "switching/cases/mod.rs"]
pub mod switching;
