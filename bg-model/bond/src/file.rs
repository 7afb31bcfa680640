//! A file to its graphs.
//!
//! In: a path. Out: its text, where it is one, in the language of `bond_graph!`; of a robot the text that `bg-import`
//! makes. The graphs of the text, or its faults.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use bg_import::{Format, Options, import_file};
use bg_loaded::{Fault, Graph, load};
use bg_workbench::files::console;
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
    #[error("cannot read {}: {source}", path.display())]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{}: larger than {} MB, which is no mechanism", .0.display(), LARGEST >> 20)]
    Large(PathBuf),
    #[error("{}: no text in UTF-8", .0.display())]
    NoText(PathBuf),
    #[error("{}: brackets in brackets, more than {DEEPEST} deep", .0.display())]
    Deep(PathBuf),
    #[error("{}: {fault}", path.display())]
    Import { path: PathBuf, fault: String },
}

/// A text with the name of its file.
#[derive(Clone, Debug)]
pub struct Text {
    pub name: String,
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
    let deepest = text.chars().fold((0_usize, 0), |(depth, deepest), c| match c {
        '(' | '[' | '{' => (depth + 1, deepest.max(depth + 1)),
        ')' | ']' | '}' => (depth.saturating_sub(1), deepest),
        _ => (depth, deepest),
    });
    if deepest.1 > DEEPEST { Err(FileFault::Deep(path.to_owned())) } else { Ok(Text { name, text }) }
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

/// The graphs of a text.
///
/// # Errors
/// All faults of the first stage that has any.
pub fn graphs(text: &Text) -> Result<Vec<Graph>, Vec<Fault>> {
    let text = text.text.clone();
    let compiler = std::thread::Builder::new().stack_size(STACK).spawn(move || load(&text));
    compiler.expect("a thread can be started").join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
