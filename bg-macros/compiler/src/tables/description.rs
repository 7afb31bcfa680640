//! The static description of a model.
//!
//! In: a [`Compiled`]. Out: a [`Description`] with its tables, in the order of `bg_model::description`.

use super::Counted;
use super::drawing::{Drawing, drawing};
use crate::graph::causality::{CausalGraph, End};
use crate::graph::{self, BondGraph, NodeKind};
use crate::pipeline::{Compiled, Derived};
use crate::program::Counts;
use crate::source::mechanism::{self, Part};
use crate::system::equations::{self, Origin, StateEquations};

/// What a model consists of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The model's name.
    pub name: String,
    /// Its documentation.
    pub doc: String,
    /// The graph in bond-graph words.
    pub graph: String,
    /// What became of the states of a scene; empty of a literal graph.
    pub reduction: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its inputs.
    pub inputs: Vec<Input>,
    /// Its states.
    pub states: Vec<State>,
    /// Its outputs.
    pub outputs: Vec<Output>,
    /// Its switches.
    pub switches: Vec<Switch>,
    /// Bodies, joints and parts.
    pub parts: Vec<Named>,
    /// Elements and junctions.
    pub elements: Vec<Element>,
    /// Bonds with their strokes.
    pub bonds: Vec<Bond>,
    /// The equations of the causal graph, one line each.
    pub equations: Vec<String>,
    /// The functions of the running model with their operations.
    pub operations: Vec<(String, Counts)>,
    /// What pictures show.
    pub drawing: Drawing,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its default.
    pub default: f64,
    /// Its documentation.
    pub doc: String,
    /// The values that it may have.
    pub range: Bounds,
}

/// Values that a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lower bound and whether it belongs to the range.
    pub lower: (f64, bool),
    /// The upper bound and whether it belongs to the range.
    pub upper: (f64, bool),
}

/// An input.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its documentation.
    pub doc: String,
}

/// A state.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// What it is.
    pub kind: StateKind,
    /// The element or junction that it belongs to; empty of an integral and of an angle that counts turns.
    pub element: String,
}

/// What a state is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StateKind {
    /// Component of a momentum.
    Momentum(usize),
    /// Component of a displacement.
    Displacement(usize),
    /// Component of a position.
    Position(usize),
    /// Row and column of a rotation matrix.
    Orientation(usize, usize),
    /// An angle.
    Angle,
    /// What a junction has gone.
    Way,
    /// An integral.
    Integral,
}

/// An output.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name with its component's suffix.
    pub name: String,
    /// The name without the suffix.
    pub of: String,
    /// What it observes, as written.
    pub observes: String,
    /// Its unit.
    pub unit: String,
}

/// A switch.
#[derive(Clone, Debug, PartialEq)]
pub struct Switch {
    /// What holds in its first branch, and of whom.
    pub name: String,
    /// The element.
    pub element: String,
    /// The guard as text.
    pub guard: String,
}

/// A body, a joint or a part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// Its word.
    pub word: String,
    /// Its name.
    pub name: String,
}

/// An element or junction.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Its symbol.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Its law; empty of a junction.
    pub law: String,
    /// The part that it is of; empty of none.
    pub part: String,
}

/// A bond.
#[derive(Clone, Debug, PartialEq)]
pub struct Bond {
    /// Where the half arrow comes from.
    pub from: String,
    /// Where it points to.
    pub to: String,
    /// How many components it has.
    pub cardinality: usize,
    /// Whether the stroke is at the end it points to.
    pub stroke_at_end: bool,
    /// The unit of the effort.
    pub effort: String,
    /// The unit of the flow.
    pub flow: String,
}

/// The description of a model.
#[must_use]
pub fn description(model: &Compiled, counted: Counted) -> Description {
    let (causal, equations) = (&model.derived.causal, &model.equations);
    let graph = &causal.graph;
    let parts = mechanism::parts(&model.source);
    Description {
        name: graph.name.text.clone(),
        doc: graph.docs.clone(),
        graph: model.derived.expanded.to_string(),
        reduction: model.reduction.as_ref().map(ToString::to_string).unwrap_or_default(),
        parameters: equations.parameters.iter().map(parameter).collect(),
        inputs: graph.inputs.iter().map(input).collect(),
        states: states(graph, equations),
        outputs: equations.outputs.iter().map(output).collect(),
        switches: switches(equations),
        elements: elements(graph, &parts),
        parts: parts.iter().map(|Part { word, name }| Named { word: word.to_string(), name: name.clone() }).collect(),
        bonds: bonds(causal),
        equations: equations.texts.clone(),
        operations: operations(model, counted),
        drawing: drawing(model),
    }
}

/// What is declared in a graph of which no model is made: its name, parameters and inputs.
#[must_use]
pub fn declared(derived: &Derived) -> Description {
    let graph = &derived.causal.graph;
    Description {
        name: graph.name.text.clone(),
        doc: graph.docs.clone(),
        parameters: derived.equations.parameters.iter().map(parameter).collect(),
        inputs: graph.inputs.iter().map(input).collect(),
        ..Description::default()
    }
}

fn operations(model: &Compiled, counted: Counted) -> Vec<(String, Counts)> {
    let owned = |(name, counts): (&str, Counts)| (name.to_owned(), counts);
    match counted {
        Counted::All => model.costs().into_iter().map(owned).collect(),
        Counted::Made => model.programs.running.costs().map(owned).collect(),
    }
}

/// A parameter with its bounds, infinite where none is given.
#[must_use]
pub fn parameter(of: &graph::Parameter) -> Parameter {
    Parameter {
        name: of.name.text.clone(),
        unit: of.unit.clone(),
        default: of.default,
        doc: of.docs.clone(),
        range: Bounds {
            lower: of.lower.unwrap_or((f64::NEG_INFINITY, false)),
            upper: of.upper.unwrap_or((f64::INFINITY, false)),
        },
    }
}

fn input(of: &graph::Input) -> Input {
    Input { name: of.name.text.clone(), unit: of.unit.clone(), doc: of.docs.clone() }
}

fn output(of: &equations::Output) -> Output {
    let equations::Output { name, of, observes, unit, .. } = of;
    Output { name: name.clone(), of: of.clone(), observes: observes.clone(), unit: unit.clone() }
}

fn states(graph: &BondGraph, equations: &StateEquations) -> Vec<State> {
    let state = |state: &equations::State| State {
        name: state.name.clone(),
        unit: state.unit.clone(),
        kind: state_kind(state.origin),
        element: element_of(graph, state.origin).to_owned(),
    };
    equations.states.iter().map(state).collect()
}

fn switches(equations: &StateEquations) -> Vec<Switch> {
    let switch = |switch: &equations::Switch| Switch {
        name: switch.name(),
        element: switch.element.clone(),
        guard: equations.shown(&equations.pool, switch.guard),
    };
    equations.switches.iter().map(switch).collect()
}

fn elements(graph: &BondGraph, parts: &[Part]) -> Vec<Element> {
    let element = |node: &graph::Node| {
        let part = mechanism::part_of(parts, &node.name.text).map_or("", |part| &parts[part].name);
        let law = if let NodeKind::Element(element) = &node.kind { element.text.as_str() } else { "" };
        Element { kind: node.kind.symbol(), name: node.name.text.clone(), law: law.to_owned(), part: part.to_owned() }
    };
    graph.nodes.iter().map(element).collect()
}

/// The name of the element or junction that a state belongs to; none of an integral or of an angle that counts turns.
pub(crate) fn element_of(graph: &BondGraph, origin: Origin) -> &str {
    let node = match origin {
        Origin::Momentum(node, _) | Origin::Displacement(node, _) | Origin::Way(node) => node,
        Origin::Position(track, _)
        | Origin::Orientation(track, ..)
        | Origin::Angle(track)
        | Origin::Hinge(track, _)
        | Origin::Speed(track, _) => graph.tracks[track].junction,
        Origin::Turn(_) | Origin::Integral(_) | Origin::Memory(_) => return "",
    };
    &graph.node(node).name.text
}

const fn state_kind(origin: Origin) -> StateKind {
    match origin {
        Origin::Momentum(_, component) => StateKind::Momentum(component),
        Origin::Displacement(_, component) => StateKind::Displacement(component),
        Origin::Position(_, axis) => StateKind::Position(axis),
        Origin::Orientation(_, row, column) => StateKind::Orientation(row, column),
        Origin::Angle(_) => StateKind::Angle,
        Origin::Speed(..) => StateKind::Momentum(0),
        Origin::Turn(_) | Origin::Hinge(..) | Origin::Way(_) => StateKind::Way,
        Origin::Integral(_) | Origin::Memory(_) => StateKind::Integral,
    }
}

fn bonds(causal: &CausalGraph) -> Vec<Bond> {
    let graph = &causal.graph;
    let bond = |(bond, stroke): (&graph::Bond, &End)| Bond {
        from: graph.node(bond.from).name.text.clone(),
        to: graph.node(bond.to).name.text.clone(),
        cardinality: bond.cardinality,
        stroke_at_end: matches!(stroke, End::To),
        effort: bond.effort_unit().to_string(),
        flow: bond.flow_unit().to_string(),
    };
    graph.bonds.iter().zip(&causal.strokes).map(bond).collect()
}
