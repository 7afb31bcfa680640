//! Graphs without a fault, and the code that uses what they promise.

mod motor;
mod names;
mod parts;
