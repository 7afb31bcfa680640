//! The paper's five-link power hacksaw: the mechanism, and what the paper adds to the workbench of any mechanism.
//!
//! | module | question |
//! |---|---|
//! | [`mechanism`] | what the hacksaw is: its multibond graph, compiled |
//! | [`scenes`] | which of its models there are, by a name that the compiler knows |
//! | [`agreement`] | how far a scene is from the literal model |
//! | [`columns`] | which columns the paper's figures and its reference have |
//! | [`checks`] | does the motion show what the paper says of it |
//! | [`figures`] | what the paper's figures 4 to 19 look like |
//! | [`sources`] | which parameters the paper gives, which are assumed |
//! | [`summary`] | energy, gaps and crank speed of a run |
//! | [`precision`] | which cases are measured, and their stored solutions |
//! | [`command`] | the program |

#[cfg(not(target_arch = "wasm32"))]
pub mod agreement;
pub mod checks;
pub mod columns;
pub mod command;
#[cfg(not(target_arch = "wasm32"))]
pub mod figures;
pub mod mechanism;
#[cfg(not(target_arch = "wasm32"))]
pub mod precision;
pub mod scenes;
pub mod sources;
pub mod summary;

pub use mechanism::Mechanism;
