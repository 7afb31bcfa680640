//! The floors of the workbench: what is asked, one run, what it looks like, the program, studies of many runs,
//! commands. No room imports from one above it, or from another on its floor, and few arrows lead from room to room.
//!
//! Imports are read from the source, as paths that begin with `crate::` or `super::`. Modules of tests are left out.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Rooms from the ground up; those of one floor do not know each other.
const FLOORS: [&[&str]; 7] =
    [&["files"], &["ask"], &["run"], &["show"], &["program"], &["studies", "live"], &["command"]];
/// The most arrows between rooms, and between the folders in them.
const MOST_ARROWS: usize = 24;
const MOST_ARROWS_OF_FOLDERS: usize = 69;

fn floor(room: &str) -> usize {
    FLOORS.iter().position(|floor| floor.contains(&room)).unwrap_or_else(|| panic!("on which floor is `{room}`?"))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// The source files in and below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, mut found): (Vec<PathBuf>, Vec<PathBuf>) = entries.partition(|path| path.is_dir());
    found.extend(folders.iter().flat_map(|folder| files(folder)));
    found
}

/// The code of a text: neither tests nor comments.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    product.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// The names at the beginning of a path.
fn segments(path: &str) -> Vec<String> {
    let end = path.find(|c: char| !c.is_alphanumeric() && c != '_' && c != ':').unwrap_or(path.len());
    path[..end].split("::").filter(|segment| !segment.is_empty()).map(str::to_owned).collect()
}

/// Every path of a module's code from the root.
fn paths(module: &[String], code: &str) -> Vec<Vec<String>> {
    let mut found: Vec<Vec<String>> = code.split("crate::").skip(1).map(segments).collect();
    for (at, _) in code.match_indices("super::").filter(|(at, _)| !code[..*at].ends_with("super::")) {
        let path = segments(&code[at..]);
        let up = path.iter().take_while(|part| *part == "super").count();
        found.push(module[..module.len() - up].iter().chain(&path[up..]).cloned().collect());
    }
    found
}

/// The modules, each with the paths in its code: `show/mod.rs` is the module `show`.
fn modules() -> Vec<(Vec<String>, Vec<Vec<String>>)> {
    let root = root();
    let of = |file: PathBuf| {
        let path = file.strip_prefix(&root).expect("below the root").with_extension("");
        let names: Vec<String> = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        let module: Vec<String> = names.into_iter().filter(|part| part != "mod").collect();
        let paths = paths(&module, &code(&fs::read_to_string(&file).expect("text")));
        (module, paths)
    };
    files(&root).into_iter().map(of).filter(|(module, _)| *module != ["lib"]).collect()
}

/// The innermost folder that a module is in.
fn folder(module: &[String]) -> String {
    let folders = (1..=module.len()).rev().map(|length| module[..length].join("/"));
    folders.into_iter().find(|folder| root().join(folder).is_dir()).expect("every module is in a room")
}

#[test]
fn no_room_imports_from_a_floor_above_it() {
    let (mut wrong, mut rooms, mut folders) = (Vec::new(), BTreeSet::new(), BTreeSet::new());
    for (module, paths) in modules() {
        for path in paths {
            let [from, to] = [&module, &path].map(|names| names.first().expect("a path a line: `crate::room::..`"));
            let (inner, outer) = (folder(&module), folder(&path));
            if inner != outer {
                folders.insert((inner, outer));
            }
            if from == to {
                continue;
            }
            rooms.insert((from.clone(), to.clone()));
            if floor(to) >= floor(from) {
                wrong.push(format!("{} imports {}", module.join("/"), path.join("::")));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(rooms.len() <= MOST_ARROWS, "{} arrows: {rooms:#?}", rooms.len());
    assert!(folders.len() <= MOST_ARROWS_OF_FOLDERS, "{} arrows: {folders:#?}", folders.len());
    assert!(rooms.contains(&("command".to_owned(), "studies".to_owned())), "not even this was found: {rooms:#?}");
}
