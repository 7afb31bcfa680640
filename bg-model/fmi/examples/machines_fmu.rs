//! A library for functional mock-up units of three machines.
//!
//!     cargo build --release -p bg-fmi --example machines_fmu

mod machines;

bg_fmi::export!(machines::Pendulum, machines::Ball, machines::Shaker);
