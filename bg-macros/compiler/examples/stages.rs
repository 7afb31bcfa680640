//! Prints the stages of a graph in a file: `cargo run -p bg-compiler --example stages -- FILE [STAGE]`.

use std::process::ExitCode;

use bg_compiler::stages::NAMES;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(file) = arguments.next() else {
        eprintln!("usage: stages FILE [{}]", NAMES.join("|"));
        return ExitCode::from(2);
    };
    let wanted = arguments.next();
    let text = match std::fs::read_to_string(&file) {
        Ok(text) => text,
        Err(error) => {
            eprintln!("error: {file}: {error}");
            return ExitCode::from(2);
        }
    };
    let tokens = match text.parse() {
        Ok(tokens) => tokens,
        Err(error) => {
            eprintln!("error: {file}: {error}");
            return ExitCode::FAILURE;
        }
    };
    match bg_compiler::stages::stages(tokens) {
        Ok(stages) => {
            for stage in stages.iter().filter(|stage| wanted.as_deref().is_none_or(|name| name == stage.name)) {
                println!("== {} {}\n{}", stage.graph, stage.name, stage.text);
            }
            ExitCode::SUCCESS
        }
        Err(faults) => {
            for fault in faults {
                let at = fault.span.start();
                eprintln!("{file}:{}:{}: {fault}", at.line, at.column + 1);
            }
            ExitCode::FAILURE
        }
    }
}
