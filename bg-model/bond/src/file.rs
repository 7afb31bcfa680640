//! A file to its graphs.
//!
//! In: a path. Out: its text, where it is one, in the language of `bond_graph!`; of a robot the text that `bg-import`
//! makes. The graphs of the text and of the files that it uses, or their faults.

use std::cell::RefCell;
use std::fs::{File, metadata};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

use bg_compiler::source::syntax::files::gather;
use bg_import::{Format, Options, import_file};
use bg_loaded::{Bundle, Fault, Graph, Opened, check_file, load_file, on_a_large_stack};
use bg_workbench::files::console;
use thiserror::Error;

use crate::text::DEEPEST;
pub use crate::text::{Counted, Text, Wanted};

/// The largest file that is read, bytes: a mechanism of a thousand bodies has a tenth of it.
const LARGEST: u64 = 8 << 20;
/// The endings of files that hold no mechanism.
const DATA: [&str; 6] = ["csv", "json", "toml", "parquet", "svg", "html"];
/// How often a file is read that changes meanwhile, and the pause before it is read again.
const ATTEMPTS: usize = 5;
const PAUSE: Duration = Duration::from_millis(20);

/// A file that cannot be used.
#[derive(Debug, Error)]
pub enum FileFault {
    /// It is not there, or not to be read.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// It is larger than any mechanism.
    #[error("{}: larger than {} MB, which is no mechanism", .0.display(), LARGEST >> 20)]
    Large(PathBuf),
    /// It is no text.
    #[error("{}: no text in UTF-8", .0.display())]
    NoText(PathBuf),
    /// It is written all the time.
    #[error("{}: changes while it is read; wait until it is written", .0.display())]
    Changing(PathBuf),
    /// It is Rust, or a robot.
    #[error("{}: no text of the language alone; give a file such as saw.bond", .0.display())]
    Other(PathBuf),
    /// It is a table, settings, a picture or a page.
    #[error("{}: data, no mechanism; the file of the mechanism comes first, such as saw.bond", .0.display())]
    Data(PathBuf),
    /// Its brackets are too deep for a reader of any kind.
    #[error("{}: brackets in brackets, more than {DEEPEST} deep", .0.display())]
    Deep(PathBuf),
    /// It is no robot that can be taken over.
    #[error("{}: {fault}", path.display())]
    Import {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: String,
    },
}

/// The text of the file of a mechanism.
///
/// # Errors
/// [`FileFault`].
pub fn read(path: &Path) -> Result<Text, FileFault> {
    let is_data = |ending: &str| DATA.iter().any(|data| ending.eq_ignore_ascii_case(data));
    let ending = path.extension().and_then(|ending| ending.to_str());
    if ending.is_some_and(is_data) { Err(FileFault::Data(path.to_owned())) } else { taken(path) }
}

/// The text of a file of any kind.
fn taken(path: &Path) -> Result<Text, FileFault> {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let format = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("urdf") => Some(Format::Urdf),
        Some("xml" | "mjcf") => Some(Format::Mjcf),
        _ => None,
    };
    match format {
        Some(format) => Text { path: path.to_owned(), text: imported(format, path)? }.checked(),
        None => plain(path),
    }
}

/// The text of a file of the language.
///
/// # Errors
/// [`FileFault`]; it is of another kind.
pub fn read_text(path: &Path) -> Result<Text, FileFault> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("rs" | "urdf" | "xml" | "mjcf") => Err(FileFault::Other(path.to_owned())),
        _ => plain(path),
    }
}

/// A file that a text uses.
fn open(path: &Path) -> Result<Opened, String> {
    Ok(taken(path).map_err(|fault| fault.to_string())?.opened())
}

/// The file that a path leads to; the path where it leads to none, as that of a text from elsewhere.
fn itself(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

impl Text {
    /// It as the compiler takes it.
    fn opened(&self) -> Opened {
        Opened { file: itself(&self.path), text: self.text.clone() }
    }

    /// The text, if a reader can follow it.
    fn checked(self) -> Result<Self, FileFault> {
        if self.is_deep() { Err(FileFault::Deep(self.path)) } else { Ok(self) }
    }
}

/// The text of a file as it is at one time.
fn plain(path: &Path) -> Result<Text, FileFault> {
    let unreadable = |source| FileFault::Unreadable { path: path.to_owned(), source };
    // A pipe has been written meanwhile, and is read once.
    let state = || {
        let metadata = metadata(path).map_err(unreadable)?;
        Ok(metadata.is_file().then(|| (metadata.len(), metadata.modified().ok())))
    };
    let read = || text_of(File::open(path).map_err(unreadable)?, path);
    at_one_time(state, read)?.ok_or_else(|| FileFault::Changing(path.to_owned()))
}

/// What is read while the state stays; none where it does not, in several attempts.
fn at_one_time<S: PartialEq, T, E>(
    state: impl Fn() -> Result<S, E>,
    mut read: impl FnMut() -> Result<T, E>,
) -> Result<Option<T>, E> {
    let mut before = state()?;
    for _ in 0..ATTEMPTS {
        let found = read();
        let after = state()?;
        if before == after {
            return found.map(Some);
        }
        before = after;
        std::thread::sleep(PAUSE);
    }
    Ok(None)
}

/// The text that a reader gives, called `path`.
///
/// # Errors
/// [`FileFault`].
pub fn text_of(reader: impl Read, path: &Path) -> Result<Text, FileFault> {
    let path = path.to_owned();
    let mut bytes = Vec::new();
    // A pipe has no length, and a file may grow while it is read.
    if let Err(source) = reader.take(LARGEST + 1).read_to_end(&mut bytes) {
        return Err(FileFault::Unreadable { path, source });
    }
    if bytes.len() as u64 > LARGEST {
        return Err(FileFault::Large(path));
    }
    match String::from_utf8(bytes) {
        Ok(text) => Text { path, text }.checked(),
        Err(_) => Err(FileFault::NoText(path)),
    }
}

/// The text of a robot. What it has in another way than the file is said.
fn imported(format: Format, path: &Path) -> Result<String, FileFault> {
    let options = Options { contacts: false, ..Options::default() };
    let fault = |fault: bg_import::ImportError| FileFault::Import { path: path.to_owned(), fault: fault.to_string() };
    let imported = import_file(format, path, options).map_err(fault)?;
    imported.notes.iter().for_each(console::note);
    if imported.notes.iter().any(|note| note.contains(" --")) {
        console::note(&"options in these notes are those of `bg-import`, which writes a robot as a text to go on with");
    }
    Ok(imported.text)
}

/// The files that a text is made of: the one at `path`, those that it uses, and those that it would use if they were
/// there.
///
/// # Panics
/// The machine has no memory for a thread.
#[must_use]
pub fn files(path: &Path) -> Vec<PathBuf> {
    let path = path.to_owned();
    // With its thread ends what the compiler remembers of a text.
    let reader = std::thread::spawn(move || {
        let found = RefCell::new(vec![path.clone()]);
        let open = |path: &Path| {
            found.borrow_mut().push(path.to_owned());
            open(path)
        };
        if let Ok(text) = read(&path) {
            drop(gather(&path, text.opened(), &open));
        }
        found.into_inner()
    });
    reader.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// A text with all files that it uses, as data.
#[must_use]
pub fn bundle(text: &Text) -> Bundle {
    Bundle::gathered(&text.path, text.opened(), &open)
}

/// The graphs of a text.
///
/// # Errors
/// All faults of the first stage that has any, each with the file that it is in.
///
/// # Panics
/// The machine has no memory for a thread.
pub fn graphs(text: &Text, wanted: &Wanted) -> Result<Vec<Graph>, Vec<Fault>> {
    on_a_large_stack(|| wanted.told(|wanted| load_file(&text.path, text.opened(), &open, wanted)))
}

/// The names of the graphs of a text, each with the number of its models, where none of these has a fault; `most` is
/// how many statements a graph may have. Nothing is made of them.
///
/// # Errors
/// As [`graphs`].
///
/// # Panics
/// As [`graphs`].
pub fn check(text: &Text, most: Option<usize>) -> Result<Vec<(String, usize)>, Vec<Fault>> {
    on_a_large_stack(|| check_file(&text.path, text.opened(), &open, most))
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn what_changes_while_it_is_read_is_read_again() {
        let (version, reads) = (Cell::new(0), Cell::new(0));
        let at = |last: u32| {
            reads.set(0);
            // A writer is done after `last` steps, one during each read.
            let read = || {
                reads.set(reads.get() + 1);
                let found = version.get();
                version.set(last.min(found + 1));
                Ok::<u32, ()>(found)
            };
            version.set(0);
            at_one_time(|| Ok(version.get()), read)
        };
        assert_eq!((at(0), reads.get()), (Ok(Some(0)), 1));
        assert_eq!((at(2), reads.get()), (Ok(Some(2)), 3));
        assert_eq!((at(u32::MAX), reads.get()), (Ok(None), ATTEMPTS));
        let failed = at_one_time(|| Ok(0), || Err::<(), &str>("gone"));
        assert_eq!(failed, Err("gone"));
    }
}
