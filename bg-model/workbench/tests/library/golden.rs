//! Golden outputs as a user meets them: recorded, checked, and every way in which they can differ or be unusable.
//!
//! The models of this file are one mechanism at different times: one that was changed is another model of the same
//! name.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use bg_model::mechanism::Scenes;
use bg_workbench::Program;
use bg_workbench::golden::{Difference, GoldenError, check};
use tempfile::TempDir;

mod now {
    bg_model::bond_graph! {
        pub graph Slide {
            param mass: kg = 2, above 0;
            param start: m = 0.1;
            param k: N/m = 50;
            param r: N*s/m = 0.1;
            param second: s = 1;
            1 slide: translation; I body = mass; C spring = k start start; R damper = r;
            slide -> body; slide -> spring; slide -> damper;
            observe { x: m = spring.q; v: m/s = slide.flow; angle: rad = atan2(slide.flow, spring.q / second) }
            /// Without the place.
            scene Fast { observe { v: m/s = slide.flow } tune { mass } }
        }
    }
}

/// Other defaults, no `v`, and `speed` in place of it.
mod later {
    bg_model::bond_graph! {
        pub graph Slide {
            param mass: kg = 2.5, above 0;
            param k: N/m = 50;
            param r: N*s/m = 0.1;
            param second: s = 1;
            1 slide: translation; I body = mass; C spring = k start 0.1; R damper = r;
            slide -> body; slide -> spring; slide -> damper;
            observe { x: m = spring.q; speed: m/s = slide.flow; angle: rad = atan2(slide.flow, spring.q / second) }
        }
    }
}

/// Without a literal model.
mod scenes {
    bg_model::bond_graph! {
        pub graph Slide {
            param mass: kg = 2, above 0;
            1 slide: translation; I body = mass; param k: N/m = 50; C spring = k start 0.1;
            slide -> body; slide -> spring;
            observe { x: m = spring.q }
            scenes only;
            /// All of it.
            scene Slide {}
            /// Without the place.
            scene Fast { observe { v: m/s = slide.flow } tune {} }
        }
    }
}

/// Another mechanism.
mod other {
    bg_model::bond_graph! {
        pub graph Turntable {
            param k: N*m/rad = 50;
            param j: kg*m^2 = 2;
            1 turn: rotation; I wheel = j; C spring = k start 0.1; turn -> wheel; turn -> spring;
            observe { angle: rad = spring.q }
        }
    }
}

/// With an input.
mod driven {
    bg_model::bond_graph! {
        pub graph Slide {
            param mass: kg = 2, above 0;
            input force: N;
            1 slide: translation; I body = mass; Se push = force; push -> slide -> body;
            observe { v: m/s = slide.flow }
        }
    }
}

/// A folder for golden outputs, and what a program says about it.
struct Bench {
    root: TempDir,
}

impl Bench {
    fn new() -> Self {
        Self { root: tempfile::tempdir().unwrap() }
    }

    fn folder(&self) -> PathBuf {
        self.root.path().join("golden")
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder().join(name)
    }

    /// The exit code of the program of `Me` with `golden`, these words and the folder.
    fn golden<Me: Scenes>(&self, words: &[&str]) -> ExitCode {
        let folder = self.folder();
        let words = [&["slide", "golden"], words, &["--out", folder.to_str().unwrap()]].concat();
        Program::of::<Me>().main(words.into_iter().map(Into::into))
    }

    /// Records 1 s with samples every 0.1 s under the scene's name.
    fn record(&self, more: &[&str]) -> ExitCode {
        self.golden::<now::Slide>(&[&["record", "--t-end", "1", "--step", "0.1"], more].concat())
    }

    /// With a golden output `literal`.
    fn recorded() -> Self {
        let bench = Self::new();
        assert_eq!(bench.record(&[]), ExitCode::SUCCESS);
        bench
    }

    fn edit(&self, name: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(name)).unwrap();
        assert!(text.contains(from), "no `{from}` in {text}");
        fs::write(self.path(name), text.replacen(from, to, 1)).unwrap();
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// What a test of the user's says, with the folder as `DIR`. It says it by `Debug`.
    fn fault<Me: Scenes>(&self) -> String {
        let fault = check::<Me>(self.folder()).unwrap_err();
        let text = format!("{fault:?}");
        assert_eq!(text, fault.to_string());
        text.replace(self.folder().to_str().unwrap(), "DIR")
    }
}

/// Field `column` of the sample in line `line` of the CSV file, counted from 0.
fn field(text: &str, line: usize, column: usize) -> &str {
    text.lines().nth(line).unwrap().split(',').nth(column).unwrap()
}

const RENEWAL: &str = "literal: if this change is intended, record it again: slide golden record --scene literal \
                       --t-end 1 --step 0.1 --method auto --rtol 1e-8 --out DIR";

#[test]
fn with_scenes_only_the_first_scene_is_the_program_s_own() {
    let bench = Bench::new();
    let record =
        |more: &[&str]| bench.golden::<scenes::Slide>(&[&["record", "--t-end", "1", "--step", "0.1"], more].concat());
    assert_eq!(record(&[]), ExitCode::SUCCESS);
    assert_eq!(record(&["--scene", "fast"]), ExitCode::SUCCESS);
    assert_eq!(record(&["--scene", "literal"]), ExitCode::from(2));
    assert!(bench.path("slide.csv").exists() && bench.path("fast.csv").exists());
    check::<scenes::Slide>(bench.folder()).unwrap();
}

#[test]
fn what_is_recorded_comes_out_again() {
    let bench = Bench::recorded();
    let more = ["--scene", "fast", "--set", "mass=0.8", "--method", "rk4", "--fixed-step", "1e-3", "--name", "a b"];
    assert_eq!(bench.record(&more), ExitCode::SUCCESS);
    check::<now::Slide>(bench.folder()).unwrap();
    assert_eq!(bench.golden::<now::Slide>(&["check"]), ExitCode::SUCCESS);
    assert_eq!(bench.golden::<now::Slide>(&["check", "a b"]), ExitCode::SUCCESS);
    let csv = bench.read("literal.csv");
    assert!(csv.starts_with("t,x,v,angle\n0.0,0.1,0.0,0.0\n0.1,"), "{csv}");
    assert_eq!(csv.lines().count(), 12);
    let toml = bench.read("a b.toml");
    for part in [
        "\nmodel = \"Slide\"\nversion = ",
        "\nscene = \"fast\"\n\n[run]\nt_end = 1.0\nstep = 0.1\nmethod = \"rk4\"\nrtol = 1e-8\nfixed_step = 0.001\n\n\
         [parameters]\nmass = 0.8\n\n# All parameters as they were.",
        "\n[values]\n\"k\" = { value = 50.0, unit = \"N/m\" }\n\"mass\" = { value = 0.8, unit = \"kg\" }\n",
        "\"start\" = { value = 0.1, unit = \"m\" }\n\n[counts]\nsteps = 1000\nrejected = 0\n",
        "\nevents = 0\n\n[tolerances.\"m/s\"]\nrelative = 1e-9\nabsolute = 0.0\n",
    ] {
        assert!(toml.contains(part), "{part} is not in {toml}");
    }
    assert!(!toml.contains("[tolerances.\"m\"]"));
    // Recorded again it has the same bytes.
    let before = [csv, bench.read("literal.toml")];
    assert_eq!(bench.record(&[]), ExitCode::SUCCESS);
    assert_eq!(before, [bench.read("literal.csv"), bench.read("literal.toml")]);
    assert_eq!(fs::read_dir(bench.folder()).unwrap().count(), 4);
}

#[test]
fn a_value_that_differs_is_told_with_its_column_its_instant_and_its_distance() {
    let bench = Bench::recorded();
    let csv = bench.read("literal.csv");
    // v at 0.3 s.
    let now = field(&csv, 4, 2).to_owned();
    let recorded = now.parse::<f64>().unwrap() + 0.125;
    bench.edit("literal.csv", &now, &format!("{recorded:?}"));
    let largest = bench.read("literal.csv");
    let largest = largest.lines().skip(1).map(|line| line.split(',').nth(2).unwrap().parse::<f64>().unwrap().abs());
    let largest = largest.fold(0.0, f64::max);
    let line = format!(
        "literal: `v` at t = 0.3 s is {now} m/s, recorded is {recorded} m/s: 1.250e-1 m/s apart, tolerance {:.3e} m/s",
        1e-9 * largest
    );
    assert_eq!(bench.fault::<now::Slide>(), format!("{line}\n{RENEWAL}"));
    assert_eq!(bench.golden::<now::Slide>(&["check"]), ExitCode::from(1));
    // Recorded anew, it is as recorded.
    assert_eq!(bench.record(&[]), ExitCode::SUCCESS);
    assert_eq!(bench.read("literal.csv"), csv);
    check::<now::Slide>(bench.folder()).unwrap();
}

#[test]
fn a_whole_turn_of_an_angle_is_no_difference_and_no_number_is_one() {
    let bench = Bench::recorded();
    let csv = bench.read("literal.csv");
    let angle: f64 = field(&csv, 6, 3).parse().unwrap();
    bench.edit("literal.csv", field(&csv, 6, 3), &format!("{:?}", angle + std::f64::consts::TAU));
    check::<now::Slide>(bench.folder()).unwrap();
    bench.edit("literal.csv", field(&csv, 5, 1), "NaN");
    let text = bench.fault::<now::Slide>();
    assert!(
        text.starts_with("literal: `x` at t = 0.4 s is ") && text.contains("recorded is NaN m: NaN m apart"),
        "{text}"
    );
}

#[test]
fn a_tolerance_that_is_edited_counts_and_is_kept() {
    let bench = Bench::recorded();
    let csv = bench.read("literal.csv");
    let v: f64 = field(&csv, 4, 2).parse().unwrap();
    bench.edit("literal.csv", field(&csv, 4, 2), &format!("{:?}", v + 1e-3));
    assert!(bench.fault::<now::Slide>().contains("1.000e-3 m/s apart"));
    let wide = "[tolerances.\"m/s\"]\nrelative = 0\nabsolute = 0.0011\n";
    bench.edit("literal.toml", "[tolerances.\"m/s\"]\nrelative = 1e-9\nabsolute = 0.0\n", wide);
    check::<now::Slide>(bench.folder()).unwrap();
    // Below the distance it is too little.
    bench.edit("literal.toml", "0.0011", "0.0009");
    assert!(bench.fault::<now::Slide>().contains("1.000e-3 m/s apart, tolerance 9.000e-4 m/s"));
    assert_eq!(bench.record(&[]), ExitCode::SUCCESS);
    assert_eq!(bench.read("literal.csv"), csv);
    let toml = bench.read("literal.toml");
    assert!(toml.contains("[tolerances.\"m/s\"]\nrelative = 0.0\nabsolute = 0.0009\n"), "{toml}");
    assert!(toml.contains("[tolerances.\"m\"]\nrelative = 1e-9\nabsolute = 0.0\n"), "{toml}");
}

#[test]
fn counts_are_exact() {
    let bench = Bench::recorded();
    let toml = bench.read("literal.toml");
    let steps: u64 = toml.split("steps = ").nth(1).unwrap().lines().next().unwrap().parse().unwrap();
    bench.edit("literal.toml", &format!("\nsteps = {steps}\n"), &format!("\nsteps = {}\n", steps + 1));
    bench.edit("literal.toml", "events = 0", "events = 2");
    let lines = format!("literal: {steps} steps, recorded are {}\nliteral: 0 events, recorded are 2\n", steps + 1);
    assert_eq!(bench.fault::<now::Slide>(), lines + RENEWAL);
}

#[test]
fn a_model_that_has_changed_is_told_in_all_its_differences() {
    let bench = Bench::recorded();
    let GoldenError::Deviates(deviating) = check::<later::Slide>(bench.folder()).unwrap_err() else {
        panic!("the golden output itself is usable")
    };
    let [deviating] = &deviating[..] else { panic!("one golden output") };
    let texts: Vec<String> = deviating.differences.iter().map(ToString::to_string).collect();
    assert_eq!(texts[..2], ["there is no output `v` any more", "output `speed` is new"]);
    let column = |difference: &Difference| match difference {
        Difference::Value { column, distance, tolerance, .. } => {
            assert!(distance > tolerance);
            Some(column.clone())
        }
        _ => None,
    };
    // Another default of the mass moves both columns, the farthest off in units of its tolerance first.
    let columns: Vec<String> = deviating.differences.iter().filter_map(column).collect();
    assert_eq!(columns, ["x", "angle"]);
    assert!(texts.iter().any(|text| text.contains(" steps, recorded are ")), "{texts:?}");
    assert_eq!(deviating.recorded_by, None);
    let changed = [
        "`mass` is 2.5 kg, and was 2 kg when it was recorded",
        "there is no parameter `start` any more; it was 0.1 m when it was recorded",
    ];
    assert_eq!(deviating.changed, changed);
    let lines: Vec<String> = deviating.lines().collect();
    assert_eq!(lines[lines.len() - 3..][..2], changed.map(|change| format!("literal: {change}")));
}

#[test]
fn other_instants_are_told() {
    let bench = Bench::recorded();
    bench.edit("literal.toml", "step = 0.1", "step = 0.2");
    assert!(bench.fault::<now::Slide>().starts_with("literal: instant 2 is t = 0.2 s, recorded is t = 0.1 s\n"));
    let bench = Bench::recorded();
    let csv = bench.read("literal.csv");
    bench.edit("literal.csv", &format!("{}\n", csv.lines().last().unwrap()), "");
    assert!(bench.fault::<now::Slide>().starts_with("literal: 11 instants, recorded are 10\n"));
}

#[test]
fn what_is_recorded_by_another_version_says_so_where_it_differs() {
    let bench = Bench::recorded();
    bench.edit("literal.toml", concat!("version = \"", env!("CARGO_PKG_VERSION")), "version = \"0.0.7");
    check::<now::Slide>(bench.folder()).unwrap();
    bench.edit("literal.toml", "events = 0", "events = 1");
    let text = bench.fault::<now::Slide>();
    let this =
        concat!("recorded by version 0.0.7, this is ", env!("CARGO_PKG_VERSION"), "; if this change is intended");
    assert!(text.contains(this), "{text}");
}

#[test]
fn a_renewal_says_all_that_the_record_says() {
    let bench = Bench::new();
    let more = ["--set", "start=-0.2", "--set", "mass=1e7", "--atol", "1e-12", "--name", "slow one"];
    assert_eq!(bench.record(&more), ExitCode::SUCCESS);
    bench.edit("slow one.toml", "events = 0", "events = 1");
    let renewal = "slide golden record --scene literal --set mass=1e7 --set start=-0.2 --t-end 1 --step 0.1 \
                   --method auto --rtol 1e-8 --atol 1e-12 --name 'slow one' --out DIR";
    let text = bench.fault::<now::Slide>();
    assert!(text.ends_with(&format!("slow one: if this change is intended, record it again: {renewal}")), "{text}");
}

#[test]
fn a_run_that_can_no_longer_be_made_is_a_difference() {
    let bench = Bench::new();
    assert_eq!(bench.record(&["--scene", "fast", "--set", "mass=3"]), ExitCode::SUCCESS);
    bench.edit("fast.toml", "mass = 3.0", "start = 0.2");
    let text = bench.fault::<now::Slide>();
    assert!(
        text.starts_with(
            "fast: scene `fast` keeps `start` fixed at 0.1 m; use --scene literal\nfast: `mass` is 2 kg, and was 3"
        ),
        "{text}"
    );
}

#[test]
fn a_file_of_an_input_that_has_changed_is_told_before_any_run() {
    let bench = Bench::new();
    let table = bench.root.path().join("load.csv");
    fs::write(&table, "0,4\n1,2\n").unwrap();
    let input = format!("force={}", table.display());
    let record = ["record", "--t-end", "1", "--step", "0.1", "--input", &input];
    assert_eq!(bench.golden::<driven::Slide>(&record), ExitCode::SUCCESS);
    check::<driven::Slide>(bench.folder()).unwrap();
    // After the end of the run, where no value sees it.
    fs::write(&table, "0,4\n1,2\n2,9\n").unwrap();
    let expected = "DIR/literal.toml: the file of the input `force` is not the one that the run was recorded with; \
                    restore it, or record the run again";
    assert_eq!(bench.fault::<driven::Slide>(), expected);
    // A record of an earlier version knows no file.
    let toml = bench.read("literal.toml");
    let (before, after) = toml.split_once("\n# The CRC-32 of the files of the inputs.").unwrap();
    let rest = &after[after.find("\n[counts]").unwrap()..];
    fs::write(bench.path("literal.toml"), format!("{before}{rest}")).unwrap();
    check::<driven::Slide>(bench.folder()).unwrap();
}

/// What is wrong with a file, and the same by the command: exit code 2.
fn unusable(bench: &Bench, expected: &str) {
    assert_eq!(bench.fault::<now::Slide>(), expected);
    assert_eq!(bench.golden::<now::Slide>(&["check"]), ExitCode::from(2));
}

#[test]
fn what_is_no_golden_output_is_one_line() {
    let edited = |from: &str, to: &str, expected: &str| {
        let bench = Bench::recorded();
        bench.edit("literal.toml", from, to);
        unusable(&bench, &format!("DIR/literal.toml: {expected}"));
    };
    edited("scene = \"literal\"", "scene = \"slow\"", "there is no scene `slow`; the command `scene` lists the scenes");
    edited("[counts]", "[parameters]\nmas = 3\n[counts]", "there is no parameter `mas`; did you mean `mass`?");
    edited("t_end = 1.0", "t_end = -1", "t_end -1: must be a finite number above 0");
    edited("step = 0.1", "step = 1e-9", "step 1e-9: gives more than 500000 rows until 1 s; choose a longer one");
    edited("relative = 1e-9", "relative = nan", "the tolerances of `m` must be finite numbers, at least 0");
    edited("absolute = 0.0", "absolute = -1", "the tolerances of `m` must be finite numbers, at least 0");
}

#[test]
fn a_file_that_cannot_be_read_is_one_line() {
    let bench = Bench::new();
    let none = "no golden output is in DIR: record one: slide golden record --out DIR";
    unusable(&bench, none);
    fs::create_dir(bench.folder()).unwrap();
    unusable(&bench, none);
    assert_eq!(bench.golden::<now::Slide>(&["check", "literal"]), ExitCode::from(2));
    bench.record(&[]);
    let toml = bench.read("literal.toml");
    bench.edit("literal.toml", "model =", "model");
    let text = bench.fault::<now::Slide>();
    assert!(text.starts_with("cannot read DIR/literal.toml: line 4, column "), "{text}");
    assert_eq!(text.lines().count(), 1);
    fs::write(bench.path("literal.toml"), toml.replace("relative", "relativ")).unwrap();
    let text = bench.fault::<now::Slide>();
    assert!(text.contains("unknown field `relativ`, expected `relative` or `absolute`"), "{text}");
    fs::write(bench.path("literal.toml"), toml.replace("auto", "euler")).unwrap();
    let text = bench.fault::<now::Slide>();
    assert!(text.contains("there is no integrator `euler`; there are auto, bs5"), "{text}");
    fs::write(bench.path("literal.toml"), &toml).unwrap();
    bench.edit("literal.csv", "0.0,0.1", "0.0,far");
    unusable(&bench, "cannot read DIR/literal.csv: `far` in line 2 is not a number");
    fs::remove_file(bench.path("literal.csv")).unwrap();
    unusable(&bench, "cannot read DIR/literal.csv: No such file or directory (os error 2)");
}

#[test]
fn of_another_mechanism_nothing_is_run_or_replaced() {
    let bench = Bench::recorded();
    let toml = bench.read("literal.toml");
    let expected = "DIR/literal.toml is of `Slide`, not of `Turntable`: remove it, or choose another folder with --out";
    assert_eq!(bench.fault::<other::Turntable>(), expected);
    assert_eq!(bench.golden::<other::Turntable>(&["record"]), ExitCode::from(2));
    assert_eq!(bench.read("literal.toml"), toml);
}

#[test]
fn a_record_that_cannot_be_made_leaves_what_is_there() {
    let bench = Bench::recorded();
    let before = [bench.read("literal.csv"), bench.read("literal.toml")];
    for more in [
        &["--name", "../literal"][..],
        &["--name", ".."],
        &["--name", ""],
        &["--name", ".hidden"],
        &["--set", "mass=-1"],
        &["--rtol", "2"],
        &["--scene", "slow"],
    ] {
        assert_eq!(bench.record(more), ExitCode::from(2), "{more:?}");
    }
    assert_eq!(bench.golden::<now::Slide>(&["check", "absent"]), ExitCode::from(2));
    // A run that fails: the spring overflows at once.
    assert_eq!(bench.record(&["--set", "start=1e308", "--set", "mass=1e-300"]), ExitCode::from(1));
    assert_eq!(before, [bench.read("literal.csv"), bench.read("literal.toml")]);
    assert_eq!(fs::read_dir(bench.folder()).unwrap().count(), 2);
    // Broken settings may have tolerances worth keeping; a CSV file without settings is none of ours.
    fs::write(bench.path("literal.toml"), "model = ").unwrap();
    assert_eq!(bench.record(&[]), ExitCode::from(2));
    assert_eq!(bench.read("literal.toml"), "model = ");
    fs::remove_file(bench.path("literal.toml")).unwrap();
    assert_eq!(bench.record(&[]), ExitCode::from(2));
    assert_eq!(bench.read("literal.csv"), before[0]);
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_run() {
    let bench = Bench::new();
    fs::write(bench.folder(), "a file").unwrap();
    assert_eq!(bench.record(&[]), ExitCode::from(2));
    assert_eq!(fs::read_to_string(bench.folder()).unwrap(), "a file");
    assert!(bench.fault::<now::Slide>().starts_with("cannot read DIR: "));
    let words = ["slide", "golden", "record", "--out", "/proc/golden"].map(Into::into);
    assert_eq!(Program::of::<now::Slide>().main(words), ExitCode::from(2));
    assert!(!Path::new("/proc/golden").exists());
}
