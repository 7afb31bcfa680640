//! Causal strokes: which end of every bond receives the effort.
//!
//! In: [`BondGraph`]. Out: [`CausalGraph`]. No longer occurs: a bond without a stroke.
//! Method: the sequential causality assignment procedure (SCAP) of Karnopp and Rosenberg: sources first, then laws that
//! work one way only, then storages in integral causality in the order of declaration, then whatever is left; each
//! assignment is propagated as far as it implies others.

use std::collections::VecDeque;

use crate::fault::{Explain, Fault, Staged};
use crate::graph::{BondGraph, BondId, Law, NodeId, NodeKind};
use crate::source::ast::{ElementKind, Role};

/// An end of a bond.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum End {
    /// Where the half arrow starts.
    From,
    /// Where it points.
    To,
}

/// A graph whose every bond has its causal stroke.
#[derive(Clone, Debug)]
pub struct CausalGraph {
    /// The graph.
    pub graph: BondGraph,
    /// For every bond the end with the stroke: it receives the effort and determines the flow.
    pub strokes: Vec<End>,
}

impl CausalGraph {
    /// Whether the node receives the effort of the bond (its end has the stroke).
    #[must_use]
    pub fn receives_effort(&self, node: NodeId, bond: BondId) -> bool {
        end_at(&self.graph, bond, node) == self.strokes[bond.0]
    }

    /// The strong bond of a junction: the one that determines the common variable.
    #[must_use]
    pub fn strong_bond(&self, node: NodeId) -> Option<BondId> {
        let definition = self.graph.node(node);
        let zero = matches!(definition.kind, NodeKind::Zero);
        definition.bonds.iter().copied().find(|&bond| self.receives_effort(node, bond) == zero)
    }
}

/// A fault of causality.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum CausalFault {
    Conflict { junction: String, variable: &'static str, first: (String, String), second: (String, String) },
    Underdetermined { junction: String, variable: &'static str },
    Derivative { symbol: &'static str, name: String, by: String },
    OneWay { symbol: &'static str, name: String, needs: &'static str, by: String },
}

use CausalFault as F;

impl Explain for CausalFault {
    fn code(&self) -> &'static str {
        match self {
            F::Conflict { .. } => "BG0401",
            F::Underdetermined { .. } => "BG0402",
            F::Derivative { .. } => "BG0403",
            F::OneWay { .. } => "BG0404",
        }
    }

    fn message(&self) -> String {
        match self {
            F::Conflict { junction, variable, first, second } => format!(
                "causal conflict: two bonds determine the {variable} of `{junction}`: {} (forced by {}) and {} (forced \
                 by {})",
                first.0, first.1, second.0, second.1
            ),
            F::Underdetermined { junction, variable } => {
                format!("causal conflict: no bond is left to determine the {variable} of `{junction}`")
            }
            F::Derivative { symbol, name, by } => {
                format!("{symbol} `{name}` would be in derivative causality: its state is already determined by {by}")
            }
            F::OneWay { symbol, name, needs, by } => {
                format!(
                    "the law of {symbol} `{name}` needs its {needs}, but that is what it would have to give: {by} determines the other variable"
                )
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::Conflict { variable: "effort", .. } => {
                "put a 1-junction with an R between one of the two and the junction".to_owned()
            }
            F::Conflict { .. } => {
                "put a 0-junction with an R or a C between one of the two and the junction".to_owned()
            }
            F::Underdetermined { junction, variable: "effort" } => format!("bond a C or an R to `{junction}`"),
            F::Underdetermined { junction, .. } => format!("bond an I or an R to `{junction}`"),
            F::Derivative { symbol: "I", name, .. } => format!(
                "let a C and an R (a compliant coupling) sit between them, `1 -> 0 -> C` in front of `{name}`, or merge \
                 the two inertias into one I"
            ),
            F::Derivative { name, .. } => format!("let an R sit in series with `{name}`, or merge the two C into one"),
            F::OneWay { name, .. } => format!("write the law of `{name}` as an expression of the other variable"),
        }
    }
}

/// Why a bond has its stroke.
#[derive(Clone, Copy, Debug)]
enum Reason {
    /// A node asked for it.
    Node(NodeId),
    /// Another bond implied it.
    Bond(BondId),
}

/// Assigns every stroke.
///
/// # Errors
/// Causal conflicts, storages in derivative causality, laws that would have to work the wrong way.
pub fn assign(graph: BondGraph) -> Staged<CausalGraph> {
    let bonds = graph.bonds.len();
    let mut procedure =
        Procedure { graph: &graph, strokes: vec![None; bonds], reasons: vec![None; bonds], faults: Vec::new() };
    procedure.run();
    let Procedure { strokes, faults, .. } = procedure;
    if !faults.is_empty() {
        return Err(faults);
    }
    let strokes = strokes.into_iter().map(|stroke| stroke.unwrap_or(End::To)).collect();
    Ok(CausalGraph { graph, strokes })
}

fn end_at(graph: &BondGraph, bond: BondId, node: NodeId) -> End {
    if graph.bond(bond).to == node { End::To } else { End::From }
}

fn opposite(end: End) -> End {
    match end {
        End::From => End::To,
        End::To => End::From,
    }
}

/// What a one-port wants of its bond.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wish {
    /// To give the effort.
    GiveEffort,
    /// To receive the effort.
    ReceiveEffort,
    /// Either will do.
    Either,
}

struct Procedure<'a> {
    graph: &'a BondGraph,
    strokes: Vec<Option<End>>,
    reasons: Vec<Option<Reason>>,
    faults: Vec<Fault>,
}

impl Procedure<'_> {
    fn run(&mut self) {
        let nodes = || (0..self.graph.nodes.len()).map(NodeId);
        let fixed: Vec<NodeId> = nodes().filter(|&node| self.is_source(node)).collect();
        let one_way: Vec<NodeId> = nodes().filter(|&node| self.is_one_way(node)).collect();
        let storages: Vec<NodeId> = nodes().filter(|&node| self.is_storage(node)).collect();
        for node in fixed.into_iter().chain(one_way).chain(storages) {
            self.ask(node);
            if !self.faults.is_empty() {
                return;
            }
        }
        for bond in (0..self.graph.bonds.len()).map(BondId) {
            if self.strokes[bond.0].is_none() {
                let node = self.graph.bond(bond).from;
                self.set(bond, end_at(self.graph, bond, node), Reason::Node(node));
            }
        }
    }

    fn is_source(&self, node: NodeId) -> bool {
        use ElementKind as K;
        self.graph.element(node).is_some_and(|element| matches!(element.kind, K::Se | K::MSe | K::Sf | K::MSf | K::RSe))
    }

    fn is_storage(&self, node: NodeId) -> bool {
        self.graph.element(node).is_some_and(|element| matches!(element.kind, ElementKind::I | ElementKind::C))
    }

    /// Nonlinear resistors and matrix transformers work in one direction only.
    fn is_one_way(&self, node: NodeId) -> bool {
        self.graph.element(node).is_some_and(|element| {
            matches!(element.law, Law::Of { .. }) && !matches!(element.kind, ElementKind::I | ElementKind::C)
        })
    }

    fn wish(&self, node: NodeId) -> Wish {
        use ElementKind as K;
        let Some(element) = self.graph.element(node) else { return Wish::Either };
        match (element.kind, &element.law) {
            (K::Se | K::MSe | K::RSe | K::C, _) => Wish::GiveEffort,
            (K::Sf | K::MSf | K::I, _) => Wish::ReceiveEffort,
            (_, Law::Of { role: Role::Flow, .. }) => Wish::GiveEffort,
            (_, Law::Of { role: Role::Effort, .. }) => Wish::ReceiveEffort,
            _ => Wish::Either,
        }
    }

    /// Gives a node's bonds the strokes it asks for, or says why they cannot have them.
    fn ask(&mut self, node: NodeId) {
        let wish = self.wish(node);
        let bonds = self.graph.node(node).bonds.clone();
        let Some(&first) = bonds.first() else { return };
        // A two-port with a flow law receives the flow of its bond in, so it gives that bond's effort.
        let here = end_at(self.graph, first, node);
        let stroke = if wish == Wish::GiveEffort { opposite(here) } else { here };
        match self.strokes[first.0] {
            None => self.set(first, stroke, Reason::Node(node)),
            Some(present) if present == stroke => {}
            Some(_) => self.refuse(node, first),
        }
    }

    /// The bond's stroke is the wrong one for the node: by what, and what that makes it.
    fn refuse(&mut self, node: NodeId, bond: BondId) {
        let definition = self.graph.node(node);
        let Some(element) = self.graph.element(node) else { return };
        let (symbol, name) = (element.kind.symbol(), definition.name.text.clone());
        let by = self.root(bond);
        let fault = match element.kind {
            ElementKind::I | ElementKind::C => F::Derivative { symbol, name, by },
            _ if self.is_source(node) => {
                let other = self.graph.bond(bond).other(node);
                let forcing = if let Some(Reason::Bond(other)) = self.reasons[bond.0] { other } else { bond };
                F::Conflict {
                    junction: self.graph.node(other).name.text.clone(),
                    variable: if self.wish(node) == Wish::GiveEffort { "effort" } else { "flow" },
                    first: (self.bond_text(forcing), by),
                    second: (self.bond_text(bond), self.label(node)),
                }
            }
            _ => {
                let needs = if self.wish(node) == Wish::GiveEffort { "flow" } else { "effort" };
                F::OneWay { symbol, name, needs, by }
            }
        };
        self.faults.push(Fault::new(definition.name.span, &fault));
    }

    /// Sets a stroke and everything it implies.
    fn set(&mut self, bond: BondId, stroke: End, reason: Reason) {
        let mut queue = VecDeque::from([(bond, stroke, reason)]);
        while let Some((bond, stroke, reason)) = queue.pop_front() {
            match self.strokes[bond.0] {
                Some(present) if present == stroke => continue,
                Some(_) => {
                    self.clash(bond, reason);
                    return;
                }
                None => {
                    self.strokes[bond.0] = Some(stroke);
                    self.reasons[bond.0] = Some(reason);
                }
            }
            for node in [self.graph.bond(bond).from, self.graph.bond(bond).to] {
                match self.implied(node, bond) {
                    Ok(implied) => queue.extend(implied.into_iter().map(|(b, end)| (b, end, Reason::Bond(bond)))),
                    Err(fault) => {
                        self.faults.push(fault);
                        return;
                    }
                }
            }
        }
    }

    /// Two implications meet on one bond with opposite strokes.
    fn clash(&mut self, bond: BondId, reason: Reason) {
        let first = self.root(bond);
        let second = match reason {
            Reason::Bond(other) => self.root(other),
            Reason::Node(node) => self.label(node),
        };
        let ends = self.graph.bond(bond);
        let junction = [ends.from, ends.to].into_iter().find(|&node| self.graph.element(node).is_none());
        let node = junction.unwrap_or(ends.to);
        let name = &self.graph.node(node).name;
        let text = self.bond_text(bond);
        let fault = F::Conflict {
            junction: name.text.clone(),
            variable: if matches!(self.graph.node(node).kind, NodeKind::Zero) { "effort" } else { "flow" },
            first: (text.clone(), first),
            second: (text, second),
        };
        self.faults.push(Fault::new(name.span, &fault));
    }

    /// What the strokes at a node imply for its other bonds.
    fn implied(&self, node: NodeId, bond: BondId) -> Result<Vec<(BondId, End)>, Fault> {
        match &self.graph.node(node).kind {
            NodeKind::Zero => self.at_junction(node, true),
            NodeKind::One => self.at_junction(node, false),
            NodeKind::Element(element) => Ok(self.at_two_port(node, bond, element.kind)),
        }
    }

    /// A 0-junction receives effort from exactly one bond, a 1-junction flow from exactly one.
    fn at_junction(&self, node: NodeId, zero: bool) -> Result<Vec<(BondId, End)>, Fault> {
        let definition = self.graph.node(node);
        let strong_end = |bond: BondId| {
            let here = end_at(self.graph, bond, node);
            if zero { here } else { opposite(here) }
        };
        let (mut strong, mut open) = (Vec::new(), Vec::new());
        for &bond in &definition.bonds {
            match self.strokes[bond.0] {
                None => open.push(bond),
                Some(stroke) if stroke == strong_end(bond) => strong.push(bond),
                Some(_) => {}
            }
        }
        let variable = if zero { "effort" } else { "flow" };
        let junction = definition.name.text.clone();
        match (&strong[..], &open[..]) {
            ([first, second, ..], _) => {
                let describe = |bond: BondId| (self.bond_text(bond), self.root(bond));
                let fault = F::Conflict { junction, variable, first: describe(*first), second: describe(*second) };
                Err(Fault::new(definition.name.span, &fault))
            }
            ([_], _) => Ok(open.iter().map(|&bond| (bond, opposite(strong_end(bond)))).collect()),
            ([], [last]) => Ok(vec![(*last, strong_end(*last))]),
            ([], []) => Err(Fault::new(definition.name.span, &F::Underdetermined { junction, variable })),
            ([], _) => Ok(Vec::new()),
        }
    }

    fn at_two_port(&self, node: NodeId, bond: BondId, kind: ElementKind) -> Vec<(BondId, End)> {
        let bonds = &self.graph.node(node).bonds;
        let Some(&other) = bonds.iter().find(|&&candidate| candidate != bond) else { return Vec::new() };
        if !kind.is_two_port() {
            return Vec::new();
        }
        let Some(stroke) = self.strokes[bond.0] else { return Vec::new() };
        let received = stroke == end_at(self.graph, bond, node);
        let gyrator = matches!(kind, ElementKind::Gy | ElementKind::Mgy);
        // A transformer hands the effort through, a gyrator turns it into a flow.
        let receives_other = received == gyrator;
        let here = end_at(self.graph, other, node);
        vec![(other, if receives_other { here } else { opposite(here) })]
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
    fn root(&self, bond: BondId) -> String {
        let mut current = bond;
        loop {
            match self.reasons[current.0] {
                Some(Reason::Bond(previous)) => current = previous,
                Some(Reason::Node(node)) => return self.label(node),
                None => return self.bond_text(bond),
            }
        }
    }
}
