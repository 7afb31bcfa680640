//! What a scene consists of, for programs: as JSON.
//!
//! In: a scene. Out: JSON, from the description that the compiler left in the scene's type.

use bg_model::description::{BondEnd, BondInfo, Description, ElementInfo, OperationCount, OutputInfo, StateInfo};
use serde_json::{Map, Value, json};

use super::tables::{ScenePart, one_line, rate_operations};
use crate::ask::parameters;
use crate::ask::scenes::Scene;

/// A scene: its name, what it is, how many states it has, its parameters and outputs with their units.
#[must_use]
pub fn scene(scene: &Scene) -> Value {
    let Scene { name, description, .. } = scene;
    let output = |output: &OutputInfo| json!({ "name": output.name, "unit": output.unit });
    json!({
        "scene": name,
        "doc": one_line(description.doc),
        "states": description.states.len(),
        "operations_a_rate": rate_operations(description).total(),
        "parameters": parameters::json(description.parameters),
        "outputs": description.outputs.iter().map(output).collect::<Vec<_>>(),
    })
}

/// The graph of a scene: all parts of it, each by its name, or one.
#[must_use]
pub fn graph(scene: &Scene, part: Option<ScenePart>) -> Value {
    let description = scene.description;
    let all = [
        ScenePart::Source,
        ScenePart::Elements,
        ScenePart::Bonds,
        ScenePart::States,
        ScenePart::Equations,
        ScenePart::Operations,
    ];
    let wanted = all.into_iter().filter(|one| part.is_none_or(|part| part == *one));
    let head = [("graph", description.name), ("scene", &scene.name)];
    let head = head.into_iter().map(|(key, name)| (key.to_owned(), Value::from(name)));
    head.chain(wanted.map(|part| one(description, part))).collect::<Map<_, _>>().into()
}

fn one(description: &Description, part: ScenePart) -> (String, Value) {
    let (name, value) = match part {
        ScenePart::Source => ("source", description.graph.into()),
        ScenePart::Elements => ("elements", description.elements.iter().map(element).collect()),
        ScenePart::Bonds => ("bonds", description.bonds.iter().map(bond).collect()),
        ScenePart::States => ("states", description.states.iter().map(state).collect()),
        ScenePart::Equations => ("equations", description.equations.iter().copied().collect()),
        ScenePart::Operations => ("operations", description.operations.iter().map(operations).collect()),
    };
    (name.to_owned(), value)
}

fn element(element: &ElementInfo) -> Value {
    json!({ "name": element.name, "kind": element.kind, "law": element.law })
}

/// A bond; its stroke is at the end that receives the effort.
fn bond(bond: &BondInfo) -> Value {
    let stroke = match bond.stroke {
        BondEnd::From => bond.from,
        BondEnd::To => bond.to,
    };
    json!({
        "from": bond.from, "to": bond.to, "cardinality": bond.cardinality, "stroke_at": stroke,
        "effort": bond.effort, "flow": bond.flow,
    })
}

fn state(state: &StateInfo) -> Value {
    json!({ "name": state.name, "unit": state.unit, "storage": state.kind.storage() })
}

fn operations((function, count): &(&'static str, OperationCount)) -> (String, Value) {
    let OperationCount { additions, multiplications, divisions, functions, choices } = *count;
    let counts = json!({
        "all": count.total(), "additions": additions, "multiplications": multiplications, "divisions": divisions,
        "functions": functions, "choices": choices,
    });
    ((*function).to_owned(), counts)
}
