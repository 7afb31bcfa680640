//! Whether strokes can be completed to a valid assignment, and to which.
//!
//! In: strokes of some bonds, propagated. Out: strokes of all bonds, or what is lacking, each fault once.
//! Method: every junction needs exactly one strong bond. A chain of bonds without strokes from junction to junction, by
//! way of two-ports, has two states, and either both ends are strong in the same one or each end in its own. So
//! junctions without a strong bond are the vertices of a graph, chains of the first kind its edges; in the middle of
//! one of the second kind a vertex of its own has a partner at exactly one side. A chain that ends at an element which
//! takes either causality is a spare of its junction. Valid assignments are the matchings in which no vertex goes
//! without; `matching` finds one in polynomial time, where trying out strokes would take an exponential one.

use super::matching::{Matching, Mate};
use super::{End, across, is_junction, strong_end};
use crate::graph::{BondGraph, BondId, NodeId};

/// A part of the graph that no choice of strokes can satisfy.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lack {
    /// No bond is left to determine what the bonds of this junction have in common.
    Cause(NodeId),
    /// Two bonds determine it, whatever the choice; each with the node at the far end of its chain.
    Place { junction: NodeId, bonds: [(BondId, NodeId); 2] },
}

/// A chain of bonds without strokes.
struct Chain {
    /// Its bonds, each with its stroke where the chain determines the variable of its first junction.
    bonds: Vec<(BondId, End)>,
    /// Where it starts.
    first: NodeId,
    last: Last,
}

/// Where a chain ends.
#[derive(Clone, Copy)]
enum Last {
    /// At an element that takes either causality.
    Free(NodeId),
    /// At a junction, strong there in the same state as at the first one.
    Same(NodeId),
    /// At a junction, strong there in the other state; the vertex in the middle.
    Opposite(NodeId, usize),
}

/// Completes the strokes, near to `hint` where that is possible.
///
/// Bonds of chains without any junction keep the hint.
///
/// # Errors
/// What keeps the strokes from being completed.
pub(super) fn complete(graph: &BondGraph, strokes: &[Option<End>], hint: &[End]) -> Result<Vec<End>, Vec<Lack>> {
    let mut puzzle = Puzzle::new(graph, strokes);
    puzzle.suggest(hint);
    let lacks = puzzle.solve();
    if !lacks.is_empty() {
        return Err(lacks);
    }
    let mut complete: Vec<End> = strokes.iter().zip(hint).map(|(stroke, &hint)| stroke.unwrap_or(hint)).collect();
    for (number, chain) in puzzle.chains.iter().enumerate() {
        let is_first = puzzle.is_strong(chain.first, number);
        for &(bond, stroke) in &chain.bonds {
            complete[bond.0] = if is_first { stroke } else { stroke.opposite() };
        }
    }
    Ok(complete)
}

struct Puzzle<'a> {
    graph: &'a BondGraph,
    chains: Vec<Chain>,
    matching: Matching,
    /// The vertex of every junction that has one.
    vertices: Vec<Option<usize>>,
    /// What every vertex stands for: a junction, or the middle of a chain.
    meanings: Vec<Meaning>,
}

#[derive(Clone, Copy)]
enum Meaning {
    Junction(NodeId),
    Middle(usize),
}

impl<'a> Puzzle<'a> {
    fn new(graph: &'a BondGraph, strokes: &[Option<End>]) -> Self {
        let mut puzzle = Self {
            graph,
            chains: Vec::new(),
            matching: Matching::default(),
            vertices: vec![None; graph.nodes.len()],
            meanings: Vec::new(),
        };
        let is_strong = |node: NodeId| {
            let mut bonds = graph.node(node).bonds.iter();
            bonds.any(|&bond| strokes[bond.0] == Some(strong_end(graph, node, bond)))
        };
        for node in (0..graph.nodes.len()).map(NodeId) {
            if is_junction(graph, node) && !is_strong(node) {
                puzzle.vertices[node.0] = Some(puzzle.vertex(Meaning::Junction(node)));
            }
        }
        let mut seen: Vec<bool> = strokes.iter().map(Option::is_some).collect();
        for node in (0..graph.nodes.len()).map(NodeId).filter(|&node| is_junction(graph, node)) {
            for &bond in &graph.node(node).bonds {
                if !seen[bond.0] {
                    puzzle.chain(node, bond, &mut seen);
                }
            }
        }
        puzzle
    }

    fn vertex(&mut self, meaning: Meaning) -> usize {
        self.meanings.push(meaning);
        self.matching.vertex()
    }

    /// The vertex of a junction that has a bond without a stroke: it has no strong bond, or propagation would have set
    /// all.
    fn vertex_of(&mut self, node: NodeId) -> usize {
        let known = self.vertices[node.0];
        known.unwrap_or_else(|| {
            let vertex = self.vertex(Meaning::Junction(node));
            self.vertices[node.0] = Some(vertex);
            vertex
        })
    }

    /// Follows the chain that starts with `bond` at a junction.
    fn chain(&mut self, first: NodeId, bond: BondId, seen: &mut [bool]) {
        let graph = self.graph;
        let number = self.chains.len();
        let mut step = (bond, strong_end(graph, first, bond));
        let mut bonds = vec![step];
        let mut node = graph.bond(bond).other(first);
        seen[bond.0] = true;
        while let Some(next) = across(graph, node, step.0, step.1) {
            step = next;
            seen[step.0.0] = true;
            bonds.push(step);
            node = graph.bond(step.0).other(node);
        }
        let a = self.vertex_of(first);
        let last = if !is_junction(graph, node) {
            self.matching.spare(a, number);
            Last::Free(node)
        } else if step.1 == strong_end(graph, node, step.0) {
            let b = self.vertex_of(node);
            // From a junction back to itself: strong twice or not at all.
            if a != b {
                self.matching.edge(a, b, number);
            }
            Last::Same(node)
        } else {
            let b = self.vertex_of(node);
            let middle = self.vertex(Meaning::Middle(number));
            self.matching.edge(a, middle, number);
            if a != b {
                self.matching.edge(middle, b, number);
            }
            Last::Opposite(node, middle)
        };
        self.chains.push(Chain { bonds, first, last });
    }

    fn suggest(&mut self, hint: &[End]) {
        for number in 0..self.chains.len() {
            let Chain { bonds, first, last } = &self.chains[number];
            let (bond, stroke) = bonds[0];
            let (is_first, first, last) = (hint[bond.0] == stroke, *first, *last);
            let a = self.vertex_of(first);
            match last {
                Last::Free(_) if is_first => self.matching.settle(a, number),
                Last::Same(node) if is_first => {
                    let b = self.vertex_of(node);
                    if a != b {
                        self.matching.suggest(a, b, number);
                    }
                }
                Last::Opposite(node, middle) => {
                    let strong = if is_first { a } else { self.vertex_of(node) };
                    self.matching.suggest(strong, middle, number);
                }
                Last::Free(_) | Last::Same(_) => {}
            }
        }
    }

    /// Matches every vertex; what cannot be is treated as if it had been put right, so that each fault comes once.
    fn solve(&mut self) -> Vec<Lack> {
        let mut lacks = Vec::new();
        for vertex in 0..self.meanings.len() {
            while self.matching.mate(vertex) == Mate::None
                && let Err(candidates) = self.matching.augment(vertex)
            {
                let lack = self.lack(vertex, &candidates);
                let at = if let Lack::Cause(node) = lack { self.vertex_of(node) } else { vertex };
                self.matching.spare(at, self.chains.len());
                lacks.push(lack);
            }
        }
        lacks
    }

    /// What an element bonded to a junction would put right, else the chain that has no place.
    fn lack(&self, vertex: usize, candidates: &[usize]) -> Lack {
        let own = std::iter::once(vertex).chain(candidates.iter().copied());
        let junction = own.clone().find_map(|candidate| match self.meanings[candidate] {
            Meaning::Junction(node) => Some(node),
            Meaning::Middle(_) => None,
        });
        match (junction, self.meanings[vertex]) {
            (Some(node), _) | (None, Meaning::Junction(node)) => Lack::Cause(node),
            (None, Meaning::Middle(number)) => {
                let junction = self.chains[number].first;
                let (bond, far) = self.at(number, junction);
                let known = match self.vertices[junction.0].map(|vertex| self.matching.mate(vertex)) {
                    Some(Mate::Vertex(_, other)) => self.at(other, junction),
                    _ => (bond, far),
                };
                Lack::Place { junction, bonds: [known, (bond, far)] }
            }
        }
    }

    /// The bond with which a chain ends at a junction, and the node at its other end.
    fn at(&self, number: usize, junction: NodeId) -> (BondId, NodeId) {
        let Chain { bonds, first, last } = &self.chains[number];
        let (Last::Free(end) | Last::Same(end) | Last::Opposite(end, _)) = *last;
        if *first == junction { (bonds[0].0, end) } else { (bonds[bonds.len() - 1].0, *first) }
    }

    /// Whether a chain determines the variable of a junction.
    fn is_strong(&self, junction: NodeId, number: usize) -> bool {
        let mate = self.vertices[junction.0].map(|vertex| self.matching.mate(vertex));
        matches!(mate, Some(Mate::Spare(own) | Mate::Vertex(_, own)) if own == number)
    }
}
