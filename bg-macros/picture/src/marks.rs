//! Which storages are not free: in derivative causality, or under a multiplier.
//!
//! In: a [`Graph`]. Out: a [`Mark`] for each node. Method: a storage in integral causality receives what it
//! integrates, an I the effort and a C the flow; the stroke says which (Karnopp, Margolis, Rosenberg, System
//! Dynamics, ch. 5). A residual sink `rSe` of a rigid joint demands a flow; the strokes lead from it to the I that
//! give this flow, and the sink's effort, the multiplier, keeps their motions together (Bos, Modelling multibody
//! systems in terms of multibond graphs, 1986).

use crate::graph::Graph;

/// What is special about a storage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
    /// Nothing.
    #[default]
    None,
    /// An I whose motion a rigid joint ties to others: a multiplier keeps the constraint.
    Multiplier,
    /// A storage whose state others determine.
    Derivative,
}

/// The mark of each node.
#[must_use]
pub fn marks(graph: &Graph) -> Vec<Mark> {
    let bonds = bonds_of(graph);
    let mut marks: Vec<Mark> = (0..graph.nodes.len()).map(|node| own_mark(graph, &bonds, node)).collect();
    for (node, _) in graph.nodes.iter().enumerate().filter(|(_, node)| node.kind == "rSe") {
        for inertia in givers_of_flow(graph, &bonds, node) {
            marks[inertia] = marks[inertia].max(Mark::Multiplier);
        }
    }
    marks
}

/// The bonds of each node.
pub(crate) fn bonds_of(graph: &Graph) -> Vec<Vec<usize>> {
    let mut bonds = vec![Vec::new(); graph.nodes.len()];
    for (index, bond) in graph.bonds.iter().enumerate() {
        bonds[bond.from].push(index);
        bonds[bond.to].push(index);
    }
    bonds
}

fn own_mark(graph: &Graph, bonds: &[Vec<usize>], node: usize) -> Mark {
    let integral_with_stroke = match graph.nodes[node].kind.as_str() {
        "I" => true,
        "C" => false,
        _ => return Mark::None,
    };
    let is_integral = |&bond: &usize| graph.bonds[bond].has_stroke_at(node) == integral_with_stroke;
    if bonds[node].iter().all(is_integral) { Mark::None } else { Mark::Derivative }
}

/// The I that give the flow which `sink` receives: along each bond from its end without the stroke to the one with it.
fn givers_of_flow(graph: &Graph, bonds: &[Vec<usize>], sink: usize) -> Vec<usize> {
    let mut seen = vec![false; graph.bonds.len()];
    let mut open: Vec<(usize, usize)> = bonds[sink].iter().map(|&bond| (bond, sink)).collect();
    let mut givers = Vec::new();
    while let Some((bond, receiver)) = open.pop() {
        if graph.bonds[bond].has_stroke_at(receiver) || std::mem::replace(&mut seen[bond], true) {
            continue;
        }
        let giver = graph.bonds[bond].other(receiver);
        match graph.nodes[giver].kind.as_str() {
            "I" => givers.push(giver),
            "0" | "1" | "TF" | "MTF" => {
                open.extend(bonds[giver].iter().filter(|&&next| next != bond).map(|&next| (next, giver)));
            }
            _ => {}
        }
    }
    givers
}
