//! Of which values something is asked: clauses of mechanism words, linear laws, orientations, laminar ranges.
//!
//! In: the resolved graph. Out: [`Requirements`] over a pool of their own.

use super::signals::Signals;
use super::solving::Pivot;
use crate::graph::units::Dimension;
use crate::graph::{
    Allowed, BinaryOperator, BondGraph, Builtin, CausalGraph, ElementKind, End, Law, NodeId, Reference, Term, TermKind,
    TrackKind,
};
use crate::system::Value;
use crate::system::requirements::{Requirements, Subject};

/// A term of which something is asked.
type Asked<'g> = (Subject, &'g Term);

impl Signals<'_> {
    /// What is asked of the values that parameters and numbers give. The model's own expressions and switches stay as
    /// they are.
    pub(super) fn requirements(&mut self) -> Requirements {
        let graph = self.graph;
        let (pool, switches) = (self.pool.clone(), self.switches.len());
        let mut asked = clauses(graph);
        asked.extend(laws(self.causal));
        asked.extend(orientations(graph));
        asked.extend(laminar_ranges(graph));
        asked.extend(restitutions(graph));
        asked.retain(|(subject, term)| subject.allowed != Allowed::Rotation || !is_rotation(graph, term));
        let values: Vec<Value> = asked.iter().map(|(_, term)| self.evaluate(term, None)).collect();
        let clearances = self.clearances();
        self.switches.truncate(switches);
        let mut requirements = Requirements::over(std::mem::replace(&mut self.pool, pool));
        for ((subject, _), value) in asked.iter().zip(&values) {
            requirements.ask(subject, value);
        }
        for (subject, value) in &clearances {
            requirements.ask(subject, value);
        }
        for Pivot { what, node, value } in &self.pivots {
            let (span, what, unit) = (graph.node(*node).name.span, what.clone(), String::new());
            let subject = Subject { what, unit, span, allowed: Allowed::Determined };
            requirements.ask(&subject, &Value::scalar(*value));
        }
        requirements
    }
}

/// Linear laws of storages and resistances.
fn laws(causal: &CausalGraph) -> Vec<Asked<'_>> {
    (0..causal.graph.nodes.len()).filter_map(|node| law(causal, NodeId(node))).collect()
}

fn law(causal: &CausalGraph, node: NodeId) -> Option<Asked<'_>> {
    use ElementKind as K;
    let graph = &causal.graph;
    let (definition, element) = (graph.node(node), graph.element(node)?);
    let term = element.law.term();
    if graph.is_clause(term) {
        return None;
    }
    let bond = graph.bond(definition.bonds[0]);
    let resistance = bond.effort.per(bond.flow());
    let (word, allowed, unit) = match (element.kind, &element.law) {
        (K::R | K::Mr, Law::Parameter(_)) => {
            let stroke = match causal.strokes[definition.bonds[0].0] {
                End::From => bond.from,
                End::To => bond.to,
            };
            let allowed = if stroke == node { Allowed::Invertible } else { Allowed::Dissipative };
            ("resistance", allowed, resistance)
        }
        (K::I, Law::Parameter(_)) => ("inertia", Allowed::Positive, resistance.times(Dimension::SECOND)),
        (K::C, Law::Stiffness(_)) if causal.derivative.contains(&node) => {
            ("stiffness", Allowed::Positive, resistance.per(Dimension::SECOND))
        }
        (K::C, Law::Stiffness(_)) => ("stiffness", Allowed::NotNegative, resistance.per(Dimension::SECOND)),
        (K::C, Law::Compliance(_)) => ("compliance", Allowed::Positive, Dimension::SECOND.per(resistance)),
        _ => return None,
    };
    let what = format!("the {word} of {} `{}`", element.kind.symbol(), definition.name.text);
    Some((Subject { what, unit: unit.to_string(), span: term.span, allowed }, term))
}

/// The clauses of mechanism words.
fn clauses(graph: &BondGraph) -> Vec<Asked<'_>> {
    let clauses = graph.lets.iter().filter_map(|definition| {
        let clause = definition.clause.as_ref()?;
        let unit = definition.unit.clone().unwrap_or_default();
        let subject = Subject { what: clause.what.clone(), unit, span: definition.value.span, allowed: clause.allowed };
        Some((subject, &definition.value))
    });
    clauses.filter(|(subject, _)| subject.allowed != Allowed::Any).collect()
}

/// Starts of orientations, and the axes in which tensors are constant.
fn orientations(graph: &BondGraph) -> Vec<Asked<'_>> {
    let starts = graph.tracks.iter().filter(|track| track.kind == TrackKind::Orientation).filter_map(|track| {
        let what = format!("the start of orientation `{}`", track.name.text);
        track.start.as_ref().map(|start| (what, start))
    });
    let frames = (0..graph.nodes.len()).map(NodeId).filter_map(|node| {
        let what = format!("the frame of I `{}`", graph.node(node).name.text);
        Some((what, graph.element(node)?.frame.as_ref()?))
    });
    let asked = starts.chain(frames).filter(|(_, term)| !graph.is_clause(term));
    asked
        .map(|(what, term)| (Subject { what, unit: String::new(), span: term.span, allowed: Allowed::Rotation }, term))
        .collect()
}

/// The restitutions of stops in bond-graph words.
fn restitutions(graph: &BondGraph) -> Vec<Asked<'_>> {
    let of = |node: NodeId| Some((graph.node(node), graph.element(node)?.restitution.as_ref()?));
    let given = (0..graph.nodes.len()).filter_map(|node| of(NodeId(node)));
    let asked = given.filter(|(_, term)| !graph.is_clause(term)).map(|(node, term)| {
        let what = format!("the restitution of stop `{}`", node.name.text);
        (Subject { what, unit: String::new(), span: term.span, allowed: Allowed::Fraction }, term)
    });
    asked.collect()
}

/// The second arguments of `root`, but those that are of a law's variable.
fn laminar_ranges(graph: &BondGraph) -> Vec<Asked<'_>> {
    let mut found: Vec<&Term> = Vec::new();
    graph.each_term(&mut |part| {
        if let TermKind::Call(Builtin::Root, arguments) = &part.kind {
            found.push(&arguments[1]);
        }
    });
    let is_free = |term: &&Term| {
        let mut references = Vec::new();
        term.references(&mut references);
        !references.contains(&Reference::Variable)
    };
    let subject = |term: &Term| {
        let (what, unit) = ("the laminar range of `root`".to_owned(), String::new());
        Subject { what, unit, span: term.span, allowed: Allowed::Positive }
    };
    found.into_iter().filter(is_free).map(|term| (subject(term), term)).collect()
}

/// Whether a term is a rotation by the way it is made, for all values of what it depends on.
pub(super) fn is_rotation(graph: &BondGraph, term: &Term) -> bool {
    use Builtin as B;
    match &term.kind {
        TermKind::Call(B::RotationX | B::RotationY | B::RotationZ | B::Identity, _) => true,
        TermKind::Call(B::Transpose | B::Inverse, arguments) => is_rotation(graph, &arguments[0]),
        TermKind::Chain(first, rest) => {
            let products = rest.iter().all(|next| next.operator == BinaryOperator::Multiply);
            products && is_rotation(graph, first) && rest.iter().all(|next| is_rotation(graph, &next.operand))
        }
        TermKind::Reference(Reference::Let(index)) => is_rotation(graph, &graph.lets[*index].value),
        TermKind::Reference(Reference::Track(index)) => graph.tracks[*index].kind == TrackKind::Orientation,
        _ => false,
    }
}
