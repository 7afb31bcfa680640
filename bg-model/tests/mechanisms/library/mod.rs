//! The library of parts, `use gears;`: each part beside a closed form, or beside equations of its own.

mod machines;
mod page;
mod planets;
mod transmissions;

use bg_loaded::{Counted, Interpreted, Wanted, load_wanted};
use bg_model::dynamics::{Dynamics as _, Machine as _};

use super::hand::run;
use super::text::{graphs, model, outputs};

/// A run of a text's only graph: what its outputs are at the end, and how many states it has.
struct Ran {
    names: Vec<&'static str>,
    values: Vec<f64>,
    states: usize,
}

impl Ran {
    /// The output of this name.
    fn of(&self, name: &str) -> f64 {
        let index = self.names.iter().position(|known| *known == name);
        self.values[index.unwrap_or_else(|| panic!("no output {name} of {:?}", self.names))]
    }

    /// Asserts what an output is, to `part` of that or of 1.
    fn is(&self, name: &str, expected: f64, part: f64) {
        let found = self.of(name);
        assert!((found - expected).abs() <= part * expected.abs().max(1.0), "{name} is {found}, not {expected}");
    }
}

/// A graph with these statements, and `use`s before it, after `t_end`.
fn after(t_end: f64, uses: &str, statements: &str) -> Ran {
    of_text(t_end, &format!("{uses} graph Tried {{ {statements} }}"))
}

/// Why there is no model of a graph with these statements: a fault, or a value that cannot be.
fn refused(uses: &str, statements: &str) -> String {
    let wanted = Wanted { scene: &|_| true, counted: Counted::Made, most: None };
    match load_wanted(&format!("{uses} graph Tried {{ {statements} }}"), wanted) {
        Err(faults) => faults[0].to_string(),
        Ok(graphs) => {
            let model = &graphs[0].models[0];
            let values: Vec<f64> = model.description.parameters.iter().map(|parameter| parameter.default).collect();
            let blueprint = model.blueprint.as_ref().expect("it was asked for");
            Interpreted::<f64>::new(blueprint, &values, &[]).map(drop).expect_err("values that cannot be").to_string()
        }
    }
}

/// The graph of a text after `t_end`.
fn of_text(t_end: f64, text: &str) -> Ran {
    let graphs = graphs(text);
    // The graph's literal model, or the scene that stands for it.
    let model = model(&graphs, graphs[0].models[0].description.name, &[]);
    let start = model.start().unwrap_or_else(|error| panic!("{error}"));
    let finish = run(&*model, &start, t_end);
    let names = model.description().outputs.iter().map(|output| output.name).collect();
    let values = outputs(&*model, finish.t, finish.x.as_slice(), &finish.negative);
    Ran { names, values, states: model.states() }
}
