//! Runs: the driver, events, samples, what ends them, what they say and that they allocate nothing; tables, values and
//! drawings of a model.

mod allocation;
mod decades;
mod drawing;
mod driver;
mod events;
mod messages;
mod no_number;
mod origins;
mod parameters;
mod peaks;
#[path = "../problems/mod.rs"]
mod problems;
#[path = "../random/mod.rs"]
mod random;
mod recording;
mod run;
mod sizes;
mod states;
mod stopping;
mod switching;
mod tables;
#[allow(dead_code, reason = "`mechanisms` uses more of it")]
#[path = "../mechanisms/text.rs"]
mod text;
mod values;
