//! The proof that a displacement given by the poses is the integral of its bond's flow.
//!
//! In: C elements with `at E`. Out: nothing, or a fault. Method: the flows of the tracked junctions become symbols;
//! then dE/dt by the chain rule and the bond's flow are polynomials in them and in the poses, compared term by term.
//! Where they grow too large, as for the distance from a profile, they are compared at places drawn at random: two
//! functions that are analytic in each branch and agree there agree but for a set of measure zero (Schwartz, Journal of
//! the ACM 27, 1980).

use std::collections::BTreeMap;

use super::EquationFault;
use super::signals::{Layout, Signals};
use super::unknowns::number;
use crate::expr::{Environment, Id, Pool, Symbol, derivative, evaluate, magnitudes, same_polynomial, substitute};
use crate::fault::Fault;
use crate::graph::{ElementKind, NodeId, Reference, Storage, Term};
use crate::random::Random;
use crate::system::Value;

impl Signals<'_> {
    /// Proves every given displacement.
    pub(super) fn prove_displacements(&mut self) {
        let graph = self.graph;
        let nodes: Vec<NodeId> = (0..graph.nodes.len())
            .map(NodeId)
            .filter(|&node| graph.element(node).is_some_and(|element| element.displacement.is_some()))
            .collect();
        if nodes.is_empty() {
            return;
        }
        let mut next = 0;
        for track in &graph.tracks {
            if !self.given_flows.contains_key(&track.junction) {
                let flow = (next..next + 3).map(|k| self.pool.symbol(Symbol::Flow(k))).collect();
                self.given_flows.insert(track.junction, Value(flow));
                next += 3;
            }
        }
        let mut seeds = self.track_seeds();
        if !self.stops().is_empty() || self.has_displacement_of_others(&nodes) {
            self.add_displacements(&mut seeds);
        }
        self.add_ways(&mut seeds);
        let faults: Vec<Fault> = nodes.into_iter().filter_map(|node| self.prove(node, &seeds)).collect();
        self.given_flows.clear();
        self.forget();
        self.faults = faults;
    }

    /// The rates of all poses in terms of these flows.
    fn track_seeds(&mut self) -> BTreeMap<Symbol, Id> {
        let mut seeds = BTreeMap::new();
        for Layout { storage, components, .. } in self.layout.clone() {
            let Storage::Track(index) = storage else { continue };
            let flow = self.given_flows[&self.graph.tracks[index].junction].clone();
            let rate = self.track_rate(storage, &flow);
            seeds.extend(components.into_iter().map(|(k, state)| (Symbol::state(state), rate.0[k])));
        }
        seeds
    }

    /// Whether one of the given displacements depends on that of another C. By its terms: expressions that are made for
    /// the question would come before those of the proofs.
    fn has_displacement_of_others(&self, nodes: &[NodeId]) -> bool {
        let graph = self.graph;
        let mut open: Vec<&Term> =
            nodes.iter().filter_map(|&node| graph.element(node)?.displacement.as_ref()).collect();
        let mut seen = vec![false; graph.lets.len()];
        while let Some(term) = open.pop() {
            let mut references = Vec::new();
            term.references(&mut references);
            for reference in references {
                match reference {
                    Reference::Let(index) if !std::mem::replace(&mut seen[index], true) => {
                        open.push(&graph.lets[index].value);
                    }
                    Reference::Displacement(node)
                        if graph.element(node).is_some_and(|element| element.displacement.is_none()) =>
                    {
                        return true;
                    }
                    _ => {}
                }
            }
        }
        false
    }

    /// The rates of the displacements of C, which the place of a stop may be.
    fn add_displacements(&mut self, seeds: &mut BTreeMap<Symbol, Id>) {
        for Layout { storage, components, .. } in self.layout.clone() {
            let Storage::Element(node) = storage else { continue };
            if self.graph.element(node).is_some_and(|element| element.kind == ElementKind::C) {
                let bond = self.graph.node(node).bonds[0];
                let flow = self.flow(bond).scale(&mut self.pool, self.graph.sign(bond, node));
                let flow = self.without_loops(&flow);
                seeds.extend(components.into_iter().map(|(k, state)| (Symbol::state(state), flow.0[k])));
            }
        }
    }

    /// The rates of angles that count turns and of displacements of junctions.
    fn add_ways(&mut self, seeds: &mut BTreeMap<Symbol, Id>) {
        for (state, rate) in self.rates_of_ways() {
            seeds.insert(Symbol::state(state), self.without_loops(&rate).0[0]);
        }
    }

    fn prove(&mut self, node: NodeId, seeds: &BTreeMap<Symbol, Id>) -> Option<Fault> {
        let graph = self.graph;
        let term = graph.element(node)?.displacement.as_ref()?;
        let displacement = self.evaluate(term, None);
        // Of an angle that counts turns its state: the difference is zero in a pose, and changes with nothing.
        let zero = self.pool.zero();
        let counted = |symbol| matches!(symbol, Symbol::Turned(_)).then_some(zero);
        let displacement = Value(substitute(&mut self.pool, &displacement.0, &counted));
        let bond = graph.node(node).bonds[0];
        let flow = self.flow(bond);
        let flow = flow.scale(&mut self.pool, graph.sign(bond, node));
        let flow = self.without_loops(&flow);
        let rates = derivative(&mut self.pool, &displacement.0, seeds);
        let proved = rates.iter().zip(&flow.0).all(|(&rate, &flow)| {
            same_polynomial(&mut self.pool, rate, flow) || same_at_places(&mut self.pool, rate, flow)
        });
        let (name, is_sink) = (graph.node(node).name.text.clone(), graph.element(node)?.kind == ElementKind::RSe);
        let is_known = self.pool.symbols(&flow.0).into_iter().all(|symbol| number(symbol).is_none());
        (!proved && is_known).then(|| Fault::new(term.span, &EquationFault::DisplacementOfOtherFlow { name, is_sink }))
    }

    /// The value with the algebraic loops solved that it needs.
    fn without_loops(&mut self, value: &Value) -> Value {
        let residuals = self.unknowns.residuals.clone();
        if self.pool.symbols(&value.0).into_iter().all(|symbol| number(symbol).is_none()) {
            return value.clone();
        }
        let values = self.solved(&residuals);
        Value(substitute(&mut self.pool, &value.0, &|symbol| values.get(&symbol).copied()))
    }
}

/// Places at which two rates are compared, and how often one is drawn: not everywhere they are numbers.
const PLACES: usize = 16;
const DRAWS: usize = 400;
/// What rounding leaves of their difference, beside its parts.
const ROUNDING: f64 = 1e-10;

/// Whether two functions of parameters, poses and flows agree at places and in branches drawn at random.
fn same_at_places(pool: &mut Pool, one: Id, other: Id) -> bool {
    let difference = pool.sub(one, other);
    let size = magnitudes(pool, &[one])[0];
    let symbols = pool.symbols(&[difference, size]);
    let switches = pool.switches(&[difference, size]).last().map_or(0, |last| *last as usize + 1);
    let mut random = Random::new(1);
    let seen = (0..DRAWS).filter_map(|_| {
        // Flows have no place among the values: they become numbers.
        let values: BTreeMap<Symbol, Id> =
            symbols.iter().map(|&symbol| (symbol, pool.number(2.0 * random.unit() - 1.0))).collect();
        let at = substitute(pool, &[difference, size], &|symbol| values.get(&symbol).copied());
        let negative: Vec<bool> = (0..switches).map(|_| random.unit() < 0.5).collect();
        let found = evaluate(pool, &at, &Environment { negative: &negative, ..Environment::default() });
        found.iter().all(|value| value.is_finite()).then(|| found[0].abs() <= ROUNDING * found[1])
    });
    let seen: Vec<bool> = seen.take(PLACES).collect();
    seen.len() == PLACES && seen.iter().all(|agree| *agree)
}
