//! The page as its readers have it: the answers of its compiler are those of `bond`, in WebAssembly as they are
//! natively; a browser that opens it from a static server sees the machine move, a fault at its place, and what a link
//! holds.

#[path = "../../../workbench/tests/pages/browser.rs"]
mod browser;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use bond_graph::file::{self, Wanted};
use bond_graph::text::Text;
use bond_graph::{faults, serve};
use bond_page::answers::Answerer;
use bond_page::examples;
use serde_json::{Value, json};

fn parsed(answer: &str) -> Value {
    serde_json::from_str(answer).expect("an answer is JSON")
}

/// The text of the example called `name`.
fn text(name: &str) -> String {
    let mut all = examples::all().expect("the sources of this repository").into_iter();
    all.find(|example| example.name == name).expect("there is such an example").text
}

/// The questions of a reader who opens a text, changes it and moves a slider.
fn questions() -> Vec<Value> {
    let first = text("first");
    let order = json!({ "scene": "literal", "parameters": { "length": 0.8 }, "inputs": [], "begin": "model",
        "integration": { "t_end": 1.0, "step": 0.01, "method": "auto", "rtol": 1e-8, "atol": null,
        "fixed_step": 1e-4 } });
    vec![
        json!({ "ask": "report" }),
        json!({ "ask": "check", "text": first }),
        json!({ "ask": "compile", "text": first, "graph": null, "scene": null }),
        json!({ "ask": "report", "t_end": 1.0, "set": { "length": 0.7, "unknown": 1 } }),
        json!({ "ask": "report", "t_end": -1.0 }),
        json!({ "ask": "run", "order": order.to_string() }),
        json!({ "ask": "rate", "count": 2 }),
        json!({ "ask": "check", "text": first.replace("rad = 0.5", "radd = 0.5") }),
        json!({ "ask": "check", "text": "graph A { use \"b.bond\"; }" }),
        json!({ "ask": "check", "text": "(".repeat(300) }),
        json!({ "ask": "words", "text": first }),
        json!({ "ask": "compile", "text": text("slider_crank"), "graph": "Other", "scene": "planar-slider-crank" }),
        json!({ "ask": "report", "t_end": 0.1 }),
        json!({ "ask": "compile", "text": text("hacksaw"), "graph": null, "scene": "motion" }),
        json!({ "ask": "report", "t_end": 0.2 }),
        json!({ "ask": "answer" }),
    ]
}

/// The folder of the page, made once by the program; `None`, and a line that says why, where the target is not
/// installed.
fn site() -> Option<&'static Path> {
    static SITE: OnceLock<Option<PathBuf>> = OnceLock::new();
    let site = SITE.get_or_init(|| {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let folder = place.join("page");
        let output = Command::new(env!("CARGO_BIN_EXE_bond-page"))
            .arg(folder.join("site"))
            // What all WebAssembly here needs is built once.
            .env("CARGO_TARGET_DIR", place.join("webassembly"))
            .output()
            .expect("the program was built");
        let told = String::from_utf8_lossy(&output.stderr);
        if told.contains("rustup target add") {
            println!("skipped: {told}");
            return None;
        }
        assert!(output.status.success(), "{told}");
        Some(folder.join("site"))
    });
    site.as_deref()
}

#[test]
fn faults_are_those_of_the_program() {
    for (before, after) in
        [("rad = 0.5", "radd = 0.5"), ("graph", "grph"), ("rod.end)", "rod.ende)"), ("0.5;", "0.5; é ü;")]
    {
        let text = Text { path: "text".into(), text: text("first").replace(before, after) };
        let found = file::graphs(&text, &Wanted::default()).expect_err("it has faults");
        let program: Vec<Value> = faults::json(&text, &found).lines().map(parsed).collect();
        let answer = parsed(&Answerer::default().answer(&json!({ "ask": "check", "text": text.text }).to_string()));
        assert_eq!(answer["faults"], Value::from(program), "{after}");
        assert_eq!(answer["graphs"], json!([]));
    }
}

#[test]
fn what_is_compiled_can_be_chosen_and_run() {
    let answerer = Answerer::default();
    let answers: Vec<Value> =
        questions().iter().map(|question| parsed(&answerer.answer(&question.to_string()))).collect();
    assert_eq!(answers[0], json!({ "fault": "nothing is compiled" }));
    assert_eq!((&answers[1]["faults"], &answers[1]["chosen"]), (&json!([]), &Value::Null));
    assert_eq!(answers[2]["chosen"], json!(["Pendulum", "literal"]));
    let page = answers[3]["page"].as_str().expect("a page");
    assert!(
        page.contains("<h1>Pendulum</h1>") && page.contains("<b>simulated time</b>1 s") && !page.contains("wall time")
    );
    assert!(page.contains("<td class=\"number\">0.7</td>") && page.contains("<script src=\"report.js\">"), "{page}");
    assert_eq!(page.matches("data-bond=").count(), 23);
    assert!(!page.contains("WebGLRenderer"), "its script is beside it");
    assert_eq!(answers[4], json!({ "fault": "t_end -1: must be a finite number above 0" }));
    assert_eq!(answers[5]["lines"][2], json!(["parameters", "length = 0.8 m"]));
    assert_eq!(answers[6], json!({ "states": 20 }));
    assert_eq!(answers[7]["faults"][0]["code"], "BG0301");
    assert!(answers[8]["faults"][0]["message"].is_string(), "a text alone uses no files: {}", answers[8]);
    assert!(answers[9]["faults"][0]["message"].as_str().unwrap().contains("more than 200 deep"));
    let words = answers[10]["words"].as_array().expect("words");
    let word = |block: Value, word: &str| {
        let found = words.iter().find(|one| one["block"] == block && one["word"] == word);
        let [from, to] = [0, 1].map(|end| found.expect(word)["bytes"][end].as_u64().unwrap() as usize);
        text("first")[from..to].to_owned()
    };
    assert_eq!(word(json!("a joint"), "stiffness"), "stiffness");
    assert_eq!(
        (word(Value::Null, "rotation_z"), word(json!("a graph"), "param")),
        ("rotation_z".into(), "param".into())
    );
    assert_eq!(answers[11]["chosen"], json!(["SliderCrank", "planar-slider-crank"]), "a graph that is there");
    assert!(answers[12]["page"].as_str().expect("a page").contains("<h1>SliderCrank: PlanarSliderCrank</h1>"));
    assert!(answers[14]["page"].as_str().expect("a page").contains("<h1>Hacksaw: Motion</h1>"));
    assert!(answers[15]["fault"].as_str().unwrap().starts_with("the question cannot be read: "));
}

#[test]
fn webassembly_gives_the_bits_that_the_native_compiler_gives() {
    if !Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success()) {
        println!("skipped: node is not installed");
        return;
    }
    let Some(site) = site() else { return };
    let questions: Vec<String> = questions().iter().map(Value::to_string).collect();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../workbench/page/live.js");
    let mut node = Command::new("node");
    node.arg(script).arg(site.join("bond.wasm")).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut node = node.spawn().expect("node starts");
    node.stdin.take().unwrap().write_all(questions.join("\n").as_bytes()).unwrap();
    let output = node.wait_with_output().unwrap();
    let answers = String::from_utf8(output.stdout).unwrap();
    assert_eq!(answers.lines().count(), questions.len());
    let told = String::from_utf8(output.stderr).unwrap();
    let has_machine_code = |line: &&str| !line.ends_with(" 0 functions of machine code");
    assert!(told.lines().filter(has_machine_code).count() >= 2, "the run of the hacksaw has machine code: {told}");
    let answerer = Answerer::default();
    for (question, answer) in questions.iter().zip(answers.lines()) {
        assert!(answerer.answer(question) == answer, "the answers to {question} differ");
    }
    // What the page opens with is what its compiler gives.
    let first = json!({ "ask": "compile", "text": text("first"), "graph": null, "scene": null });
    let _ = answerer.answer(&first.to_string());
    let page = parsed(&answerer.answer(&json!({ "ask": "report" }).to_string()));
    assert_eq!(page["page"], std::fs::read_to_string(site.join("first.html")).unwrap());
}

#[test]
fn the_module_is_small() {
    let Some(site) = site() else { return };
    let module = std::fs::read(site.join("bond.wasm")).unwrap();
    // As gzip has it, but for its head.
    let packed = miniz_oxide::deflate::compress_to_vec(&module, 9).len();
    println!("{} bytes, {packed} deflated", module.len());
    assert!(packed < 1_500_000, "{packed} bytes");
}

#[test]
fn a_browser_compiles_while_one_types() {
    let Some(browser) = browser::browser() else { return };
    let Some(site) = site() else { return };
    let address = serve::start(site, 0).expect("a free port");
    let visit = browser::visit_address(browser, &format!("{address}?test"), &["--window-size=1200,900"]);
    assert_eq!(visit.console, [""; 0], "nothing is said on the console");
    let (_, rest) = visit.document.split_once("<pre id=\"verdict\" hidden=\"\">").expect("the page has tried itself");
    let text = rest.split_once("</pre>").unwrap().0;
    let verdict = parsed(&text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"));
    println!("{verdict:#}");
    assert_eq!(verdict["faults"], json!([]));
    assert!(verdict["motion_ms"].as_f64().is_some_and(|time| time < 20_000.0), "the machine moves");
    let status = verdict["status"].as_str().unwrap();
    assert!(status.contains("Compiled in ") && status.contains("in machine code"), "{status}");
    assert_eq!((&verdict["title"], &verdict["bonds"]), (&json!("Pendulum"), &json!(23)));
    assert!(verdict["charts"].as_u64().is_some_and(|count| count >= 3));
    assert_eq!(verdict["overflow"], 0, "nothing is wider than the window");
    let told = |word: &str| verdict["told"][word].as_array().expect("what is told").clone();
    let function = told("rotation_z");
    assert_eq!(
        (&function[0], &function[1]),
        (&json!("rotation_z(a)"), &json!("The rotation matrix about the z axis."))
    );
    assert!(function[3].as_str().is_some_and(|example| example.contains("rotation_z(30 deg)")), "{function:?}");
    assert_eq!((told("tilt").len(), &told("tilt")[0]), (2, &json!("tilt, in a joint")));
    // The fault stands where the text has it, and the machine of before is still there.
    assert_eq!((&verdict["marked"], &verdict["old"]), (&json!("radd"), &json!(true)));
    assert!(verdict["fault"].as_str().unwrap().starts_with("4:18 BG0301 `radd`"), "{}", verdict["fault"]);
    // A text of which but a number is another is shown where the one before was.
    assert_eq!((&verdict["corrected"], &verdict["renewed"]), (&json!("0.75"), &json!(true)));
    // A slider runs the model that is compiled here.
    assert_eq!(verdict["changed"], verdict["slid"].to_string());
    assert_eq!((&verdict["followed"]["text"], &verdict["followed"]["end"]), (&json!(true), &json!("1.5")));
    assert!(verdict["followed"]["link"].as_str().unwrap().starts_with("text="));
    let stopped = json!({ "offered": true, "status": "Stopped. The next change compiles again.", "hidden": true });
    assert_eq!(verdict["stopped"], stopped);
    let scenes = (verdict["scenes"].as_u64(), verdict["hacksaw_rate_ms"].as_f64());
    assert!(scenes.0 == Some(7) && scenes.1.is_some_and(|time| time > 0.0), "{verdict}");
}

#[test]
fn the_script_is_what_the_sources_give() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("web");
    let has_node = Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success());
    if !has_node || !folder.join("node_modules").exists() {
        println!("skipped: `npm ci` in {} was not run", folder.display());
        return;
    }
    let output = Command::new("node").current_dir(folder).args(["build.js", "--check"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
