//! Equilibrium and linearisation of any mechanism.
//!
//! In: a mechanism, a time at which its inputs are held, a state. Out: the equilibrium near it, the linear model there
//! with its modes and frequency responses, as tables, JSON, CSV and arrays of numpy. Nothing is written: a caller has
//! texts and bytes.
//!
//! | to | see |
//! |---|---|
//! | find the equilibrium near a state | [`equilibrium`] |
//! | linearise at a state | [`linearise`], or [`linearise_at`] a state of a run; both give a [`StateSpace`] |
//! | look at modes | [`StateSpace::modes`], [`StateSpace::table`] |
//! | follow modes over a parameter | [`branches()`], [`crossings`] |
//! | get frequency responses | [`StateSpace::responses`], [`logarithmic`], [`responses_csv`], [`responses_json`] |
//! | write files | [`StateSpace::json`], [`StateSpace::npz`] |
//! | get eigenvalues of a matrix | [`eigen_pairs`] |
//!
//! # What a linear model is about
//!
//! Small changes that the mechanism can make. Of the nine entries of an orientation three rotations stay, of
//! displacements that the poses determine none, of momenta those that rigid joints allow; what memories keep and
//! samples hold stays as it is; integrals that only outputs
//! ask for change nothing and are left out ([`LeftOut`] says what is). So every eigenvalue 0 is real: a free motion,
//! such as the turning of a crank that nothing drives.
//!
//! # What an equilibrium is
//!
//! A state whose rates vanish, but for integrals that only outputs ask for. Where there is none, a steady motion:
//! coordinates on which no rate depends may go on changing ([`Equilibrium::turning`]). It is the state that Newton's
//! method finds from the guess by moves that the joints allow: what is free stays where it is, and a stable equilibrium
//! is preferred.

mod branches;
mod carry;
mod coordinates;
mod descent;
mod eigen;
mod equilibrium;
mod error;
mod independent;
mod manifold;
mod modes;
#[cfg(not(target_arch = "wasm32"))]
mod npz;
mod plant;
mod response;
mod sloped;
mod state_space;
mod text;

pub use branches::{Branch, branches, crossings};
pub use eigen::{EigenPair, eigen_pairs};
pub use equilibrium::{Equilibrium, equilibrium};
pub use error::LinearError;
pub use manifold::LeftOut;
pub use modes::{Mode, Participation};
pub use response::{Response, logarithmic};
pub use state_space::{Named, PointState, StateSpace, linearise, linearise_at};
pub use text::{responses_csv, responses_json};
