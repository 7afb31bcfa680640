//! Long-term behaviour: what conservative scenes keep of their energy, angular momentum and orthogonality.
//!
//! In: nothing. Out: [`scenes::scenes`], and what became of their invariants in a run ([`drift::drift`]). The suite
//! `long_term` and the bench `stability` use them.

pub mod drift;
pub mod scenes;
pub mod sheets;
