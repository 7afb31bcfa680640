//! What documents say of files: links lead somewhere, files that are named are there, tables list the modules of their
//! folders, decisions are short. That lines of code are, too, that each mutant has its place in the code, and that all
//! workspaces have the same versions.

mod markdown;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use bg_compiler::source::functions::{FUNCTIONS, Function};
use markdown::{anchors, codes, first_cells, labels, links};

/// Lines that a decision may have.
const LINES: usize = 40;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the folder of the workspace").to_owned()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The files in and below a folder, but for what is hidden and what builds leave.
fn files(folder: &Path) -> Vec<PathBuf> {
    let name = |path: &Path| path.file_name().expect("a name").to_string_lossy().into_owned();
    let is_source = |path: &PathBuf| {
        let name = name(path);
        !name.starts_with('.') && !["target", "out", "node_modules"].contains(&name.as_str())
    };
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, mut found): (Vec<PathBuf>, Vec<PathBuf>) = entries.filter(is_source).partition(|path| path.is_dir());
    found.extend(folders.iter().flat_map(|folder| files(folder)));
    found
}

fn documents() -> impl Iterator<Item = (PathBuf, String)> {
    let is_markdown = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "md");
    files(&root()).into_iter().filter(is_markdown).map(|path| (path.clone(), read(&path)))
}

/// The modules that a folder has, tests and lists left out.
fn modules(folder: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(root().join(folder)).expect("a folder").map(|entry| entry.expect("an entry").path());
    let names = entries.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned());
    names.filter(|name| !["lib", "mod", "tests"].contains(&name.as_str())).collect()
}

/// The names in code in the first column of the table of `ARCHITECTURE.md` with this head.
fn table_of_the_architecture(head: &str) -> BTreeSet<String> {
    first_cells(&read(&root().join("ARCHITECTURE.md")), head).iter().flat_map(|cell| codes(cell)).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut count = 0;
    for (path, text) in documents() {
        for link in links(&text).into_iter().filter(|link| !link.contains(':')) {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
            assert!(target.exists(), "{}: {link} leads to no file", path.display());
            let is_anchored = !anchor.is_empty() && target.extension().is_some_and(|extension| extension == "md");
            assert!(
                !is_anchored || anchors(&read(&target)).contains(anchor),
                "{}: {link} leads to no heading",
                path.display()
            );
            count += 1;
        }
    }
    assert!(count > 300, "{count} links");
}

/// Of the documents for who works on the project: others name files of their readers, too.
#[test]
fn source_files_that_are_named_are_there() {
    let of_the_project = ["ARCHITECTURE.md", "CONTRIBUTING.md", "tests", "docs/decisions", "docs/benchmarks"];
    let is_of_the_project = |path: &Path| of_the_project.iter().any(|part| path.starts_with(root().join(part)));
    let all: Vec<String> = files(&root()).iter().map(|path| path.to_string_lossy().into_owned()).collect();
    // `NAME` stands for any.
    let is_source = |code: &String| {
        let is_path = code.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '/' | '.'));
        is_path && code.ends_with(".rs") && !code.contains("NAME")
    };
    let mut count = 0;
    for (path, text) in documents().filter(|(path, _)| is_of_the_project(path)) {
        for code in codes(&text).into_iter().filter(is_source) {
            let end = format!("/{code}");
            assert!(all.iter().any(|file| file.ends_with(&end)), "{}: `{code}` is no file", path.display());
            count += 1;
        }
    }
    assert!(count > 80, "{count} files");
}

#[test]
fn decisions_are_short_and_listed_in_their_order() {
    let folder = root().join("docs/decisions");
    let list = read(&folder.join("README.md"));
    let mut files = files(&folder);
    files.retain(|path| !path.ends_with("README.md"));
    files.sort();
    let mut rows = Vec::new();
    for path in files {
        let (name, text) = (path.file_name().expect("a name").to_string_lossy().into_owned(), read(&path));
        let lines = text.lines().count();
        assert!(lines <= LINES, "{name}: {lines} lines");
        let (number, title) = text.lines().next().and_then(|head| head[2..].split_once(". ")).expect("`# N. Title`");
        assert_eq!(format!("{number:0>4}"), name[..4], "{name}");
        rows.push(format!("| [{}]({name}) | {title} |", &name[..4]));
    }
    let listed: Vec<&str> = list.lines().filter(|line| line.starts_with("| [")).collect();
    assert_eq!(listed.len(), rows.len());
    for (listed, row) in listed.iter().zip(&rows) {
        assert!(listed.starts_with(row), "{listed}\nis not\n{row}");
    }
}

#[test]
fn tables_of_modules_have_those_of_their_folders() {
    for folder in ["model", "solve"] {
        let listed = table_of_the_architecture(&format!("| module of `{folder}/` |"));
        assert_eq!(listed, modules(&format!("bg-model/src/{folder}")), "{folder}");
    }
    let workbench = "bg-model/workbench/src";
    assert_eq!(table_of_the_architecture("| room of the workbench |"), modules(workbench));
    for room in ["ask", "run", "show", "studies"] {
        let listed = table_of_the_architecture(&format!("| module of `{room}/` |"));
        assert_eq!(listed, modules(&format!("{workbench}/{room}")), "{room}");
    }
}

#[test]
fn the_layout_has_files_that_are_there() {
    let text = read(&root().join("ARCHITECTURE.md"));
    let layout = text.split("```text\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the layout");
    let mut folders: Vec<&str> = Vec::new();
    for line in layout.lines() {
        let entry = line.trim_start();
        let depth = (line.len() - entry.len()) / 2;
        folders.truncate(depth);
        let (entry, _) = entry.split_once("  ").unwrap_or((entry, ""));
        for name in entry.split(", ") {
            assert!(folders.iter().fold(root(), |path, folder| path.join(folder)).join(name).exists(), "{line}");
        }
        folders.push(entry);
    }
}

#[test]
fn stages_of_the_table_are_those_of_the_pipeline() {
    let text = read(&root().join("ARCHITECTURE.md"));
    let compiler = root().join("bg-macros/compiler/src");
    let code = ["pipeline.rs", "lib.rs"].map(|file| read(&compiler.join(file))).concat();
    let rows = text.lines().skip_while(|line| !line.starts_with("| floor | stage |")).skip(2);
    let stages: Vec<String> = rows
        .take_while(|line| line.starts_with('|'))
        .flat_map(|row| codes(row.split('|').nth(2).expect("a stage")))
        .collect();
    assert!(stages.len() > 15, "{stages:?}");
    for stage in stages {
        assert!(code.contains(&stage), "`{stage}` is no stage");
    }
}

/// In rustdoc the chapters of the language are one page: there a label leads to a heading of that page.
#[test]
fn labels_of_the_language_lead_to_headings_in_rustdoc() {
    let package = root().join("bg-macros");
    let source = read(&package.join("src/lib.rs"));
    let in_rustdoc = labels(&source.replace("/// ", ""));
    let chapters: Vec<String> = files(&package.join("docs/language")).iter().map(|path| read(path)).collect();
    let headings: BTreeSet<String> = chapters.iter().flat_map(|text| anchors(text)).collect();
    let used: BTreeSet<String> = chapters.iter().flat_map(|text| labels(text).into_keys()).collect();
    assert!(used.len() > 15, "{used:?}");
    assert_eq!(used, in_rustdoc.keys().cloned().collect());
    for (label, target) in &in_rustdoc {
        assert!(target.strip_prefix('#').is_some_and(|anchor| headings.contains(anchor)), "{label}: {target}");
    }
    for text in &chapters {
        let (text, defined) = (text.to_lowercase(), labels(text));
        let lacking =
            in_rustdoc.keys().find(|label| text.contains(&format!("[{label}]")) && !defined.contains_key(*label));
        assert_eq!(lacking, None, "in {:?}", text.lines().next());
    }
    let tested = read(&root().join("bg-model/src/language.rs"));
    for path in files(&package.join("docs/language")) {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        assert!(source.contains(&format!("include_str!(\"../docs/language/{name}\")")), "{name} is not in rustdoc");
        assert!(tested.contains(&format!("docs/language/{name}\")")), "the examples of {name} are not tested");
    }
}

/// The table of the reference is what an editor shows of each function. `RENEW=1` writes it.
#[test]
fn functions_of_the_reference_are_those_of_the_language() {
    let path = root().join("bg-macros/docs/language/expressions.md");
    let text = read(&path);
    let head = "| function | gives | units | for example |\n|---|---|---|---|\n";
    let (before, after) = text.split_once(head).expect("the table");
    let (_, after) = after.split_once("\n\n").expect("its end");
    let rows: String = FUNCTIONS.iter().map(row).collect();
    let expected = format!("{before}{head}{OF_TABLES}{rows}\n{after}");
    if std::env::var_os("RENEW").is_some() {
        fs::write(&path, &expected).expect("written");
    }
    assert!(read(&path) == expected, "RENEW=1 writes the table of functions anew");
}

/// What calls a table.
const OF_TABLES: &str = "\
| `NAME(a)`, `NAME(a, b)` of a [table][tables] | Its value there. | as declared | `torque: N*m = curve(pin.speed);` |
| `NAME.derivative(a)`, `NAME.second_derivative(a)` | Those of a table by its argument. | value per argument, and \
again | `slope: N*m*s/rad = curve.derivative(pin.speed);` |
";

fn row(function: &Function) -> String {
    let Function { meaning, more, units, example, .. } = function;
    let calls: Vec<String> = function.calls().iter().map(|call| format!("`{call}`")).collect();
    let more = more.map_or_else(String::new, |heading| format!(" [More](#{heading})."));
    format!("| {} | {meaning}{more} | {units} | `{example}` |\n", calls.join(", "))
}

#[test]
fn suites_are_listed() {
    let text = read(&root().join("tests/README.md"));
    let listed: BTreeSet<String> = first_cells(&text, "| suite |").iter().flat_map(|cell| codes(cell)).collect();
    let manifest = read(&root().join("tests/Cargo.toml"));
    let suites = manifest.split("[[test]]\nname = \"").skip(1).filter_map(|rest| rest.split_once('"'));
    // Not one of cargo's: a script that runs the others on changed code.
    let scripts = ["mutants/".to_owned()];
    assert_eq!(listed, suites.map(|(name, _)| format!("{name}/")).chain(scripts).collect());
}

/// Name, version and lock of each package of all workspaces here.
fn locked() -> Vec<(String, String, PathBuf)> {
    let ignored = ["bg-model/python", "bg-model/workbench/template"].map(|folder| root().join(folder));
    let is_lock =
        |path: &PathBuf| path.ends_with("Cargo.lock") && !ignored.iter().any(|folder| path.starts_with(folder));
    let of_one = |path: PathBuf| {
        let lock: toml::Table = read(&path).parse().expect("a lock is TOML");
        let packages = lock["package"].as_array().expect("a list").clone().into_iter();
        let text = |package: &toml::Value, key: &str| package[key].as_str().expect("text").to_owned();
        packages.map(move |package| (text(&package, "name"), text(&package, "version"), path.clone()))
    };
    files(&root()).into_iter().filter(is_lock).flat_map(of_one).collect()
}

/// The versions that can stand for each other begin with these numbers.
fn compatible(version: &str) -> Vec<&str> {
    let numbers: Vec<&str> = version.split('.').collect();
    let count = if numbers[0] == "0" { 2 } else { 1 };
    numbers[..count].to_vec()
}

/// All workspaces here have one target folder in `.ci/run`: with other versions the compiler is built once more for
/// each.
#[test]
fn workspaces_have_the_same_versions() {
    let locked = locked();
    for (name, version, path) in &locked {
        let other = locked
            .iter()
            .find(|(other, of, _)| other == name && compatible(of) == compatible(version) && of != version);
        assert_eq!(other, None, "{name} {version} in {}", path.display());
    }
}

/// Nobody scrolls sideways: but for rows of tables, which cannot be broken, and for what `bg-import` has written.
#[test]
fn lines_of_code_are_short() {
    const COLUMNS: usize = 120;
    let written = root().join("bg-model/import/tests/cases");
    let is_code = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "rs") && !path.starts_with(&written);
    let is_row = |line: &str| ["/// |", "//! |"].iter().any(|row| line.trim_start().starts_with(row));
    let is_long = |line: &str| line.chars().count() > COLUMNS && !is_row(line);
    let long = files(&root()).into_iter().filter(is_code).flat_map(|path| {
        let text = read(&path);
        let numbers: Vec<usize> = text.lines().zip(1..).filter(|(line, _)| is_long(line)).map(|of| of.1).collect();
        numbers.into_iter().map(move |number| format!("{}:{number}", path.display()))
    });
    assert_eq!(long.collect::<Vec<_>>(), Vec::<String>::new(), "longer than {COLUMNS} columns");
}

/// What a mutant replaces occurs once, so that the script that breaks the code breaks what it says.
#[test]
fn mutants_have_their_places() {
    let text = read(&root().join("tests/mutants/mutants.toml"));
    let subjects: toml::Table = text.parse().expect("a table of mutants");
    let mutants: Vec<&toml::Value> =
        subjects.values().flat_map(|subject| subject.as_array().expect("a list")).collect();
    assert!(mutants.len() > 80, "{}", mutants.len());
    let of = |mutant: &toml::Value, key: &str| mutant[key].as_str().expect("a text").to_owned();
    let is_lost =
        |mutant: &&&toml::Value| read(&root().join(of(mutant, "file"))).matches(&of(mutant, "old")).count() != 1;
    let lost: Vec<String> = mutants.iter().filter(is_lost).map(|mutant| of(mutant, "name")).collect();
    assert!(lost.is_empty(), "these have no place, or several: {lost:?}");
}
