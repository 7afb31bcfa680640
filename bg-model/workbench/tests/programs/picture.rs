//! The pictures of the examples' graphs, read back from their files and compared with the table of bonds that is
//! printed.
//!
//! Cargo builds the examples with `cargo test -p bg-workbench`; a run with `--test programs` alone takes those built
//! before.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::example::program;
use crate::support::{self, Picture, faults, faults_in_words};
use bg_picture::{Graph, Level};

/// The names of the examples, sorted.
fn examples() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let files = fs::read_dir(folder).expect("the package has examples").map(|file| file.expect("a file").path());
    let mut names: Vec<_> = files.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort_unstable();
    names
}

fn run(example: &str, arguments: &[&str]) -> Output {
    program(example).args(arguments).output().expect("the example is built")
}

fn printed(example: &str, arguments: &[&str]) -> String {
    let output = run(example, arguments);
    assert!(output.status.success(), "{example} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// The file that a command writes.
fn drawn(example: &str, arguments: &[&str], option: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("picture");
    let all: Vec<&str> = [&["graph", option, file.to_str().unwrap()], arguments].concat();
    assert_eq!(printed(example, &all), "");
    fs::read_to_string(file).expect("the file is there")
}

/// The graph as the printed tables have it.
fn tables(example: &str, scene: &[&str]) -> Graph {
    let rows = |part: &str| printed(example, &[&["graph", "--part", part], scene].concat());
    support::tables(&rows("elements"), &rows("bonds"))
}

#[test]
fn every_examples_picture_is_legible_and_has_the_strokes_of_the_table() {
    let examples = examples();
    assert!(examples.len() >= 12, "{examples:?}");
    for example in &examples {
        let svg = drawn(example, &[], "--svg");
        assert_eq!(faults(&tables(example, &[]), &svg), [""; 0], "{example}");
        assert_eq!(svg, drawn(example, &["--level", "full"], "--svg"), "{example}: the same bytes again");
        let words = drawn(example, &["--level", "words"], "--svg");
        assert_eq!(faults_in_words(&Graph::default(), &words), [""; 0], "{example}");
        println!("{example}: {:?}, {} and {} bytes", Picture::read(&svg).counts(), svg.len(), words.len());
    }
}

#[test]
fn the_documentation_draws_the_same_graph_as_the_command() {
    for example in examples() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(format!("{example}.rs"));
        let text = fs::read_to_string(file).unwrap();
        let (_, graphs) = text.split_once("bond_graph! {").expect("a graph");
        let (graphs, _) = graphs.split_once("\n}\n").expect("its end");
        let code = bg_compiler::compile(graphs.parse().expect("tokens")).to_string();
        let (_, literal) = code.split_once("picture ! (\"").expect("the literal of the first model, the graph itself");
        let (literal, _) = literal.split_once('"').expect("its end");
        let graph: Graph = literal.replace("\\n", "\n").replace("\\t", "\t").parse().expect("a graph");
        assert_eq!(bg_picture::svg(&graph, Level::Full), drawn(&example, &[], "--svg"), "{example}");
    }
}

#[test]
fn parts_laws_states_and_units_are_in_the_picture() {
    let svg = drawn("slider_crank", &[], "--svg");
    for text in [
        "<g class=\"group\" data-group=\"pin_a\">",
        "pin_a <tspan class=\"word\" dx=\"2\" fill=\"#5b6875\" font-weight=\"normal\">revolute z</tspan>",
        "<title>I rod.linear\nlaw: rod.mass\nstates: rod.linear.p_x kg*m/s, ",
        "<title>1 rod.translation\nstates: rod.position_x m, ",
        "effort N, flow m/s, 3 components; stroke at rod.linear",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    let words = drawn("slider_crank", &["--level", "words"], "--svg");
    for part in ["ground", "crank", "rod", "slider", "pin_o", "pin_a", "pin_b", "slide", "motor"] {
        assert!(words.contains(&format!("data-group=\"{part}\"")), "{part}");
    }
    assert!(drawn("slider_crank", &[], "--dot").contains("label=\"slide prismatic x\""));
}

#[test]
fn rigid_joints_mark_the_inertias_that_they_hold() {
    let scene = ["--scene", "rigid-pendulum"];
    let svg = drawn("double_pendulum", &scene, "--svg");
    assert_eq!(faults(&tables("double_pendulum", &scene), &svg), [""; 0]);
    assert_eq!(svg.matches("class=\"node storage multiplier\"").count(), 4, "two bodies, linear and angular");
    assert!(
        !drawn("double_pendulum", &[], "--svg").contains("storage multiplier"),
        "nothing is held where joints give"
    );
}

#[test]
fn a_file_that_cannot_be_written_is_one_line_and_nothing_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let svg = folder.path().join("a.svg");
    let output =
        run("rlc_circuit", &["graph", "--svg", svg.to_str().unwrap(), "--dot", folder.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(line.starts_with("error: cannot write ") && line.lines().count() == 1 && !svg.exists(), "{line}");
    let output = run("rlc_circuit", &["graph", "--svg", svg.to_str().unwrap(), "--part", "bonds"]);
    assert!(String::from_utf8(output.stderr).unwrap().contains("cannot be used with"));
}
