//! What a user of the command line sees: files, summary, error lines, exit codes.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn hacksaw(directory: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("hacksaw").unwrap();
    command.current_dir(directory).args(arguments);
    command
}

/// The names in a folder of results. What begins with a dot is not a result.
fn results(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| !name.starts_with('.')).collect()
}

/// A short run, so that the suite stays quick in debug.
const SHORT: [&str; 2] = ["--t-end", "0.05"];

/// Runs with these arguments and gives the one line of stderr; nothing else may have happened.
fn refused(directory: &Path, arguments: &[&str]) -> String {
    let output = hacksaw(directory, arguments).assert().code(2).get_output().clone();
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(output.stdout.is_empty());
    assert!(line.starts_with("error: ") && line.ends_with('\n') && line.lines().count() == 1, "{line:?}");
    assert!(!directory.join("out").exists(), "{arguments:?} left an output directory");
    line
}

#[test]
fn a_bare_run_writes_everything_into_out() {
    let directory = tempfile::tempdir().unwrap();
    let output = hacksaw(directory.path(), &SHORT).assert().success().get_output().clone();
    assert!(output.stderr.is_empty(), "silent in a pipe");
    let summary = String::from_utf8(output.stdout).unwrap();
    for name in [
        "states",
        "steps",
        "rate evaluations",
        "wall time",
        "energy balance residual",
        "largest joint gap",
        "crank speed",
    ] {
        assert!(summary.contains(name), "{name} is not in the summary");
    }
    let out = directory.path().join("out");
    let names = results(&out);
    assert_eq!(names.len(), 20);
    assert_eq!(names.iter().filter(|name| name.starts_with("figure_") && name.ends_with(".svg")).count(), 16);
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains("data-drawing=\"15\"") && !page.contains("id=\"machine\""), "the figures are in it");
    let json: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(json["checks"].as_array().unwrap().len(), 12);
}

#[test]
fn the_csv_file_has_the_reference_columns_the_forces_and_the_same_bytes_twice() {
    let directory = tempfile::tempdir().unwrap();
    for file in ["a.csv", "b.csv"] {
        let arguments = [&SHORT[..], &["--step", "0.02", "--csv", file, "--no-figures"]].concat();
        hacksaw(directory.path(), &[&["run"], &arguments[..]].concat()).assert().success();
    }
    let csv = fs::read(directory.path().join("a.csv")).unwrap();
    assert_eq!(csv, fs::read(directory.path().join("b.csv")).unwrap());
    assert!(!directory.path().join("out").exists());
    let text = String::from_utf8(csv).unwrap();
    let header = text.lines().next().unwrap();
    assert!(
        header.starts_with("t,C2_x,C2_y,C2_z,R2_11,") && header.contains(",h5_x,h5_y,h5_z,F12_x,F12_y,F12_z,F23_x")
    );
    assert!(header.ends_with(",F45_z,Fcut_x,Fcut_y,Fcut_z"), "{header}");
    assert_eq!(header.split(',').count(), 91);
    let times: Vec<&str> = text.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(times, ["0.0", "0.02", "0.04", "0.05"]);
}

#[test]
fn settings_beat_the_file_and_both_reach_the_model() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("p.toml"), "torque = 20\ngravity = 0\n").unwrap();
    let arguments = [&SHORT[..], &["--params", "p.toml", "--set", "torque=30", "--no-figures"]].concat();
    let output = hacksaw(directory.path(), &arguments).assert().success().get_output().clone();
    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.contains("gravity = 0 m/s^2, torque = 30 N*m"), "{summary}");
}

#[test]
fn a_parameter_goes_to_the_scene_or_is_refused_with_its_place() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("p.toml"), "rod_offset = 0.025\n").unwrap();
    let kept = "scene `paper` keeps `rod_offset` fixed at 0 m; use --scene full\n";
    assert_eq!(refused(path, &["--set", "rod_offset=0.025"]), format!("error: --set rod_offset=0.025: {kept}"));
    assert_eq!(refused(path, &["--params", "p.toml"]), format!("error: p.toml: {kept}"));
    let line = refused(path, &["run", "--scene", "angles", "--set", "k_2=2e7"]);
    assert!(line.ends_with("scene `angles` keeps `k_2` fixed at 1e7 N/m; use --scene paper\n"), "{line}");
    assert!(refused(path, &["--scene", "angels"]).contains("angles"));
    for more in [&["--set", "rod_offset=0"][..], &["--params", "p.toml", "--set", "rod_offset=0"]] {
        hacksaw(path, &[&SHORT[..], &["--no-figures"], more].concat()).assert().success();
    }
    // With the rod out of the plane the motion is stiff beyond an explicit method but for a moment.
    let arguments = ["--scene", "full", "--set", "rod_offset=0.025", "--t-end", "1e-4", "--no-figures"];
    let output = hacksaw(path, &arguments).assert().success().get_output().clone();
    assert!(String::from_utf8(output.stdout).unwrap().contains("rod_offset = 0.025 m"));
}

#[test]
fn scenes_with_the_reference_columns_write_the_same_file() {
    let directory = tempfile::tempdir().unwrap();
    let read = |scene: &str| {
        let file = format!("{scene}.csv");
        let arguments = [&["run", "--scene", scene, "--csv", &file, "--no-figures"], &SHORT[..]].concat();
        let output = hacksaw(directory.path(), &arguments).assert().success().get_output().clone();
        let summary = String::from_utf8(output.stdout).unwrap();
        assert!(summary.contains("statements hold") && summary.contains("energy balance residual"), "{summary}");
        fs::read_to_string(directory.path().join(file)).unwrap()
    };
    let texts = ["paper", "full", "literal"].map(read);
    for text in &texts {
        assert_eq!(text.lines().next(), texts[2].lines().next());
        assert_eq!(text.lines().count(), texts[2].lines().count());
    }
}

#[test]
fn scenes_without_the_reference_columns_write_their_own_and_no_figures() {
    let directory = tempfile::tempdir().unwrap();
    let cases = [
        (
            "angles",
            "t,crank_angle,rod_angle,frame_angle,guide_angle",
            &["energy", "gap", "crank speed", "statements"][..],
        ),
        ("free-run", "t,crank_speed,C4_x,C4_y,C4_z,F34_x,F34_y,F34_z", &["energy", "gap", "statements"]),
    ];
    for (scene, header, absent) in cases {
        let arguments = [&["run", "--scene", scene, "--out", scene], &SHORT[..]].concat();
        let output = hacksaw(directory.path(), &arguments).assert().success().get_output().clone();
        let summary = String::from_utf8(output.stdout).unwrap();
        assert!(summary.lines().next().unwrap().ends_with(scene), "{summary}");
        for word in absent {
            assert!(!summary.contains(word), "{scene}: `{word}` in {summary}");
        }
        assert_eq!(summary.contains("crank speed"), scene == "free-run");
        let out = directory.path().join(scene);
        assert_eq!(results(&out).len(), 3);
        let csv = fs::read_to_string(out.join("trajectory.csv")).unwrap();
        assert_eq!(csv.lines().next(), Some(header));
        let json: serde_json::Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
        assert_eq!(json["scene"], scene);
        assert!(json["supplied_energy_j"].is_null() && json["checks"].as_array().unwrap().is_empty());
    }
}

#[test]
fn scenes_and_graphs_are_printed() {
    let directory = tempfile::tempdir().unwrap();
    let text = |arguments: &[&str]| {
        let output = hacksaw(directory.path(), arguments).assert().success().get_output().clone();
        String::from_utf8(output.stdout).unwrap()
    };
    let list = text(&["scene"]);
    assert_eq!(list.lines().count(), 8);
    assert!(list.lines().nth(1).unwrap().starts_with("  paper         31 "), "{list}");
    let report = text(&["scene", "paper"]);
    assert!(report.lines().nth(2).unwrap().starts_with("85 states: 46 constant; "), "{report}");
    assert!(report.contains("  rod.position_z: constant: ") && report.contains("\n  rod_offset = 0 m\n"), "{report}");
    assert!(text(&["scene", "literal"]).contains("\n  84  "));
    assert!(text(&["graph"]).contains("129 bonds"));
    assert!(text(&["graph", "--scene", "free-run"]).contains("113 bonds"));
    assert!(text(&["graph", "--part", "source"]).contains("graph Paper {"));
    assert!(text(&["graph", "--part", "bonds"]).contains(" ->|  "));
    assert!(text(&["graph", "--part", "equations"]).contains("d(slot.tilt_spring.q)/dt = "));
    assert!(text(&["graph", "--help"]).contains("equations"));
    assert!(refused(directory.path(), &["graph", "--part", "bond"]).contains("bonds"));
    assert!(refused(directory.path(), &["scene", "papers"]).contains("paper"));
}

#[test]
fn a_reader_that_has_gone_away_is_no_fault() {
    use std::process::{Command, Stdio};
    for arguments in [&["graph", "--part", "source"][..], &["scene", "literal"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_hacksaw"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{arguments:?}: {output:?}");
    }
}

#[test]
fn bad_input_is_one_line_and_exit_code_2() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    fs::write(path.join("bad.toml"), "torque = = 1\n").unwrap();
    fs::write(path.join("unknown.toml"), "torqe = 1\n").unwrap();
    fs::write(path.join("file"), "").unwrap();
    fs::write(path.join("bytes.toml"), [0xff, 0xfe]).unwrap();
    let cases: [(&[&str], &str); 26] = [
        (&["--set", "torqe=1"], "did you mean `torque`?"),
        (&["run", "--set", "torqe=1"], "did you mean `torque`?"),
        (&["--set", "k_23=-1"], "k_23"),
        (&["--set", "torque=NaN"], "finite"),
        (&["--set", "torque=ten"], "`ten`"),
        (&["--set", "torque"], "NAME=VALUE"),
        (&["--params", "bad.toml"], "line 1, column 10"),
        (&["--params", "unknown.toml"], "did you mean `torque`?"),
        (&["--params", "absent.toml"], "cannot read absent.toml"),
        (&["--params", "bytes.toml"], "cannot read bytes.toml"),
        (&["--out", "file"], "cannot write into file: file is a file; choose a folder with --out"),
        (&["--out", "file/below"], "cannot write into file/below: file is a file"),
        (&["--csv", "absent/run.csv", "--no-figures"], "cannot write absent/run.csv"),
        (&["--csv", ".", "--no-figures"], "cannot write ."),
        (&["--t-end", "-1"], "--t-end -1: must be a finite number above 0"),
        (&["--t-end", "nan"], "--t-end NaN"),
        (&["--t-end", "five"], "invalid value 'five' for '--t-end <SECONDS>': not a number"),
        (&["--rtol", "0"], "--rtol 0"),
        (&["--rtol", "1e-30"], "--rtol 1e-30: must be at least"),
        (&["--atol=-1e-3"], "--atol -0.001"),
        (&["--step", "0"], "--step 0"),
        (&["--step", "1e-9"], "choose a longer one"),
        (&["--tend", "1"], "--t-end"),
        (&["--nonsense"], "--help says more"),
        (&["--csv", "out/summary.txt"], "the run writes another file of this name"),
        (&["precision", "--rtol", "x"], "not a number"),
    ];
    for (arguments, part) in cases {
        let line = refused(path, arguments);
        assert!(line.contains(part), "{arguments:?}: {line}");
    }
}

#[test]
fn a_run_that_fails_says_when_and_which_state_and_keeps_what_it_had() {
    let directory = tempfile::tempdir().unwrap();
    // So large a torque takes the crank beyond the numbers.
    let output = hacksaw(directory.path(), &["--set", "torque=1e300"]).assert().code(1).get_output().clone();
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(line.starts_with("error: the run failed: ") && line.contains("t = ") && line.contains('`'), "{line}");
    assert_eq!(line.lines().count(), 1);
    let csv = fs::read_to_string(directory.path().join("out/trajectory.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("0.0,"));
    assert!(fs::read_to_string(directory.path().join("out/index.html")).unwrap().contains("The run failed"));
}

#[test]
fn help_and_the_list_name_every_parameter() {
    let directory = tempfile::tempdir().unwrap();
    let text = |arguments: &[&str]| {
        let output = hacksaw(directory.path(), arguments).assert().success().get_output().clone();
        String::from_utf8(output.stdout).unwrap()
    };
    let names = "torque crank_angle gravity density r_cut r_return k_2 r_2 k_23 r_23 k_34 r_34 k_15 r_15 k_45 r_45 \
        k_45r r_45r k_work r_work";
    for arguments in [&["--help"][..], &["run", "--help"], &["parameters"]] {
        let text = text(arguments);
        for name in names.split(' ') {
            assert!(text.contains(&format!("  {name} ")), "{arguments:?} does not list {name}");
        }
    }
    fs::write(directory.path().join("p.toml"), text(&["parameters", "--toml"])).unwrap();
    let arguments = [&SHORT[..], &["--params", "p.toml", "--no-figures"]].concat();
    hacksaw(directory.path(), &arguments).assert().success();
}
