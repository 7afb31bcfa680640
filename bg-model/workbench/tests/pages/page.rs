//! The report page: its numbers are the CSV's, nothing in a text breaks it, and a browser shows it, plays it and scrubs
//! it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::browser;
use crate::machine::{self, DoublePendulum};
use base64::Engine;
use bg_model::description::{Description, ParameterInfo};
use bg_model::mechanism::Mechanism;
use bg_model::parameters::Parameters;
use bg_model::run::Trajectory;
use bg_model::simulation::{Column, Recording};
use bg_workbench::extras::{Extras, Page, Plain};
use bg_workbench::page::{Linearised, Parameter, Report, Views, glb, page};
use bg_workbench::samples;
use bg_workbench::summary::{Additions, Summary};
use serde_json::Value;

/// What `report` would write of a run, with these views.
fn written(run: &Trajectory, rows: &[f64], texts: &Page, description: &'static Description, views: &Views) -> String {
    let summary = Summary::new("literal", run, None, Additions::default());
    let parameter = |info: &ParameterInfo| {
        let value = if info.name == "gravity" { 1.62 } else { info.default };
        Parameter { info: info.clone(), value, source: "" }
    };
    let parameters: Vec<Parameter> = <DoublePendulum as Mechanism>::Parameters::table().iter().map(parameter).collect();
    let (scene, parameters, summary, others) = ("", &parameters[..], &summary, &[measured()][..]);
    page(&Report {
        texts,
        description,
        scene,
        parameters,
        summary,
        run,
        rows,
        figures: &[],
        others,
        drawings: &[],
        views,
        live: None,
    })
}

/// A measurement of two outputs, and of what is none.
fn measured() -> (String, Recording) {
    let columns = ["upper_position_x", "upper_position_y", "weather"].map(|name| Column::new(name, "m"));
    let mut run = Recording::new(columns.into());
    run.push(0.25, [0.125, -0.5, 1.0]);
    run.push(0.75, [0.25, -0.75, 2.0]);
    ("measured".to_owned(), run)
}

fn double_pendulum(t_end: f64) -> (Trajectory, Vec<f64>, String) {
    let (run, rows) = machine::run(t_end);
    let animation = Some(machine::animation(&run));
    let modes = Linearised { modes: machine::modes(), place: "at rest".to_owned(), rest: Some(machine::at_rest()) };
    let modes = Some(Ok(modes));
    let views = Views { animation, picture: Some(machine::picture(&run.times)), modes };
    let description = DoublePendulum::describe();
    let html = written(&run, &rows, &Plain.page(description.name, description), description, &views);
    (run, rows, html)
}

/// The data of a page.
fn data(html: &str) -> Value {
    let start = "<script type=\"application/json\" id=\"data\">";
    let text = html.split_once(start).expect("the page has data").1.split_once("</script>").expect("they end").0;
    serde_json::from_str(text).expect("they are JSON")
}

/// A packed text of a page.
fn unpacked(html: &str, id: &str) -> String {
    let start = format!("<script type=\"text/plain\" id=\"{id}\">");
    let text = html.split_once(&start).expect("the page has it").1.split_once("</script>").expect("it ends").0;
    let bytes = base64::engine::general_purpose::STANDARD.decode(text).expect("base64");
    String::from_utf8(miniz_oxide::inflate::decompress_to_vec(&bytes).expect("deflated")).expect("text")
}

/// Value `k` of a series, which is one number where it never changes.
fn value(series: &Value, k: usize) -> f64 {
    series.as_f64().or_else(|| series[k].as_f64()).unwrap_or(f64::NAN)
}

#[test]
fn every_number_of_the_charts_is_the_csv_s() {
    let (run, rows, html) = double_pendulum(2.0);
    let mut csv = Vec::new();
    run.at(&rows).write_csv(&mut csv).unwrap();
    let csv = samples::read(&csv[..]).unwrap();
    let data = data(&html);
    let places: Vec<usize> = data["rows"].as_array().unwrap().iter().map(|k| k.as_u64().unwrap() as usize).collect();
    assert_eq!(places.len(), 201, "every row is in the page");
    for (row, &k) in places.iter().enumerate() {
        assert_eq!(value(&data["times"], k), csv.times[row]);
    }
    let mut columns = 0;
    for curve in data["charts"].as_array().unwrap().iter().flat_map(|chart| chart["curves"].as_array().unwrap()) {
        let name = curve["column"].as_str().unwrap();
        let column = csv.column(name).unwrap();
        columns += 1;
        for (row, &k) in places.iter().enumerate() {
            assert_eq!(value(&curve["values"], k).to_bits(), column[row].to_bits(), "{name} at {} s", csv.times[row]);
        }
    }
    assert_eq!(columns, csv.columns.len(), "every output is in a chart");
    // Between the rows a number has six digits.
    let between = run.times.iter().position(|&t| t == 0.002).unwrap();
    let x = data["charts"].as_array().unwrap().iter().find(|chart| chart["title"] == "lower_position").unwrap();
    let exact = run["lower_position_x"][between];
    let shown = value(&x["curves"][0]["values"], between);
    assert!(shown != exact && (shown - exact).abs() < 5e-6 * exact.abs(), "{shown} and {exact}");
}

#[test]
fn a_measurement_stands_beside_the_outputs_of_its_names() {
    let data = data(&double_pendulum(1.0).2);
    let columns = serde_json::json!([
        { "name": "upper_position_x", "values": [0.125, 0.25] },
        { "name": "upper_position_y", "values": [-0.5, -0.75] },
    ]);
    let expected = serde_json::json!([{ "name": "measured", "times": [0.25, 0.75], "columns": columns }]);
    assert_eq!(data["others"], expected);
}

#[test]
fn poses_and_forces_are_the_run_s() {
    let (run, _, html) = double_pendulum(1.0);
    let data = data(&html);
    let motion = &data["animation"];
    for (k, expected) in [(0, 0.0), (250, run.times[250])] {
        assert_eq!(motion["times"][k], expected);
        let near =
            |found: f64, exact: f64| assert!((found - exact).abs() <= 5e-6 * exact.abs() + 1e-12, "{found}, {exact}");
        near(value(&motion["bodies"][1]["position"][0], k), run["lower_position_x"][k]);
        near(value(&motion["bodies"][0]["orientation"][2], k), (run["upper_angle"][k] / 2.0).sin());
        near(value(&motion["joints"][1]["force"][1], k), -1e5 * run["elbow_gap_y"][k]);
    }
    assert_eq!(
        motion["bodies"][0]["solids"][1]["shape"],
        serde_json::json!({ "kind": "cylinder", "radius": 0.035, "length": 0.05, "axis": 2 })
    );
    let bonds: Value = serde_json::from_str(&unpacked(&html, "bonds")).unwrap();
    let series = |bond: usize, of: &str| &bonds["series"][bonds["bonds"][bond][of][0].as_u64().unwrap() as usize];
    let last = bonds["times"].as_array().unwrap().len() - 1;
    let at = value(&bonds["times"], last);
    assert!(last > 400 && (value(series(7, "effort"), last) - 7.0 - at).abs() < 1e-3);
    assert_eq!(series(7, "flow"), 2.0);
}

#[test]
fn no_text_breaks_the_page() {
    const EVIL: &str = "</script><script>document.title='broken'</script><!-- <b title=\"'x'\">&amp;";
    let (run, rows) = machine::run(0.1);
    let mut animation = machine::animation(&run);
    animation.bodies[0].name = EVIL.to_owned();
    animation.joints[0].name = EVIL.to_owned();
    let evil: &'static Description = {
        let usual = DoublePendulum::describe();
        Box::leak(Box::new(Description { name: EVIL, doc: EVIL, equations: &[EVIL], ..usual.clone() }))
    };
    let views = Views { animation: Some(animation), ..Views::default() };
    let texts = Page { gallery: EVIL.to_owned(), about_gallery: EVIL.to_owned(), ..Plain.page(evil.name, evil) };
    let html = written(&run, &rows, &texts, evil, &views);
    let usual = double_pendulum(0.1).2;
    assert_eq!(html.matches("</script").count(), usual.matches("</script").count());
    assert_eq!(html.matches("<script").count(), usual.matches("<script").count());
    assert_eq!(html.matches("<!--").count(), usual.matches("<!--").count());
    assert_eq!(data(&html)["animation"]["bodies"][0]["name"], EVIL);
    let Some(browser) = browser::browser() else { return };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("evil.html");
    std::fs::write(&file, html).unwrap();
    let visit = browser::visit(browser, &file, "test", &["--window-size=1000,800"]);
    assert_eq!(visit.console, [""; 0]);
    assert!(!visit.document.contains("<title>broken") && verdict(&visit.document)["faults"] == serde_json::json!([]));
}

/// What the page found of itself.
fn verdict(document: &str) -> Value {
    let start = "<pre id=\"verdict\" hidden=\"\">";
    let text = document.split_once(start).expect("the page has tried itself").1.split_once("</pre>").unwrap().0;
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
    serde_json::from_str(&text).expect("the verdict is JSON")
}

#[test]
fn a_browser_shows_plays_and_scrubs() {
    let Some(browser) = browser::browser() else { return };
    let (run, _, html) = double_pendulum(2.0);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.html");
    std::fs::write(&file, html).unwrap();
    let visit = browser::visit(browser, &file, "test", &["--window-size=1200,900"]);
    assert_eq!(visit.console, [""; 0], "nothing is said on the console");
    let verdict = verdict(&visit.document);
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    assert_eq!(verdict["faults"], serde_json::json!([]));
    let played = number(&verdict["played_to"]);
    assert!(played > 0.0 && played < 2.0, "{verdict}");
    assert_eq!(verdict["at_end"]["time"], 2.0);
    let last = run.times.len() - 1;
    let middle = run.times.iter().position(|&t| t == 1.0).unwrap();
    for (at, k) in [("at_end", last), ("at_middle", middle)] {
        for (axis, name) in ["lower_position_x", "lower_position_y"].into_iter().enumerate() {
            let shown = number(&verdict[at]["positions"][1][axis]);
            assert!((shown - run[name][k]).abs() < 1e-5, "{name} {at}: {shown} and {}", run[name][k]);
        }
    }
    assert_eq!(verdict["at_middle"]["time"], 1.0);
    assert!(number(&verdict["charts"]["drawn"]) >= 2.0, "{verdict}");
    assert!(verdict["charts"]["drawn"].as_u64() < verdict["charts"]["all"].as_u64(), "{verdict}");
    assert_eq!(verdict["blank_on_paper"], 0, "on paper all charts are drawn: {verdict}");
    assert!((number(&verdict["charts"]["line"]) - 1.0).abs() < 0.01, "the charts follow the slider: {verdict}");
    assert!((number(&verdict["pressed_to"]) - 0.5).abs() < 0.02, "the time follows a press in a chart: {verdict}");
    assert!(number(&verdict["colours"]) > 50.0, "the machine is drawn: {verdict}");
    assert_eq!(verdict["photo"], 255, "a photo has a background");
    let csv = verdict["csv"].as_array().expect("lines of the first chart's numbers");
    assert!(csv[0].as_str().is_some_and(|head| head.starts_with("t [s],")), "{csv:?}");
    assert!(csv[1].as_str().is_some_and(|row| row.starts_with("0,") && row.split(',').count() > 1), "{csv:?}");
    assert_eq!(verdict["bond_charts"], 3);
    // One scale on both axes, a dot at the time, the measurement beside the run.
    let against = &verdict["against"];
    assert_eq!(against["chosen"], serde_json::json!(["upper_position x", "upper_position y"]));
    assert_eq!(against["paths"], 2, "the run and the measurement: {against}");
    let place = |at: &str, axis: usize| number(&against[at][axis]);
    let moved = |axis: usize| place("last", axis) - place("first", axis);
    let way = |name: &str| run[name][last] - run[name][0];
    let scales = [moved(0) / way("upper_position_x"), -moved(1) / way("upper_position_y")];
    assert!(scales[0] > 100.0 && (scales[0] / scales[1] - 1.0).abs() < 1e-3, "{scales:?} {against}");
    let swing = &verdict["swing"];
    assert!(number(&swing["moved"]) >= 1e-3 && swing["pressed"] == "true", "a mode moves the machine: {swing}");
    assert!(number(&swing["back"]) < 1e-6, "setting the time ends that: {swing}");
    assert_eq!(verdict["overflow"], 0, "nothing is wider than the window");
}

#[test]
fn a_mode_swings_as_its_shape_says() {
    let data = data(&double_pendulum(0.1).2);
    let modes = machine::modes();
    // Two uniform rods that hang, small angles a and b: with M = [0.3, 0.14; 0.14, 0.130667] kg m^2 and
    // K = diag(6.867, 2.7468) N m, det(K - w^2 M) = 0 gives w = 3.582 rad/s, and there a = 0.5955 b.
    let slow = modes.iter().position(|mode| (mode.frequency - 0.5701).abs() < 1e-3).expect("the slow mode");
    let bodies = &data["modes"]["modes"][slow]["bodies"];
    let turn = |body: usize| bodies[body]["rotation"][2][0].as_f64().unwrap();
    assert!((turn(0) / turn(1) - 0.5955).abs() < 1e-3, "{} {}", turn(0), turn(1));
    // Each centre moves across its rod: half the upper rod, all of it and half the lower one.
    let x = |body: usize| bodies[body]["translation"][0][0].as_f64().unwrap();
    assert!((x(0) - 0.25 * turn(0)).abs() < 1e-3 && (x(1) - 0.5 * turn(0) - 0.35 * turn(1)).abs() < 1e-3, "{bodies}");
    assert_eq!(data["modes"]["bodies"][1]["position"][1], -0.85);
}

#[test]
fn the_machine_is_a_gltf_file_that_other_programs_read() {
    let (run, _) = machine::run(0.5);
    let animation = machine::animation(&run);
    let bytes = glb::glb(&animation).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&bytes[..4], word(4), word(8), &bytes[16..20]), (&b"glTF"[..], 2, bytes.len(), &b"JSON"[..]));
    let document: Value = serde_json::from_slice(&bytes[20..20 + word(12)]).unwrap();
    let binary = &bytes[28 + word(12)..];
    // The last place of the lower rod, by the tables of the file.
    let channel = &document["animations"][0]["samplers"][2];
    let accessor = &document["accessors"][channel["output"].as_u64().unwrap() as usize];
    let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let end = (view["byteOffset"].as_u64().unwrap() + view["byteLength"].as_u64().unwrap()) as usize;
    let x = f32::from_le_bytes(binary[end - 12..end - 8].try_into().unwrap());
    assert_eq!(x, *run["lower_position_x"].last().unwrap() as f32);
    assert_eq!((accessor["count"].as_u64(), &accessor["type"]), (Some(run.times.len() as u64), &"VEC3".into()));
    assert!(glb::glb(&Default::default()).is_none());
    validate(&bytes);
}

/// The folder of the page's sources, with the packages that it is built by; says so where they are not there.
fn sources() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
    let has_node = Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    if has_node && folder.join("node_modules").exists() {
        return Some(folder);
    }
    println!("skipped: `npm ci` in {} was not run", folder.display());
    None
}

/// Holds a file against the specification, by the Khronos Group's validator.
fn validate(bytes: &[u8]) {
    let Some(folder) = sources() else { return };
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    let output = Command::new("node").current_dir(folder).arg("validate.js").arg(file.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn the_script_is_what_the_sources_give() {
    let Some(folder) = sources() else { return };
    let output = Command::new("node").current_dir(folder).args(["build.js", "--check"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Keeps pages for whoever wants to look at them: `PAGES=folder cargo test -p bg-workbench --test pages`.
#[test]
fn pages_can_be_kept() {
    let Some(folder) = std::env::var_os("PAGES") else { return };
    let path = Path::new(&folder).join("double-pendulum.html");
    std::fs::write(&path, double_pendulum(10.0).2).unwrap();
    println!("written: {}", path.display());
}
