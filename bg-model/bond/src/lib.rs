//! Mechanisms in text files, as the program `bond` and the Python module `bond_graph` take them.
//!
//! | module | question it answers |
//! |---|---|
//! | [`file`](mod@file) | what stands in a file: its text, its graphs |
//! | [`faults`] | what is wrong with a text, as a reader or a program sees it |
//! | [`format`](mod@format) | how a text looks in the one form that all have |
//! | [`maker`] | what makes the models of a graph, for the workbench |

pub mod faults;
pub mod file;
pub mod format;
pub mod maker;
