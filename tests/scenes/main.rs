//! Scenes: a reduced model equals the full one, rigid joints are what compliant ones tend to, and what a scene cannot
//! be is a fault at its place.
//!
//! Both models of a comparison take the same steps, so that only rounding tells them apart: deviations are held to
//! 1e-12 of the column's largest magnitude, or of 1 where that is less. `-- --nocapture` prints them. A debug build
//! compares a tenth of the time.

mod examples;
mod faults;
mod hacksaw;
mod rigid;
mod twin;
