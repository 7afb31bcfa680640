//! The paper's hacksaw against other solvers: what each costs for each error, all in one run.
//!
//! `cargo run --release --manifest-path hacksaw/peers/Cargo.toml`. In: options, see `--help`. Out: tables on standard
//! output, and in a folder the whole of it as Markdown, CSV, JSON and a work-precision diagram. `README.md` beside this
//! package says what is measured and how.

mod batch;
mod command;
mod diagram;
mod machine;
mod measure;
mod poses;
mod problem;
mod ratios;
mod solvers;
mod table;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    match command::run(&command::Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("error: {fault}");
            ExitCode::FAILURE
        }
    }
}
