//! The documentation of a generated model.
//!
//! In: a [`Compiled`]. Out: markdown: tables of what the model has and what it costs. They stand after the user's own
//! words and the picture of the graph.

use std::fmt::Display;

use crate::graph::{Input, Parameter};
use crate::pipeline::Compiled;
use crate::program::Counts;
use crate::system::equations::StateEquations;

/// The tables of the generated type's documentation. `costs` are the functions with their operations.
pub(super) fn tables(model: &Compiled, costs: &[(&str, Counts)]) -> String {
    let (graph, equations) = (&model.derived.causal.graph, &model.equations);
    let parts = [
        parameters(&equations.parameters),
        inputs(&graph.inputs),
        outputs(equations),
        switches(equations),
        states(equations),
        operations(costs),
        jacobian(model),
    ];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n\n")
}

/// A table under a title; nothing where it has no rows.
fn table<const COLUMNS: usize>(
    title: &str,
    head: [&str; COLUMNS],
    rows: impl Iterator<Item = [String; COLUMNS]>,
) -> String {
    let lines: Vec<String> = rows.map(|row| line(&row)).collect();
    if lines.is_empty() {
        return String::new();
    }
    format!("# {title}\n\n{}\n|{}\n{}", line(&head), "---|".repeat(COLUMNS), lines.join("\n"))
}

fn line(cells: &[impl Display]) -> String {
    let cells = cells.iter().map(|cell| format!(" {cell} |"));
    std::iter::once("|".to_owned()).chain(cells).collect()
}

/// A name as it stands in the source.
fn code(name: &str) -> String {
    format!("`{name}`")
}

/// A documentation comment as one cell of a table.
fn cell(docs: &str) -> String {
    docs.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

fn parameters(of: &[Parameter]) -> String {
    let row = |parameter: &Parameter| {
        let Parameter { name, unit, default, docs, .. } = parameter;
        [code(&name.text), unit.clone(), default.to_string(), range(parameter), cell(docs)]
    };
    table("Parameters", ["name", "unit", "default", "range", "meaning"], of.iter().map(row))
}

/// The range of a parameter as it is declared.
fn range(of: &Parameter) -> String {
    let end = |end: Option<(f64, bool)>, [included, excluded]: [&str; 2]| {
        end.map(|(value, is_included)| format!("{} {value}", if is_included { included } else { excluded }))
    };
    let ends = [end(of.lower, ["at least", "above"]), end(of.upper, ["at most", "below"])];
    ends.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

fn inputs(of: &[Input]) -> String {
    let rows = of.iter().map(|input| [code(&input.name.text), input.unit.clone(), cell(&input.docs)]);
    table("Inputs", ["name", "unit", "meaning"], rows)
}

fn outputs(equations: &StateEquations) -> String {
    let outputs = equations.outputs.iter().enumerate();
    let rows = outputs.map(|(index, output)| [index.to_string(), code(&output.name), output.unit.clone()]);
    table("Outputs", ["index", "name", "unit"], rows)
}

fn switches(equations: &StateEquations) -> String {
    let switches = equations.switches.iter().enumerate();
    let rows = switches.map(|(index, switch)| [index.to_string(), code(&switch.element), code(&switch.condition)]);
    table("Switches", ["index", "of", "first branch if"], rows)
}

fn states(equations: &StateEquations) -> String {
    let rows = equations.states.iter().enumerate().map(|(index, state)| {
        let storage = state.origin.kind().storage().to_owned();
        [index.to_string(), code(&state.name), state.unit.clone(), storage]
    });
    table("States", ["index", "name", "unit", "storage"], rows)
}

fn operations(costs: &[(&str, Counts)]) -> String {
    let rows = costs.iter().map(|(name, counts)| {
        let Counts { additions, multiplications, divisions, functions, choices } = counts;
        let counts = [additions, multiplications, divisions, functions, choices].map(usize::to_string);
        let [additions, multiplications, divisions, functions, choices] = counts;
        [(*name).to_owned(), additions, multiplications, divisions, functions, choices]
    });
    let head = ["function", "additions", "multiplications", "divisions", "functions", "choices"];
    table("Operations", head, rows)
}

fn jacobian(model: &Compiled) -> String {
    let (entries, fill) = (model.jacobian.entries.len(), model.elimination.fill);
    format!(
        "The Jacobian has {entries} entries that are not identically zero; its elimination fills {fill} more places."
    )
}
