//! The commands `sensitivity` and `identify`: derivatives against runs, parameters that come back from noisy columns,
//! what cannot be identified, refusals. The program is the example `mass_spring_damper`.

use std::fmt::Write as _;
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

fn refused(directory: &Path, arguments: &[&str]) -> String {
    let output = run(directory, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

/// The last row of a run's table, by name.
fn last(directory: &Path, set: &str, name: &str) -> f64 {
    let arguments = ["run", "--t-end", "2", "--rtol", "1e-12", "--set", set, "--csv", "run.csv", "--no-figures"];
    text(directory, &arguments);
    let csv = fs::read_to_string(directory.join("run.csv")).unwrap();
    let column = csv.lines().next().unwrap().split(',').position(|column| column == name).unwrap();
    csv.lines().last().unwrap().split(',').nth(column).unwrap().parse().unwrap()
}

#[test]
fn derivatives_in_the_table_are_those_of_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let arguments =
        ["sensitivity", "--t-end", "2", "--rtol", "1e-12", "--by", "stiffness,mass", "--at", "0.5", "--out", "s"];
    let told = text(path, &arguments);
    assert!(
        told.contains("derivatives of 6 outputs by 2 parameters over 2 s") && told.contains("4 files in s"),
        "{told}"
    );
    let csv = fs::read_to_string(path.join("s/sensitivity.csv")).unwrap();
    for output in ["x", "v", "dissipated"] {
        let line = csv.lines().find(|line| line.starts_with(&format!("{output},")) && line.contains(",final,"));
        let fields: Vec<&str> = line.unwrap().split(',').collect();
        assert_eq!((fields[4], fields[5]), ("stiffness", "N/m"));
        let derivative: f64 = fields[7].parse().unwrap();
        let [low, high] = ["stiffness=199.99", "stiffness=200.01"].map(|set| last(path, set, output));
        let difference = (high - low) / 0.02;
        // In truncation and rounding the differences err by some 1e-10.
        assert!(
            (derivative - difference).abs() < 1e-6 * derivative.abs().max(1e-3),
            "{output} {derivative} {difference}"
        );
    }
    assert!(csv.lines().any(|line| line.starts_with("x,m,at 0.5 s,")), "{csv}");
    let courses = fs::read_to_string(path.join("s/sensitivity_over_time.csv")).unwrap();
    assert!(courses.starts_with("t,d(x)/d(stiffness),d(x)/d(mass),") && courses.lines().count() == 202);
    assert!(fs::read_to_string(path.join("s/sensitivity.svg")).unwrap().contains("<svg"));
}

/// A run with other parameters, with gaps and noise that an even generator gives.
fn measured(directory: &Path) {
    let set = ["--set", "stiffness=150", "--set", "damping=3"];
    text(directory, &[&["run", "--t-end", "2", "--csv", "true.csv", "--no-figures"][..], &set[..]].concat());
    let csv = fs::read_to_string(directory.join("true.csv")).unwrap();
    let mut state = 1_u64;
    let mut even = || {
        // The generator MMIX of Knuth, The Art of Computer Programming, vol. 2, 3.3.4.
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut noisy = "t,place,v,remark\n".to_owned();
    for line in csv.lines().skip(1) {
        let fields: Vec<f64> = line.split(',').take(3).map(|field| field.parse().unwrap()).collect();
        let [x, v] = [fields[1] + 1e-4 * even(), fields[2] + 1e-3 * even()];
        let x = if even() > 0.4 { String::new() } else { x.to_string() };
        writeln!(noisy, "{},{x},{v},0", fields[0]).unwrap();
    }
    fs::write(directory.join("noisy.csv"), noisy).unwrap();
}

/// What the table of a report says of a parameter: the value found, and the ends of its interval where there are any.
fn found(report: &str, name: &str) -> (f64, Option<[f64; 2]>) {
    let line = report.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
    let fields: Vec<Option<f64>> = line.split_whitespace().skip(2).map(|field| field.parse().ok()).collect();
    (fields[0].unwrap(), fields[1].zip(fields[2]).map(|(lower, upper)| [lower, upper]))
}

#[test]
fn parameters_come_back_from_noisy_columns_with_gaps() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    measured(path);
    let arguments = ["identify", "noisy.csv", "--column", "place=x", "--fit", "stiffness,damping", "--out", "i"];
    let report = text(path, &arguments);
    assert!(report.contains("converged") && report.contains("asked for: remark"), "{report}");
    for (name, expected) in [("stiffness", 150.0), ("damping", 3.0)] {
        let (value, interval) = found(&report, name);
        let [lower, upper] = interval.unwrap();
        assert!(lower < expected && expected < upper && lower < value && value < upper, "{report}");
        assert!((value / expected - 1.0).abs() < 2e-3, "{report}");
    }
    // Of even noise of this width the mean square is a twelfth.
    let noise = report.lines().find(|line| line.trim_start().starts_with("place")).unwrap();
    let noise: f64 = noise.split_whitespace().nth(3).unwrap().parse().unwrap();
    assert!((noise - 1e-4 / 12.0_f64.sqrt()).abs() < 5e-6, "{report}");
    assert!(fs::read_to_string(path.join("i/identified.toml")).unwrap().contains("stiffness = 1"));
    assert!(path.join("i/fit_x.svg").exists() && path.join("i/fit_v.svg").exists());
    text(path, &["run", "--params", "i/identified.toml", "--t-end", "1", "--csv", "again.csv", "--no-figures"]);
}

#[test]
fn what_cannot_be_identified_is_said_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    measured(path);
    let fit = ["identify", "noisy.csv", "--column", "place=x", "--fit"];
    let together = text(path, &[&fit[..], &["stiffness,damping,mass", "--out", "a"][..]].concat());
    assert!(together.contains("cannot be told apart") && together.contains("`mass` by +1.00 %"), "{together}");
    assert_eq!(found(&together, "mass").1, None);
    let bounded = ["stiffness", "--set", "stiffness=210", "--bounds", "stiffness=200..220", "--out", "b"];
    let output = run(path, &[&fit[..], &bounded[..]].concat());
    assert_eq!(output.status.code(), Some(1));
    let bounded = String::from_utf8(output.stdout).unwrap();
    assert!(bounded.contains("`stiffness` is at its bound") && found(&bounded, "stiffness").0 == 200.0, "{bounded}");
}

/// Some ten turns that end in an error of the frequency: the next minimum has the model run half a turn ahead, or more.
/// It is seen by what it leaves, and the first turns lead out of it; where the model is another one nothing does.
#[test]
fn another_minimum_is_left_and_another_model_is_a_failure() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let low = ["--set", "damping=0.05", "--set", "speed=0"];
    let made = ["run", "--t-end", "8", "--step", "0.05", "--csv", "meas.csv", "--no-figures"];
    text(path, &[&made[..], &low].concat());
    let fit = ["identify", "meas.csv", "--output", "x,v", "--fit", "stiffness", "--out", "i"];
    let near = text(path, &[&fit[..], &low, &["--set", "stiffness=203"]].concat());
    let (value, interval) = found(&near, "stiffness");
    // Without noise, to the run's own error: nothing is asked of that.
    assert!((value - 200.0).abs() < 1e-5 && interval.is_some() && near.contains("columns: converged after"), "{near}");

    for start in ["130", "280", "390"] {
        let far = text(path, &[&fit[..], &low, &["--set", &format!("stiffness={start}")]].concat());
        let (value, interval) = found(&far, "stiffness");
        assert!((value - 200.0).abs() < 1e-5 && interval.is_some(), "{far}");
        assert!(far.contains("with derivatives, from 2 starts"), "{far}");
    }

    let other = ["--set", "damping=0.05", "--set", "speed=0.4", "--set", "stiffness=280"];
    let output = run(path, &[&fit[..], &other].concat());
    assert_eq!(output.status.code(), Some(1));
    let fault = String::from_utf8(output.stderr).unwrap();
    assert!(fault.contains("error: what the best fit leaves is no noise; fit what else may differ"), "{fault}");
    let far = String::from_utf8(output.stdout).unwrap();
    assert!(found(&far, "stiffness").1.is_none() && far.contains(", from 10 starts"), "{far}");
    assert!(far.contains("columns: converged, but what is left is no noise, after"), "{far}");
    assert!(far.contains("\nwhat is left of `x`, ") && far.contains(" of its spread, is correlated by "), "{far}");
    assert_eq!(fs::read_to_string(path.join("i/identify.txt")).unwrap(), far.split("\nwritten:").next().unwrap());
    assert!(
        fs::read_to_string(path.join("i/identified.toml")).unwrap().contains("no interval: what is left is no noise")
    );
}

#[test]
fn what_cannot_be_asked_is_refused_with_the_nearest_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    measured(path);
    let line = |arguments: &[&str]| refused(path, arguments);
    assert!(
        line(&["sensitivity", "--by", "stifness"])
            .contains("no parameter `stifness` to be asked for; did you mean `stiffness`?")
    );
    assert!(line(&["sensitivity", "--output", "spring_forse"]).contains("did you mean `spring_force`?"));
    assert!(line(&["sensitivity", "--at", "9"]).contains("a time in the run"));
    assert!(line(&["identify", "noisy.csv", "--fit", "mas"]).contains("did you mean `mass`?"));
    assert!(
        line(&["identify", "noisy.csv", "--fit", "mass", "--column", "plaice=x"]).contains("did you mean `place`?")
    );
    assert!(line(&["identify", "noisy.csv", "--fit", "mass", "--bounds", "mass=5..6"]).contains("starts at 2"));
    assert!(line(&["identify", "none.csv", "--fit", "mass"]).contains("cannot use none.csv"));
}
