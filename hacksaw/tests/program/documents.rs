//! The commands that documents show are those of the program.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// The documents whose commands every program has, or the hacksaw's.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let folders = ["docs", "docs/benchmarks"].map(|folder| fs::read_dir(root.join(folder)).unwrap());
    let entries = folders.into_iter().flatten().map(|entry| entry.unwrap().path());
    let mut found: Vec<PathBuf> = entries.filter(|path| path.extension().is_some_and(|end| end == "md")).collect();
    found.extend(
        ["README.md", "bg-model/workbench/README.md", "bg-model/workbench/cookbook.md"].map(|file| root.join(file)),
    );
    found
}

/// The arguments of each command in a text.
fn commands(text: &str) -> Vec<Vec<&str>> {
    let calls = text.lines().flat_map(|line| {
        let before = ["cargo run --release -- ", "cargo run -- "];
        before.into_iter().flat_map(move |call| line.split(call).skip(1))
    });
    calls.map(|rest| rest.split(['#', '`', '>']).next().unwrap().split_whitespace().collect()).collect()
}

/// The command and, where it has some, its own command.
fn command<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let words = arguments.iter().copied().take_while(|word| !word.starts_with('-'));
    let (command, inner): (Vec<_>, Vec<_>) = (words.clone().take(1).collect(), words.skip(1).take(1).collect());
    match (&command[..], &inner[..]) {
        (["golden"], _) | (["sweep"], ["show"]) => [command, inner].concat(),
        _ => command,
    }
}

/// What `--help` says of a command.
fn help(command: &[&str]) -> String {
    let output =
        Command::cargo_bin("hacksaw").unwrap().args(command).arg("--help").assert().success().get_output().clone();
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn commands_and_options_of_the_documents_are_there() {
    let mut helps = BTreeMap::new();
    let mut options = 0;
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap();
        for arguments in commands(&text) {
            let command = command(&arguments);
            let help = helps.entry(command.join(" ")).or_insert_with(|| help(&command));
            for option in arguments.iter().filter(|word| word.starts_with("--")) {
                let name = option.split('=').next().unwrap();
                let is_there = help.split([' ', '\n', '[', '=', ',']).any(|word| word == name);
                assert!(is_there, "{}: `{}` has no {name}", path.display(), command.join(" "));
                options += 1;
            }
        }
    }
    assert!(helps.len() > 8 && options > 20, "{} commands, {options} options", helps.len());
}
