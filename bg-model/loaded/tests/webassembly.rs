//! Models in WebAssembly, in node where it is installed: there machine code of each program has the bits of the
//! interpreter, in the functions of the examples and in random programs.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use bg_loaded::macro_calls;

const TARGET: &str = "wasm32-unknown-unknown";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the workspace")
}

/// The module of the example `functions`, made once; none, and a line that says why, where node or the target is
/// missing.
fn module() -> Option<&'static Path> {
    static MODULE: OnceLock<Option<PathBuf>> = OnceLock::new();
    MODULE.get_or_init(built).as_deref()
}

fn built() -> Option<PathBuf> {
    let asked = |program: &str, arguments: &[&str]| Command::new(program).args(arguments).output().ok();
    if !asked("node", &["--version"]).is_some_and(|output| output.status.success()) {
        println!("skipped: node is not installed");
        return None;
    }
    let folder = asked("rustc", &["--print", "target-libdir", "--target", TARGET]).expect("rustc");
    if !Path::new(String::from_utf8_lossy(&folder.stdout).trim_end()).is_dir() {
        println!("skipped: the target {TARGET} is not installed");
        return None;
    }
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("functions");
    let mut build = Command::new(env!("CARGO"));
    build.current_dir(root()).env("CARGO_TARGET_DIR", &target).args(["rustc", "--target", TARGET]);
    build.args(["-p", "bg-loaded", "--features", "machine-code", "--example", "functions", "--"]);
    build.args(["-C", "link-arg=--export-table", "-C", "link-arg=--growable-table"]);
    assert!(build.status().expect("cargo").success());
    Some(target.join(TARGET).join("debug/examples/functions.wasm"))
}

/// The answers of the module to questions with names; none where it cannot be made.
fn answers(questions: &[(String, String)]) -> Option<Vec<String>> {
    let mut node = Command::new("node");
    node.arg(root().join("bg-model/workbench/page/live.js")).arg(module()?);
    let mut node = node.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("node starts");
    let lines: String = questions.iter().map(|(_, question)| format!("{question}\n")).collect();
    node.stdin.take().expect("it is piped").write_all(lines.as_bytes()).expect("node reads");
    let output = node.wait_with_output().expect("node ends");
    let answers: Vec<String> = String::from_utf8(output.stdout).expect("UTF-8").lines().map(str::to_owned).collect();
    // What traps ends node.
    assert!(output.status.success(), "the bits of {} differ", questions[answers.len()].0);
    Some(answers)
}

/// Compares the models of all texts in a folder, of which there are at least so many.
fn compare(folder: &str, least: usize) {
    let entries = fs::read_dir(root().join(folder)).expect("a folder");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    let question = |path: PathBuf| {
        let text = || fs::read_to_string(&path).expect("a text");
        let text = match path.extension()?.to_str()? {
            "bond" => text(),
            "rs" => macro_calls(text().parse().expect("tokens")).iter().map(|call| call.stream().to_string()).collect(),
            _ => return None,
        };
        Some((path.display().to_string(), serde_json::to_string(&text).expect("a text")))
    };
    let questions: Vec<(String, String)> = paths.into_iter().filter_map(question).collect();
    assert!(questions.len() >= least, "{}", questions.len());
    for ((name, _), answer) in questions.iter().zip(answers(&questions).into_iter().flatten()) {
        let [started, translated]: [usize; 2] = serde_json::from_str(&answer).expect("two counts");
        assert!(started > 0 && translated > 10 * started, "{name}: {answer}");
    }
}

#[test]
fn the_hacksaw() {
    compare("hacksaw", 1);
}

#[test]
fn mechanisms_with_loops_and_contacts() {
    compare("bg-model/bond/examples", 8);
}

#[test]
fn examples_of_the_workbench() {
    compare("bg-model/workbench/examples", 15);
}

#[test]
fn random_programs() {
    let answers = answers(&[("a random program".to_owned(), "null".to_owned())]);
    let Some([answer]) = answers.as_deref() else { return };
    assert!(answer.parse::<usize>().is_ok_and(|paired| paired > 50), "{answer}");
}
