//! Linear algebra of implicit methods: the Jacobian at a point and the systems (I - c J) y = b.
//!
//! In: a flow with its Jacobian's sparsity. Out: factors of I - c J for a real or complex c, and solutions: by the
//! flow's own elimination where it has one, else, and where a pivot gets too small, by a dense one with row exchanges.

mod dense;
mod factors;
mod jacobian;

pub(super) use factors::Factors;
pub(super) use jacobian::Jacobian;
