//! Faults of a text as a reader sees them.
//!
//! In: a text and its faults. Out: each with its code, its place in the text and what to do, as rustc shows its own;
//! the same as JSON, one line each.

use std::path::Path;

#[cfg(not(target_arch = "wasm32"))]
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use bg_loaded::Fault;
#[cfg(not(target_arch = "wasm32"))]
use bg_workbench::files::console;
use serde::Serialize;

use crate::text::Text;

/// Shows the faults on the error output.
#[cfg(not(target_arch = "wasm32"))]
pub fn tell(text: &Text, faults: &[Fault]) {
    let renderer = if console::is_coloured() { Renderer::styled() } else { Renderer::plain() };
    for fault in faults {
        eprintln!("{}\n", shown(text, fault, &renderer));
    }
    let count = if faults.len() == 1 { "a fault".to_owned() } else { format!("{} faults", faults.len()) };
    eprintln!("error: {}: {count}", text.path.display());
}

/// A fault as text: what is wrong, its place, what to do.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn plain(text: &Text, fault: &Fault) -> String {
    shown(text, fault, &Renderer::plain())
}

#[cfg(not(target_arch = "wasm32"))]
fn shown(text: &Text, fault: &Fault, renderer: &Renderer) -> String {
    let (path, source) = place(text, fault);
    let title = Level::ERROR.primary_title(&fault.message).id(fault.code);
    let bytes = fault.bytes.start.min(source.len())..fault.bytes.end.min(source.len());
    let path = path.display().to_string();
    let place = Snippet::source(source).path(&path).annotation(AnnotationKind::Primary.span(bytes));
    let group: Group<'_> = title.element(place);
    let group = if fault.help.is_empty() { group } else { group.element(Level::HELP.message(&fault.help)) };
    renderer.render(&[group])
}

/// The file that a fault is in: its path, what stands in it.
#[must_use]
pub fn place<'a>(text: &'a Text, fault: &'a Fault) -> (&'a Path, &'a str) {
    match &fault.file {
        Some(file) => (&file.path, &file.text),
        None => (&text.path, &text.text),
    }
}

/// A fault for programs.
#[derive(Debug, Serialize)]
pub struct Line<'a> {
    /// The file that it is in.
    pub file: String,
    /// The line of its first character, from 1.
    pub line: usize,
    /// The column of that, from 1, in characters.
    pub column: usize,
    /// The bytes of the file that it is about: the first, and the one after the last.
    pub bytes: [usize; 2],
    /// The stable code, such as `BG0301`.
    pub code: &'static str,
    /// What is wrong.
    pub message: &'a str,
    /// What to do about it; may be empty.
    pub help: &'a str,
}

impl<'a> Line<'a> {
    /// A fault of a text.
    #[must_use]
    pub fn of(text: &Text, fault: &'a Fault) -> Self {
        let Fault { code, message, help, place: [line, column], bytes, .. } = fault;
        let file = place(text, fault).0.display().to_string();
        Self { file, line: *line, column: *column, bytes: [bytes.start, bytes.end], code, message, help }
    }
}

/// The faults, each a line of JSON.
///
/// # Panics
/// Never: texts and numbers can be written.
#[must_use]
pub fn json(text: &Text, faults: &[Fault]) -> String {
    let line = |fault| serde_json::to_string(&Line::of(text, fault)).expect("texts and numbers") + "\n";
    faults.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_shown_at_its_place() {
        let text = Text { path: "swing.bond".into(), text: "graph Swing {\n    param mass: kgg = 2;\n}\n".to_owned() };
        let faults = crate::file::graphs(&text, &crate::file::Wanted::default()).expect_err("there is no unit kgg");
        let told = plain(&text, &faults[0]);
        assert!(told.starts_with("error[BG0"), "{told}");
        assert!(told.contains("--> swing.bond:2:17") && told.contains("^^^") && told.contains("help: "), "{told}");
        let json = json(&text, &faults[..1]);
        let value: serde_json::Value = serde_json::from_str(&json).expect("a line of JSON");
        assert_eq!([value["line"].as_u64(), value["column"].as_u64()], [Some(2), Some(17)]);
    }
}
