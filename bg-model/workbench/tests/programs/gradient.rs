//! The command `sensitivity` of one number: the same derivatives as of all outputs, integrals, squares of measured
//! columns, refusals. The program is the example `mass_spring_damper`.

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

fn refused(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// Rows of a CSV file, each as a parameter with its derivative, whose columns have these numbers; the rows for which
/// `which` holds.
fn slopes(csv: &str, [parameter, derivative]: [usize; 2], which: impl Fn(&[&str]) -> bool) -> Vec<(String, f64)> {
    let rows = csv.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>()).filter(|row| which(row));
    rows.map(|row| (row[parameter].to_owned(), row[derivative].parse().unwrap())).collect()
}

/// The value and the derivatives of the last number.
fn gradient(directory: &Path) -> (f64, Vec<(String, f64)>) {
    let csv = fs::read_to_string(directory.join("out/sensitivity/gradient.csv")).unwrap();
    let value = csv.lines().nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
    (value, slopes(&csv, [2, 5], |_| true))
}

#[test]
fn derivatives_are_those_of_slopes() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let of_run = ["--t-end", "2", "--method", "dop853"];
    text(directory, &[&["sensitivity", "--output", "x", "--at", "0.7"], &of_run[..]].concat());
    let csv = fs::read_to_string(directory.join("out/sensitivity/sensitivity.csv")).unwrap();
    for (measure, more) in [("final", vec![]), ("at 0.7 s", vec!["--at", "0.7"])] {
        let told = text(directory, &[&["sensitivity", "--of", "x"], &more[..], &of_run].concat());
        assert!(told.contains("derivatives by 5 parameters over 2 s, 0 events"), "{told}");
        let expected = slopes(&csv, [4, 7], |row| row[2] == measure);
        let (_, found) = gradient(directory);
        assert_eq!(found.len(), 5);
        for ((name, slope), (expected_name, expected)) in found.iter().zip(&expected) {
            assert_eq!(name, expected_name);
            assert!((slope - expected).abs() <= 1e-10 * (1.0 + expected.abs()), "{name}: {slope} {expected}");
        }
    }
}

#[test]
fn the_integral_of_a_speed_is_a_way() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let of = |arguments: &[&str]| {
        text(directory, &[&["sensitivity", "--t-end", "2", "--method", "dop853"], arguments].concat());
        gradient(directory)
    };
    let ((way, of_way), (_, of_place)) = (of(&["--of", "v", "--integral"]), of(&["--of", "x"]));
    let (start, of_start) = of(&["--of", "x", "--at", "0"]);
    let (end, _) = of(&["--of", "x"]);
    assert!((way - (end - start)).abs() < 1e-12);
    for (k, (name, slope)) in of_way.iter().enumerate() {
        assert!((slope - (of_place[k].1 - of_start[k].1)).abs() < 1e-12, "{name}");
    }
}

/// The squares at two instants, against the derivatives of the output there.
#[test]
fn squares_of_measured_columns() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let method = ["--method", "dop853"];
    fs::write(directory.join("measured.csv"), "t,place,v\n0.5,0.03,\n1,-0.04,0.2\n").unwrap();
    let arguments = ["sensitivity", "--data", "measured.csv", "--column", "place=x"];
    text(directory, &[&arguments, &method[..]].concat());
    let (value, found) = gradient(directory);
    let size = ((0.03_f64.powi(2) + 0.04_f64.powi(2)) / 2.0).sqrt();
    let (mut sum, mut expected) = (0.0, vec![0.0; found.len()]);
    for (output, at, measured, size) in [("x", "0.5", 0.03, size), ("x", "1", -0.04, size), ("v", "1", 0.2, 0.2)] {
        text(directory, &[&["sensitivity", "--of", output, "--at", at, "--t-end", "1"], &method[..]].concat());
        let (value, slopes) = gradient(directory);
        let left = (value - measured) / size;
        sum += left * left;
        expected.iter_mut().zip(slopes).for_each(|(sum, (_, slope))| *sum += 2.0 * left / size * slope);
    }
    assert!((value - sum).abs() < 1e-9 * sum, "{value} {sum}");
    for ((name, slope), expected) in found.iter().zip(expected) {
        assert!((slope - expected).abs() <= 1e-7 * (1.0 + expected.abs()), "{name}: {slope} {expected}");
    }
}

#[test]
fn what_cannot_be_asked_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let directory = folder.path();
    let fault = refused(&run(directory, &["sensitivity", "--of", "y"]));
    assert!(fault.contains("has no output `y`"), "{fault}");
    let fault = refused(&run(directory, &["sensitivity", "--of", "x", "--at", "9"]));
    assert!(fault.contains("a time in the run, 0 to 5 s"), "{fault}");
    let fault = refused(&run(directory, &["sensitivity", "--integral"]));
    assert!(fault.contains("--of"), "{fault}");
    let fault = refused(&run(directory, &["sensitivity", "--of", "x", "--at", "0.1,0.2"]));
    assert!(fault.contains("one number has one time, and here are 2"), "{fault}");
    let fault = refused(&run(directory, &["sensitivity", "--of", "x", "--output", "v"]));
    assert!(fault.contains("cannot be used with"), "{fault}");
    assert!(!directory.join("out").exists());
}
