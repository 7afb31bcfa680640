//! Tables of a text that have the points of other files.

use serde::{Deserialize, Serialize};

/// A table with the file that its points were from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TableFile {
    /// The name of the table.
    pub table: String,
    /// The file.
    pub file: std::path::PathBuf,
    /// Its CRC-32.
    pub crc32: String,
}

#[cfg(not(target_arch = "wasm32"))]
impl TableFile {
    /// A table with the points of the file at `path`.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn at(table: &str, path: &std::path::Path) -> std::io::Result<Self> {
        // As it is found from any folder.
        let file = path.canonicalize()?;
        let crc32 = crate::files::crc32(&std::fs::read(&file)?);
        Ok(Self { table: table.to_owned(), file, crc32 })
    }
}
