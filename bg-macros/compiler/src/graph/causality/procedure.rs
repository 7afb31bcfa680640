//! The sequential procedure: requests in their order, each propagated as far as it implies other strokes.
//!
//! In: [`BondGraph`]. Out: a stroke for every bond, or the faults. A request that cannot be met is a fault and is taken
//! back, so that what comes after it is judged as if it had not been made. First all storages ask for integral
//! causality. Where that leaves no valid assignment, and the graph does not insist on it, a second run gives each in
//! turn integral causality where the rest can still be completed, and derivative causality elsewhere.

use std::collections::VecDeque;

use super::completion::{Lack, complete};
use super::wish::{Wish, wish, wished};
use super::{CausalFault as F, End, across, is_junction, strong_end};
use crate::fault::{Fault, Staged};
use crate::graph::{BondGraph, BondId, Element, ElementKind, Law, NodeId, NodeKind, Role};

/// Why a bond has its stroke.
#[derive(Clone, Copy, Debug)]
enum Reason {
    /// A node asked for it.
    Node(NodeId),
    /// Another bond implied it.
    Bond(BondId),
}

/// The strokes, and for every junction its strong bond.
type Strokes = (Vec<End>, Vec<Option<BondId>>);

/// Runs the procedure.
pub(super) fn run(graph: &BondGraph) -> Staged<Strokes> {
    let integral = Procedure::new(graph).finished(Procedure::ask_storages);
    if integral.is_ok() || graph.expects_integral {
        return integral;
    }
    Procedure::new(graph).finished(Procedure::prefer_integral)
}

struct Procedure<'a> {
    graph: &'a BondGraph,
    strokes: Vec<Option<End>>,
    reasons: Vec<Option<Reason>>,
    /// For every node how many of its bonds have no stroke.
    open: Vec<usize>,
    /// For every junction its strong bond.
    strong: Vec<Option<BondId>>,
    /// The bonds in the order in which they got their strokes.
    trail: Vec<BondId>,
    faults: Vec<Fault>,
}

impl<'a> Procedure<'a> {
    fn new(graph: &'a BondGraph) -> Self {
        let (bonds, nodes) = (graph.bonds.len(), graph.nodes.len());
        Self {
            graph,
            strokes: vec![None; bonds],
            reasons: vec![None; bonds],
            open: graph.nodes.iter().map(|node| node.bonds.len()).collect(),
            strong: vec![None; nodes],
            trail: Vec::new(),
            faults: Vec::new(),
        }
    }

    /// Sources, then laws that work one way, then storages as `storages` has it, then the rest.
    fn finished(mut self, storages: fn(&mut Self)) -> Staged<Strokes> {
        self.demand(&self.nodes(|procedure, node| procedure.is_source(node)));
        self.demand(&self.nodes(|procedure, node| procedure.is_one_way(node)));
        storages(&mut self);
        self.choose();
        if !self.faults.is_empty() {
            return Err(self.faults);
        }
        let strokes = self.strokes.into_iter().map(|stroke| stroke.unwrap_or(End::To)).collect();
        Ok((strokes, self.strong))
    }

    fn nodes(&self, wanted: impl Fn(&Self, NodeId) -> bool) -> Vec<NodeId> {
        (0..self.graph.nodes.len()).map(NodeId).filter(|&node| wanted(self, node)).collect()
    }

    /// Gives nodes what they ask for; what cannot be is a fault.
    fn demand(&mut self, nodes: &[NodeId]) {
        for &node in nodes {
            let before = self.trail.len();
            if let Err(fault) = self.ask(node) {
                self.undo(before);
                self.faults.push(fault);
            }
        }
    }

    /// Every storage insists on integral causality.
    fn ask_storages(&mut self) {
        self.demand(&self.nodes(|procedure, node| procedure.storage(node).is_some()));
    }

    /// A displacement that the poses give stays one. Of the others come first those whose state is hard to replace:
    /// laws that need not have an inverse, then those with a start of their own; then the order of declaration decides.
    fn prefer_integral(&mut self) {
        let posed = |procedure: &Self, node| {
            procedure.storage(node).is_some() && procedure.graph.element(node).is_some_and(|e| e.displacement.is_some())
        };
        self.demand(&self.nodes(posed));
        let mut others = self.nodes(|procedure, node| procedure.storage(node).is_some() && !posed(procedure, node));
        others.sort_by_key(|&node| {
            let element = self.graph.element(node);
            let (is_of, has_start) = element
                .map_or((false, false), |element| (matches!(element.law, Law::Of { .. }), element.start.is_some()));
            (!is_of, !has_start)
        });
        let completes = self.can_be_completed();
        for node in others {
            self.prefer(node, completes);
        }
    }

    /// Integral causality where it has a place and, if `completes`, the rest can then be completed; else the other
    /// stroke.
    fn prefer(&mut self, node: NodeId, completes: bool) {
        let before = self.trail.len();
        if self.ask(node).is_ok() && (!completes || self.can_be_completed()) {
            return;
        }
        self.undo(before);
        if let Some((bond, stroke)) = wished(self.graph, node)
            && self.strokes[bond.0].is_none()
            && self.set(bond, stroke.opposite(), Reason::Node(node)).is_err()
        {
            self.undo(before);
        }
    }

    fn can_be_completed(&self) -> bool {
        complete(self.graph, &self.strokes, &vec![End::From; self.strokes.len()]).is_ok()
    }

    /// What no one asked for: the stroke where the half arrow starts, unless that leaves no assignment of the rest.
    fn choose(&mut self) {
        let before = self.trail.len();
        if self.first_choices().is_ok() {
            return;
        }
        self.undo(before);
        let firsts = vec![End::From; self.strokes.len()];
        let mut witness = match complete(self.graph, &self.strokes, &firsts) {
            Ok(witness) => witness,
            Err(lacks) => {
                let faults: Vec<Fault> = lacks.iter().map(|lack| self.lack(lack)).collect();
                self.faults.extend(faults);
                return;
            }
        };
        for bond in (0..self.graph.bonds.len()).map(BondId) {
            if self.strokes[bond.0].is_none()
                && let Err(fault) = self.choose_one(bond, &mut witness)
            {
                self.faults.push(fault);
                return;
            }
        }
    }

    fn first_choices(&mut self) -> Result<(), Fault> {
        for bond in (0..self.graph.bonds.len()).map(BondId) {
            if self.strokes[bond.0].is_none() {
                self.set(bond, End::From, Reason::Node(self.graph.bond(bond).from))?;
            }
        }
        Ok(())
    }

    /// The first choice where it can be completed, else that of the valid assignment `witness`.
    fn choose_one(&mut self, bond: BondId, witness: &mut Vec<End>) -> Result<(), Fault> {
        let reason = Reason::Node(self.graph.bond(bond).from);
        if witness[bond.0] != End::From {
            let before = self.trail.len();
            if self.set(bond, End::From, reason).is_ok()
                && let Ok(other) = complete(self.graph, &self.strokes, witness)
            {
                *witness = other;
                return Ok(());
            }
            self.undo(before);
        }
        self.set(bond, witness[bond.0], reason)
    }

    fn is_source(&self, node: NodeId) -> bool {
        use ElementKind as K;
        self.graph.element(node).is_some_and(|element| matches!(element.kind, K::Se | K::MSe | K::Sf | K::MSf | K::RSe))
    }

    /// The kind of a storage.
    fn storage(&self, node: NodeId) -> Option<ElementKind> {
        let kind = self.graph.element(node)?.kind;
        matches!(kind, ElementKind::I | ElementKind::C).then_some(kind)
    }

    /// Nonlinear resistors and matrix transformers work in one direction only.
    fn is_one_way(&self, node: NodeId) -> bool {
        let has_variable = |element: &Element| matches!(element.law, Law::Of { .. });
        self.graph.element(node).is_some_and(has_variable) && self.storage(node).is_none()
    }

    /// Gives a node's bonds the strokes it asks for, or says why they cannot have them.
    fn ask(&mut self, node: NodeId) -> Result<(), Fault> {
        let Some((first, stroke)) = wished(self.graph, node) else { return Ok(()) };
        match self.strokes[first.0] {
            None => self.set(first, stroke, Reason::Node(node)),
            Some(present) if present == stroke => Ok(()),
            Some(_) => Err(self.refusal(node, first)),
        }
    }

    /// The bond's stroke is the wrong one for the node: by what, and what that makes it.
    fn refusal(&self, node: NodeId, bond: BondId) -> Fault {
        let definition = self.graph.node(node);
        let (symbol, name) = (definition.kind.symbol(), definition.name.text.clone());
        let by = self.root_text(bond);
        let fault = if let Some(kind) = self.storage(node) {
            let by_inertia = self.root(bond).and_then(|root| self.storage(root)) == Some(ElementKind::I);
            F::Derivative { kind, name, by, by_inertia }
        } else if self.is_source(node) {
            let other = self.graph.bond(bond).other(node);
            let forcing = if let Some(Reason::Bond(other)) = self.reasons[bond.0] { other } else { bond };
            F::Conflict {
                junction: self.graph.node(other).name.text.clone(),
                variable: if wish(self.graph, node) == Wish::GiveEffort { Role::Effort } else { Role::Flow },
                first: (self.bond_text(forcing), by),
                second: (self.bond_text(bond), self.label(node)),
            }
        } else {
            let needs = if wish(self.graph, node) == Wish::GiveEffort { "flow" } else { "effort" };
            F::OneWay { symbol, name, needs, by }
        };
        Fault::new(definition.name.span, &fault)
    }

    /// Sets a stroke and everything it implies. After an error some are set: `undo` them.
    fn set(&mut self, bond: BondId, stroke: End, reason: Reason) -> Result<(), Fault> {
        let mut queue = VecDeque::from([(bond, stroke, reason)]);
        while let Some((bond, stroke, reason)) = queue.pop_front() {
            match self.strokes[bond.0] {
                Some(present) if present == stroke => continue,
                Some(_) => return Err(self.clash(bond, reason)),
                None => self.put(bond, stroke, reason),
            }
            for node in [self.graph.bond(bond).from, self.graph.bond(bond).to] {
                if is_junction(self.graph, node) {
                    self.at_junction(node, bond, stroke, &mut queue)?;
                } else if let Some((other, implied)) = across(self.graph, node, bond, stroke) {
                    queue.push_back((other, implied, Reason::Bond(bond)));
                }
            }
        }
        Ok(())
    }

    fn put(&mut self, bond: BondId, stroke: End, reason: Reason) {
        self.strokes[bond.0] = Some(stroke);
        self.reasons[bond.0] = Some(reason);
        self.trail.push(bond);
        let ends = self.graph.bond(bond);
        self.open[ends.from.0] -= 1;
        self.open[ends.to.0] -= 1;
    }

    /// Takes strokes back until the trail is as long as it was.
    fn undo(&mut self, length: usize) {
        for bond in self.trail.split_off(length) {
            self.strokes[bond.0] = None;
            self.reasons[bond.0] = None;
            for node in [self.graph.bond(bond).from, self.graph.bond(bond).to] {
                self.open[node.0] += 1;
                self.strong[node.0].take_if(|strong| *strong == bond);
            }
        }
    }

    /// What the new stroke of `bond` implies for the other bonds of a junction: the strong bond is the only one.
    fn at_junction(
        &mut self,
        node: NodeId,
        bond: BondId,
        stroke: End,
        queue: &mut VecDeque<(BondId, End, Reason)>,
    ) -> Result<(), Fault> {
        let graph = self.graph;
        let open = |procedure: &Self| {
            let bonds = graph.node(node).bonds.iter().copied();
            bonds.filter(|other| procedure.strokes[other.0].is_none()).collect::<Vec<_>>()
        };
        if stroke == strong_end(graph, node, bond) {
            if let Some(known) = self.strong[node.0] {
                return Err(self.two_strong(node, known, bond));
            }
            self.strong[node.0] = Some(bond);
            for other in open(self) {
                queue.push_back((other, strong_end(graph, node, other).opposite(), Reason::Bond(bond)));
            }
        } else if self.strong[node.0].is_none() {
            match self.open[node.0] {
                0 => return Err(self.lack(&Lack::Cause(node))),
                1 => {
                    for last in open(self) {
                        queue.push_back((last, strong_end(graph, node, last), Reason::Bond(bond)));
                    }
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn two_strong(&self, node: NodeId, one: BondId, other: BondId) -> Fault {
        let bonds = &self.graph.node(node).bonds;
        let mut both = [one, other];
        both.sort_by_key(|bond| bonds.iter().position(|known| known == bond));
        let [first, second] = both.map(|bond| (self.bond_text(bond), self.root_text(bond)));
        self.conflict(node, first, second)
    }

    /// Two implications meet on one bond with opposite strokes.
    fn clash(&self, bond: BondId, reason: Reason) -> Fault {
        let first = self.root_text(bond);
        let second = match reason {
            Reason::Bond(other) => self.root_text(other),
            Reason::Node(node) => self.label(node),
        };
        let ends = self.graph.bond(bond);
        let junction = [ends.from, ends.to].into_iter().find(|&node| is_junction(self.graph, node));
        let text = self.bond_text(bond);
        self.conflict(junction.unwrap_or(ends.to), (text.clone(), first), (text, second))
    }

    fn conflict(&self, node: NodeId, first: (String, String), second: (String, String)) -> Fault {
        let name = &self.graph.node(node).name;
        let fault = F::Conflict { junction: name.text.clone(), variable: self.common(node), first, second };
        Fault::new(name.span, &fault)
    }

    /// What keeps the choices from an assignment.
    fn lack(&self, lack: &Lack) -> Fault {
        match *lack {
            Lack::Cause(node) => {
                let name = &self.graph.node(node).name;
                let fault = F::Underdetermined { junction: name.text.clone(), variable: self.common(node) };
                Fault::new(name.span, &fault)
            }
            Lack::Place { junction, bonds } => {
                let [first, second] = bonds.map(|(bond, far)| (self.bond_text(bond), self.label(far)));
                self.conflict(junction, first, second)
            }
        }
    }

    /// What the bonds of a junction have in common.
    fn common(&self, node: NodeId) -> Role {
        if matches!(self.graph.node(node).kind, NodeKind::Zero) { Role::Effort } else { Role::Flow }
    }

    fn bond_text(&self, bond: BondId) -> String {
        let ends = self.graph.bond(bond);
        format!("`{} -> {}`", self.graph.node(ends.from).name.text, self.graph.node(ends.to).name.text)
    }

    fn label(&self, node: NodeId) -> String {
        let definition = self.graph.node(node);
        format!("{} `{}`", definition.kind.symbol(), definition.name.text)
    }

    /// The node whose request led, step by step, to the stroke of this bond.
    fn root(&self, bond: BondId) -> Option<NodeId> {
        let mut current = bond;
        loop {
            match self.reasons[current.0]? {
                Reason::Bond(previous) => current = previous,
                Reason::Node(node) => return Some(node),
            }
        }
    }

    fn root_text(&self, bond: BondId) -> String {
        self.root(bond).map_or_else(|| self.bond_text(bond), |node| self.label(node))
    }
}
