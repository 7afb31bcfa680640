//! The graph of a scene as a picture.
//!
//! In: a description. Out: the tables that `bg-picture` draws, with the same indices of elements and bonds.

use std::collections::BTreeMap;

use bg_model::description::{BondEnd, Description};
use bg_picture::{Bond, End, Graph, Node, Part};

/// How much of a graph is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(not(target_arch = "wasm32"), derive(clap::ValueEnum))]
pub enum Level {
    /// One box for each body, joint, spring, contact and drive
    Words,
    /// Every junction and element
    #[default]
    Full,
}

impl From<Level> for bg_picture::Level {
    fn from(level: Level) -> Self {
        match level {
            Level::Words => Self::Words,
            Level::Full => Self::Full,
        }
    }
}

/// The whole graph of a description as an SVG text.
#[must_use]
pub fn svg(description: &Description) -> String {
    bg_picture::svg(&graph(description), bg_picture::Level::Full)
}

/// The graph of a description.
#[must_use]
pub fn graph(description: &Description) -> Graph {
    let Description { name, parts, elements, bonds, states, .. } = description;
    let nodes: BTreeMap<&str, usize> =
        elements.iter().enumerate().map(|(index, element)| (element.name, index)).collect();
    let node = |element: &bg_model::description::ElementInfo| Node {
        kind: element.kind.to_owned(),
        name: element.name.to_owned(),
        law: element.law.to_owned(),
        states: states
            .iter()
            .filter(|state| state.element == element.name)
            .map(|state| bg_picture::quantity(state.name, state.unit))
            .collect(),
        part: parts.iter().position(|part| part.name == element.part),
    };
    let bond = |bond: &bg_model::description::BondInfo| {
        Some(Bond {
            from: *nodes.get(bond.from)?,
            to: *nodes.get(bond.to)?,
            cardinality: bond.cardinality,
            stroke: match bond.stroke {
                BondEnd::From => End::From,
                BondEnd::To => End::To,
            },
            effort: bond.effort.to_owned(),
            flow: bond.flow.to_owned(),
        })
    };
    Graph {
        name: (*name).to_owned(),
        parts: parts.iter().map(|part| Part { word: part.word.to_owned(), name: part.name.to_owned() }).collect(),
        nodes: elements.iter().map(node).collect(),
        bonds: bonds.iter().filter_map(bond).collect(),
    }
}
