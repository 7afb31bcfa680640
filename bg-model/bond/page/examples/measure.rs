//! How long the page's answers take natively, interpreted: the same questions as those of `web/measure.js`, which asks
//! the module.
//!
//!     cargo run --release -p bond-page --example measure

use std::time::Instant;

use bond_page::answers::Answerer;
use bond_page::examples;
use serde_json::json;

/// Evaluations of the rate.
const COUNT: usize = 100_000;

fn main() {
    let all = examples::all().expect("the sources of this repository");
    for name in ["first", "hacksaw"] {
        let example = all.iter().find(|example| example.name == name).expect("there is such an example");
        let answerer = Answerer::default();
        let asked = |question: serde_json::Value| {
            let begin = Instant::now();
            assert!(!answerer.answer(&question.to_string()).contains("\"fault\""));
            begin.elapsed().as_secs_f64()
        };
        let compile = json!({ "ask": "compile", "text": example.text, "graph": null, "scene": example.scene });
        let compiled = (0..5).map(|_| asked(compile.clone())).fold(f64::INFINITY, f64::min);
        let report = (0..5).map(|_| asked(json!({ "ask": "report" }))).fold(f64::INFINITY, f64::min);
        let rate = (0..5).map(|_| asked(json!({ "ask": "rate", "count": COUNT }))).fold(f64::INFINITY, f64::min);
        let (compiled, report, rate) = (1e3 * compiled, 1e3 * report, 1e9 * rate / COUNT as f64);
        println!(
            "{name}: compiled in {compiled:.0} ms, report in {report:.0} ms, a rate in {rate:.0} ns; least of five"
        );
    }
}
