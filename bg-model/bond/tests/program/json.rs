//! What commands print for programs, with `--json`.

use serde_json::{Value, json};

use super::{SWING, folder, told, write};

/// One document of JSON is all that a command prints.
fn printed(folder: &std::path::Path, line: &str) -> Value {
    let text = told(folder, line);
    serde_json::from_str(&text).unwrap_or_else(|fault| panic!("{line}: {fault}\n{text}"))
}

#[test]
fn a_graph_is_its_elements_bonds_and_states() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    let graph = printed(folder.path(), "graph swing.bond --json");
    assert_eq!(graph["graph"], "Swing");
    assert_eq!(graph["elements"].as_array().map(Vec::len), Some(4));
    let body = json!({ "from": "slide", "to": "body", "cardinality": 1, "stroke_at": "body" });
    let bonds = graph["bonds"].as_array().expect("bonds");
    let found = bonds.iter().find(|bond| bond["to"] == "body").expect("the bond to the mass");
    for (name, value) in body.as_object().expect("an object") {
        assert_eq!(&found[name], value, "{name}");
    }
    let states = json!([
        { "name": "spring.q", "unit": "m", "storage": "C" }, { "name": "body.p", "unit": "kg*m/s", "storage": "I" }
    ]);
    assert_eq!(graph["states"], states);
    let part = printed(folder.path(), "graph swing.bond --part operations --json");
    let keys: Vec<_> = part.as_object().expect("an object").keys().map(String::as_str).collect();
    assert_eq!(keys, ["graph", "operations", "scene"]);
    assert!(part["operations"]["rate"]["all"].as_u64().is_some_and(|count| count > 0), "{part}");
    let drawn = printed(folder.path(), "graph swing.bond --svg swing.svg --json");
    assert!(drawn["bonds"].is_array() && folder.path().join("swing.svg").is_file());
}

#[test]
fn studies_print_what_they_have_found() {
    let folder = folder();
    write(&folder, "swing.bond", SWING);
    let path = folder.path();

    // Released at 0.1 m: x(0) is the first point.
    let plot = printed(path, "plot swing.bond --show x --t-end 0.5 --out x.svg --json");
    assert_eq!((&plot["file"], &plot["up"]), (&json!("x.svg"), &json!("x in m")));
    assert_eq!(plot["series"][0]["points"][0], json!([0.0, 0.1]));

    let precision = "precision swing.bond --methods dop853 --rtol 1e-4 --repeats 1 --json";
    let entries = printed(path, precision);
    assert_eq!((entries.as_array().map(Vec::len), &entries[0]["integrator"]), (Some(1), &json!("dop853")));
    let file = std::fs::read_to_string(path.join("out/precision/precision.json")).expect("it is written");
    assert_eq!(serde_json::from_str::<Value>(&file).expect("JSON"), entries);

    let recorded = printed(path, "golden record swing.bond --t-end 0.2 --json");
    assert!(recorded["csv"].as_str().is_some_and(|file| path.join(file).is_file()), "{recorded}");

    write(&folder, "plan.toml", "t_end = 0.2\n[grid]\nstiffness = [40, 60]\n[columns]\nx = [\"max\"]\n");
    printed(path, "sweep swing.bond --plan plan.toml --out s --json");
    let shown = printed(path, "sweep swing.bond show s --json");
    assert_eq!((&shown["runs"], &shown["failed"], &shown["shards"]), (&json!(2), &json!(0), &json!(1)));
    assert_eq!((&shown["recipe"]["runs"], &shown["recipe"]["swept"]), (&json!(2), &json!(["stiffness"])));
    // Those of distributions only.
    assert!(shown["statistics"].is_null(), "{shown}");

    write(&folder, "library.so", "fmi3InstantiateModelExchange");
    let unit = printed(path, "fmu swing.bond --library library.so --json");
    assert_eq!((&unit["file"], &unit["model"], &unit["fmi"]), (&json!("swing.fmu"), &json!("Swing"), &json!("3.0")));
}
