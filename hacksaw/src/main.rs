//! The program `hacksaw`: see [`hacksaw::command`].

use std::process::ExitCode;

fn main() -> ExitCode {
    hacksaw::command::main(std::env::args_os())
}
