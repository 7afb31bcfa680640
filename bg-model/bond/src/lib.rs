//! Mechanisms in text files, as the program `bond` and the Python module `bond_graph` take them.
//!
//! | module | question it answers |
//! |---|---|
//! | [`text`] | what a text is; its graphs, where it uses no files |
//! | [`file`](mod@file) | what stands in a file: its text, its graphs |
//! | [`faults`] | what is wrong with a text, as a reader or a program sees it |
//! | [`format`](mod@format) | how a text looks in the one form that all have |
//! | `serve` | what serves the page that compiles; with the feature `program` |
//! | [`tables`] | which tables of a text have the points of other files |
//! | [`maker`] | what makes the models of a graph, for the workbench |

pub mod faults;
// In WebAssembly there are no files.
#[cfg(not(target_arch = "wasm32"))]
pub mod file;
pub mod format;
pub mod maker;
#[cfg(feature = "program")]
pub mod serve;
#[cfg(not(target_arch = "wasm32"))]
pub mod tables;
pub mod text;
