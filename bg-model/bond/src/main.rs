//! The program `bond`: every command of the workbench on a text file, without rustc.
//!
//! In: a command, a file with graphs in the language of `bond_graph!` (or a robot's description), the command's options.
//! Out: what the command gives of the models of the file, which run in machine code or are interpreted.

mod arguments;
mod check;
mod new;

use std::process::ExitCode;

use arguments::{Asked, Call};
use bg_loaded::BackEnd;
use bg_workbench::Program;
use bg_workbench::files::console;
use bond_graph::{faults, file, maker};

fn main() -> ExitCode {
    let outcome = match arguments::asked(std::env::args_os().skip(1)) {
        Ok(Asked::Help(text)) => console::print(&text).map(|()| ExitCode::SUCCESS).map_err(|fault| fault.to_string()),
        Ok(Asked::Check { files, json }) => return check::check(&files, json),
        Ok(Asked::New { name }) => new::new(&name).map(|()| ExitCode::SUCCESS),
        Ok(Asked::Program(call)) => return program(call),
        Err(fault) => Err(fault),
    };
    outcome.unwrap_or_else(|fault| {
        console::complain(&fault);
        ExitCode::from(2)
    })
}

/// Hands a command of the workbench to the program of a graph.
fn program(Call { file, graph, is_interpreted, command, options }: Call) -> ExitCode {
    let read = match file::read(&file) {
        Ok(read) => read,
        Err(fault) => {
            console::complain(&fault);
            return ExitCode::from(2);
        }
    };
    let graphs = match file::graphs(&read, arguments::only_scene(&command, &options).as_deref()) {
        Ok(graphs) => graphs,
        Err(faults) => {
            faults::tell(&read, &faults);
            return ExitCode::from(2);
        }
    };
    match maker::Loaded::of(graphs, graph.as_deref()) {
        Ok(loaded) => {
            let words = ["bond".into()].into_iter().chain(command.iter().map(Into::into));
            let loaded = if is_interpreted { loaded.by(BackEnd::Interpreter) } else { loaded };
            let program = Program::with(loaded).on_file("bond", &file.display().to_string());
            program.version(env!("CARGO_PKG_VERSION")).main(words.chain(options))
        }
        Err(fault) => {
            console::complain(&format!("{}: {fault}", file.display()));
            ExitCode::from(2)
        }
    }
}
