//! The files of the page.
//!
//! In: a folder. Out: what a static server needs to show the page from there: the page with its script and style, the
//! report's, the examples, and the compiler as a WebAssembly module, which cargo builds.

use std::path::Path;

use bg_loaded::functions::{FUNCTIONS, Function};
use bg_loaded::vocabulary::{self, Word};
use bg_workbench::live::Module;
use bg_workbench::page::BESIDE;
use serde_json::{Map, Value, json};

use crate::answers::Answerer;
use crate::examples::{self, Offered};

/// The texts of the page itself, by their names.
const TEXTS: [(&str, &str); 5] = [
    ("index.html", include_str!("../web/index.html")),
    ("page.css", include_str!("../web/dist/page.css")),
    ("page.js", include_str!("../web/dist/page.js")),
    ("compiler.js", include_str!("../web/dist/compiler.js")),
    ("THIRD-PARTY.txt", include_str!("../web/dist/THIRD-PARTY.txt")),
];
/// The compiler.
pub const MODULE: &str = "bond.wasm";
/// The examples.
const EXAMPLES: &str = "examples.json";
/// What is told of the language's words and functions.
const WORDS: &str = "words.json";
/// The report of the first example, with which the page opens before its compiler is there: the bytes that this gives.
const FIRST: &str = "first.html";

/// What is made small rather than fast, since it does not run once for each step, and how: a third of the whole module.
const SMALL: [(&str, &str); 22] = [
    ("bg-analysis", "z"),
    ("bg-compiler", "z"),
    // What a compilation calculates with: at "s" a compilation takes a sixth less, the module 2 % more.
    ("bg-expressions", "z"),
    ("bg-loaded", "s"),
    ("bg-native", "z"),
    ("bg-picture", "z"),
    ("bg-units", "z"),
    ("bg-workbench", "z"),
    ("bond-graph", "z"),
    ("csv", "z"),
    ("csv-core", "z"),
    ("proc-macro2", "z"),
    ("quote", "z"),
    ("serde_json", "z"),
    ("strsim", "z"),
    ("syn", "z"),
    ("toml", "z"),
    ("toml_datetime", "z"),
    ("toml_parser", "z"),
    ("toml_writer", "z"),
    ("wasm-encoder", "z"),
    ("winnow", "z"),
];

/// Builds the module and writes all files; gives a sentence that says so.
///
/// # Errors
/// The module cannot be built, a file not be written: a sentence.
pub fn write(folder: &Path) -> Result<String, String> {
    let small = SMALL.map(|(package, level)| format!("profile.release.package.{package}.opt-level = \"{level}\""));
    let module = Module::Built.wasm_with(0, &small).map_err(|fault| fault.to_string())?;
    let examples = examples::all()?;
    let first = report(&examples[0])?;
    let examples = serde_json::to_string(&examples).expect("texts and numbers");
    std::fs::create_dir_all(folder).map_err(|fault| format!("cannot make {}: {fault}", folder.display()))?;
    let texts = TEXTS.into_iter().chain(BESIDE).map(|(name, text)| (name, text.as_bytes()));
    let words = words().to_string();
    let made =
        [(MODULE, &module[..]), (EXAMPLES, examples.as_bytes()), (WORDS, words.as_bytes()), (FIRST, first.as_bytes())];
    for (name, bytes) in texts.chain(made) {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|fault| format!("cannot write {}: {fault}", path.display()))?;
    }
    let folder = folder.display();
    Ok(format!("written: {folder}; put it on a static server, or open it by: bond serve --page {folder}"))
}

/// What is told of words, by their blocks, and of functions, by their names.
fn words() -> Value {
    let word = |Word { word, of, meaning }: &Word| json!({ "word": word, "of": of, "meaning": meaning });
    let function = |function: &Function| {
        let Function { name, meaning, units, example, .. } = function;
        let told =
            json!({ "head": function.calls().join("\n"), "meaning": meaning, "units": units, "example": example });
        ((*name).to_owned(), told)
    };
    let functions: Map<String, Value> = FUNCTIONS.iter().map(function).collect();
    json!({ "words": vocabulary::WORDS.iter().map(word).collect::<Vec<_>>(), "functions": functions })
}

/// The report of an example, as the page's own compiler gives it.
fn report(example: &Offered) -> Result<String, String> {
    let Offered { text, scene, t_end, step, inputs, .. } = example;
    let answerer = Answerer::default();
    let _ = answerer.answer(&json!({ "ask": "compile", "text": text, "graph": null, "scene": scene }).to_string());
    let run = json!({ "ask": "report", "t_end": t_end, "step": step, "inputs": inputs });
    let answer: Value = serde_json::from_str(&answerer.answer(&run.to_string())).expect("answers are JSON");
    answer["page"].as_str().map(str::to_owned).ok_or_else(|| answer["fault"].to_string())
}
