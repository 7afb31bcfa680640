//! The program `bond`: every command of the workbench on a text file, without rustc.
//!
//! In: a command, a file with graphs in the language of `bond_graph!` (or a robot's description), the command's
//! options. Out: what the command gives of the models of the file, which run in machine code or are interpreted.

mod arguments;
mod check;
mod fmt;
mod new;
mod parts;
mod served;
mod watch;

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use arguments::{Asked, Call, Own};
use bg_loaded::BackEnd;
use bg_workbench::Program;
use bg_workbench::command::{config, manual};
use bg_workbench::files::commit::commit_of;
use bg_workbench::files::{FileError, console, crc32};
use bond_graph::maker::{self, Source};
use bond_graph::{faults, file, serve, tables};
use served::Served;

fn main() -> ExitCode {
    match arguments::asked(std::env::args_os()) {
        Ok(Asked::Own(Own::Check { files, json, most })) => check::check(&files, json, most),
        Ok(Asked::Own(Own::Fmt { files, check })) => fmt::fmt(&files, check),
        Ok(Asked::Own(Own::Watch { served, file, options })) => watch::watch(&file, &options, &served),
        Ok(Asked::Own(Own::Serve { served, page })) => serve_page(page, &served).unwrap_or_else(refused),
        Ok(Asked::Own(Own::Completions { shell })) => {
            said(console::print(&manual::completions(arguments::whole(), shell)))
        }
        Ok(Asked::Own(Own::Man { out: None })) => said(console::print(&manual::page(arguments::whole()))),
        Ok(Asked::Own(Own::Man { out: Some(folder) })) => {
            said(manual::pages(arguments::whole(), &folder).and_then(|written| console::print(&format!("{written}\n"))))
        }
        Ok(Asked::Own(Own::New { name })) => new::new(&name).map_or_else(refused, |()| ExitCode::SUCCESS),
        Ok(Asked::Own(Own::Parts { name })) => {
            parts::parts(name.as_deref()).map_or_else(refused, |()| ExitCode::SUCCESS)
        }
        Ok(Asked::Program(call)) => program(call),
        Err(fault) if fault.use_stderr() => refused(console::in_one_line(&fault.render().to_string())),
        // Help and version.
        Err(help) => said(console::printed(help.print())),
    }
}

/// What became of saying something.
fn said(outcome: Result<(), FileError>) -> ExitCode {
    outcome.map_or_else(refused, |()| ExitCode::SUCCESS)
}

/// Input that cannot be used.
fn refused(fault: impl Display) -> ExitCode {
    console::complain(&fault);
    ExitCode::from(2)
}

/// Serves the page that compiles until the process is ended.
fn serve_page(folder: Option<PathBuf>, served: &Served) -> Result<ExitCode, String> {
    let folder = folder.unwrap_or_else(serve::usual);
    let address = serve::start(&folder, served.port).map_err(|fault| fault.to_string())?;
    served.show(&address, "the page that compiles")?;
    loop {
        std::thread::park();
    }
}

/// Hands a command of the workbench to the program of a graph.
fn program(Call { file, graph, is_interpreted, most, tables, command, options }: Call) -> ExitCode {
    let read = match file::read(&file) {
        Ok(read) => read,
        Err(fault) => return refused(fault),
    };
    let crc32 = crc32(read.text.as_bytes());
    let words = ["bond".into()].into_iter().chain(command.iter().map(Into::into)).chain(options);
    let words = match config::words(words) {
        Ok(words) => words,
        Err(fault) => return refused(fault),
    };
    let tables = match tables::given(&tables, arguments::again(&words.options()).as_deref()) {
        Ok(tables) => tables,
        Err(fault) => return refused(fault),
    };
    let read = match tables::put(read, &tables) {
        Ok(read) => read,
        Err(fault) => return refused(format!("--table: {fault}")),
    };
    let scene = arguments::only_scene(&command, &words.options());
    let counted = arguments::counted(&command);
    let wanted = file::Wanted { scene, counted, most };
    let graphs = match file::graphs(&read, &wanted) {
        Ok(graphs) => graphs,
        Err(faults) => {
            faults::tell(&read, &faults);
            return ExitCode::from(2);
        }
    };
    match maker::Loaded::of(graphs, graph.as_deref()) {
        Ok(loaded) => {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
            let commit = commit_of(folder.unwrap_or_else(|| Path::new(".")));
            let loaded = loaded.of_source(Source { text: read, gather: file::bundle, most });
            let loaded = if is_interpreted { loaded.by(BackEnd::Interpreter) } else { loaded };
            let program = Program::with(loaded).on_file("bond", &file.display().to_string()).tables(tables);
            program.version(&arguments::version()).of_text(&name, &crc32).commit(commit.as_deref()).obey(&words)
        }
        Err(fault) => refused(format!("{}: {fault}", file.display())),
    }
}
