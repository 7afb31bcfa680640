//! The command `new`: a file with a first mechanism.

use std::fs::OpenOptions;
use std::io::Write;

use bg_workbench::files::console;

/// What stands in the file.
const TEXT: &str = include_str!("first.bond");

/// Writes the file `NAME.bond`.
///
/// # Errors
/// There is such a file, or it cannot be written.
pub fn new(name: &str) -> Result<(), String> {
    let path = if name.ends_with(".bond") { name.to_owned() } else { format!("{name}.bond") };
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    let written = file.and_then(|mut file| file.write_all(TEXT.as_bytes()));
    written.map_err(|fault| format!("cannot write {path}: {fault}"))?;
    console::print(&format!("{path}: a pendulum; run it by: bond run {path}\n")).map_err(|fault| fault.to_string())
}
