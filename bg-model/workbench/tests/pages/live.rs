//! A live page: the model inside gives the bits that it gives natively, in node and, after a move of a slider, in a
//! browser.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use crate::browser;
use crate::example::program;
use crate::pendulum::Pendulum;
use bg_workbench::{Program, live};
use serde_json::{Value, json};

bg_model::bond_graph! {
    /// A mass that is pushed.
    pub graph Pushed {
        input force: N;
        input other: N;
        1 slide: translation; I body = 2; Se push = force + other; push -> slide -> body;
        observe { v: m/s = slide.flow }
    }
}

/// What a report of 2 s orders, with this length of the rod, m.
fn order(length: f64) -> String {
    let integration =
        json!({ "t_end": 2.0, "step": 0.01, "method": "auto", "rtol": 1e-8, "atol": null, "fixed_step": 1e-4 });
    let parameters = json!({ "length": length });
    let order = json!({ "scene": "literal", "parameters": parameters, "inputs": [], "integration": integration,
        "begin": "model" });
    order.to_string()
}

fn native(order: &str) -> String {
    live::answer(&Program::of::<Pendulum>(), order)
}

fn parsed(answer: &str) -> Value {
    serde_json::from_str(answer).expect("an answer is JSON")
}

/// The live report of the pendulum over 2 s, made once; `None`, and a line that says why, where the target is not
/// installed.
fn page() -> Option<&'static Path> {
    static PAGE: OnceLock<Option<PathBuf>> = OnceLock::new();
    let page = PAGE.get_or_init(|| {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let folder = place.join("live");
        let output = program("pendulum")
            .args(["report", "--live", "--t-end", "2", "--out"])
            .arg(folder.join("out"))
            // What all WebAssembly here needs is built once.
            .env("CARGO_TARGET_DIR", place.join("webassembly"))
            .output()
            .expect("the example was built");
        let told = String::from_utf8_lossy(&output.stderr);
        if told.contains("rustup target add") {
            println!("skipped: {told}");
            return None;
        }
        assert!(output.status.success(), "{told}");
        Some(folder.join("out/pendulum.html"))
    });
    page.as_deref()
}

/// A text of a page between the tags of this script.
fn script<'a>(html: &'a str, id: &str) -> &'a str {
    let (_, rest) = html.split_once(&format!("id=\"{id}\">")).expect("the page has it");
    rest.split_once("</script>").expect("it ends").0
}

/// The module in a page, in a file.
fn module(html: &str) -> tempfile::NamedTempFile {
    use base64::Engine;
    let packed = base64::engine::general_purpose::STANDARD.decode(script(html, "module")).expect("base64");
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&miniz_oxide::inflate::decompress_to_vec(&packed).expect("deflated")).unwrap();
    file
}

#[test]
fn an_answer_says_what_the_run_says_or_why_there_is_none() {
    let answer = parsed(&native(&order(0.8)));
    assert_eq!(answer["lines"][2], json!(["parameters", "length = 0.8 m"]));
    assert!(answer["failure"].is_null() && answer["data"]["times"].as_array().unwrap().len() > 200);
    assert!(!answer["lines"].as_array().unwrap().iter().any(|line| line[0] == "wall time"));
    let fault = |text: &str| parsed(&native(text))["fault"].as_str().expect("there is none").to_owned();
    assert!(fault(&order(-1.0)).contains("length"), "{}", fault(&order(-1.0)));
    assert!(fault("{}").starts_with("the order cannot be read: "));
    assert!(fault(&order(1.0).replace("literal", "other")).ends_with("not that of the scene `other`"));
    assert_eq!(fault(&order(1.0).replace("2.0", "-2.0")), "t_end -2: must be a finite number above 0");
    let early = parsed(&native(&order(0.8).replace("1e-8", "1e-15")));
    assert!(early["fault"].as_str().unwrap().starts_with("rtol 1e-15: must be at least"), "{early}");
}

#[test]
fn an_answer_names_the_inputs_as_the_report_does() {
    let table = json!({ "times": [0.0, 1.0], "values": [4.0, 6.0], "cubic": false,
        "source": { "file": "load.csv", "column": null, "crc32": "0a1b2c3d" } });
    let order = order(0.8).replace("\"length\":0.8", "").replace("\"inputs\":[]", &format!("\"inputs\":[{table}]"));
    let answer = parsed(&live::answer(&Program::of::<Pushed>(), &order));
    let lines = answer["lines"].as_array().unwrap_or_else(|| panic!("{answer}"));
    let expected = [
        json!(["input", "force = load.csv: 2 rows from 0 to 1 s, CRC-32 0a1b2c3d"]),
        json!(["input held", "force = 6 N after the last row at 1 s"]),
        json!(["inputs not given", "other is 0; set it with --input NAME=VALUE or NAME=FILE.csv"]),
    ];
    assert_eq!(lines[3..6], expected);
    // 5 N s until 1 s, 6 N s after that; the mass is 2 kg.
    assert!(lines.iter().any(|line| line[0] == "v" && line[1].as_str().unwrap().starts_with("0 to 5.5,")), "{answer}");
}

#[test]
fn a_model_that_cannot_be_had_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("no.wasm"), "text").unwrap();
    let refused = |argument: &str, rustc: &str| {
        let mut run = program("pendulum");
        run.current_dir(folder.path()).args(["report", argument, "--t-end", "0.1"]).env("RUSTC", rustc);
        let output = run.output().expect("the example was built");
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && told.lines().count() == 1, "{told}");
        assert!(!folder.path().join("out").exists(), "nothing was claimed");
        told
    };
    assert!(refused("--live=no.wasm", "rustc").starts_with("error: --live: no.wasm: not a program of bg-workbench"));
    assert!(refused("--live=absent.wasm", "rustc").starts_with("error: --live: cannot read absent.wasm: "));
    assert!(refused("--live", "no-such-rustc").starts_with("error: --live: no-such-rustc cannot be started: "));
    if cfg!(unix) {
        let told = refused("--live", "true");
        assert!(told.ends_with("is not installed; rustup target add wasm32-unknown-unknown\n"), "{told}");
    }
}

#[test]
fn node_gives_the_bits_that_the_native_program_gives() {
    if !Command::new("node").arg("--version").output().is_ok_and(|output| output.status.success()) {
        println!("skipped: node is not installed");
        return;
    }
    let Some(page) = page() else { return };
    let html = fs::read_to_string(page).unwrap();
    let first = parsed(script(&html, "live"))["order"].to_string();
    let orders = [first.clone(), order(0.8), order(-1.0)];
    let script_of_node = Path::new(env!("CARGO_MANIFEST_DIR")).join("page/live.js");
    let module = module(&html);
    let mut node = Command::new("node");
    node.arg(script_of_node).arg(module.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut node = node.spawn().expect("node starts");
    node.stdin.take().unwrap().write_all(orders.join("\n").as_bytes()).unwrap();
    let output = node.wait_with_output().unwrap();
    let answers = String::from_utf8(output.stdout).unwrap();
    let answers: Vec<&str> = answers.lines().collect();
    assert_eq!(answers.len(), orders.len());
    for (order, answer) in orders.iter().zip(&answers) {
        assert!(native(order) == *answer, "the answers to {order} differ");
    }
    // What the page shows first is what the model in it says.
    assert_eq!(parsed(answers[0])["data"], parsed(script(&html, "data")));
}

#[test]
fn a_browser_follows_a_slider() {
    let Some(browser) = browser::browser() else { return };
    let Some(page) = page() else { return };
    let visit = browser::visit(browser, page, "test", &["--window-size=1000,800"]);
    assert_eq!(visit.console, [""; 0]);
    let verdict = visit.document.split_once("id=\"verdict\"").expect("the page has a verdict").1;
    let verdict = verdict.split_once('>').unwrap().1.split_once("</pre>").unwrap().0;
    let verdict = parsed(&verdict.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"));
    assert_eq!(verdict["faults"], json!([]));
    let moved = &verdict["live"];
    assert_eq!((&moved["name"], moved["fault"].as_str()), (&json!("angle"), Some("")));
    // The slider's value, by the native program.
    let mut order = parsed(script(&fs::read_to_string(page).unwrap(), "live"))["order"].clone();
    order["parameters"]["angle"] = moved["value"].clone();
    let answer = parsed(&native(&order.to_string()));
    let curve = &answer["data"]["charts"][0]["curves"][0];
    assert_eq!(moved["curve"], curve["name"]);
    assert_eq!(moved["last"], *curve["values"].as_array().unwrap().last().unwrap());
    assert!(moved["milliseconds"].as_f64().is_some_and(|time| time < 20_000.0), "{moved}");
}
