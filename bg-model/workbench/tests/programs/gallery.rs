//! The gallery: every example runs, does what its head comment tells the reader to try, and stands in the README's
//! table.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::example::program;

/// The names of the examples, sorted.
fn examples() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = fs::read_dir(folder).expect("the package has examples").map(|file| file.expect("a file").path());
    let sources = files.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
    let mut names: Vec<_> = sources.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort_unstable();
    names
}

/// What the example does with these arguments.
fn run(example: &str, arguments: &[&str]) -> Output {
    program(example).args(arguments).output().expect("the program starts")
}

/// The rows of a CSV file, its head first.
fn rows(file: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(file).unwrap_or_else(|fault| panic!("{}: {fault}", file.display()));
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn every_example_runs_and_writes_its_trajectory() {
    let examples = examples();
    assert!(examples.len() >= 12, "{examples:?}");
    for example in examples {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let output = run(&example, &["run", "--t-end", "0.1", "--out", out]);
        assert!(output.status.success(), "{example}: {}", String::from_utf8_lossy(&output.stderr));
        let rows = rows(&folder.path().join("trajectory.csv"));
        assert!(rows[0].len() > 1 && rows[0][0] == "t", "{example}: {:?}", rows[0]);
        assert_eq!(rows.len(), 12, "{example}: the head, and a row every 0.01 s");
        let numbers = |row: &Vec<String>| row.iter().map(|text| text.parse().unwrap()).collect::<Vec<f64>>();
        let values: Vec<Vec<f64>> = rows[1..].iter().map(numbers).collect();
        assert!(values.iter().flatten().all(|value| value.is_finite()), "{example}");
        assert_eq!(values[10][0], 0.1, "{example}");
        assert!(folder.path().join("index.html").exists(), "{example}");
    }
}

#[test]
fn the_commands_of_the_head_comments_work_and_something_moves() {
    for example in examples() {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(format!("{example}.rs"));
        let source = fs::read_to_string(source).unwrap();
        let start = format!("//!     cargo run --release --example {example} -- ");
        let command = source.lines().find_map(|line| line.strip_prefix(&start));
        let command = command.unwrap_or_else(|| panic!("{example}: its head comment has no line `{start}..`"));
        let folder = tempfile::tempdir().unwrap();
        let mut arguments: Vec<&str> = command.split_whitespace().collect();
        arguments.extend(["--out", folder.path().to_str().unwrap()]);
        let output = run(&example, &arguments);
        assert!(output.status.success(), "{example} {command}: {}", String::from_utf8_lossy(&output.stderr));
        let rows = rows(&folder.path().join("trajectory.csv"));
        let moves = |column: usize| rows[2..].iter().any(|row| row[column] != rows[1][column]);
        assert!((1..rows[0].len()).any(moves), "{example} {command}: every output stays as it is");
    }
}

#[test]
fn the_readme_lists_every_example_with_the_states_of_its_literal_model() {
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let listed: Vec<(String, String)> = readme
        .lines()
        .filter_map(|line| line.strip_prefix("| [`")?.split_once("`](examples/"))
        .map(|(name, rest)| (name.to_owned(), rest.trim_end_matches(" |").rsplit("| ").next().unwrap().to_owned()))
        .collect();
    assert_eq!(listed.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>(), examples());
    for (example, states) in listed {
        let output = run(&example, &["scene"]);
        let text = String::from_utf8(output.stdout).unwrap();
        let literal = text.lines().find(|line| line.trim_start().starts_with("literal")).unwrap();
        assert_eq!(literal.split_whitespace().nth(1), Some(states.as_str()), "{example}: {literal}");
    }
}
