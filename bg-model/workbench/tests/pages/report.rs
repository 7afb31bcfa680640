//! What a user sees of the command `report`. The programs are the examples `pendulum` and `rlc_circuit`.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::browser;
use crate::example::program;
use crate::outcome::text_of;
use serde_json::Value;

fn run(example: &str, directory: &Path, arguments: &[&str]) -> Output {
    program(example).current_dir(directory).args(arguments).output().expect("the example was built")
}

fn text(example: &str, directory: &Path, arguments: &[&str]) -> String {
    text_of(run(example, directory, arguments), arguments)
}

/// The names of the files in a folder, sorted.
fn files(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().to_string_lossy().into_owned());
    let mut files: Vec<String> = files.filter(|name| name != ".run").collect();
    files.sort_unstable();
    files
}

fn data(html: &str) -> Value {
    let text = html.split_once("id=\"data\">").unwrap().1.split_once("</script>").unwrap().0;
    serde_json::from_str(text).unwrap()
}

#[test]
fn one_page_beside_the_trajectory_has_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let told = text("pendulum", path, &["report", "--t-end", "1", "--set", "length=0.8", "--out", "o"]);
    assert!(
        told.contains("length = 0.8 m") && told.ends_with("written: 4 files in o; open pendulum.html there\n"),
        "{told}"
    );
    assert_eq!(files(&path.join("o")), ["pendulum.html", "summary.json", "summary.txt", "trajectory.csv"]);
    let html = fs::read_to_string(path.join("o/pendulum.html")).unwrap();
    let csv = fs::File::open(path.join("o/trajectory.csv")).unwrap();
    let csv = bg_workbench::samples::read(csv).unwrap();
    let data = data(&html);
    let rows = data["rows"].as_array().unwrap();
    assert_eq!((rows.len(), csv.times.len()), (101, 101));
    for curve in data["charts"].as_array().unwrap().iter().flat_map(|chart| chart["curves"].as_array().unwrap()) {
        let column = csv.column(curve["column"].as_str().unwrap()).unwrap();
        let shown = rows.iter().map(|k| curve["values"][k.as_u64().unwrap() as usize].as_f64().unwrap());
        assert!(shown.zip(column).all(|(shown, value)| shown.to_bits() == value.to_bits()), "{}", curve["column"]);
    }
    // Nothing comes from elsewhere: the addresses in the page are data, anchors and the licence's.
    for address in html.split("src=\"").skip(1).chain(html.split("href=\"").skip(1)) {
        assert!(address.starts_with("data:") || address.starts_with('#'), "{}", &address[..40]);
    }
    assert!(html.contains("<tr class=\"changed\"><td><code>length</code></td><td class=\"number\">0.8</td>"));
    assert!(html.contains("d(rod.position)/dt = ") && html.contains("Permission is hereby granted"));

    // The next run into the folder takes its page away, as that of any run before it.
    text("pendulum", path, &["run", "--t-end", "0.1", "--out", "o"]);
    assert!(!path.join("o/pendulum.html").exists() && path.join("o/index.html").exists());
}

#[test]
fn modes_drawings_and_a_csv_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(
        path.join("work_and_precision.svg"),
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"123\" height=\"50\"><!-- 5 % #1 --></svg>",
    )
    .unwrap();
    let mut arguments =
        vec!["report", "--t-end", "0.2", "--modes", "--show", "work_and_precision.svg", "--csv", "run.csv"];
    let told = text("pendulum", path, &arguments);
    assert!(told.ends_with("written: run.csv and 3 files in out; open pendulum.html there\n"), "{told}");
    let html = fs::read_to_string(path.join("out/pendulum.html")).unwrap();
    assert!(html.contains("<img data-drawing=\"0\" alt=\"work and precision\">"));
    // sqrt(3 g / (2 l)) of a rod over 2 pi, less what its thickness and the pin's compliance take.
    let modes = html.split_once("id=\"modes\"").unwrap().1.split_once("</section>").unwrap().0;
    assert!(modes.contains("<td class=\"number\">0.7879<"), "{modes}");
    if let Some(browser) = browser::browser() {
        let visit = browser::visit(browser, &path.join("out/pendulum.html"), "test", &["--window-size=800,700"]);
        assert!(visit.console.is_empty() && visit.document.contains("\"drawings\":[123]"), "{:?}", visit.console);
    }
    text("pendulum", path, &["report", "--t-end", "0.2", "--modes", "0.1"]);
    let html = fs::read_to_string(path.join("out/pendulum.html")).unwrap();
    assert!(html.contains("<h2>Modes <small>where the run is at t = 0.1 s</small></h2>"));
    let output = run("pendulum", path, &["report", "--modes", "-1"]);
    let line = String::from_utf8(output.stderr).unwrap();
    assert!(line.starts_with("error: --modes -1: must be a finite number, at least 0"), "{line}");
    fs::write(path.join("no.svg"), "text").unwrap();
    arguments[5] = "no.svg";
    for (file, told) in [
        ("no.svg", "--show no.svg: has no <svg; give an SVG file"),
        ("absent.svg", "--show absent.svg: cannot be read"),
    ] {
        arguments[5] = file;
        let output = run("pendulum", path, &arguments);
        let line = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && line.contains(told) && line.lines().count() == 1, "{line}");
    }
}

/// Value `k` of a series, which is one number where it never changes.
fn value(series: &Value, k: usize) -> f64 {
    series.as_f64().or_else(|| series[k].as_f64()).unwrap_or(f64::NAN)
}

#[test]
fn the_machine_and_the_graph_are_those_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("o");
    text("double_pendulum", folder.path(), &["report", "--t-end", "1", "--modes", "0", "--glb", "--out", "o"]);
    let html = fs::read_to_string(out.join("double-pendulum.html")).unwrap();
    let csv = bg_workbench::samples::read(fs::File::open(out.join("trajectory.csv")).unwrap()).unwrap();
    let data = data(&html);
    let motion = &data["animation"];
    assert_eq!(motion["upright"], serde_json::json!([0.0, 0.0, 0.0, 1.0]));
    let [upper, lower] = [0, 1].map(|body| &motion["bodies"][body]);
    assert_eq!([&upper["name"], &lower["name"], &motion["joints"][1]["name"]], ["upper", "lower", "elbow"]);
    let times = motion["times"].as_array().unwrap();
    let mut rows = 0;
    for (k, t) in times.iter().enumerate() {
        let Some(row) = csv.times.iter().position(|&time| Some(time) == t.as_f64()) else { continue };
        rows += 1;
        let of = |name: &str| csv.column(name).unwrap()[row];
        // Six digits are in the page.
        let near = |series: &Value, exact: f64| {
            let shown = value(series, k);
            assert!((shown - exact).abs() <= 5e-6 * exact.abs() + 1e-9, "{shown} and {exact} at {t} s");
        };
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            near(&lower["position"][axis], of(&format!("lower_position_{letter}")));
            // Undamped: the force on the lower rod is what the gap's spring gives.
            near(&motion["joints"][1]["force"][axis], -1e5 * of(&format!("elbow_gap_{letter}")));
        }
        near(&upper["orientation"][2], (of("upper_angle") / 2.0).sin());
    }
    assert_eq!(rows, 101, "every row of the CSV file is in the motion");

    let bonds = html.matches("data-bond=\"").count();
    assert!(bonds > 30 && html.contains("<button type=\"button\" data-mode=\"0\">swing</button>"), "{bonds} bonds");
    let glb = fs::read(out.join("double-pendulum.glb")).unwrap();
    assert_eq!(&glb[..4], b"glTF");
    let Some(browser) = browser::browser() else { return };
    let visit = browser::visit(browser, &out.join("double-pendulum.html"), "test", &["--window-size=1000,800"]);
    assert_eq!(visit.console, [""; 0]);
    assert!(visit.document.contains("\"faults\":[]") && visit.document.contains("\"positions\":[["));
}

#[test]
fn what_is_up_comes_from_gravity() {
    let folder = tempfile::tempdir().unwrap();
    text("spinning_top", folder.path(), &["report", "--t-end", "0.1", "--out", "o"]);
    let html = fs::read_to_string(folder.path().join("o/spinning-top.html")).unwrap();
    // A quarter turn about x, which takes z to y.
    let upright = &data(&html)["animation"]["upright"];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for (part, expected) in [-half, 0.0, 0.0, half].into_iter().enumerate() {
        assert!((value(upright, part) - expected).abs() < 1e-6, "{upright}");
    }
}

#[test]
fn a_circuit_has_a_page_without_a_machine() {
    let folder = tempfile::tempdir().unwrap();
    text("rlc_circuit", folder.path(), &["report", "--t-end", "0.02", "--step", "1e-4", "--glb", "--out", "o"]);
    let file = folder.path().join("o/rlc-circuit.html");
    let html = fs::read_to_string(&file).unwrap();
    assert!(!html.contains("id=\"machine\"") && html.contains("id=\"balance\"") && data(&html)["animation"].is_null());
    assert!(!folder.path().join("o/rlc-circuit.glb").exists(), "what does not move has no glTF");
    let Some(browser) = browser::browser() else { return };
    let visit = browser::visit(browser, &file, "test", &["--window-size=800,700"]);
    assert_eq!(visit.console, [""; 0]);
    assert!(visit.document.contains("\"faults\":[]"), "{}", visit.document.len());
}

#[test]
fn a_machine_without_an_equilibrium_has_a_page_that_says_so_in_place_of_its_modes() {
    let folder = tempfile::tempdir().unwrap();
    // A torque turns its crank on and on.
    let told = text("slider_crank", folder.path(), &["report", "--t-end", "0.05", "--modes", "--out", "o"]);
    assert!(told.contains("open slider-crank.html there"), "{told}");
    let html = fs::read_to_string(folder.path().join("o/slider-crank.html")).unwrap();
    let modes = html.split_once("<section id=\"modes\">").unwrap().1.split_once("</section>").unwrap().0;
    assert!(
        modes.contains("<p>There are none: there is no equilibrium near the start: `slider.position_x`"),
        "{modes}"
    );
    assert!(html.contains("href=\"#modes\"") && html.contains("id=\"machine\""));
}

#[test]
fn every_example_has_a_page_whose_data_are_whole() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for file in fs::read_dir(examples).unwrap().map(|file| file.unwrap().path()) {
        let example = file.file_stem().unwrap().to_string_lossy().into_owned();
        let folder = tempfile::tempdir().unwrap();
        text(&example, folder.path(), &["report", "--t-end", "0.05", "--step", "1e-3", "--out", "o"]);
        let pages: Vec<String> = files(&folder.path().join("o")).into_iter().filter(|f| f.ends_with(".html")).collect();
        assert_eq!(pages.len(), 1, "{example}");
        let html = fs::read_to_string(folder.path().join("o").join(&pages[0])).unwrap();
        let data = data(&html);
        let count = data["times"].as_array().unwrap().len();
        assert_eq!(data["rows"].as_array().unwrap().len(), 51, "{example}");
        let curves = data["charts"].as_array().unwrap().iter().flat_map(|chart| chart["curves"].as_array().unwrap());
        let shown: Vec<&Value> = curves.collect();
        let csv = fs::read_to_string(folder.path().join("o/trajectory.csv")).unwrap();
        assert_eq!(
            shown.len() + 1,
            csv.lines().next().unwrap().split(',').count(),
            "{example}: every output is in a chart"
        );
        let is_whole =
            |values: &Value| values.is_f64() || values.as_array().is_some_and(|values| values.len() == count);
        assert!(shown.iter().all(|curve| is_whole(&curve["values"])), "{example}");
    }
}
