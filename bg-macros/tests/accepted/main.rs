//! Graphs without a fault, and the code that uses what they promise.

mod file;
mod library;
mod motor;
mod names;
mod parts;
