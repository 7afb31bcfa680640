//! Compiled for WebAssembly: compares functions in machine code with the interpreter's, for a test that asks it
//! (`tests/webassembly.rs`).
//!
//! In: a text, as JSON, or `null`. Out: how many models of the text can start, and how many programs of theirs are
//! machine code; of random programs, how many have pairs of operations. A bit that differs is a trap.

#[path = "../../../tests/loaded/functions.rs"]
mod functions;
#[path = "../native/tests/programs/random.rs"]
mod random;

use std::rc::Rc;
use std::sync::Arc;

use bg_loaded::{BackEnd, Blueprint, Interpreted, load};
use bg_model::dynamics::Machine;
use bg_model::input::Input;
use bg_model::integrator::Integrator;
use functions::{Compared, same_functions, same_runs};

fn main() {
    bg_live::register(|question| {
        let question: Option<String> = serde_json::from_str(question).expect("JSON");
        match question {
            Some(text) => format!("{:?}", of_text(&text)),
            None => random::compare().paired.to_string(),
        }
    });
}

/// How many models of a text can start, and how many of their programs are machine code.
fn of_text(text: &str) -> [usize; 2] {
    let graphs = load(text).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let blueprints = graphs.into_iter().flat_map(|graph| graph.models).filter_map(|model| model.blueprint);
    let counts: Vec<[usize; 2]> = blueprints.map(|blueprint| of_model(&blueprint)).collect();
    [0, 1].map(|which| counts.iter().map(|count| count[which]).sum())
}

fn of_model(blueprint: &Arc<Blueprint>) -> [usize; 2] {
    let description = blueprint.description();
    let values: Vec<f64> = description.parameters.iter().map(|parameter| parameter.default).collect();
    let inputs: Vec<Input> = (1..=description.inputs.len()).map(|k| Input::constant(0.7 * k as f64)).collect();
    let machine = |back_end| -> Rc<dyn Machine> {
        Rc::new(Interpreted::<f64>::new(blueprint, &values, &inputs).expect("defaults are possible").by(back_end))
    };
    let (interpreted, machine_code) = (machine(BackEnd::Interpreter), machine(BackEnd::MachineCode { after: 0 }));
    same_functions(&*interpreted, &*machine_code, Compared::Exactly);
    same_runs(&interpreted, &machine_code, Integrator::Auto, Compared::Exactly);
    [usize::from(interpreted.start().is_ok()), blueprint.translate()]
}
