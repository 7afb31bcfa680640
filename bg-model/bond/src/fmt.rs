//! The command `fmt`: texts in one form.

use std::io::stdin;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_workbench::files::console;
use bond_graph::file::{self, Text};
use bond_graph::{faults, format};

/// Brings the files into their form, or with `check` names those that have another; exit code 1 where there are any, 2
/// where one cannot be used, which is left as it is.
pub fn fmt(files: &[PathBuf], check: bool) -> ExitCode {
    let mut code = 0;
    for path in files {
        match formatted(path, check) {
            Ok(true) => {}
            Ok(false) => code = code.max(1),
            Err(fault) => {
                fault.tell();
                code = 2;
            }
        }
    }
    ExitCode::from(code)
}

/// What stopped it.
enum Stopped {
    Said(String),
    Faults(Text, Vec<bg_loaded::Fault>),
}

impl Stopped {
    fn tell(&self) {
        match self {
            Self::Said(fault) => console::complain(fault),
            Self::Faults(text, found) => faults::tell(text, found),
        }
    }
}

/// Whether the file needs no other form.
fn formatted(path: &Path, check: bool) -> Result<bool, Stopped> {
    let said = |fault: String| Stopped::Said(fault);
    let is_stream = path == Path::new("-");
    let text =
        if is_stream { read_stream() } else { file::read_text(path) }.map_err(|fault| said(fault.to_string()))?;
    let formatted = match format::formatted(&text.text) {
        Ok(formatted) => formatted,
        Err(found) => return Err(Stopped::Faults(text, found)),
    };
    let is_same = formatted == text.text;
    let print = |text: &str| console::print(text).map_err(|fault| said(fault.to_string()));
    if check {
        if !is_same {
            print(&format!("{} has another form\n", text.path.display()))?;
        }
        return Ok(is_same);
    }
    if is_stream {
        print(&formatted)?;
    } else if !is_same {
        std::fs::write(path, formatted).map_err(|fault| said(format!("cannot write {}: {fault}", path.display())))?;
    }
    Ok(true)
}

/// The text of the standard input.
fn read_stream() -> Result<Text, file::FileFault> {
    let path = PathBuf::from("<stdin>");
    file::text_of(stdin().lock(), &path)
}
