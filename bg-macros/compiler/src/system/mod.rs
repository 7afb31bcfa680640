//! The system of equations: scalars only.
//!
//! In: a graph with its strokes. Out: the state equations, what a scene needs of them, their derivatives.

mod accelerated;
pub mod equations;
pub mod inverse;
pub mod jacobian;
pub mod link;
pub mod projection;
pub mod reduce;
pub mod requirements;
pub mod rigid;
pub mod second_order;
pub mod sizes;
mod value;

pub use equations::StateEquations;
pub use equations::stage::{Closed, Ordered, Projected, Solved};
pub use jacobian::Jacobian;
pub use second_order::SecondOrder;
pub use sizes::Sizes;
pub use value::Value;
