//! Mechanisms of a text, compiled where the tests run and interpreted: rustc has no code of theirs to compile.

use std::fs;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use bg_loaded::{Counted, Graph, Interpreted, Wanted, load_wanted};
use bg_model::dynamics::Machine;

/// The graphs of a text with their models.
pub fn graphs(text: &str) -> Vec<Graph> {
    let wanted = Wanted { scene: &|_| true, counted: Counted::Made, most: None };
    load_wanted(text, wanted).unwrap_or_else(|faults| panic!("{}", faults[0]))
}

/// The graph or scene of this name with these values of parameters, the others as they are by default.
pub fn model(graphs: &[Graph], name: &str, values: &[(&str, f64)]) -> Rc<Interpreted> {
    let mut models = graphs.iter().flat_map(|graph| &graph.models);
    let model = models.find(|model| model.description.name == name).unwrap_or_else(|| panic!("no model `{name}`"));
    let table = model.description.parameters;
    let mut all: Vec<f64> = table.iter().map(|parameter| parameter.default).collect();
    for (name, value) in values {
        let index = table.iter().position(|parameter| parameter.name == *name);
        all[index.unwrap_or_else(|| panic!("no parameter `{name}`"))] = *value;
    }
    let blueprint = model.blueprint.as_ref().expect("all models were asked for");
    Rc::new(Interpreted::new(blueprint, &all, &[]).unwrap_or_else(|error| panic!("{error}")))
}

/// The outputs of a model in these branches.
pub fn outputs(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<f64> {
    let mut y = vec![0.0; model.description().outputs.len()];
    model.outputs(t, x, negative, &mut y);
    y
}

/// A file of the tests.
pub fn file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The text at `path`, which is `expected` unless it is to be made anew.
pub fn held(path: &Path, expected: &str) {
    if std::env::var_os("RENEW").is_some() {
        fs::write(path, expected).expect("a file to write");
    }
    let found = fs::read_to_string(path).expect("a text");
    let differs = found.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    assert!(found == expected, "{} differs, first {differs:?}: RENEW=1 writes it anew", path.display());
}

/// What is said of a text.
pub fn said(text: &str) -> String {
    let wanted = Wanted { scene: &|_| true, counted: Counted::Made, most: None };
    match load_wanted(text, wanted) {
        Ok(_) => "nothing: no fault\n".to_owned(),
        Err(faults) => {
            faults.iter().map(|fault| format!("[{}] {}; {}\n", fault.code, fault.message, fault.help)).collect()
        }
    }
}
