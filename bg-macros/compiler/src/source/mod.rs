//! The description as its author wrote it: text, tree, mechanism words.
//!
//! In: tokens. Out: a tree of bond-graph words without parts for each model: the literal graph and one for each scene.

pub mod ast;
pub mod clause;
pub mod drawing;
pub mod functions;
pub mod library;
pub mod mechanism;
pub mod names;
pub mod numbers;
pub mod part;
pub mod print;
pub mod scene;
pub mod syntax;
pub mod visibility;
pub mod vocabulary;
pub(crate) mod walk;
pub(crate) mod words;
