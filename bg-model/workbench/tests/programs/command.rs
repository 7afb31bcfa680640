//! What a user of any mechanism's program sees: files, lines, faults, exit codes. The program is the example
//! `pendulum`.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::example::program;
use crate::outcome::text_of;

fn run(directory: &Path, arguments: &[&str]) -> Output {
    program("pendulum").current_dir(directory).args(arguments).output().expect("the example was built")
}

fn text(directory: &Path, arguments: &[&str]) -> String {
    text_of(run(directory, arguments), arguments)
}

/// The one line of a refusal; nothing else may have happened.
fn refused(directory: &Path, arguments: &[&str]) -> String {
    let output = run(directory, arguments);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    let line = String::from_utf8(output.stderr).expect("text");
    assert!(output.stdout.is_empty() && !directory.join("out").exists(), "{arguments:?}");
    assert!(line.starts_with("error: ") && line.lines().count() == 1, "{line:?}");
    line
}

#[test]
fn a_run_writes_its_trajectory_and_a_figure_of_each_output() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let summary = text(path, &["run", "--t-end", "1", "--set", "length=0.8", "--out", "o"]);
    assert!(summary.contains("length = 0.8 m") && summary.contains("9 files in o"), "{summary}");
    let csv = fs::read_to_string(path.join("o/trajectory.csv")).unwrap();
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some("t,angle,force_x,force_y,stored,lost"), 102));
    let page = fs::read_to_string(path.join("o/index.html")).unwrap();
    for output in ["angle", "force_x", "force_y", "stored", "lost"] {
        let is_charted = page.contains(&format!("\"column\":\"{output}\""));
        assert!(is_charted && path.join(format!("o/{output}.svg")).exists(), "{output}");
    }
    // Without a machine it has no need of three.js.
    assert!(!page.contains("id=\"machine\"") && page.len() < 300_000, "{}", page.len());
    let json: serde_json::Value = serde_json::from_slice(&fs::read(path.join("o/summary.json")).unwrap()).unwrap();
    assert_eq!(json["outputs"]["angle"]["unit"], "rad");
    assert_eq!(json["outputs"]["angle"]["start"], 0.5);
}

/// The largest of samples is below the peak, by so much the farther apart they are; what is told is the peak.
#[test]
fn ranges_are_those_of_the_solution_and_the_interval_of_samples_is_said_beside_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let step = |arguments: &[&str]| {
        let told = text(path, &[&["run", "--no-figures", "--out", "o"], arguments].concat());
        let line = told.lines().find(|line| line.starts_with("samples ")).unwrap();
        let (step, rest) = line["samples ".len()..].trim().strip_prefix("at most ").unwrap().split_once(' ').unwrap();
        assert_eq!(rest, "s apart; ranges are those of the solution between them, too");
        let json: serde_json::Value = serde_json::from_slice(&fs::read(path.join("o/summary.json")).unwrap()).unwrap();
        let (step, exact) = (step.parse::<f64>().unwrap(), json["sample_step_s"].as_f64().unwrap());
        assert!((step / exact - 1.0).abs() < 1e-5, "{step} {exact}");
        (step, json["outputs"].clone())
    };
    // A 2500th of the run, or the interval of the CSV file where that is shorter.
    let (usual, outputs) = step(&["--t-end", "0.5"]);
    let (fine, same) = step(&["--t-end", "0.5", "--step", "1e-4"]);
    assert_eq!((usual, fine), (2e-4, 1e-4));
    assert_eq!(outputs, same);
    let [least, largest] = ["least", "largest"].map(|peak| outputs["force_y"][peak].as_f64().unwrap());
    let at = outputs["force_y"]["largest_at_s"].as_f64().unwrap();
    assert!(least < 0.0 + 1e-9 && largest > 100.0 && 0.0 < at && at < 0.5, "{outputs}");
}

#[test]
fn a_run_is_made_again_from_its_summary() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let read = |file: &str| fs::read_to_string(path.join(file)).unwrap();
    let recipe = |file: &str| serde_json::from_str::<serde_json::Value>(&read(file)).unwrap()["recipe"].take();
    let set = ["--set", "length=0.73", "--t-end", "0.4", "--rtol", "1e-7", "--method", "dop853", "--step", "0.03"];
    text(path, &[&["run", "--out", "o"], &set[..]].concat());
    let told = text(path, &["run", "--again", "o/summary.json", "--out", "p"]);
    assert!(told.contains("\nprogram ") && told.contains("length = 0.73 m"), "{told}");
    assert_eq!(read("o/trajectory.csv"), read("p/trajectory.csv"));
    let made = recipe("o/summary.json");
    assert_eq!(made, recipe("p/summary.json"));
    assert_eq!(made["parameters"]["length"], serde_json::json!({ "value": 0.73, "unit": "m" }));
    assert_eq!(made["parameters"]["angle"], serde_json::json!({ "value": 0.5, "unit": "rad" }));
    assert_eq!((&made["version"], &made["integration"]["rtol"]), (&env!("CARGO_PKG_VERSION").into(), &1e-7.into()));
    // From where a run has come to, with the state in the recipe.
    text(path, &["run", "--t-end", "0.2", "--no-figures", "--csv", "first.csv", "--save-state", "state.json"]);
    text(path, &["run", "--from", "state.json", "--t-end", "0.3", "--out", "q"]);
    fs::remove_file(path.join("state.json")).unwrap();
    text(path, &["run", "--again", "q/summary.json", "--out", "r"]);
    assert_eq!(read("q/trajectory.csv"), read("r/trajectory.csv"));

    let refused = |arguments: &[&str]| {
        let output = run(path, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let line = refused(&["run", "--again", "o/summary.json", "--set", "length=1"]);
    assert!(line.contains("cannot be used with"), "{line}");
    assert!(refused(&["run", "--again", "none.json"]).starts_with("error: --again none.json: cannot be read: "));
    fs::write(path.join("other.json"), "{}").unwrap();
    let line = refused(&["run", "--again", "other.json"]);
    assert_eq!(line, "error: --again other.json: has no `recipe`; give the summary.json of a run\n");
    let changed = read("o/summary.json").replace(made["model"].as_str().unwrap(), "00000000");
    fs::write(path.join("changed.json"), changed).unwrap();
    let line = refused(&["run", "--again", "changed.json"]);
    assert!(line.contains("the model has other equations or outputs than then"), "{line}");
}

#[test]
fn a_run_begins_with_what_made_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let read = |file: &str| fs::read_to_string(path.join(file)).unwrap();
    let json = |file: &str| serde_json::from_str::<serde_json::Value>(&read(file)).unwrap();
    let with = |out: &str, hint: &[&str]| {
        text(path, &[&["run", "--t-end", "0.4", "--step", "0.03", "--out", out], hint].concat());
    };
    with("o", &[]);
    let mut summary = json("o/summary.json");
    assert_eq!((&summary["hint"], &summary["recipe"]["integration"]["hint"]), (&"dop853".into(), &().into()));
    summary["hint"] = "radau9".into();
    fs::write(path.join("other.json"), summary.to_string()).unwrap();
    with("p", &["--hint", "other.json"]);
    let told = json("p/summary.json");
    assert_eq!(told["integrators"][0], "Radau IIA 9 (auto found none better)");
    assert_eq!((&told["hint"], &told["recipe"]["integration"]["hint"]), (&"radau9".into(), &"radau9".into()));
    // The hint is part of the recipe, so the bits are the same.
    fs::remove_file(path.join("other.json")).unwrap();
    text(path, &["run", "--again", "p/summary.json", "--out", "q"]);
    assert_eq!(read("p/trajectory.csv"), read("q/trajectory.csv"));
    assert!(read("p/trajectory.csv") != read("o/trajectory.csv"));

    let refused = |hint: &str| String::from_utf8(run(path, &["run", "--hint", hint]).stderr).unwrap();
    let them = "dop853, cfmr7, nystrom, taylor, ark5, radau9";
    assert!(refused("bs5").contains(&format!("auto does not choose it; give one of {them}")), "{}", refused("bs5"));
    assert!(refused("best").contains(&format!("give one of {them}, or the summary.json")), "{}", refused("best"));
    assert!(refused("none.json").contains("cannot be read"), "{}", refused("none.json"));
    text(path, &["run", "--t-end", "0.1", "--method", "dop853", "--out", "r"]);
    assert!(refused("r/summary.json").contains("has no `hint`"), "{}", refused("r/summary.json"));
}

#[test]
fn outputs_are_chosen_and_ordered() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let told = text(path, &["run", "--t-end", "0.2", "--output", "force_y,angle", "--out", "o"]);
    assert!(told.contains("\nforce_y ") && told.contains("\nangle ") && !told.contains("force_x"), "{told}");
    let csv = fs::read_to_string(path.join("o/trajectory.csv")).unwrap();
    assert_eq!(csv.lines().next(), Some("t,force_y,angle"));
    let page = fs::read_to_string(path.join("o/index.html")).unwrap();
    assert!(page.contains("\"column\":\"angle\"") && !page.contains("\"column\":\"force_x\""));
    let is_there = |file: &str| path.join("o").join(file).exists();
    assert_eq!(["angle.svg", "force_y.svg", "force_x.svg"].map(is_there), [true, true, false]);
    let output = run(path, &["run", "--output", "forse_y"]);
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && line.contains("did you mean `force_y`?"), "{line}");
}

#[test]
fn a_run_goes_on_from_a_saved_state() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    text(path, &["run", "--t-end", "1", "--csv", "all.csv", "--no-figures"]);
    text(path, &["run", "--t-end", "0.5", "--csv", "first.csv", "--no-figures", "--save-state", "state.json"]);
    let second = ["run", "--from", "state.json", "--t-end", "1", "--csv", "second.csv", "--no-figures"];
    assert!(text(path, &second).contains("from 0.5 s to 1 s"));
    let comparison = text(path, &["compare", "all.csv", "second.csv"]);
    assert!(
        comparison.starts_with("all.csv and second.csv: 5 outputs in common, 51 instants in common (101 and 51)\n")
    );
    let angle = comparison.lines().find(|line| line.trim_start().starts_with("angle ")).unwrap();
    let largest: f64 = angle.split_whitespace().nth(1).unwrap().parse().unwrap();
    assert!(largest < 1e-6, "{comparison}");

    let state = fs::read_to_string(path.join("state.json")).unwrap();
    for (from, to, told) in [
        ("\"Pendulum\"", "\"Other\"", "this is a state of `Other`, not of `Pendulum`"),
        ("rod.position_x", "rod.x", "the states do not fit: `rod.position_x`"),
        ("\"t\": 0.5", "\"t\": null", "this is no saved state: "),
        ("  \"format\": 2,\n", "", "this state was saved in format 1, which does not say what sticks or rests"),
    ] {
        fs::write(path.join("bad.json"), state.replace(from, to)).unwrap();
        assert!(refused(path, &["run", "--from", "bad.json"]).contains(told), "{told}");
    }
    let mut turned: serde_json::Value = serde_json::from_str(&state).unwrap();
    for entry in turned["states"].as_array_mut().unwrap() {
        if entry[0].as_str().unwrap().contains("orientation") {
            entry[1] = serde_json::json!(0.0);
        }
    }
    fs::write(path.join("bad.json"), turned.to_string()).unwrap();
    let line = refused(path, &["run", "--from", "bad.json", "--out", "none"]);
    assert!(line.contains("the orientation `rod.orientation` is no rotation"), "{line}");
    assert!(!path.join("none").exists());
    assert!(
        refused(path, &["run", "--from", "absent.json"]).contains("--from absent.json: cannot be read: No such file")
    );
    let line = refused(path, &["run", "--from", "state.json", "--t-end", "0.5"]);
    assert!(line.contains("--t-end 0.5: must be after 0.5 s"), "{line}");
    assert!(refused(path, &["run", "--save-state", "absent/state.json"]).contains("cannot write absent/state.json"));
}

#[test]
fn scenes_runs_and_folders_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    text(path, &["run", "--t-end", "0.2", "--out", "o"]);
    let same = text(path, &["compare", "o", "literal", "--t-end", "0.2"]);
    assert!(same.lines().filter(|line| line.contains(" 0.000e0 ")).count() >= 5, "{same}");
    let other = text(path, &["compare", "literal", "o/trajectory.csv", "--t-end", "0.2", "--set", "angle=0.6"]);
    assert!(other.lines().filter(|line| line.contains(" 0.000e0 ")).count() == 0, "{other}");
    let line = refused(folder.path(), &["compare", "literal", "nothing"]);
    assert!(line.contains("nothing: neither a scene nor a run"), "{line}");
    fs::write(path.join("bad.csv"), "x,y\n1,2\n").unwrap();
    let output = run(path, &["compare", "literal", "bad.csv"]);
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(line.contains("cannot read bad.csv: the first column must be `t`"), "{line}");
}

#[test]
fn what_the_model_consists_of_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let text = |arguments: &[&str]| text(folder.path(), arguments);
    assert!(text(&["scene"]).lines().nth(1).unwrap().starts_with("  literal      20 "));
    assert!(text(&["graph", "--part", "states"]).contains("rod.linear.p_x"));
    assert!(text(&["graph", "--part", "equations"]).contains("d(rod.position)/dt = "));
    assert!(text(&["parameters"]).contains("Length of the rod."));
    assert!(text(&["--help"]).starts_with("A steel rod that swings about a pin."));
    assert!(text(&["--version"]).starts_with("pendulum "));
}

#[test]
fn bad_input_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let cases: [(&[&str], &str); 6] = [
        (&["run", "--set", "lenght=1"], "did you mean `length`?"),
        (&["run", "--set", "length=-1"], "parameter `length` = -1 m is out of range"),
        (&["run", "--input", "push=1"], "there is no input `push`; the model has no inputs"),
        (&["run", "--scene", "swing"], "literal"),
        (&["run", "--step", "0"], "--step 0: must be a finite number above 0"),
        (&["precision", "nothing"], "literal"),
    ];
    for (arguments, part) in cases {
        let line = refused(folder.path(), arguments);
        assert!(line.contains(part), "{arguments:?}: {line}");
    }
}

#[test]
fn errors_are_measured_against_a_reference_made_on_the_way() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["precision", "--methods", "dop853", "--rtol", "1e-6,1e-9", "--repeats", "1", "--out", "p"];
    let table = text(folder.path(), &arguments);
    let error =
        |line: usize| -> f64 { table.lines().nth(line).unwrap().split_whitespace().nth(3).unwrap().parse().unwrap() };
    assert!(error(1) < 1e-4 && error(2) < 1e-2 * error(1) && error(2) > 0.0, "{table}");
    assert!(folder.path().join("p/precision_literal_rates.svg").exists());
}

#[test]
fn the_linear_model_at_the_equilibrium_has_the_frequency_of_the_pendulum() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let table = text(path, &["linearize", "--out", "l"]);
    assert!(table.starts_with("equilibrium after ") && table.contains("written: 3 files in l"), "{table}");
    // sqrt(3 g / (2 l)) of a rod, less what its thickness and the pin's compliance take.
    let slowest = table.lines().find(|line| line.trim_start().starts_with("1 ")).unwrap();
    let frequency: f64 = slowest.split_whitespace().nth(2).unwrap().parse().unwrap();
    assert!((frequency - (1.5 * 9.81 / 0.6_f64).sqrt()).abs() < 2e-3 * frequency, "{frequency}");
    let json: serde_json::Value = serde_json::from_slice(&fs::read(path.join("l/linear.json")).unwrap()).unwrap();
    assert_eq!((json["states"].as_array().unwrap().len(), json["modes"].as_array().unwrap().len()), (12, 6));
    assert!(fs::read(path.join("l/linear.npz")).unwrap().starts_with(b"PK"));

    assert!(text(path, &["linearize", "--at", "0.1"]).starts_with("where the run is at t = 0.1 s\n"));
    let rest = text(path, &["run", "--start", "equilibrium", "--t-end", "0.1", "--out", "r"]);
    let angle = rest.lines().find(|line| line.starts_with("angle ")).unwrap();
    assert!(angle.contains("-1.5708 to -1.5708, between -1.5708 and -1.5708 rad"), "{angle}");
    assert!(
        refused(&path.join("r"), &["linearize", "--at", "-1"]).contains("--at -1: must be a finite number, at least 0")
    );
}
