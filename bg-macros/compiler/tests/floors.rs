//! The floors of the compiler: a stage builds on those below it only, and the kernel of expressions on nothing.
//!
//! Imports are read from the source. What tests use is left out: they enter through `pipeline`.

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms from the ground up; those of one floor do not know each other.
const FLOORS: [&[&str]; 7] =
    [&["fault", "random"], &["expr"], &["source"], &["graph"], &["system"], &["program"], &["pipeline"]];
/// What only reads the results.
const READERS: [&str; 2] = ["emit", "stages"];

fn floor(room: &str) -> usize {
    if READERS.contains(&room) {
        return FLOORS.len();
    }
    FLOORS.iter().position(|floor| floor.contains(&room)).unwrap_or_else(|| panic!("on which floor is `{room}`?"))
}

/// The source files in and below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            found.push(path);
        }
    }
    found
}

/// The rooms that a text imports from, its tests left out.
fn imports(text: &str) -> impl Iterator<Item = &str> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let code_lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let pieces = code_lines.flat_map(|line| line.split("crate::").skip(1));
    pieces.map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default())
}

#[test]
fn no_stage_imports_a_later_one() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    let mut count = 0;
    for file in files(&root) {
        let path = file.strip_prefix(&root).expect("below the root").to_string_lossy().into_owned();
        if path == "lib.rs" || path.split('/').any(|part| part.trim_end_matches(".rs") == "tests") {
            continue;
        }
        let room = path.split(['/', '.']).next().unwrap_or_default().to_owned();
        let text = fs::read_to_string(&file).expect("text");
        for import in imports(&text) {
            assert!(
                !import.is_empty() && import != "{",
                "{path}: imports are written one path a line: `crate::room::..`"
            );
            count += 1;
            let is_above = floor(import) > floor(&room) || (floor(import) == floor(&room) && import != room);
            if is_above {
                wrong.push(format!("{path} imports {import}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(count > 100, "only {count} imports were found");
}
