//! The algebra under the compiler of `bond_graph!`. It knows nothing of bond graphs.
//!
//! | module | from -> to |
//! |---|---|
//! | [`expr`] | terms -> nodes in which equal ones are stored once; derivatives, antiderivatives, identities, values |
//! | [`schedule`] | nodes -> straight-line code with few operations, in pairs where that pays |
//! | [`elimination`] | the pattern of a matrix -> in which order it is eliminated |
//!
//! Here the compiler spends its time, so this package alone is optimised where the compiler is built.

pub mod elimination;
pub mod expr;
pub mod random;
pub mod schedule;
