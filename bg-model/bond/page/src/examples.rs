//! The examples that the page offers.
//!
//! In: sources of this repository. Out: the text of each, as it stands in a `.bond` file, and the run that it is for.

use std::collections::BTreeMap;
use std::path::Path;

use bg_gallery::example::Example;
use bg_loaded::macro_calls;
use proc_macro2::{Group, LexError};
use serde::Serialize;

/// An example.
#[derive(Debug, Default, Serialize)]
pub struct Offered {
    /// Its name in a link.
    pub name: String,
    /// What it is.
    pub title: String,
    /// What to look at; may have code between backticks.
    pub about: String,
    /// The scene that is shown first; empty: the one that stands for the graph.
    pub scene: String,
    /// The end of the run, s, and the interval of its rows, where they are not the usual ones.
    pub t_end: Option<f64>,
    /// The interval of the rows, s.
    pub step: Option<f64>,
    /// Inputs that are not 0.
    pub inputs: BTreeMap<String, f64>,
    /// The text.
    pub text: String,
}

/// The pendulum of `bond new`.
const FIRST: &str = include_str!("../../src/first.bond");

/// Mechanisms with loops and contacts, examples of the program `bond`: names, titles, what to look at, texts.
const MECHANISMS: [[&str; 4]; 8] = [
    [
        "governor",
        "A Watt governor",
        "Look at `lift`: as the spindle turns faster the arms swing out and raise the sleeve.",
        include_str!("../../examples/governor.bond"),
    ],
    [
        "spatial_slider_crank",
        "A slider-crank in space",
        "The crank turns about x, the slider goes along x; the rod is on a ball and a universal joint.",
        include_str!("../../examples/spatial_slider_crank.bond"),
    ],
    [
        "double_wishbone",
        "A double wishbone",
        "Look at `steered`: the wheel turns a little as it goes up and down.",
        include_str!("../../examples/double_wishbone.bond"),
    ],
    [
        "stewart_platform",
        "A Stewart platform",
        "Six legs and a plate: thirteen bodies in five loops. Move the sliders `rise` and `spin`.",
        include_str!("../../examples/stewart_platform.bond"),
    ],
    [
        "planetary",
        "A planetary gear set",
        "Gears of the library between bodies: look at `carrier`, 0.3 of `sun`, and at the marks on the planets.",
        include_str!("../../examples/planetary.bond"),
    ],
    [
        "geneva",
        "A Geneva wheel",
        "Look at `wheel`: a pin between walls takes it on by a quarter, and the drum holds it until the next one.",
        include_str!("../../examples/geneva.bond"),
    ],
    [
        "ball_on_plate",
        "A ball on a plate",
        "Look at `x` and `z`: the plate tilts so that the ball rolls to its middle.",
        include_str!("../../examples/ball_on_plate.bond"),
    ],
    [
        "ball_balancer",
        "An inverted pendulum on a ball",
        "Look at `lean_x` and `x`: to stand upright the frame first goes after the way it falls, then back.",
        include_str!("../../examples/ball_balancer.bond"),
    ],
];

/// All examples; the first is the one that the page opens with.
///
/// # Errors
/// A file that cannot be read, or has no text: a sentence.
pub fn all() -> Result<Vec<Offered>, String> {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    let first = Offered {
        name: "first".to_owned(),
        title: "A first pendulum".to_owned(),
        about: "Change a number. The pendulum swings on a pin, whose force is an output.".to_owned(),
        text: FIRST
            .replace("// A pendulum on a compliant pin. Change a number, and run it again: bond run FILE\n\n", ""),
        ..Offered::default()
    };
    let hacksaw = Offered {
        name: "hacksaw".to_owned(),
        title: "A power hacksaw".to_owned(),
        about: "The five links of the paper that this project is about. Compiling it takes a moment.".to_owned(),
        scene: "motion".to_owned(),
        text: of_file(&repository.join("hacksaw/hacksaw.bond"))?,
        ..Offered::default()
    };
    let examples = Example::all(&repository.join("bg-model/workbench/examples"))?;
    let offered = examples.iter().map(|example| {
        let text = text(&repository.join(format!("bg-model/workbench/examples/{}.rs", example.name)))?;
        Ok(of_example(example, text))
    });
    let offered: Vec<Offered> = offered.collect::<Result<_, String>>()?;
    let mechanisms = MECHANISMS.map(|[name, title, about, text]| Offered {
        name: name.to_owned(),
        title: title.to_owned(),
        about: about.to_owned(),
        text: text.to_owned(),
        ..Offered::default()
    });
    Ok([first, hacksaw].into_iter().chain(offered).chain(mechanisms).collect())
}

/// An example of the workbench, with the run that its head comment is for; parameters stay at their defaults.
fn of_example(example: &Example, text: String) -> Offered {
    let value = |option: &str| {
        let place = example.arguments.iter().position(|word| word == option)?;
        example.arguments.get(place + 1).cloned()
    };
    let number = |option| value(option).and_then(|text| text.parse().ok());
    let input = value("--input").and_then(|text| {
        let (name, value) = text.split_once('=')?;
        Some((name.to_owned(), value.parse().ok()?))
    });
    Offered {
        name: example.name.clone(),
        title: example.title.clone(),
        about: example.text.clone(),
        scene: value("--scene").unwrap_or_default(),
        t_end: number("--t-end"),
        step: number("--step"),
        inputs: input.into_iter().collect(),
        text,
    }
}

/// What stands in the calls of `bond_graph!` of a Rust file.
fn text(path: &Path) -> Result<String, String> {
    let failed = |fault: &dyn std::fmt::Display| format!("{}: {fault}", path.display());
    let source = of_file(path)?;
    let calls = macro_calls(source.parse().map_err(|fault: LexError| failed(&fault))?);
    let inside = |call: &Group| {
        let [open, close] = [call.span_open().byte_range().end, call.span_close().byte_range().start];
        outdented(&source[open..close])
    };
    let texts: Vec<String> = calls.iter().map(inside).collect();
    if texts.is_empty() { Err(failed(&"has no bond_graph! { .. }")) } else { Ok(texts.join("\n")) }
}

/// A file as it stands.
fn of_file(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|fault| format!("{}: {fault}", path.display()))
}

/// The lines of a block as they stand outside of it.
fn outdented(block: &str) -> String {
    let lines = block.lines().skip_while(|line| line.trim().is_empty());
    let lines: Vec<&str> = lines.map(|line| line.strip_prefix("    ").unwrap_or(line)).collect();
    lines.join("\n").trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_is_a_text_without_faults() {
        let all = all().expect("the sources of this repository");
        assert!(all.len() > 15, "{}", all.len());
        for Offered { name, text, scene, .. } in &all {
            let text = bond_graph::text::Text { path: name.into(), text: text.clone() };
            let counted = bond_graph::text::Counted::Made;
            let wanted = bond_graph::text::Wanted { scene: Some(scene.clone()), counted, most: None };
            let graphs = bond_graph::file::graphs(&text, &wanted).unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
            assert!(!graphs.is_empty(), "{name}");
        }
    }
}
