//! Expressions as a graph with shared nodes, and the algebra on it.
//!
//! In: terms with resolved names, as calls of [`Pool`]'s constructors. Out: [`Id`]s of nodes in canonical form, and
//! their derivatives, antiderivatives, values, texts and identities.

mod antiderivative;
mod bounds;
mod calculus;
mod circle;
mod domain;
mod evaluate;
mod function;
mod gauss;
mod magnitude;
mod node;
mod polynomial;
mod pool;
mod product;
#[cfg(test)]
pub(crate) mod random;
mod sign;
mod size;
mod substitute;
mod sum;
mod text;

pub use antiderivative::antiderivative;
pub use bounds::{Bounds, bounds};
pub use calculus::{derivative, gradient, partial};
pub use circle::Circles;
pub use evaluate::{Environment, apply, evaluate};
pub use gauss::{Linear, Solution, solve_linear};
pub use magnitude::magnitudes;
pub use node::{Function, Id, Node, Number, Symbol};
pub use polynomial::{Monomials, monomials, same_polynomial};
pub use pool::{Pool, children};
pub(crate) use product::MOST_EXPONENT;
pub use sign::{Signs, signs};
pub use size::{Sized, sized};
pub use substitute::{Branch, blended, exchange, substitute, substitute_switched};
pub use text::text;
