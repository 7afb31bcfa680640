//! What rust-analyzer knows of names inside of `bond_graph!`, asked over its protocol as an editor asks: hover,
//! definition, references, rename, completion.
//!
//! Where there is no rust-analyzer on the path, it says so and asks nothing: `rustup component add rust-analyzer`. Its
//! first run builds the macro for it, into a target folder of its own.

mod client;
mod colours;
mod grammar;
mod machine;

use bg_compiler::source::functions;
use client::Editor;
use machine::{TEXT, at, mark_at, position};
use serde_json::{Value, json};

/// A name: its declaration, then all its uses in the order of the text.
const NAMES: [&[&str]; 20] = [
    &["Leg", "Leg in left", "Leg in row"],
    &["rate", "rate in knee", "rate in left"],
    &["foot", "foot in knee", "foot in way", "foot in observe"],
    &["tip", "tip in knee", "tip in observe"],
    &["floor", "floor in knee"],
    &["way", "way in observe"],
    &["length", "length in end", "length in scene", "length in Rust"],
    &["mass", "mass in rod"],
    &["torque", "torque in motor"],
    &["pivot", "pivot in pin"],
    &["rod", "rod in pin", "rod in observe"],
    &["end", "end in start", "end in pin"],
    &["pin", "pin in motor", "pin in rub", "pin in chain", "pin in observe", "pin in scene"],
    &["motor", "motor in scene"],
    &["rub", "rub in scene"],
    &["row", "row in observe"],
    &["pair", "pair in chain", "pair again in chain", "pair in observe"],
    &["left", "left in observe"],
    &["curve", "curve in observe", "curve again in observe"],
    &["Still", "Still in Rust"],
];

/// What is shown of a name, at any of its places.
const SHOWN: [(&str, &[&str]); 23] = [
    ("length in end", &["length: f64", "Length of the rod.", "Unit: m.", "Default 0.6"]),
    ("rate in knee", &["rate: Parameter", "How stiff the knee is.", "param rate: N/m = 3000;"]),
    ("torque in motor", &["torque: Input", "What turns the pin.", "Unit: N*m."]),
    (
        "rod in observe",
        &[
            "rod: Body",
            "mass mass;",
            "States: `rod.linear.p` kg*m/s, `rod.angular.p` kg*m^2/s, `rod.position` m",
            "`rod.orientation` 1, `rod.angle` rad.",
        ],
    ),
    ("end in pin", &["end: Point", "point end = [-length / 2, 0, 0]"]),
    ("pin in scene", &["pin: Revolute", "joint pin: revolute z (ground.pivot -> rod.end)"]),
    ("force", &["force: Vector", "Force on the second body, inertial axes. Unit: N."]),
    ("left in observe", &["left: Leg", "rate = 2000;"]),
    ("way in observe", &["way: Value", "way: m = foot.position.x"]),
    ("pair in observe", &["pair: GearPair", "ratio = 4;"]),
    ("GearPair", &["struct GearPair", "A rigid pair of gears, one outside of the other"]),
    ("ratio in pair", &["ratio: Parameter", "Teeth of the second gear over those of the first."]),
    ("curve in observe", &["curve: Table", "table curve: rad/s -> N*m = [[0, 2], [50, 1]], held;"]),
    ("derivative", &["derivative: f64", "the slope at the argument a"]),
    ("abs", &["abs(a)", "The magnitude: a without its sign.", "Units: that of a.", "speed: rad/s = abs(pin.speed);"]),
    ("sin", &["fn sin(&self, a: f64) -> f64", "The sine.", "Units: a in rad, or a pure number"]),
    ("delay", &["delay(a, T)", "delay(a, T, start)", "What a was at the time T before", "delay(pin.speed, 20 ms, 0)"]),
    (
        "friction",
        &["struct friction", "Dry friction that sticks, on a joint, contact or junction: `friction rub on pin"],
    ),
    ("stiffness", &["Force over the gap, N/m, in the directions that are not free"]),
    ("revolute", &["A pin: free to turn about one axis"]),
    ("held", &["Beyond its points a table keeps the value at its end."]),
    ("t", &["t: Value", "The time. Unit: s."]),
    ("Machine", &["struct Machine", "A rod on a pin.", "# States"]),
];

/// What is offered at the bar in place of a piece of text: all of it, or some where there is more to see.
const OFFERED: [(&str, &str, &[&str]); 11] = [
    ("pin./*force*/force.x", "pin.|", &["force", "moment", "gap", "angle", "direction", "speed"]),
    ("pin./*force*/force.x", "pin.fo|", &["force", "moment", "gap", "angle", "direction", "speed"]),
    ("pin./*force*/force.x", "pin.force.|", &["x", "y", "z"]),
    ("left./*way in observe*/way;", "left.|;", &["rate", "foot", "ground", "knee", "way"]),
    ("pair./*torque in observe*/torque;", "pair.|;", &["ratio", "first", "second", "mesh", "torque"]),
    ("rod./*end in pin*/end)", "rod.|)", &["end", "position", "velocity", "orientation"]),
    (
        "/*rod in observe*/rod.angle",
        "|",
        &[
            "length",
            "mass",
            "torque",
            "ground",
            "rod",
            "pin",
            "motor",
            "rub",
            "left",
            "row",
            "pair",
            "curve",
            "hub",
            "wheel",
            "t",
            "stored_energy",
            "supplied_power",
            "dissipated_power",
        ],
    ),
    ("/*friction*/friction /*rub*/rub on", "fr|", &["friction", "joint", "body", "table", "memory", "every", "stop"]),
    ("/*stiffness*/stiffness 1e6;", "st|;", &["stiffness", "clearance", "restitution", "rigid", "rest"]),
    ("/*sin*/sin(", "si|(", &["sin"]),
    ("curve./*derivative*/derivative(", "curve.|(", &["derivative", "second_derivative"]),
];

#[test]
fn an_editor_knows_the_names() {
    if !client::is_there() {
        eprintln!("skipped: no rust-analyzer on the path");
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    machine::write(folder.path());
    let target = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("editor");
    let mut editor = Editor::open(folder.path(), &target);
    faults(&mut editor);
    names(&mut editor);
    shown(&mut editor);
    words_of_the_language_stay(&mut editor);
    offered(&mut editor);
}

/// Nothing is wrong with the names. Without the standard library's sources rust-analyzer mistakes types outside of
/// them.
fn faults(editor: &mut Editor) {
    let found = editor.diagnostics();
    let items = found["items"].as_array().expect("a list");
    let codes: Vec<&str> = items.iter().filter_map(|item| item["code"].as_str()).collect();
    assert!(codes.iter().all(|code| *code == "E0308"), "{found:#}");
}

/// The marks of the places of an answer, sorted.
fn marks<'v>(places: impl Iterator<Item = &'v Value>) -> Vec<String> {
    let number = |value: &Value| value.as_u64().and_then(|number| usize::try_from(number).ok()).expect("a number");
    let start = |range: &Value| (number(&range["start"]["line"]), number(&range["start"]["character"]));
    let mut marks: Vec<String> = places.map(|place| mark_at(start(&place["range"]))).collect();
    marks.sort();
    marks
}

fn names(editor: &mut Editor) {
    for places in NAMES {
        let mut all: Vec<String> = places.iter().map(|place| (*place).to_owned()).collect();
        all.sort();
        for place in places {
            let found = editor.at("definition", at(place), json!({}));
            let found = marks(found.as_array().into_iter().flatten());
            assert_eq!(found, [places[0]], "the declaration of `{place}`");
            let declaration = json!({ "context": { "includeDeclaration": true } });
            let found = editor.at("references", at(place), declaration);
            assert_eq!(marks(found.as_array().into_iter().flatten()), all, "the references of `{place}`: {found:#}");
            let renamed = editor.at("rename", at(place), json!({ "newName": "fresh" }));
            let files = renamed["documentChanges"].as_array().into_iter().flatten();
            let edits = files.filter_map(|file| file["edits"].as_array()).flatten();
            assert_eq!(marks(edits), all, "rename at `{place}`: {renamed}");
        }
    }
}

fn shown(editor: &mut Editor) {
    for (place, words) in SHOWN {
        let found = editor.at("hover", at(place), json!({}));
        // Markdown has a backslash in front of a star.
        let text = found["contents"]["value"].as_str().unwrap_or_default().replace("\\*", "*");
        for word in words {
            assert!(text.contains(word), "`{word}` is not in the hover of `{place}`:\n{text}");
        }
    }
}

fn words_of_the_language_stay(editor: &mut Editor) {
    let renamed = editor.at("rename", at("force"), json!({ "newName": "fresh" }));
    assert!(renamed["error"].is_string(), "{renamed:#}");
}

/// What has a name in every graph and part.
const EVERYWHERE: [&str; 4] = ["t", "stored_energy", "supplied_power", "dissipated_power"];

fn offered(editor: &mut Editor) {
    for (old, new, words) in OFFERED {
        let start = TEXT.find(old).unwrap_or_else(|| panic!("no `{old}`"));
        let caret = start + new.find('|').expect("a bar");
        let text = TEXT.replacen(old, &new.replace('|', ""), 1);
        editor.change(&text);
        let found = editor.at("completion", position(&text, caret), json!({}));
        let items = found["items"].as_array().or(found.as_array()).into_iter().flatten();
        let labels: Vec<&str> = items.filter_map(|item| item["label"].as_str()?.split('(').next()).collect();
        let missing: Vec<_> = words.iter().filter(|word| !labels.contains(word)).collect();
        assert!(missing.is_empty(), "`{new}` offers {labels:?}, not {missing:?}");
        // Functions are offered wherever names are, and after a part the names that are everywhere, which its type has,
        // too.
        let is_other =
            |label: &&&str| !words.contains(label) && functions::named(label).is_none() && !EVERYWHERE.contains(label);
        let others = labels.iter().filter(is_other).count();
        assert!(others == 0 || ["rod.|)", "fr|", "st|;", "si|("].contains(&new), "`{new}` offers {labels:?}");
    }
}
