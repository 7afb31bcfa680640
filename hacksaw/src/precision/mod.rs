//! The hacksaw's cases of `precision` and their stored solutions.

pub mod case;
pub mod reference;
