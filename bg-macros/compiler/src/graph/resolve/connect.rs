//! Bonds from chains, ports counted, cardinalities made equal along junctions.
//!
//! In: nodes and chains. Out: the bonds of a [`BondGraph`], every node knowing its own.

use std::collections::BTreeMap;

use super::Entity;
use crate::fault::{Fault, near_miss};
use crate::graph::typing::is_junction;
use crate::graph::units::Dimension;
use crate::graph::{Bond, BondGraph, BondId, GraphFault, Law, Node, NodeId, NodeKind};
use crate::source::ast::{ElementKind, Name};

/// The bonds of `chains`; nodes learn theirs.
pub fn bonds(
    graph: &mut BondGraph,
    chains: &[Vec<Name>],
    names: &BTreeMap<String, Entity>,
    junctions: &BTreeMap<NodeId, usize>,
    faults: &mut Vec<Fault>,
) {
    for chain in chains {
        let ends: Vec<Option<NodeId>> = chain.iter().map(|name| node(name, names, faults)).collect();
        for (pair, name) in ends.windows(2).zip(&chain[1..]) {
            if let (Some(from), Some(to)) = (pair[0], pair[1]) {
                if from == to {
                    faults.push(Fault::new(name.span, &GraphFault::SelfBond { name: name.text.clone() }));
                }
                let id = BondId(graph.bonds.len());
                graph.bonds.push(Bond { from, to, cardinality: 1, effort: Dimension::NONE, span: name.span });
                graph.nodes[from.0].bonds.push(id);
                graph.nodes[to.0].bonds.push(id);
            }
        }
    }
    if !faults.is_empty() {
        return;
    }
    ports(graph, faults);
    cardinalities(graph, junctions, faults);
}

fn node(name: &Name, names: &BTreeMap<String, Entity>, faults: &mut Vec<Fault>) -> Option<NodeId> {
    match names.get(&name.text) {
        Some(Entity::Node(id)) => return Some(*id),
        Some(Entity::Several) => {}
        Some(_) => faults.push(Fault::new(name.span, &GraphFault::NotANode { name: name.text.clone() })),
        None => {
            let nodes = names.iter().filter(|(_, entity)| matches!(entity, Entity::Node(_)));
            let near = near_miss(&name.text, nodes.map(|(text, _)| text.as_str())).map(str::to_owned);
            faults.push(Fault::new(name.span, &GraphFault::UnknownName { name: name.text.clone(), near }));
        }
    }
    None
}

fn ports(graph: &mut BondGraph, faults: &mut Vec<Fault>) {
    let mut reordered = Vec::new();
    for (index, node) in graph.nodes.iter().enumerate() {
        match &node.kind {
            NodeKind::Zero | NodeKind::One => {
                if node.bonds.is_empty() {
                    faults.push(Fault::new(node.name.span, &GraphFault::NoBond { name: node.name.text.clone() }));
                }
            }
            NodeKind::Element(element) if element.kind.is_two_port() => {
                match two_port(graph, NodeId(index), node, element.kind) {
                    Ok(ordered) => reordered.push((index, ordered)),
                    Err(fault) => faults.push(fault),
                }
            }
            NodeKind::Element(element) => {
                let count = node.bonds.len();
                if count != 1 {
                    let (symbol, name) = (element.kind.symbol(), node.name.text.clone());
                    faults.push(Fault::new(node.name.span, &GraphFault::OnePortBonds { symbol, name, count }));
                }
            }
        }
    }
    for (index, ordered) in reordered {
        graph.nodes[index].bonds = ordered;
    }
}

/// The bond in and the bond out of a two-port.
fn two_port(graph: &BondGraph, id: NodeId, node: &Node, kind: ElementKind) -> Result<Vec<BondId>, Fault> {
    let inward: Vec<BondId> = node.bonds.iter().copied().filter(|&bond| graph.bond(bond).to == id).collect();
    let outward: Vec<BondId> = node.bonds.iter().copied().filter(|&bond| graph.bond(bond).from == id).collect();
    if let ([bond_in], [bond_out]) = (&inward[..], &outward[..]) {
        return Ok(vec![*bond_in, *bond_out]);
    }
    let (symbol, name) = (kind.symbol(), node.name.text.clone());
    let fault = GraphFault::TwoPortBonds { symbol, name, inward: inward.len(), outward: outward.len() };
    Err(Fault::new(node.name.span, &fault))
}

/// Junctions say their cardinality; two-ports that map component by component hand it on.
fn cardinalities(graph: &mut BondGraph, junctions: &BTreeMap<NodeId, usize>, faults: &mut Vec<Fault>) {
    let mut known: Vec<Option<usize>> = vec![None; graph.bonds.len()];
    for (index, bond) in graph.bonds.iter().enumerate() {
        let (from, to) = (junctions.get(&bond.from), junctions.get(&bond.to));
        if let (Some(&from_cardinality), Some(&to_cardinality)) = (from, to)
            && from_cardinality != to_cardinality
        {
            let name = |id: NodeId| graph.node(id).name.text.clone();
            let fault =
                GraphFault::Cardinality { from: name(bond.from), from_cardinality, to: name(bond.to), to_cardinality };
            faults.push(Fault::new(bond.span, &fault));
        }
        known[index] = from.or(to).copied();
    }
    while let Some((bond, cardinality)) = handed_on(graph, &known) {
        known[bond.0] = Some(cardinality);
    }
    for (bond, cardinality) in graph.bonds.iter_mut().zip(&known) {
        bond.cardinality = cardinality.unwrap_or(1);
    }
    for (index, node) in graph.nodes.iter().enumerate() {
        if let Some((bond_in, bond_out)) = component_wise(graph, NodeId(index)) {
            let (inward, outward) = (graph.bond(bond_in).cardinality, graph.bond(bond_out).cardinality);
            if inward != outward {
                let name = |id: NodeId| graph.node(id).name.text.clone();
                let fault = GraphFault::Cardinality {
                    from: name(graph.bond(bond_in).from),
                    from_cardinality: inward,
                    to: name(graph.bond(bond_out).to),
                    to_cardinality: outward,
                };
                faults.push(Fault::new(node.name.span, &fault));
            }
        }
    }
}

/// A bond whose cardinality follows from its neighbour's through a two-port.
fn handed_on(graph: &BondGraph, known: &[Option<usize>]) -> Option<(BondId, usize)> {
    (0..graph.nodes.len()).find_map(|index| {
        let (bond_in, bond_out) = component_wise(graph, NodeId(index))?;
        match (known[bond_in.0], known[bond_out.0]) {
            (Some(cardinality), None) => Some((bond_out, cardinality)),
            (None, Some(cardinality)) => Some((bond_in, cardinality)),
            _ => None,
        }
    })
}

/// The bonds of a two-port whose modulus acts on every component alike.
fn component_wise(graph: &BondGraph, id: NodeId) -> Option<(BondId, BondId)> {
    let node = graph.node(id);
    let element = graph.element(id)?;
    let plain = element.kind.is_two_port() && !matches!(element.law, Law::Of { .. });
    match node.bonds[..] {
        [bond_in, bond_out] if plain && !is_junction(&node.kind) => Some((bond_in, bond_out)),
        _ => None,
    }
}
