//! Random graphs in machine code beside the interpreter: every function has the same bits, the signs of zeros too.

use std::rc::Rc;

use bg_loaded::load;
use bg_model::input::Input;
use bond_graph_tests::fuzz::{self, Kind};
use bond_graph_tests::linear::draw::{FULL, LOOSE, VECTORS, network};

use super::functions::{Compared, same_functions, same_runs};
use super::{BACK_ENDS, loaded};

/// How many of these texts have models that can start; all of them have equal bits.
fn compared(texts: impl Iterator<Item = String>) -> usize {
    let blueprints = texts.filter_map(|text| load(&text).ok()).flatten().flat_map(|graph| graph.models);
    let compare = |model: bg_loaded::Model| {
        let blueprint = model.blueprint.expect("all scenes were asked for");
        let description = blueprint.description();
        let values: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
        let inputs: Vec<Input> = (1..=description.inputs.len()).map(|k| Input::constant(0.3 * k as f64)).collect();
        let machines = BACK_ENDS.map(|back_end| loaded(&blueprint, &values, &inputs, back_end));
        let [Ok(interpreted), Ok(machine_code)] = machines else { return false };
        same_functions(&*interpreted, &*machine_code, Compared::Exactly);
        same_runs(&interpreted, &machine_code, "taylor".parse().expect("a method"), Compared::Exactly);
        Rc::clone(&interpreted).start().is_ok()
    };
    blueprints.map(compare).filter(|&is_compared| is_compared).count()
}

#[test]
fn linear_graphs() {
    let texts =
        [FULL, VECTORS, LOOSE].into_iter().flat_map(|style| (0..600).map(move |seed| network(seed, style).text()));
    let count = compared(texts);
    assert!(count > 25, "{count}");
}

#[test]
fn graphs_of_the_fuzzer() {
    let texts = |kind: Kind, count: u64| (0..count).map(move |number| kind.input(&[], 1, number));
    let calls = texts(Kind::Network, 300).chain(texts(Kind::Mechanism, 40)).filter_map(|input| match input {
        fuzz::Input::Call(text) => Some(text),
        fuzz::Input::Settings { .. } => None,
    });
    let count = compared(calls);
    assert!(count > 40, "{count}");
}
