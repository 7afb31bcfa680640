//! Causal strokes: which end of every bond receives the effort.
//!
//! In: [`BondGraph`]. Out: [`CausalGraph`]. No longer occurs: a bond without a stroke.
//! Method: the sequential causality assignment procedure (SCAP) of Karnopp and Rosenberg: sources first, then laws that
//! work one way only, then storages in integral causality in the order of declaration, then whatever is left; each
//! assignment is propagated as far as it implies others (`procedure`). What is left is a choice; it is the first one,
//! in the order of the bonds, that leaves a valid assignment of the rest (`completion`). A storage that cannot have
//! integral causality has derivative causality: others determine its state.

mod completion;
mod fault;
mod matching;
mod procedure;
#[cfg(test)]
mod tests;
mod wish;

use std::collections::BTreeSet;

use crate::fault::Staged;
use crate::graph::{BondGraph, BondId, ElementKind, NodeId, NodeKind};

pub use fault::CausalFault;

/// An end of a bond.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum End {
    /// Where the half arrow starts.
    From,
    /// Where it points.
    To,
}

impl End {
    /// The other end.
    fn opposite(self) -> Self {
        match self {
            Self::From => Self::To,
            Self::To => Self::From,
        }
    }
}

/// A graph whose every bond has its causal stroke.
#[derive(Clone, Debug)]
pub struct CausalGraph {
    /// The graph.
    pub graph: BondGraph,
    /// For every bond the end with the stroke: it receives the effort and determines the flow.
    pub strokes: Vec<End>,
    /// The storages in derivative causality.
    pub derivative: BTreeSet<NodeId>,
    /// For every junction its strong bond.
    strong: Vec<Option<BondId>>,
}

impl CausalGraph {
    /// The strong bond of a junction: the one that determines the common variable.
    #[must_use]
    pub fn strong_bond(&self, node: NodeId) -> Option<BondId> {
        self.strong[node.0]
    }
}

/// Assigns every stroke.
///
/// # Errors
/// Causal conflicts, laws that would have to work the wrong way, storages in derivative causality where the graph
/// expects none: each that is left when those before it have given way.
pub fn assign(graph: BondGraph) -> Staged<CausalGraph> {
    let (strokes, strong) = procedure::run(&graph)?;
    let nodes = (0..graph.nodes.len()).map(NodeId);
    let is_storage = |node: NodeId| {
        graph.element(node).is_some_and(|element| matches!(element.kind, ElementKind::I | ElementKind::C))
    };
    let dependent = nodes.filter(|&node| is_storage(node) && !wish::has_its_wish(&graph, &strokes, node));
    let derivative = dependent.collect();
    Ok(CausalGraph { graph, strokes, derivative, strong })
}

fn end_at(graph: &BondGraph, bond: BondId, node: NodeId) -> End {
    if graph.bond(bond).to == node { End::To } else { End::From }
}

fn is_junction(graph: &BondGraph, node: NodeId) -> bool {
    graph.element(node).is_none()
}

/// The stroke with which a bond determines a junction's common variable: a 0-junction receives effort from exactly one
/// bond, a 1-junction flow from exactly one.
fn strong_end(graph: &BondGraph, node: NodeId, bond: BondId) -> End {
    let here = end_at(graph, bond, node);
    if matches!(graph.node(node).kind, NodeKind::Zero) { here } else { here.opposite() }
}

/// What a stroke on one bond of a two-port implies for the other.
fn across(graph: &BondGraph, node: NodeId, bond: BondId, stroke: End) -> Option<(BondId, End)> {
    let kind = graph.element(node)?.kind;
    let other = *graph.node(node).bonds.iter().find(|&&candidate| candidate != bond)?;
    if !kind.is_two_port() {
        return None;
    }
    let received = stroke == end_at(graph, bond, node);
    let gyrator = matches!(kind, ElementKind::Gy | ElementKind::Mgy);
    // A transformer hands the effort through, a gyrator turns it into a flow.
    let here = end_at(graph, other, node);
    Some((other, if received == gyrator { here } else { here.opposite() }))
}
