//! What a program says: results on standard output, faults as one line each on standard error.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write, stderr, stdout};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::FileError;

/// What stands for standard output where a file can be given.
pub const STANDARD: &str = "-";

/// Whether the program says nothing but faults and what is asked for.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// From now on the program says faults and what is asked for, and, unless it is to be quiet, also what it does beside.
pub fn set_quiet(is_quiet: bool) {
    IS_QUIET.store(is_quiet, Relaxed);
}

/// Whether it is to be quiet.
#[must_use]
pub fn is_quiet() -> bool {
    IS_QUIET.load(Relaxed)
}

/// Whether what is said is coloured: always, never, or on a terminal unless the environment has `NO_COLOR`
/// (no-color.org).
#[cfg(not(target_arch = "wasm32"))]
pub fn set_colour(choice: clap::ColorChoice) {
    let choice = match choice {
        clap::ColorChoice::Auto => anstream::ColorChoice::Auto,
        clap::ColorChoice::Always => anstream::ColorChoice::AlwaysAnsi,
        clap::ColorChoice::Never => anstream::ColorChoice::Never,
    };
    choice.write_global();
}

/// Whether what is said on standard error is coloured.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn is_coloured() -> bool {
    anstream::AutoStream::choice(&stderr()) != anstream::ColorChoice::Never
}

/// Prints `text`, which tells of files that are written, to standard output, unless the program is to be quiet.
///
/// # Errors
/// As [`print()`].
pub fn tell(text: &str) -> Result<(), FileError> {
    if is_quiet() { Ok(()) } else { print(text) }
}

/// What a command has found: `text`, as [`tell`] has it, or where JSON is asked for that, whether the program is to be
/// quiet or not.
///
/// # Errors
/// As [`print()`].
pub fn tell_as(as_json: bool, text: &str, json: impl FnOnce() -> serde_json::Value) -> Result<(), FileError> {
    if as_json { print(&format!("{:#}\n", json())) } else { tell(text) }
}

/// The same on standard error, where standard output has a result.
///
/// # Errors
/// As [`print()`].
pub fn tell_aside(text: &str) -> Result<(), FileError> {
    if is_quiet() { Ok(()) } else { unless_closed(stderr().write_all(text.as_bytes())).map_err(FileError::Standard) }
}

/// Prints `text` to standard output. A reader that has gone away, as `head` does, is no fault.
///
/// # Errors
/// [`FileError::Standard`], for instance on a full disk.
pub fn print(text: &str) -> Result<(), FileError> {
    printed(stdout().write_all(text.as_bytes()))
}

/// What became of printing: flushes standard output after `outcome`, and judges both as [`print()`] does.
///
/// # Errors
/// As [`print()`].
pub fn printed(outcome: io::Result<()>) -> Result<(), FileError> {
    unless_closed(outcome.and_then(|()| stdout().flush())).map_err(FileError::Standard)
}

/// Says `fault` on standard error as one line that begins with `error: `.
pub fn complain(fault: &impl Display) {
    // There is no place left to report a failure of standard error; the exit code tells.
    let _ = writeln!(stderr(), "error: {}", one_line(&fault.to_string()));
}

/// Says `note` on standard error as one line that begins with `note: `.
pub fn note(note: &impl Display) {
    let _ = writeln!(stderr(), "note: {}", one_line(&note.to_string()));
}

/// What clap says of the words of a command line in several lines, in one.
#[must_use]
pub fn in_one_line(text: &str) -> String {
    let told =
        text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"));
    let told: Vec<&str> = told.filter(|line| !line.is_empty()).collect();
    let line = told.join("; ").replace(":; ", ": ");
    format!("{}; --help says more", line.strip_prefix("error: ").unwrap_or(&line))
}

/// `outcome`, where a reader that has gone away is none of the writer's faults.
pub(super) fn unless_closed(outcome: io::Result<()>) -> io::Result<()> {
    match outcome {
        Err(fault) if fault.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome,
    }
}

/// `text` without control characters, which a path may contain.
fn one_line(text: &str) -> String {
    let shown = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_does_not_break_the_line() {
        assert_eq!(one_line("cannot write a\nb\u{1b}[1m: \u{e9}"), "cannot write a\\nb\\u{1b}[1m: \u{e9}");
    }

    #[test]
    fn only_a_closed_pipe_is_no_fault() {
        assert!(unless_closed(Err(ErrorKind::BrokenPipe.into())).is_ok());
        assert!(unless_closed(Err(ErrorKind::StorageFull.into())).is_err());
    }
}
