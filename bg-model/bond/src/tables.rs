//! Tables of a text with the points of other files.
//!
//! In: names and files, or the summary of a run that is made again. Out: the text with them; what the summary has of
//! them.

use std::path::{Path, PathBuf};

use bg_workbench::files::crc32;
use bg_workbench::recipe::{AgainError, read};
use bg_workbench::table_file::TableFile;
use thiserror::Error;

use crate::text::{NoTable, Points, Text};

/// Points that cannot be had.
#[derive(Debug, Error)]
pub enum TableFault {
    /// A file cannot be read.
    #[error("--table {name}={}: cannot be read: {fault}", path.display())]
    Unreadable {
        /// The table.
        name: String,
        /// The file.
        path: PathBuf,
        /// Why.
        fault: std::io::Error,
    },
    /// The summary of the run cannot be used.
    #[error(transparent)]
    Again(#[from] AgainError),
    /// A file has changed since.
    #[error("--again: the points of the table `{name}` in {} are others than then; \
        the run would be another one", path.display())]
    Other {
        /// The table.
        name: String,
        /// The file.
        path: PathBuf,
    },
    /// A run that is made again has the tables that it had.
    #[error("--again makes a run with the tables that it had; leave --table out")]
    Both,
}

/// The tables with their files: those that are named, or those of the run whose summary is at `again`.
///
/// # Errors
/// [`TableFault`].
pub fn given(named: &[(String, PathBuf)], again: Option<&Path>) -> Result<Vec<TableFile>, TableFault> {
    let Some(summary) = again else { return named.iter().map(|(name, path)| at(name, path)).collect() };
    if !named.is_empty() {
        return Err(TableFault::Both);
    }
    let then = read(summary)?.tables;
    let same = |then: TableFile| {
        let now = at(&then.table, &then.file)?;
        if now == then { Ok(now) } else { Err(TableFault::Other { name: then.table, path: then.file }) }
    };
    then.into_iter().map(same).collect()
}

/// A table with the points of the file at `path`, as it is found from any folder.
fn at(name: &str, path: &Path) -> Result<TableFile, TableFault> {
    let read = || {
        let file = path.canonicalize()?;
        let crc32 = crc32(&std::fs::read(&file)?);
        Ok(TableFile { table: name.to_owned(), file, crc32 })
    };
    read().map_err(|fault| TableFault::Unreadable { name: name.to_owned(), path: path.to_owned(), fault })
}

/// The text with these tables.
///
/// # Errors
/// It has no such table.
pub fn put(text: Text, tables: &[TableFile]) -> Result<Text, NoTable> {
    tables.iter().try_fold(text, |text, of| text.with_table(&of.table, &Points::File(of.file.clone())))
}
