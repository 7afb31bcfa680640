//! Prints the stages of a graph in a file: `cargo run -p bg-compiler --example stages -- FILE [STAGE]`.

use std::path::Path;
use std::process::ExitCode;

use bg_compiler::source::syntax::files::{Opened, gather};
use bg_compiler::stages::{NAMES, stages};

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(file) = arguments.next() else {
        eprintln!("usage: stages FILE [{}]", NAMES.join("|"));
        return ExitCode::from(2);
    };
    let wanted = arguments.next();
    let first = match open(Path::new(&file)) {
        Ok(first) => first,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    let gathered = gather(Path::new(&file), first, &open);
    let stages =
        if gathered.faults.is_empty() { stages(gathered.tokens.clone()) } else { Err(gathered.faults.clone()) };
    match stages {
        Ok(stages) => {
            for stage in stages.iter().filter(|stage| wanted.as_deref().is_none_or(|name| name == stage.name)) {
                println!("== {} {}\n{}", stage.graph, stage.name, stage.text);
            }
            ExitCode::SUCCESS
        }
        Err(faults) => {
            for fault in faults {
                let (at, file) = (fault.span.start(), &gathered.files[gathered.place(fault.span)].path);
                eprintln!("{}:{}:{}: {}", file.display(), at.line, at.column + 1, gathered.named(fault));
            }
            ExitCode::FAILURE
        }
    }
}

fn open(path: &Path) -> Result<Opened, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(Opened { file: path.canonicalize().unwrap_or_else(|_| path.to_owned()), text })
}
