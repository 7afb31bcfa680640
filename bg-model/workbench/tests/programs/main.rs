//! What the programs of the examples do: their commands, files, refusals and pictures.

mod command;
mod example;
mod gallery;
mod gradient;
mod identify;
mod inputs;
mod outcome;
mod picture;
#[path = "../../../../bg-macros/picture/tests/support/mod.rs"]
mod support;
mod sweep;
mod trajectory;
