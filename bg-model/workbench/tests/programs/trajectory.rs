//! Where a trajectory goes and as what, what is said beside it, and options from a file.

use std::fs;
use std::path::Path;
use std::process::Output;

use bg_workbench::files::parquet::{Table, Values};

use crate::example::program;
use crate::outcome::text_of;

fn run(directory: &Path, arguments: &[&str]) -> Output {
    program("pendulum").current_dir(directory).args(arguments).output().expect("the example was built")
}

fn text(directory: &Path, arguments: &[&str]) -> String {
    text_of(run(directory, arguments), arguments)
}

const SHORT: [&str; 5] = ["run", "--t-end", "0.1", "--output", "angle,force_x"];

fn short<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SHORT.into_iter().chain(more.iter().copied()).collect()
}

#[test]
fn csv_parquet_and_numpy_have_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let all = ["--csv", "a.csv", "--units", "--parquet", "a.parquet", "--npz", "a.npz", "--no-figures"];
    let told = text(path, &short(&all));
    assert!(told.ends_with("written: a.csv, a.parquet, a.npz\n"), "{told}");
    assert!(!path.join("out").exists());
    let csv = fs::read_to_string(path.join("a.csv")).unwrap();
    assert_eq!(csv.lines().next(), Some("t [s],angle [rad],force_x [N]"));
    let rows: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|line| line.split(',').map(|field| field.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 11);
    let table = Table::read(&fs::read(path.join("a.parquet")).unwrap()).unwrap();
    assert_eq!(table.texts, [("units".to_owned(), r#"{"angle":"rad","force_x":"N","t":"s"}"#.to_owned())]);
    let npz = fs::read(path.join("a.npz")).unwrap();
    for (index, column) in table.columns.iter().enumerate() {
        assert_eq!(column.name, ["t", "angle", "force_x"][index]);
        let wanted: Vec<f64> = rows.iter().map(|row| row[index]).collect();
        assert_eq!(column.values, Values::Real(wanted.clone()));
        let bytes: Vec<u8> = wanted.iter().flat_map(|value| value.to_le_bytes()).collect();
        assert!(npz.windows(bytes.len()).any(|window| window == bytes), "{}", column.name);
    }
    // With its units it can be compared with, and given as what was measured.
    let compared = text(path, &["compare", "a.csv", "literal", "--t-end", "0.1"]);
    let line = compared.lines().find(|line| line.trim_start().starts_with("angle ")).unwrap();
    assert_eq!(line.split_whitespace().nth(1), Some("0.000e0"), "{compared}");
}

#[test]
fn standard_output_has_what_is_asked_for_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let output = run(path, &short(&["--csv", "-", "--no-figures"]));
    let [csv, aside] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(csv.starts_with("t,angle,force_x\n0.0,0.5,") && csv.lines().count() == 12, "{csv}");
    assert!(aside.contains("written: nothing") && aside.contains("steps"), "{aside}");
    let output = run(path, &short(&["--csv", "-", "--no-figures", "--quiet"]));
    assert_eq!((String::from_utf8(output.stdout).unwrap(), output.stderr.len()), (csv, 0));
    let output = run(path, &short(&["--no-figures", "--quiet"]));
    assert_eq!((output.stdout.len(), output.stderr.len()), (0, 0));
    let json = text(path, &short(&["--no-figures", "--json"]));
    assert_eq!(json, fs::read_to_string(path.join("out/summary.json")).unwrap());
    // What only prints does so.
    assert!(text(path, &["parameters", "--quiet"]).contains("length"));
}

#[test]
fn options_come_from_a_file_and_those_of_the_command_line_win() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let write = |text: &str| fs::write(path.join("run.toml"), text).unwrap();
    write("t_end = 0.1\nmethod = \"dop853\"\noutput = [\"angle\"]\nno-figures = true\n[set]\nlength = \"800mm\"\n");
    let told = text(path, &["run", "--config", "run.toml", "--out", "a"]);
    assert!(
        told.contains("length = 0.8 m") && told.contains("DOP853") && told.contains("simulated time    0.1 s"),
        "{told}"
    );
    let told = text(path, &["--config", "run.toml", "--out", "b", "--set", "length=0.7", "--t-end", "0.2"]);
    assert!(told.contains("length = 0.7 m") && told.contains("simulated time    0.2 s"), "{told}");
    let csv = fs::read_to_string(path.join("b/trajectory.csv")).unwrap();
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some("t,angle"), 22));
    for (text, expected) in [
        (
            "t_ende = 1",
            "error: --config run.toml: unexpected argument '--t-ende' found; \
            tip: a similar argument exists: '--t-end'; --help says more\n",
        ),
        (
            "t_end = \"long\"",
            "error: --config run.toml: invalid value 'long' for '--t-end <SECONDS>': not a number; --help says more\n",
        ),
        ("set = [\"lenght=1\"]", "error: --set lenght=1: there is no parameter `lenght`; did you mean `length`?\n"),
    ] {
        write(text);
        let output = run(path, &["run", "--config", "run.toml"]);
        assert_eq!((output.status.code(), String::from_utf8(output.stderr).unwrap().as_str()), (Some(2), expected));
    }
}

#[test]
fn shells_and_manuals_know_the_commands() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let script = text(path, &["completions", "bash"]);
    for word in ["linearize", "--no-figures", "--rtol", "literal"] {
        assert!(script.contains(word), "{word}");
    }
    assert!(text(path, &["man"]).contains(".TH pendulum 1"));
    text(path, &["man", "--out", "man"]);
    let page = fs::read_to_string(path.join("man/pendulum-linearize.1")).unwrap();
    assert!(page.contains("eigenvalues") || page.contains("Linearise"), "{page}");
}
