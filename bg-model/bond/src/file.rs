//! A file to its graphs.
//!
//! In: a path. Out: its text, where it is one, in the language of `bond_graph!`; of a robot the text that `bg-import`
//! makes. The graphs of the text, or its faults.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use bg_import::{Format, Options, import_file};
use bg_loaded::{Counted, Fault, Graph, Wanted, load_wanted};
use bg_workbench::files::console;
use bg_workbench::scenes::in_small_letters;
use thiserror::Error;

/// The largest file that is read, bytes: a mechanism of a thousand bodies has a tenth of it.
const LARGEST: u64 = 8 << 20;
/// Brackets in brackets: a text has some ten.
const DEEPEST: usize = 200;
/// The stack of the compiler, bytes: laws may be long.
const STACK: usize = 1 << 28;

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

/// A text with the name of its file.
#[derive(Clone, Debug)]
pub struct Text {
    /// The name, for messages.
    pub name: String,
    /// The text.
    pub text: String,
}

/// The text of a file.
///
/// # Errors
/// [`FileFault`].
pub fn read(path: &Path) -> Result<Text, FileFault> {
    let name = path.display().to_string();
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let format = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("urdf") => Some(Format::Urdf),
        Some("xml" | "mjcf") => Some(Format::Mjcf),
        _ => None,
    };
    let text = match format {
        Some(format) => imported(format, path)?,
        None => plain(path)?,
    };
    let text = Text { name, text };
    if text.is_deep() { Err(FileFault::Deep(path.to_owned())) } else { Ok(text) }
}

impl Text {
    /// Whether brackets are in brackets more often than a reader follows.
    #[must_use]
    pub fn is_deep(&self) -> bool {
        let mut depth = 0_usize;
        self.text.chars().any(|c| {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
            depth > DEEPEST
        })
    }
}

fn plain(path: &Path) -> Result<String, FileFault> {
    let unreadable = |source| FileFault::Unreadable { path: path.to_owned(), source };
    let mut bytes = Vec::new();
    // A pipe has no length, and a file may grow while it is read.
    File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes)).map_err(unreadable)?;
    if bytes.len() as u64 > LARGEST {
        return Err(FileFault::Large(path.to_owned()));
    }
    String::from_utf8(bytes).map_err(|_| FileFault::NoText(path.to_owned()))
}

/// The text of a robot. What it has in another way than the file is said.
fn imported(format: Format, path: &Path) -> Result<String, FileFault> {
    let options = Options { contacts: false, ..Options::default() };
    let fault = |fault: bg_import::ImportError| FileFault::Import { path: path.to_owned(), fault: fault.to_string() };
    let imported = import_file(format, path, options).map_err(fault)?;
    imported.notes.iter().for_each(console::note);
    Ok(imported.text)
}

/// The graphs of a text; where a command asks for one scene only, called `scene` on the command line or not said, only what
/// runs it.
///
/// # Errors
/// All faults of the first stage that has any.
///
/// # Panics
/// The machine has no memory for a thread.
pub fn graphs(text: &Text, scene: Option<&str>) -> Result<Vec<Graph>, Vec<Fault>> {
    let counted = if scene.is_some() { Counted::Made } else { Counted::All };
    let (text, scene) = (text.text.clone(), scene.map(str::to_owned));
    let is_wanted = move |name: &str| scene.as_ref().is_none_or(|scene| in_small_letters(name) == *scene);
    let compiler = std::thread::Builder::new()
        .stack_size(STACK)
        .spawn(move || load_wanted(&text, Wanted { scene: &is_wanted, counted }));
    compiler.expect("a thread can be started").join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
