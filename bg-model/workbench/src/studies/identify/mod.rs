//! Identification from files: measured columns in, what was found as text. What is calculated stands in
//! [`bg_analysis::identify`].

pub mod data;
pub mod report;

pub use bg_analysis::identify::*;
