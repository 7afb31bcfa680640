//! The floors of the compiler: a stage builds on those below it only, and the kernel of expressions on nothing.
//!
//! Imports are read from the source. What tests use is left out: they enter through `pipeline`.
//! The rooms of a stage are its folders; their arrows are counted.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Rooms from the ground up; those of one floor do not know each other.
const FLOORS: [&[&str]; 8] =
    [&["fault", "random"], &["expr"], &["source"], &["graph"], &["system"], &["program"], &["pipeline"], &["tables"]];
/// What only reads the results.
const READERS: [&str; 2] = ["emit", "stages"];

/// The rooms whose arrows are counted, with the rooms in them.
const STAGES: [&str; 6] = ["source", "graph", "system", "program", "tables", "emit"];
/// The most arrows between them. What another room needs stands at the door: the room's `mod.rs`.
const MOST_ARROWS: usize = 54;

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

/// The code of a text: neither tests nor comments.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    product.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// The product's modules with their code: `graph/mod.rs` is the module `graph`.
fn modules() -> Vec<(Vec<String>, String)> {
    let root = root();
    let mut found = Vec::new();
    for file in files(&root) {
        let path = file.strip_prefix(&root).expect("below the root").with_extension("");
        let module: Vec<String> = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if module != ["lib"] && !module.iter().any(|part| part == "tests") {
            let module = module.into_iter().filter(|part| part != "mod").collect();
            found.push((module, code(&fs::read_to_string(&file).expect("text"))));
        }
    }
    found
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The modules that a path names.
fn segments(path: &str) -> impl Iterator<Item = &str> {
    let end = path.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':').unwrap_or(path.len());
    path[..end].split("::").filter(|segment| !segment.is_empty())
}

/// What follows `crate::` in each path of a code.
fn imports(code: &str) -> impl Iterator<Item = &str> {
    code.split("crate::").skip(1).map(|rest| segments(rest).next().unwrap_or_default())
}

/// Every path of a module's code from the root: those that begin with `crate::` or `super::`.
fn paths(module: &[String], code: &str) -> Vec<Vec<String>> {
    let owned = |path: &str| segments(path).map(str::to_owned).collect::<Vec<_>>();
    let mut found: Vec<Vec<String>> = code.split("crate::").skip(1).map(owned).collect();
    for (at, _) in code.match_indices("super::").filter(|(at, _)| !code[..*at].ends_with("super::")) {
        let path = owned(&code[at..]);
        let up = path.iter().take_while(|part| *part == "super").count();
        found.push(module[..module.len() - up].iter().chain(&path[up..]).cloned().collect());
    }
    found
}

/// The room that a module stands in: the innermost folder of its name or around it.
fn room(module: &[String]) -> Option<String> {
    let rooms = (1..=module.len()).rev().map(|length| module[..length].join("/"));
    rooms.into_iter().find(|room| root().join(room).is_dir())
}

#[test]
fn no_stage_imports_a_later_one() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (module, code) in modules() {
        let (path, room) = (module.join("/"), &module[0]);
        for import in imports(&code) {
            assert!(!import.is_empty(), "{path}: imports are written one path a line: `crate::room::..`");
            count += 1;
            if floor(import) > floor(room) || (floor(import) == floor(room) && import != room) {
                wrong.push(format!("{path} imports {import}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(count > 100, "only {count} imports were found");
}

/// An arrow is a pair of two folders of which the first imports from the second, however often and whatever. Folders of
/// the kernel, and what a folder takes from itself, do not count.
#[test]
fn rooms_have_few_arrows() {
    let mut arrows = BTreeSet::new();
    for (module, code) in modules().into_iter().filter(|(module, _)| STAGES.contains(&module[0].as_str())) {
        let from = room(&module).expect("a stage is a folder");
        let stages = paths(&module, &code).into_iter().filter(|path| STAGES.contains(&path[0].as_str()));
        arrows.extend(stages.filter_map(|path| room(&path)).filter(|to| *to != from).map(|to| (from.clone(), to)));
    }
    assert!(arrows.len() <= MOST_ARROWS, "{} arrows: {arrows:#?}", arrows.len());
    let known = ("system/reduce", "system/equations");
    assert!(arrows.contains(&(known.0.to_owned(), known.1.to_owned())), "not even {known:?} was found: {arrows:#?}");
}
