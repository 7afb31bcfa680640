//! How the results of a program reach the disk and the terminal: whole, or not at all and with a message.
//!
//! Nothing here knows a mechanism. [`RunFolder`] is a folder that is one run's or none's, [`whole`] writes a single
//! file, [`console`] prints. What goes wrong is a [`FileError`]: one line with the place and, where there is one, what
//! to do.

#[cfg(not(target_arch = "wasm32"))]
pub mod commit;
pub mod console;
mod folder;
pub mod head;
#[cfg(not(target_arch = "wasm32"))]
pub mod json;
pub mod parquet;
pub mod table;
pub mod whole;

use std::io;
use std::path::PathBuf;

use thiserror::Error;

pub use folder::RunFolder;
pub(crate) use folder::check_is_no_file;

/// A result that does not reach its place.
#[derive(Debug, Error)]
pub enum FileError {
    /// The system refuses to write.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file stands where the folder, or one above it, should be.
    #[error("cannot write into {}: {} is a file; choose a folder with --out", folder.display(), file.display())]
    NotAFolder {
        /// The folder.
        folder: PathBuf,
        /// The file.
        file: PathBuf,
    },
    /// Another run has claimed the folder.
    #[error("another run is writing into {}: wait for its end, or choose another folder with --out", .0.display())]
    Busy(PathBuf),
    /// A file of a result's name is there that no earlier run wrote.
    #[error("{} is no file of an earlier run: move it away, or choose another folder with --out", .0.display())]
    Foreign(PathBuf),
    /// The file system does not lock files.
    #[error("cannot lock {}: {source}; choose a folder on another disk with --out", path.display())]
    Lock {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Standard output takes no more.
    #[error("cannot write to standard output: {0}")]
    Standard(io::Error),
}

/// The CRC-32 of `bytes` in eight hexadecimal digits, by which files and values are told apart: it guards against
/// mistakes, not against forgery.
#[must_use]
pub fn crc32(bytes: &[u8]) -> String {
    format!("{:08x}", rawzip::crc32(bytes))
}
