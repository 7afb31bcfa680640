//! Units: an instance through its safe layer, its terminals, and what hosts say of both.

mod hosts;
mod instance;
#[path = "../../examples/machines/mod.rs"]
mod machines;
mod states;
mod terminals;
