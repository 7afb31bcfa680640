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
