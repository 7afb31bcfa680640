//! What an element wants of its bond.
//!
//! In: [`BondGraph`]. Out: for a node the stroke of its first bond. Sources and laws of a variable insist on it,
//! storages have integral causality with it.

use super::{End, end_at};
use crate::graph::{BondGraph, BondId, ElementKind, Law, NodeId, Role};

/// What a one-port wants of its bond.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Wish {
    /// To give the effort.
    GiveEffort,
    /// To receive the effort.
    ReceiveEffort,
    /// Either will do.
    Either,
}

/// Whether a node has the causality that it wants, with these strokes.
pub(super) fn has_its_wish(graph: &BondGraph, strokes: &[End], node: NodeId) -> bool {
    wished(graph, node).is_none_or(|(bond, stroke)| strokes[bond.0] == stroke)
}

/// The stroke that a node wants for its first bond.
pub(super) fn wished(graph: &BondGraph, node: NodeId) -> Option<(BondId, End)> {
    let &first = graph.node(node).bonds.first()?;
    // A two-port with a flow law receives the flow of its bond in, so it gives that bond's effort.
    let here = end_at(graph, first, node);
    Some((first, if wish(graph, node) == Wish::GiveEffort { here.opposite() } else { here }))
}

/// What a node wants.
pub(super) fn wish(graph: &BondGraph, node: NodeId) -> Wish {
    use ElementKind as K;
    let Some(element) = graph.element(node) else { return Wish::Either };
    match (element.kind, &element.law) {
        (K::Se | K::MSe | K::RSe | K::C, _) => Wish::GiveEffort,
        (K::Sf | K::MSf | K::I, _) => Wish::ReceiveEffort,
        (_, Law::Of { role: Role::Flow, .. }) => Wish::GiveEffort,
        (_, Law::Of { role: Role::Effort, .. }) => Wish::ReceiveEffort,
        _ => Wish::Either,
    }
}
