//! Inputs as a user meets them: tables with and without a head, what results say of them. The program is the example
//! `mass_spring_damper`, with its input `force`.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::example::program;
use crate::outcome::text_of;

fn run(directory: &Path, arguments: &[&str]) -> Output {
    program("mass_spring_damper").current_dir(directory).args(arguments).output().expect("the example was built")
}

fn text(directory: &Path, arguments: &[&str]) -> String {
    text_of(run(directory, arguments), arguments)
}

/// The lines of a text that begin with `name`, without it.
fn lines<'a>(text: &'a str, name: &str) -> Vec<&'a str> {
    text.lines().filter_map(|line| Some(line.strip_prefix(name)?.trim_start_matches([' ', ':']))).collect()
}

const SHORT: [&str; 6] = ["run", "--t-end", "1", "--no-figures", "--csv", "x.csv"];

fn with_input(input: &str) -> Vec<&str> {
    [&SHORT[..], &["--input", input]].concat()
}

#[test]
fn a_table_without_a_head_gives_the_run_of_the_same_table_with_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    // 40 N fall to 10 N within half a second; without the first row 10 N would hold from the start on.
    let rows = "0,40\n0.5,10\n0.75,10\n";
    fs::write(path.join("bare.csv"), rows).unwrap();
    fs::write(path.join("named.csv"), format!("t,force\n{rows}")).unwrap();
    let csv = |input: &str| {
        text(path, &with_input(input));
        fs::read_to_string(path.join("x.csv")).unwrap()
    };
    let bare = csv("force=bare.csv");
    assert_eq!(bare, csv("force=named.csv:force"));
    assert_ne!(bare, csv("force=10"));

    fs::write(path.join("mixed.csv"), format!("t,2020\n{rows}")).unwrap();
    let output = run(path, &with_input("force=mixed.csv"));
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(line.contains("the first line of mixed.csv has both a name, `t`, and a number, `2020`;"), "{line}");
}

#[test]
fn every_result_of_a_run_names_its_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("load.csv"), "0.25,40\n0.5,10\n").unwrap();
    // The CRC-32 of these bytes by zlib 1.3: `python3 -c "import zlib; print(hex(zlib.crc32(b'0.25,40\n0.5,10\n')))"`.
    let table = "force = load.csv: 2 rows from 0.25 to 0.5 s, CRC-32 a891c378";
    let held = "force = 40 N before the first row at 0.25 s, 10 N after the last row at 0.5 s";
    let summary = text(path, &["run", "--t-end", "1", "--out", "o", "--input", "force=load.csv"]);
    for told in [summary, fs::read_to_string(path.join("o/summary.txt")).unwrap()] {
        assert_eq!((lines(&told, "input  "), lines(&told, "input held")), (vec![table], vec![held]), "{told}");
        assert!(lines(&told, "inputs not given").is_empty(), "{told}");
    }
    let json: serde_json::Value = serde_json::from_slice(&fs::read(path.join("o/summary.json")).unwrap()).unwrap();
    let expected = serde_json::json!([{
        "name": "force", "unit": "N", "is_given": true,
        "table": {
            "file": "load.csv", "column": null, "crc32": "a891c378", "cubic": false, "rows": 2,
            "first": [0.25, 40.0], "last": [0.5, 10.0],
        },
    }]);
    assert_eq!(json["inputs"], expected);
    let page = fs::read_to_string(path.join("o/index.html")).unwrap();
    assert!(page.contains(&format!("<dt>input</dt><dd>{table}</dd>")), "{page}");
    text(path, &["report", "--t-end", "1", "--out", "r", "--input", "force=2.5"]);
    let report = fs::read_dir(path.join("r")).unwrap().map(|entry| entry.unwrap().path());
    let report = report.filter(|path| path.extension().is_some_and(|end| end == "html")).last().unwrap();
    assert!(fs::read_to_string(report).unwrap().contains("force = 2.5 N"));
}

#[test]
fn a_run_is_made_again_with_the_same_table_only() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("load.csv"), "t,force\n0,40\n0.5,10\n1,20\n").unwrap();
    text(path, &["run", "--t-end", "1", "--out", "o", "--input", "force=cubic:load.csv:force"]);
    text(path, &["run", "--again", "o/summary.json", "--out", "p"]);
    let csv = |folder: &str| fs::read_to_string(path.join(folder).join("trajectory.csv")).unwrap();
    assert_eq!(csv("o"), csv("p"));
    fs::write(path.join("load.csv"), "t,force\n0,41\n0.5,10\n1,20\n").unwrap();
    let output = run(path, &["run", "--again", "o/summary.json", "--out", "q"]);
    let line = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(line.contains("the file of the input `force` has other bytes than then"), "{line}");
}

#[test]
fn an_input_that_was_not_given_is_said_to_be_0() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let note = "force is 0; set it with --input NAME=VALUE or NAME=FILE.csv";
    assert_eq!(lines(&text(path, &SHORT), "inputs not given"), [note]);
    let zero = text(path, &with_input("force=0"));
    assert_eq!((lines(&zero, "input  "), lines(&zero, "inputs not given")), (vec!["force = 0 N"], vec![]));
    for command in [
        &["linearize", "--at", "0.1"][..],
        &["sensitivity", "--t-end", "0.5", "--by", "mass", "--out", "s"],
        &["sensitivity", "--of", "x", "--t-end", "0.5", "--atol", "1e-9"],
        &["compare", "literal", "literal", "--t-end", "0.5"],
    ] {
        assert_eq!(lines(&text(path, command), "inputs not given"), [note], "{command:?}");
        let given = text(path, &[command, &["--input", "force=2"]].concat());
        assert_eq!(lines(&given, "input:"), ["force = 2 N"], "{command:?}");
    }
    assert!(fs::read_to_string(path.join("s/sensitivity.txt")).unwrap().contains("input: force = 2 N"));
}

#[test]
fn a_table_that_covers_the_run_is_not_said_to_be_held() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("load.csv"), "t,force\n0,40\n1,10\n").unwrap();
    let told = text(path, &with_input("force=cubic:load.csv"));
    assert!(lines(&told, "input  ")[0].starts_with("force = load.csv, column `force`: 2 rows from 0 to 1 s, a cubic"));
    assert!(lines(&told, "input held").is_empty(), "{told}");
}

#[test]
fn a_sweep_says_its_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("load.csv"), "0.25,40\n0.5,10\n").unwrap();
    fs::write(path.join("plan.toml"), "t_end = 0.1\n[inputs]\nforce = 'load.csv'\n[grid]\nmass = [1, 2]\n").unwrap();
    text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    let file = "load.csv, CRC-32 a891c378";
    assert_eq!(lines(&text(path, &["sweep", "show", "o"]), "input  "), [format!("force = {file}")]);
    let recipe = fs::read_to_string(path.join("o/sweep.toml")).unwrap();
    assert!(recipe.contains(file), "{recipe}");
    // The same table under another name is the same sweep; another table is another one.
    fs::rename(path.join("load.csv"), path.join("moved.csv")).unwrap();
    let plan = fs::read_to_string(path.join("plan.toml")).unwrap();
    fs::write(path.join("plan.toml"), plan.replace("load.csv", "moved.csv")).unwrap();
    assert!(text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]).contains("0 files made, 1 were there"));
    fs::write(path.join("moved.csv"), "0.25,41\n0.5,10\n").unwrap();
    let output = run(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    assert!(String::from_utf8(output.stderr).unwrap().contains("has another sweep: inputs: `force`"));
}
