//! Contacts: dry friction that sticks, brakes, stops with a restitution.

mod brakes;
mod friction;
mod impacts;
#[path = "../random/mod.rs"]
mod random;
mod states;
