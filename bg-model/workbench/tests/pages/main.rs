//! Pages: what `report` writes, the page by itself, and a live one with its model inside.

mod browser;
#[path = "../programs/example.rs"]
mod example;
mod live;
mod machine;
#[path = "../programs/outcome.rs"]
mod outcome;
mod page;
#[path = "../../examples/pendulum.rs"]
#[allow(dead_code, unused_attributes)]
mod pendulum;
mod readers;
mod report;
