//! The text of every stage for the models in `stages/`, from Se-1-I to the slider-crank.
//!
//! A model whose stages are short is shown whole; of a mechanism the expanded graph and its causality are shown, whose
//! equations the oracle suite evaluates instead. `README.md` says how the snapshots are renewed.

use std::path::Path;

use bg_compiler::fault::Fault;
use bg_compiler::source::ast::Source;
use bg_compiler::source::syntax;
use bg_compiler::stages::{NAMES, Stage, stages};
use proc_macro2::TokenStream;

/// Every stage.
const WHOLE: [&str; 13] = [
    "se_1_i",
    "mass_spring_damper",
    "rlc",
    "motor",
    "gear",
    "hydraulic",
    "modulated",
    "switching",
    "nonlinear_storage",
    "rigid_gear",
    "divider",
    "friction",
    "bead",
];

/// The names of the stages after the source.
const ALL: [&str; 9] =
    ["expanded", "resolved", "causal", "equations", "projection", "program", "reversed", "jacobian", "elimination"];

/// Every stage but the program, whose lists of values in three dimensions are longer than a reader follows.
const SPATIAL: [&str; 1] = ["free_body"];

/// The graph without its parts.
const PARTS: [&str; 2] = ["trolley", "hanging_chain"];

/// The expanded graph and its causality.
const MECHANISMS: [&str; 7] = ["body", "pendulum", "prismatic", "spring", "drive", "contact", "bearing"];

/// The causality alone: the expanded graph is longer than a reader follows.
const LARGE: [&str; 1] = ["slider_crank"];

fn all() -> impl Iterator<Item = &'static str> {
    WHOLE.into_iter().chain(SPATIAL).chain(PARTS).chain(MECHANISMS).chain(LARGE)
}

fn text(model: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("stages/{model}.bond"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn shown(faults: &[Fault]) -> String {
    let at = |fault: &Fault| (fault.span.start().line, fault.span.start().column + 1);
    faults.iter().map(|fault| format!("{:?}: {fault}\n", at(fault))).collect()
}

fn compiled(text: &str) -> Vec<Stage> {
    stages(tokens(text)).unwrap_or_else(|faults| panic!("{}\n{text}", shown(&faults)))
}

/// The text of one stage of the only graph.
fn stage<'a>(stages: &'a [Stage], name: &str) -> &'a str {
    let mut found = stages.iter().filter(|stage| stage.name == name);
    let text = &found.next().expect("every stage is there").text;
    assert!(found.next().is_none(), "one graph a file");
    text
}

fn snapshot(model: &str, names: &[&str]) {
    let stages = compiled(&text(model));
    let shown: Vec<String> = names.iter().map(|name| format!("== {name}\n{}", stage(&stages, name))).collect();
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(model, shown.join("\n")));
}

#[test]
fn small_models_stage_by_stage() {
    WHOLE.iter().for_each(|model| snapshot(model, &ALL));
    let without_program: Vec<&str> = ALL.into_iter().filter(|name| *name != "program").collect();
    SPATIAL.iter().for_each(|model| snapshot(model, &without_program));
}

#[test]
fn mechanisms_as_bond_graphs() {
    PARTS.iter().for_each(|model| snapshot(model, &["source", "causal"]));
    MECHANISMS.iter().for_each(|model| snapshot(model, &["expanded", "causal"]));
    LARGE.iter().for_each(|model| snapshot(model, &["causal"]));
}

#[test]
fn stages_have_the_names_that_are_listed() {
    let graph = "param k: N/m = 2; Se push = 1; 1 cart: translation; I mass = 3; C spring = k; \
                 push -> cart -> mass; cart -> spring; observe { cart.flow }";
    let scene = compiled(&format!("graph Cart {{ {graph} scene Run {{ observe {{ cart.flow }} }} }}"));
    let names = |model: &str| scene.iter().filter(|stage| stage.graph == model).map(|stage| stage.name).collect();
    let without = |left_out: &[&str]| NAMES.into_iter().filter(|name| !left_out.contains(name)).collect();
    let (literal, reduced): (Vec<&str>, Vec<&str>) = (names("Cart"), names("Run"));
    assert_eq!((literal, reduced), (without(&["reduction", "reduced", "pairs"]), without(&["pairs"])));
    assert!(compiled(&text("slider_crank")).iter().any(|stage| stage.name == "pairs"));
}

#[test]
fn a_snapshot_is_short_enough_to_be_read() {
    for model in all() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("stages/{model}.snap"));
        let lines = std::fs::read_to_string(path).map_or(0, |text| text.lines().count());
        assert!(lines < 400, "{model}: {lines} lines");
    }
}

/// The tree without its spans.
fn bare(source: &Source) -> String {
    let mut text = format!("{source:#?}");
    // A span prints as `bytes(12..15)`, or `Span` inside a visibility.
    while let Some(start) = text.find("bytes(") {
        let end = start + text[start..].find(')').expect("a span's text is closed") + 1;
        text.replace_range(start..end, "_");
    }
    text
}

#[test]
fn the_printed_source_parses_to_the_same_tree() {
    for model in all() {
        let parsed = |text: &str| syntax::parse(tokens(text)).unwrap_or_else(|faults| panic!("{}", shown(&faults)));
        let source = parsed(&text(model));
        let printed = source.to_string();
        let again = parsed(&printed);
        assert_eq!(again.to_string(), printed, "{model}");
        assert_eq!(bare(&again), bare(&source), "{model}");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    for model in all() {
        let text = text(model);
        let once = bg_compiler::compile(tokens(&text)).to_string();
        assert_eq!(bg_compiler::compile(tokens(&text)).to_string(), once, "{model}");
        assert!(!once.contains("compile_error"), "{model}");
        let texts = |stages: Vec<Stage>| stages.into_iter().map(|stage| stage.text).collect::<Vec<_>>();
        assert_eq!(texts(compiled(&text)), texts(compiled(&text)), "{model}");
    }
}

#[test]
fn the_expanded_graph_is_source_with_the_same_equations() {
    for model in all() {
        let first = compiled(&text(model));
        let second = compiled(stage(&first, "expanded"));
        for name in ALL {
            assert_eq!(stage(&second, name), stage(&first, name), "{model}: {name}");
        }
    }
}

/// The order of the chains and of what stands between them is the reader's affair; the values are not concerned, only
/// the order of sums. The equations are compared as sets of lines.
#[test]
fn the_order_of_the_chains_changes_no_stroke() {
    // In the divider's loop either resistor may give the effort: that is the first bond's choice.
    for model in all().filter(|model| *model != "divider") {
        let mut source = syntax::parse(tokens(&text(model))).expect("the model is valid");
        let before = compiled(&source.to_string());
        let items = &mut source.graphs[0].items;
        let (mut chains, others): (Vec<_>, Vec<_>) =
            items.drain(..).partition(|item| matches!(item, bg_compiler::source::ast::Item::Chain(_)));
        chains.reverse();
        items.extend(others);
        items.extend(chains);
        let after = compiled(&source.to_string());
        let lines = |stages: &[Stage]| {
            let mut lines: Vec<String> = stage(stages, "causal").lines().map(str::to_owned).collect();
            lines.sort_unstable();
            lines
        };
        assert_eq!(lines(&after), lines(&before), "{model}");
    }
}
