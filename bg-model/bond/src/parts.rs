//! The command `parts`: what the library of parts has.

use bg_compiler::fault::near_miss;
use bg_compiler::source::library;
use bg_workbench::files::console;

/// Prints the names of all parts with what they are, or one of them as it stands in the library.
///
/// # Errors
/// There is no such part, or nothing can be printed.
pub fn parts(name: Option<&str>) -> Result<(), String> {
    let text = match name {
        None => list(),
        Some(name) => one(name)?,
    };
    console::print(&text).map_err(|fault| fault.to_string())
}

/// The parts of each file.
fn list() -> String {
    let files = library::names().map(|file| {
        let parts = library::parts().filter(|part| part.file == file && !part.is_piece());
        let lines: String = parts.map(|part| format!("  {:24}{}\n", part.name, first_sentence(&part.docs))).collect();
        format!("use {file};\n{lines}")
    });
    files.collect::<Vec<_>>().join("\n") + "\n`bond parts NAME` prints one of them, with its parameters and ports.\n"
}

fn first_sentence(docs: &str) -> &str {
    docs.split_once(". ").map_or(docs, |(first, _)| first).trim_end_matches('.')
}

fn one(name: &str) -> Result<String, String> {
    if let Some(part) = library::parts().find(|part| part.name == name) {
        return Ok(format!("use {};\n\n{}", part.file, part.text));
    }
    let parts: Vec<_> = library::parts().map(|part| part.name).collect();
    let near = near_miss(name, parts.iter().copied())
        .map_or_else(|| "`bond parts` lists them".to_owned(), |near| format!("did you mean `{near}`?"));
    Err(format!("the library has no part `{name}`; {near}"))
}
