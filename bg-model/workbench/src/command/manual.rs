//! Manual pages, and what shells complete by.
//!
//! In: a command line. Out: pages in roff, a script.

use std::path::Path;

use clap::Command;
use clap_complete::Shell;

use crate::files::FileError;

/// The script for a shell.
#[must_use]
pub fn completions(mut command: Command, shell: Shell) -> String {
    let name = command.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, name, &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// The page of the program.
#[must_use]
pub fn page(command: Command) -> String {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page).expect("memory takes it");
    String::from_utf8_lossy(&page).into_owned()
}

/// Writes a page of the program and one of each of its commands; gives a sentence that says so.
///
/// # Errors
/// [`FileError::Write`].
pub fn pages(command: Command, folder: &Path) -> Result<String, FileError> {
    let name = command.get_name().to_owned();
    let failed = |source| FileError::Write { path: folder.to_owned(), source };
    std::fs::create_dir_all(folder).map_err(failed)?;
    clap_mangen::generate_to(command, folder).map_err(failed)?;
    let folder = folder.display();
    Ok(format!("written: {folder}; man {folder}/{name}.1 shows the first"))
}
