//! The command `check`: all faults of files.

use std::path::PathBuf;
use std::process::ExitCode;

use bg_workbench::files::console;
use bond_graph::{faults, file};

/// Says the faults of all files; exit code 1 where there are any, 2 where a file cannot be read.
pub fn check(files: &[PathBuf], json: bool, most: Option<usize>) -> ExitCode {
    let mut code = 0;
    for path in files {
        let text = match file::read(path) {
            Ok(text) => text,
            Err(fault) => {
                console::complain(&fault);
                code = 2;
                continue;
            }
        };
        match file::check(&text, most) {
            Ok(graphs) if json => drop(graphs),
            Ok(graphs) => say(&format!("{}: {}\n", text.path.display(), listed(&graphs)), &mut code),
            Err(faults) => {
                code = code.max(1);
                if json { say(&faults::json(&text, &faults), &mut code) } else { faults::tell(&text, &faults) }
            }
        }
    }
    ExitCode::from(code)
}

/// The graphs, each with the number of its models where it has several.
fn listed(graphs: &[(String, usize)]) -> String {
    let one = |(name, models): &(String, usize)| match models {
        1 => name.clone(),
        count => format!("{name} with {count} models"),
    };
    if graphs.is_empty() { "only parts".to_owned() } else { graphs.iter().map(one).collect::<Vec<_>>().join(", ") }
}

fn say(text: &str, code: &mut u8) {
    if let Err(fault) = console::print(text) {
        console::complain(&fault);
        *code = (*code).max(1);
    }
}
