//! The command `watch`: the report of a file in the browser, made anew whenever the file is saved.
//!
//! In: a file, options of `report`. Out: a page of a server on this machine; the newest report is in it, and above it
//! what is wrong with the file now. Method: file times are looked at a hundred times a second, which sees a file that
//! an editor replaces as it sees one that is written, on every system and in every folder. A report is made by a
//! process of its own, which a later save ends.

mod changes;
mod report;
mod server;

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use bg_workbench::files::console;
use bond_graph::file;
use changes::Changes;
use report::{Ended, Making};
use server::Shared;
use tempfile::TempDir;

use crate::served::Served;

/// Between two looks at the files.
const LOOK: Duration = Duration::from_millis(10);

/// Serves the report of a file until the process is ended.
pub fn watch(path: &Path, options: &[OsString], served: &Served) -> ExitCode {
    // A wrong path is no file that will be right at the next save.
    if let Err(fault @ file::FileFault::Unreadable { .. }) = file::read(path) {
        return refused(&fault.to_string());
    }
    let shared = Arc::new(Shared::of(path));
    let address = match server::start(served.port, Arc::clone(&shared)) {
        Ok(address) => address,
        Err(fault) => return refused(&fault.to_string()),
    };
    if let Err(fault) = served.show(&address, &path.display().to_string()) {
        return refused(&fault);
    }
    // The graph stays the same where a number changes.
    match TempDir::new() {
        Ok(kept) => follow(path, options, &kept.path().join("picture"), &shared),
        Err(fault) => refused(&format!("there is no folder for what is kept: {fault}")),
    }
}

/// Makes a report at every change; the picture of the graph is kept in `picture`.
fn follow(path: &Path, options: &[OsString], picture: &Path, shared: &Shared) -> ! {
    let mut changes = Changes::of(of_options(options));
    let mut making: Option<Making> = None;
    loop {
        if changes.are_there(|| file::files(path)) {
            // What runs is ended where it is dropped.
            drop(making.take());
            match Making::begin(path, options, picture) {
                Ok(begun) => {
                    shared.begin();
                    making = Some(begun);
                }
                Err(fault) => shared.fail(fault),
            }
        }
        match making.as_mut().and_then(Making::ended) {
            Some(Ended::Made(page)) => shared.show(page),
            Some(Ended::Failed(told)) => {
                eprint!("{told}");
                shared.fail(told);
            }
            None => {
                std::thread::sleep(LOOK);
                continue;
            }
        }
        making = None;
    }
}

/// The files among the options: tables of inputs, parameters.
fn of_options(options: &[OsString]) -> Vec<PathBuf> {
    let words = options.iter().map(|word| word.to_string_lossy().into_owned());
    let paths = words.map(|word| PathBuf::from(word.rsplit('=').next().unwrap_or_default()));
    paths.filter(|path| path.is_file()).collect()
}

fn refused(fault: &str) -> ExitCode {
    console::complain(&fault);
    ExitCode::from(2)
}
