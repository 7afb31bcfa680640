//! The floors of the run time: what a mechanism is (`model`) builds on nothing that drives it (`solve`), and no folder
//! or file of either on one above it.
//!
//! Imports are read from the source, as paths from the crate's root. Modules of tests are left out.

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms from the ground up; those of one floor do not know each other.
const FLOORS: [&[&str]; 19] = [
    &["model::scalar", "model::requirement", "model::holding"],
    &["model::drawing", "model::nearest", "model::joined", "model::tabled"],
    &["model::description"],
    &[
        "model::iteration",
        "model::input",
        "model::clock",
        "model::linear",
        "model::series",
        "model::origin",
        "model::parameters",
        "model::assembly",
    ],
    &["model::delay"],
    &["model::capability"],
    &["model::slices"],
    &["model::system"],
    &["model::dynamics", "model::vectorised"],
    &["model::reactions", "model::mechanism", "model::sampled", "model::delayed"],
    &["model::standing", "model::start"],
    &["solve::statistics"],
    &["solve::integrator", "solve::finish"],
    &["solve::stepper", "solve::failure", "solve::fixed_step"],
    &["solve::event"],
    &["solve::simulation"],
    &["solve::extended"],
    &["solve::run"],
    &["solve::sensitivity"],
];
/// What only lists the others.
const LISTS: [&str; 6] = ["lib.rs", "language.rs", "private.rs", "sentence.rs", "model/mod.rs", "solve/mod.rs"];

fn floor(room: &str) -> usize {
    FLOORS.iter().position(|floor| floor.contains(&room)).unwrap_or_else(|| panic!("on which floor is `{room}`?"))
}

/// The source files in and below a folder, without its modules of tests.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, mut found): (Vec<PathBuf>, Vec<PathBuf>) = entries.partition(|path| path.is_dir());
    found.extend(folders.iter().flat_map(|folder| files(folder)));
    found.retain(|path| path.extension().is_some_and(|extension| extension == "rs"));
    let tests: Vec<PathBuf> = found.iter().flat_map(|file| tests_of(file)).collect();
    found.retain(|path| !tests.contains(path));
    found
}

/// The files of the modules that a file declares for tests only.
fn tests_of(file: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(file).expect("text");
    let declared = text.split("#[cfg(test)]\nmod ").skip(1).filter_map(|rest| rest.split_once(';'));
    let names = declared.map(|(name, _)| name).filter(|name| name.chars().all(|c| c.is_alphanumeric() || c == '_'));
    names.map(|name| file.with_file_name(format!("{name}.rs"))).collect()
}

/// The paths from the crate's root in a text, tests and comments left out.
fn imports(text: &str) -> impl Iterator<Item = String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.flat_map(|line| line.split("crate::").skip(1)).map(room)
}

/// The room that a path leads to: its first two names.
fn room(path: &str) -> String {
    let name = |part: &str| part.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    path.splitn(3, "::").take(2).map(name).collect::<Vec<_>>().join("::")
}

#[test]
fn no_room_imports_from_a_floor_above_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let (mut wrong, mut count) = (Vec::new(), 0);
    for file in files(&root) {
        let path = file.strip_prefix(&root).expect("below the root").to_string_lossy().into_owned();
        if LISTS.contains(&path.as_str()) {
            continue;
        }
        let own = room(&path.trim_end_matches(".rs").replace('/', "::"));
        for import in imports(&fs::read_to_string(&file).expect("text")) {
            count += 1;
            if import != own && floor(&import) >= floor(&own) {
                wrong.push(format!("{path} imports {import}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(count > 100, "only {count} imports were found");
}
