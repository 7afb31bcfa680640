//! Sweeps as a user meets them: plans, shards, a sweep that is killed and goes on, runs that fail. The program is the
//! example `pendulum`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::example::program;
use crate::outcome::text_of;
use bg_workbench::files::parquet::{Table, Values};

fn run(directory: &Path, arguments: &[&str]) -> Output {
    program("pendulum").current_dir(directory).args(arguments).output().expect("the example was built")
}

fn text(directory: &Path, arguments: &[&str]) -> String {
    text_of(run(directory, arguments), arguments)
}

/// A folder with `plan` as plan.toml.
fn with_plan(plan: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plan.toml"), plan).unwrap();
    folder
}

/// The files of a folder, hidden ones among them, with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap())).collect()
}

fn table(path: PathBuf) -> Table {
    Table::read(&fs::read(path).unwrap()).unwrap()
}

fn reals(table: &Table, name: &str) -> Vec<f64> {
    match &table.columns.iter().find(|column| column.name == name).unwrap().values {
        Values::Real(values) => values.clone(),
        other => panic!("`{name}` is {other:?}"),
    }
}

const PLAN: &str = r#"
t_end = 0.2
shard = 7
[grid]
length = { from = 0.4, to = 0.8, count = 6 }
angle = [0.1, 0.5, 1.0, 1.5, 2.0]
[columns]
angle = ["final", "max"]
force_x = ["mean", "integral"]
"#;

#[test]
fn a_row_has_what_a_single_run_has() {
    let folder = with_plan(PLAN);
    let path = folder.path();
    let said = text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    assert!(
        said.starts_with("sweep of 30 runs: 5 files made; 30 runs, 0 of them failed\nmean and integral are"),
        "{said}"
    );
    let shown = text(path, &["sweep", "show", "o"]);
    assert!(shown.contains("\nsamples  every 0.01 s; mean and integral are those of samples\n"), "{shown}");
    // As any new file: as the user's mask has it, be it the recipe or a shard.
    #[cfg(unix)]
    {
        let mode =
            |name: &str| std::os::unix::fs::PermissionsExt::mode(&fs::metadata(path.join(name)).unwrap().permissions());
        fs::write(path.join("any"), "").unwrap();
        assert_eq!(["o/sweep.toml", "o/runs-000000.parquet"].map(mode), [mode("any"); 2]);
    }
    // Run 13 is the third length with the fourth angle, the last of the second shard.
    let shard = table(path.join("o/runs-000001.parquet"));
    let names: Vec<&str> = shard.columns.iter().map(|column| column.name.as_str()).collect();
    let own = ["run", "length", "angle", "status", "reason", "reached", "steps", "events"];
    assert_eq!(names, [&own[..], &["angle_max", "angle_final", "force_x_mean", "force_x_integral"]].concat());
    assert_eq!(shard.columns[0].values, Values::Whole((7..14).collect()));
    let length = reals(&shard, "length")[6];
    assert_eq!((length, reals(&shard, "angle")[6]), (0.4 + 0.4 * 0.4, 1.5));
    let [length, angle] = [format!("length={length:?}"), "angle=1.5".to_owned()];
    text(path, &["run", "--t-end", "0.2", "--set", &length, "--set", &angle, "--csv", "t.csv", "--no-figures"]);
    let csv = fs::read_to_string(path.join("t.csv")).unwrap();
    let last: Vec<f64> = csv.lines().last().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
    assert_eq!((last[0], last[1]), (0.2, reals(&shard, "angle_final")[6]));
    let said = |name: &str| &shard.texts.iter().find(|(text, _)| text == name).unwrap().1;
    assert!(said("units").contains(r#""force_x_integral":"N*s""#) && said("rtol") == "1e-8");
}

#[test]
fn files_do_not_depend_on_threads_or_on_who_makes_them() {
    let folder = with_plan(PLAN);
    let path = folder.path();
    text(path, &["sweep", "--plan", "plan.toml", "--out", "one", "--threads", "1"]);
    text(path, &["sweep", "--plan", "plan.toml", "--out", "many", "--threads", "5"]);
    let two = ["2/2", "1/2"].map(|part| text(path, &["sweep", "--plan", "plan.toml", "--out", "two", "--shard", part]));
    assert!(two[0].contains("2 of its 5 files are of this part; 2 files made; 14 runs"), "{}", two[0]);
    let [one, many, two] = ["one", "many", "two"].map(|name| files(&path.join(name)));
    // The recipe, five shards, the page.
    assert_eq!(one.len(), 7);
    assert!(one == many && one == two);
}

#[test]
fn what_is_there_is_not_made_again_and_what_is_cut_is() {
    let folder = with_plan(PLAN);
    let path = folder.path();
    let sweep = ["sweep", "--plan", "plan.toml", "--out", "o"];
    text(path, &sweep);
    let before = files(&path.join("o"));
    assert!(text(path, &sweep).starts_with("sweep of 30 runs: 0 files made, 5 were there; 0 runs"));
    let shard = path.join("o/runs-000003.parquet");
    let bytes = &before["runs-000003.parquet"];
    let mut flipped = bytes.clone();
    flipped[60] ^= 4;
    for bad in [&bytes[..bytes.len() - 1], &bytes[1..], &flipped, b""] {
        fs::write(&shard, bad).unwrap();
        assert!(text(path, &sweep).contains(": 1 files made, 4 were there; 7 runs"));
        assert_eq!(files(&path.join("o")), before);
    }
}

#[test]
fn a_sweep_that_is_killed_at_any_instant_goes_on_to_the_same_bytes() {
    let plan = PLAN.replace("count = 6", "count = 60").replace("t_end = 0.2", "t_end = 0.02");
    let folder = with_plan(&format!("trajectories = ['angle', 'stored']{plan}"));
    let path = folder.path();
    text(path, &["sweep", "--plan", "plan.toml", "--out", "whole"]);
    let whole = files(&path.join("whole"));
    assert_eq!(whole.len(), 2 + 2 * 43);
    let start = |arguments: &[&str]| -> Child {
        let mut command = program("pendulum");
        command.current_dir(path).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().expect("the example was built")
    };
    // Later and later, each from where the one before was killed, until one comes to its end.
    let mut kills = 0;
    fs::create_dir(path.join("killed")).unwrap();
    loop {
        let mut child = start(&["sweep", "--plan", "plan.toml", "--out", "killed", "--threads", "1"]);
        sleep(Duration::from_millis(7 + 31 * kills));
        if child.try_wait().unwrap().is_some() {
            break;
        }
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        // What has a shard's name is one, at any time.
        for (name, bytes) in files(&path.join("killed")).iter().filter(|(name, _)| name.ends_with(".parquet")) {
            assert_eq!(Some(bytes), whole.get(name), "{name} after {kills} kills");
        }
    }
    assert!(kills > 0);
    text(path, &["sweep", "--plan", "plan.toml", "--out", "killed"]);
    assert_eq!(files(&path.join("killed")), whole);
}

#[test]
fn a_run_that_fails_is_a_row_with_its_reason() {
    // 120 steps are enough for the first run, not for the second.
    let plan = "t_end = 0.11\nmethod = 'dop853'\nstep_limit = 120\nlist = \"runs.csv\"\ntrajectories = \
        ['angle']\ncolumns = ['max']\n";
    let folder = with_plan(&format!("event_times = 2\n{plan}"));
    let path = folder.path();
    fs::write(path.join("runs.csv"), "angle, length\n0.5, 0.6\n1.57, 0.4\n").unwrap();
    let said = text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    assert!(said.contains("2 runs, 1 of them failed\nwritten"), "{said}");
    let shard = table(path.join("o/runs-000000.parquet"));
    let [status, reasons] = [3, 4].map(|place| match &shard.columns[place].values {
        Values::Text(texts) => texts,
        other => panic!("a column of texts: {other:?}"),
    });
    assert_eq!(*status, ["done", "stopped"]);
    assert!(reasons[0].is_empty() && reasons[1].starts_with("the limit of 120 attempted steps"), "{reasons:?}");
    assert_eq!(reals(&shard, "angle_max").iter().map(|value| value.is_nan()).collect::<Vec<_>>(), [false, true]);
    let reached = reals(&shard, "reached");
    assert!(reached[0] == 0.11 && 0.0 < reached[1] && reached[1] < 0.11, "{reached:?}");
    // The trajectory of what was reached is there.
    let samples = table(path.join("o/trajectories-000000.parquet"));
    let Values::Whole(runs) = &samples.columns[0].values else { panic!("whole numbers") };
    let count = |run: i64| runs.iter().filter(|&&of| of == run).count();
    assert!(count(0) == 12 && count(1) == 1 + (100.0 * reached[1]) as usize, "{} {}", count(0), count(1));
    let said = text(path, &["sweep", "show", "o", "--csv", "o.csv"]);
    assert!(said.contains("\nsamples  every 0.01 s\n"), "{said}");
    assert!(said.contains("runs     2 of 2 in 1 of 1 shards\nfailed   1\n         run 1: the limit of 120"), "{said}");
    let csv = fs::read_to_string(path.join("o.csv")).unwrap();
    assert!(csv.starts_with("run,angle,length,status,reason,reached,steps,events,angle_max,"), "{csv}");
    assert!(csv.lines().nth(1).unwrap().starts_with("0,0.5,0.6,done,,0.11,"), "{csv}");
    let failed = csv.lines().nth(2).unwrap();
    assert!(failed.starts_with("1,1.57,0.4,stopped,") && failed.ends_with(",,,"), "no value is empty: {csv}");
}

#[test]
fn trajectories_are_those_of_single_runs() {
    let folder = with_plan("t_end = 0.1\ntrajectories = true\n[grid]\nangle = [0.2, 0.7]\n");
    let path = folder.path();
    text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    text(path, &["sweep", "show", "o", "--trajectories", "all.csv"]);
    text(path, &["run", "--t-end", "0.1", "--set", "angle=0.7", "--csv", "t.csv", "--no-figures"]);
    let [all, one] = ["all.csv", "t.csv"].map(|name| fs::read_to_string(path.join(name)).unwrap());
    let second: Vec<&str> = all.lines().filter_map(|line| line.strip_prefix("1,")).collect();
    assert_eq!(second, one.lines().skip(1).collect::<Vec<_>>());
    assert_eq!(all.lines().next().unwrap(), format!("run,{}", one.lines().next().unwrap()));
}

/// The one line of a refusal.
fn refused(path: &Path, arguments: &[&str]) -> String {
    let output = run(path, arguments);
    let line = String::from_utf8(output.stderr).expect("text");
    assert_eq!((output.status.code(), line.lines().count()), (Some(2), 1), "{line}");
    line
}

#[test]
fn bad_plans_are_one_line_each() {
    let plans = [
        "",
        "t_end = 5\n[grid",
        "tend = 5\n[grid]\nlength = [1]\n",
        "[grid]\nlength = [1]\n[sobol]\ncount = 3\nseed = 1\nranges = { angle = { from = 0, to = 1 } }\n",
        "[grid]\n",
        "[grid]\nlength = []\n",
        "[grid]\nlength = 3\n",
        "[grid]\nlenght = [1]\n",
        "[grid]\nlength = [1, -1]\n",
        "[grid]\nlength = { from = 0.1, to = 1 }\n",
        "[grid]\nlength = { from = 0, to = 1, count = 3, scale = 'log' }\n",
        "[latin_hypercube]\ncount = 3\nranges = { angle = { from = 0, to = 1 } }\n",
        "[latin_hypercube]\ncount = 0\nseed = 1\nranges = { angle = { from = 0, to = 1 } }\n",
        "[sobol]\ncount = 100000\nseed = 1\nranges = { angle = { from = 0, to = 1 } }\n",
        "list = 'absent.csv'\n",
        "list = 'bad.csv'\n",
        "list = 'bare.csv'\n",
        "[set]\nmass = 1\n[grid]\nlength = [1]\n",
        "[set]\nlength = 2\n[grid]\nlength = [1]\n",
        "[inputs]\nforce = 3\n[grid]\nlength = [1]\n",
        "scene = 'paper'\n[grid]\nlength = [1]\n",
        "method = 'euler'\n[grid]\nlength = [1]\n",
        "rtol = 2\n[grid]\nlength = [1]\n",
        "step = 1e-9\n[grid]\nlength = [1]\n",
        "shard = 0\n[grid]\nlength = [1]\n",
        "[grid]\nlength = [1]\n[columns]\nforce = ['max']\n",
        "[grid]\nlength = [1]\n[columns]\nforce_x = ['most']\n",
        "trajectories = ['force']\n[grid]\nlength = [1]\n",
        "[tolerances]\ncount = 9\nseed = 1\n[tolerances.parameters]\nlength = { normal = [0.6, -1] }\n",
        "[tolerances]\ncount = 9\nseed = 1\n[tolerances.parameters]\nlength = { normal = [0.6, 0.3] }\n",
        "[tolerances]\ncount = 9\nseed = 1\n[tolerances.parameters]\nlength = { even = [0.6, 0.7] }\n",
        "[tolerances]\ncount = 9\nseed = 1\ncorrelations = [['length', 'mass', 0.5]]\n\
         [tolerances.parameters]\nlength = { uniform = [0.6, 0.7] }\n",
        "[tolerances]\ncount = 9\nseed = 1\nindices = true\ncorrelations = [['length', 'angle', 0.5]]\n\
         [tolerances.parameters]\nlength = { uniform = [0.6, 0.7] }\nangle = { uniform = [0.1, 0.2] }\n",
        "[grid]\nlength = [1]\n[numbers]\npeak = 'max force_z'\n",
        "[grid]\nlength = [1]\n[numbers]\nangle = 'max angle'\n[columns]\nangle = ['max']\n",
        "[grid]\nlength = [1]\n[numbers]\nlate = 'at(angle, 9)'\n",
        "[grid]\nlength = [1]\n[numbers]\nlength = 'max angle'\n",
    ];
    let mut lines = String::new();
    for plan in plans {
        let folder = with_plan(plan);
        fs::write(folder.path().join("bad.csv"), "length\none\n").unwrap();
        fs::write(folder.path().join("bare.csv"), "0.5\n0.6\n").unwrap();
        let line = refused(folder.path(), &["sweep", "--plan", "plan.toml"]);
        assert!(!folder.path().join("out").exists());
        lines += &format!("{plan}{line}\n");
    }
    insta::assert_snapshot!("plans", lines);
}

/// A length and an angle with tolerances, and numbers that are asked for by text.
const TOLERANCES: &str = r#"
t_end = 0.2
[numbers]
swing = "range angle"
last = "final angle"
pull = "max norm(force_x, force_y)"
when = "time_of_min angle"
[tolerances]
count = 100
seed = 7
indices = true
[tolerances.parameters]
length = { normal = [0.6, 0.01] }
angle = { truncated = [0.5, 0.05, 0.4, 0.6] }
"#;

#[test]
fn tolerances_give_statistics_indices_and_a_page() {
    let folder = with_plan(TOLERANCES);
    let path = folder.path();
    let told = text(path, &["sweep", "--plan", "plan.toml", "--out", "o"]);
    assert!(told.contains("swing, which parameter spreads it") && told.contains("sweep of 400 runs"), "{told}");
    let rows = table(path.join("o/runs-000000.parquet"));
    // Of each sample of four runs A and B are drawn.
    let values: Vec<f64> = ["o/runs-000000.parquet", "o/runs-000001.parquet"]
        .iter()
        .flat_map(|file| reals(&table(path.join(file)), "swing"))
        .collect();
    let drawn: Vec<f64> = values.iter().enumerate().filter(|(run, _)| run % 4 < 2).map(|(_, value)| *value).collect();
    let mean = drawn.iter().sum::<f64>() / drawn.len() as f64;
    let deviation = (drawn.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (drawn.len() - 1) as f64).sqrt();
    let statistics = fs::read_to_string(path.join("o/statistics.csv")).unwrap();
    let said = |start: &str| -> f64 {
        let line = statistics.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("{start}"));
        line.split(',').nth(4).unwrap().parse().unwrap()
    };
    assert!((said("swing,rad,mean,,") - mean).abs() < 1e-12 * mean.abs(), "{statistics}");
    assert!((said("swing,rad,deviation,,") - deviation).abs() < 1e-9 * deviation, "{statistics}");
    // The run is short, so it is nearly linear in both: derivatives say the same.
    let first_order = said("swing,rad,first order deviation,,");
    assert!((first_order / deviation - 1.0).abs() < 0.15, "{first_order} {deviation}");
    let [length, angle] = ["length", "angle"].map(|name| said(&format!("swing,rad,total index,{name},")));
    let parts = ["length", "angle"]
        .map(|name| (said(&format!("swing,rad,first order part of the deviation,{name},")) / first_order).powi(2));
    assert!((length - parts[0]).abs() < 0.15 && (angle - parts[1]).abs() < 0.15, "{length} {angle} {parts:?}");
    assert!(fs::read_to_string(path.join("o/index.html")).unwrap().contains("data:image/svg+xml;base64"));
    // A number of a row is that of a run by itself, and the same as a column that is named.
    let (lengths, angles) = (reals(&rows, "length"), reals(&rows, "angle"));
    let plan = format!(
        "t_end = 0.2\n[grid]\nlength = [{:?}]\nangle = [{:?}]\n[columns]\nangle = ['final', 'max', 'min']\n",
        lengths[3], angles[3]
    );
    fs::write(path.join("one.toml"), plan).unwrap();
    text(path, &["sweep", "--plan", "one.toml", "--out", "one"]);
    let one = table(path.join("one/runs-000000.parquet"));
    assert_eq!(reals(&one, "angle_final")[0], reals(&rows, "last")[3]);
    let range = reals(&one, "angle_max")[0] - reals(&one, "angle_min")[0];
    assert!((range - reals(&rows, "swing")[3]).abs() < 1e-9, "{range}");
    let shown = text(path, &["sweep", "show", "o"]);
    assert!(shown.contains("runs     400 of 400") && shown.contains("pull, which parameter spreads it"), "{shown}");
}

#[test]
fn a_sweep_draws_itself() {
    let page = |plan: &str| {
        let folder = with_plan(plan);
        text(folder.path(), &["sweep", "--plan", "plan.toml", "--out", "o"]);
        fs::read_to_string(folder.path().join("o/index.html")).unwrap()
    };
    let count = |page: &str| page.matches("<figure>").count();
    let columns = "[columns]\nangle = ['final', 'min']\n";
    let lines = page(&format!("t_end = 0.1\n[grid]\nlength = [0.4, 0.5, 0.6]\n{columns}"));
    assert!(count(&lines) == 2 && lines.contains("angle_final over length"), "{lines}");
    let both = "length = { from = 0.4, to = 0.8, count = 8 }\nangle = { from = 0.1, to = 1, count = 9 }\n";
    let map = page(&format!("t_end = 0.1\n[grid]\n{both}{columns}"));
    assert!(count(&map) == 2 && map.contains("angle_min over angle and length"), "{map}");
    let sampled = "ranges = { length = { from = 0.4, to = 0.8 }, angle = { from = 0.1, to = 1 } }\n";
    let dots = page(&format!("t_end = 0.1\n[sobol]\ncount = 20\nseed = 1\n{sampled}{columns}"));
    assert_eq!(count(&dots), 4);
}

#[test]
fn another_plan_needs_another_folder() {
    let folder = with_plan(PLAN);
    let path = folder.path();
    let sweep = ["sweep", "--plan", "plan.toml", "--out", "o"];
    text(path, &sweep);
    // Other words for the same.
    fs::write(path.join("plan.toml"), format!("# Again.\nrtol = 1e-8{PLAN}")).unwrap();
    assert!(text(path, &sweep).contains("5 were there"));
    for (old, new, difference) in [
        ("t_end = 0.2", "t_end = 0.3", "`t_end` is 0.2 there and 0.3 here"),
        ("count = 6", "count = 7", "`runs` is 30 there and 35 here"),
        ("angle = [0.1", "angle = [0.2", "`values` is"),
        ("\"mean\", ", "", "`columns` is"),
    ] {
        fs::write(path.join("plan.toml"), PLAN.replace(old, new)).unwrap();
        let line = refused(path, &sweep);
        assert!(line.starts_with(&format!("error: o has another sweep: {difference}")), "{line}");
        assert!(line.ends_with("; choose another folder with --out\n"), "{line}");
    }
    assert!(refused(path, &["sweep", "show", "."]).starts_with("error: . has no sweep: "));
    assert!(refused(path, &["sweep"]).contains("--plan"));
    assert!(refused(path, &["sweep", "--plan", "plan.toml", "--shard", "3/2"]).starts_with("error: --shard 3/2: "));
}
