//! What the program does: its commands, the files of a run, parameters, page and pictures.

mod command;
mod documents;
mod files;
mod page;
mod parameters;
mod picture;
#[path = "../../../bg-macros/picture/tests/support/mod.rs"]
mod support;
mod tables;
