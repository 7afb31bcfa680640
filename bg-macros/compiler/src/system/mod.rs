//! The system of equations: scalars only.
//!
//! In: a graph with its strokes. Out: the state equations, what a scene needs of them, their derivatives.

pub mod equations;
pub mod expectation;
pub mod jacobian;
pub mod reduce;
pub mod requirements;
pub mod second_order;
