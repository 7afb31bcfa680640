//! Tables with the points of other files.

use super::{folder, refused, told, write};

const FAN: &str = "graph Fan {
    table curve: rpm -> N*m = [[0, 2],
        [1000, 2]], held;
    1 shaft: rotation; I wheel = 0.1; MSe motor = curve(shaft.flow); motor -> shaft -> wheel;
    observe { speed: rad/s = shaft.flow }
}";

/// The speed after 1 s, torque / inertia.
fn speed(folder: &std::path::Path, options: &str) -> f64 {
    let text = told(folder, &format!("run fan.bond --t-end 1 --rtol 1e-10 --csv - {options}"));
    let last = text.lines().last().expect("a sample");
    last.split(',').nth(1).and_then(|cell| cell.trim().parse().ok()).unwrap_or_else(|| panic!("{text}"))
}

#[test]
fn a_run_takes_other_points_and_is_made_again_with_them() {
    let folder = folder();
    let at = folder.path();
    write(&folder, "fan.bond", FAN);
    write(&folder, "new.csv", "speed [rad/s], torque [kN*m]\n0, 0.004\n50, 0.004\n100, 0.004\n");
    assert!((speed(at, "") - 20.0).abs() < 1e-8);
    assert!((speed(at, "--table curve=new.csv") - 40.0).abs() < 1e-8);
    told(at, "run fan.bond --t-end 1 --table curve=new.csv --out first");
    let summary = std::fs::read_to_string(at.join("first/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let [table] = summary["recipe"]["tables"].as_array().expect("tables").as_slice() else { panic!("{summary}") };
    assert_eq!(table["table"], "curve");
    assert!(table["file"].as_str().is_some_and(|file| file.ends_with("new.csv")), "{table}");
    told(at, "run fan.bond --again first/summary.json --out second");
    let trajectory = |run: &str| std::fs::read(at.join(run).join("trajectory.csv")).expect("a trajectory");
    assert_eq!(trajectory("first"), trajectory("second"));
    // A file of options asks for it as well.
    write(&folder, "again.toml", "again = \"first/summary.json\"\n");
    told(at, "run fan.bond --config again.toml --out by_file");
    assert_eq!(trajectory("first"), trajectory("by_file"));
    write(&folder, "new.csv", "0, 5\n100, 5\n");
    let changed = refused(at, "run fan.bond --again first/summary.json --out third", 2);
    assert!(
        changed.contains("the points of the table `curve` in") && changed.contains("are others than then"),
        "{changed}"
    );
    // What has no other tables says nothing of them.
    told(at, "run fan.bond --t-end 1 --out plain");
    let plain = std::fs::read_to_string(at.join("plain/summary.json")).expect("a summary");
    assert!(!plain.contains("\"tables\""), "{plain}");
}

#[test]
fn mistakes_are_said_in_the_words_of_the_command_line() {
    let folder = folder();
    let at = folder.path();
    write(&folder, "fan.bond", FAN);
    write(&folder, "one.csv", "0, 5\n");
    write(&folder, "back.csv", "0, 5\n10, 5\n5, 5\n");
    write(&folder, "word.csv", "0, 5\n10, five\n");
    write(&folder, "unit.csv", "speed [V], torque [N*m]\n0, 5\n10, 5\n");
    for (given, said) in [
        ("curv=one.csv", "--table: there is no table `curv`; there are `curve`"),
        ("curve=none.csv", "--table curve=none.csv: cannot be read"),
        ("curve", "--table curve: write --table NAME=FILE.csv"),
        ("curve=one.csv", "the table `curve` has 1 points; a table has at least 2"),
        ("curve=back.csv", "BG0339"),
        ("curve=word.csv", "line 2 is no pair of numbers: `10, five`"),
        ("curve=unit.csv", "BG0316"),
    ] {
        let told = refused(at, &format!("run fan.bond --t-end 1 --table {given}"), 2);
        assert!(told.contains(said), "{given}: {told}");
    }
}
