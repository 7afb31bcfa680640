//! What a scene consists of, as text for the terminal: its report, its graph, its tables.
//!
//! In: a scene. Out: text, from the description that the compiler left in the scene's type.

use bg_model::description::{BondEnd, Description, OperationCount, ParameterInfo, StateInfo};
use clap::ValueEnum;

use crate::ask::parameters::number;
use crate::ask::scenes::Scene;
pub use crate::files::table::table;

/// A part of what a scene consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ScenePart {
    /// The graph in bond-graph words: what the mechanism words stand for
    Source,
    /// Junctions and elements with their laws
    Elements,
    /// Bonds with their causal strokes: a ->| b has its stroke at b, which receives the effort and gives the flow
    Bonds,
    /// States with unit and storage
    States,
    /// The equations of the bonds and of the states, in the order of evaluation
    Equations,
    /// The operations of every generated function
    Operations,
}

/// One line for each scene: states, operations of a rate evaluation, what it is.
#[must_use]
pub fn scenes(scenes: &[Scene]) -> String {
    let head = ["scene", "states", "operations a rate", ""].map(str::to_owned);
    let rows = scenes.iter().map(|Scene { name, description, .. }| {
        let operations = rate_operations(description).total();
        [name.clone(), description.states.len().to_string(), operations.to_string(), one_line(description.doc)]
    });
    table(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}

/// What became of the literal model in this scene, and why: counts, then state by state; the adjustable parameters; the
/// states that are left. `table` are the parameters of the literal model.
#[must_use]
pub fn scene(scene: &Scene, table: &[ParameterInfo]) -> String {
    let description = scene.description;
    let mut text = format!("scene {}: {}\n\n", scene.name, one_line(description.doc));
    if description.reduction.is_empty() {
        let (states, operations) = (description.states.len(), rate_operations(description).total());
        text += &format!("{states} states, {operations} operations a rate: nothing is left out\n");
    } else {
        text += description.reduction.trim_end();
        text += "\n";
    }
    let (kept, fixed): (Vec<_>, Vec<_>) = table.iter().partition(|parameter| scene.adjusts(parameter.name));
    let kept: Vec<_> = kept.iter().map(|parameter| parameter.name.to_owned()).collect();
    let fixed: Vec<_> = fixed
        .iter()
        .map(|fixed| format!("{} = {} {}", fixed.name, number(fixed.default), fixed.unit).trim_end().to_owned())
        .collect();
    text += &format!("\nAdjustable parameters:\n{}", listed(&kept));
    text += &format!("\nFixed parameters:\n{}", listed(&fixed));
    let outputs: Vec<_> = description.outputs.iter().map(|output| output.name.to_owned()).collect();
    text += &format!("\nOutputs:\n{}", listed(&outputs));
    text + &format!("\nStates of the scene:\n{}", states(description.states))
}

/// A part of the scene's graph; without one, an overview: the counts, the states and the operations.
#[must_use]
pub fn graph(scene: &Scene, part: Option<ScenePart>) -> String {
    let description = scene.description;
    match part {
        Some(ScenePart::Source) => description.graph.trim_end().to_owned() + "\n",
        Some(ScenePart::Elements) => elements(description),
        Some(ScenePart::Bonds) => bonds(description),
        Some(ScenePart::States) => states(description.states),
        Some(ScenePart::Equations) => description.equations.iter().map(|line| format!("{line}\n")).collect(),
        Some(ScenePart::Operations) => operations(description),
        None => overview(&scene.name, description),
    }
}

fn overview(scene: &str, description: &Description) -> String {
    let mut kinds: Vec<(&str, usize)> = Vec::new();
    for element in description.elements {
        match kinds.iter_mut().find(|(kind, _)| *kind == element.kind) {
            Some((_, count)) => *count += 1,
            None => kinds.push((element.kind, 1)),
        }
    }
    let kinds: Vec<_> = kinds.iter().map(|(kind, count)| format!("{kind}: {count}")).collect();
    let multibonds = description.bonds.iter().filter(|bond| bond.cardinality > 1).count();
    format!(
        "graph {} (scene {}): {}\n\n\
         {} junctions and elements ({})\n{} bonds, {multibonds} of them multibonds; {} equations\n\n\
         States:\n{}\nOperations:\n{}\nMore: --part source, elements, bonds or equations\n",
        description.name,
        scene,
        one_line(description.doc),
        description.elements.len(),
        kinds.join(", "),
        description.bonds.len(),
        description.equations.len(),
        states(description.states),
        operations(description)
    )
}

fn elements(description: &Description) -> String {
    let row = |kind: &str, name: &str, law: &str| [kind, name, law].map(str::to_owned);
    table(&description.elements.iter().map(|element| row(element.kind, element.name, element.law)).collect::<Vec<_>>())
}

fn bonds(description: &Description) -> String {
    let rows = description.bonds.iter().map(|bond| {
        let stroke = match bond.stroke {
            BondEnd::From => "|->",
            BondEnd::To => "->|",
        };
        let cardinality = if bond.cardinality == 1 { String::new() } else { format!("[{}]", bond.cardinality) };
        let power = format!("effort {}, flow {}", bond.effort, bond.flow);
        [bond.from.to_owned(), stroke.to_owned(), bond.to.to_owned(), cardinality, power]
    });
    table(&rows.collect::<Vec<_>>())
}

fn states(states: &[StateInfo]) -> String {
    let head = ["", "state", "unit", "storage"].map(str::to_owned);
    let rows = states
        .iter()
        .enumerate()
        .map(|(index, state)| [index.to_string(), state.name.into(), state.unit.into(), state.kind.storage().into()]);
    table(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}

fn operations(description: &Description) -> String {
    let head = ["function", "all", "additions", "multiplications", "divisions", "functions", "choices"];
    let rows = description.operations.iter().map(|(function, count)| {
        let OperationCount { additions, multiplications, divisions, functions, choices } = *count;
        let counts = [count.total(), additions, multiplications, divisions, functions, choices];
        let [all, additions, multiplications, divisions, functions, choices] = counts.map(|count| count.to_string());
        [(*function).to_owned(), all, additions, multiplications, divisions, functions, choices]
    });
    table(&std::iter::once(head.map(str::to_owned)).chain(rows).collect::<Vec<_>>())
}

/// The operations of one evaluation of the rate.
#[must_use]
pub fn rate_operations(description: &Description) -> OperationCount {
    description.operations.iter().find(|(function, _)| *function == "rate").map_or_else(Default::default, |(_, c)| *c)
}

/// Names in lines of a readable length.
fn listed(names: &[String]) -> String {
    // The width of a terminal with room for the indent.
    const WIDTH: usize = 100;
    if names.is_empty() {
        return "  none\n".to_owned();
    }
    let mut text = String::new();
    let mut line = String::new();
    for (index, name) in names.iter().enumerate() {
        let comma = if index + 1 < names.len() { "," } else { "" };
        if line.len() + name.len() > WIDTH {
            text += &format!(" {line}\n");
            line.clear();
        }
        line += &format!(" {name}{comma}");
    }
    text + &format!(" {line}\n")
}

pub(super) fn one_line(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_and_end_without_blanks() {
        let rows = [["a", "1"], ["long", "12"], ["1", ""]].map(|row| row.map(str::to_owned));
        assert_eq!(table(&rows), "  a      1\n  long  12\n  1\n");
    }
}
