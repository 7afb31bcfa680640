//! Storages in derivative causality: others determine their states.
//!
//! In: strokes, laws. Out: their states as expressions of other states, and what they give on their bonds.
//! Method: an I receives its flow, so its momentum is that of this flow, p(f), and it gives the effort dp/dt; a C
//! receives its effort and gives the flow dq/dt. The derivative is that along the rates of the states that are
//! integrated, which depend on what is given: a linear system, in which the storage adds to those that determine it
//! (Karnopp, Margolis and Rosenberg, System Dynamics (2012), section 5.6). Where a law has no inverse in symbols the
//! state stays, and what is given keeps it in step, as the residual sink of a rigid joint does. Where what is received
//! depends on what is given without any derivative, the state stays as well: it is independent, and the two follow from
//! each other at once.

use std::collections::{BTreeMap, BTreeSet};

use super::signals::Signals;
use super::unknowns::{Unknown, Unknowns};
use super::{EquationFault, Slip};
use crate::expr::{Id, Node, Pool, Symbol, derivative, partial, same_polynomial, substitute};
use crate::fault::Fault;
use crate::graph::{CausalGraph, Element, ElementKind, Law, NodeId};
use crate::system::Value;

/// How a storage in derivative causality is calculated.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Way {
    /// Its state is an expression of what it receives.
    Replaced,
    /// Its state stays; what it gives keeps it in step.
    Held,
    /// Its state stays; what it gives follows from it and what it receives.
    Kept,
}

/// A storage in derivative causality.
#[derive(Clone, Debug)]
pub(super) struct Dependent {
    pub way: Way,
    /// Its state, where that is replaced.
    pub state: Option<Value>,
    /// What it gives: the rate of its state.
    pub given: Value,
}

/// The storages in derivative causality with symbols for what is not known of them; of those in `kept` the states stay.
pub(super) fn dependents(
    causal: &CausalGraph,
    kept: &BTreeSet<NodeId>,
    (pool, unknowns, reactions): (&mut Pool, &mut Unknowns, &BTreeMap<NodeId, u32>),
) -> BTreeMap<NodeId, Dependent> {
    let graph = &causal.graph;
    let mut dependents = BTreeMap::new();
    for &node in &causal.derivative {
        let Some(element) = graph.element(node) else { continue };
        let components = graph.bond(graph.node(node).bonds[0]).cardinality;
        let way = way(element, kept.contains(&node));
        let state = (way == Way::Replaced).then(|| unknowns.symbols(pool, Unknown::State(node), components));
        let given = match reactions.get(&node) {
            Some(&first) => Value((first..).take(components).map(|k| pool.symbol(Symbol::Multiplier(k))).collect()),
            None => unknowns.symbols(pool, Unknown::Given(node), components),
        };
        dependents.insert(node, Dependent { way, state, given });
    }
    dependents
}

/// How a storage in derivative causality is calculated; `is_kept` says that what it receives depends on what it gives.
pub(super) fn way(element: &Element, is_kept: bool) -> Way {
    let has_inverse = match &element.law {
        Law::Of { value, .. } => value.is_linear(),
        _ => true,
    };
    match (is_kept, has_inverse) {
        (true, _) => Way::Kept,
        (false, true) => Way::Replaced,
        (false, false) => Way::Held,
    }
}

impl Signals<'_> {
    /// What a storage in derivative causality gives on its bond, along the half arrow.
    pub(super) fn dependent_given(&mut self, node: NodeId) -> Option<Value> {
        let given = self.dependent.get(&node)?.given.clone();
        let graph = self.graph;
        let is_flow = graph.element(node)?.kind == ElementKind::C;
        let sign = if is_flow { graph.sign(graph.node(node).bonds[0], node) } else { 1.0 };
        Some(given.scale(&mut self.pool, sign))
    }

    /// What such a storage receives: a flow into an I, the effort of a C.
    fn received(&mut self, node: NodeId, element: &Element) -> Value {
        let bond = self.graph.node(node).bonds[0];
        if element.kind == ElementKind::C {
            return self.effort(bond);
        }
        let sign = self.graph.sign(bond, node);
        self.flow(bond).scale(&mut self.pool, sign)
    }

    /// The equations of the states of storages in derivative causality.
    pub(super) fn equate_dependents(&mut self) {
        let graph = self.graph;
        for (node, Dependent { way, state, given }) in self.dependent.clone() {
            let Some(element) = graph.element(node) else { continue };
            let received = self.received(node, element);
            match (way, state) {
                (Way::Replaced, Some(state)) => {
                    let value = self.storage_inverse(node, element, &received);
                    self.unknowns.equate(&mut self.pool, &state, (&state, &value));
                }
                (Way::Kept, _) => {
                    let state = self.element_state(node);
                    let value = self.storage_law(node, element, &state);
                    self.unknowns.equate(&mut self.pool, &given, (&value, &received));
                }
                _ => {}
            }
        }
    }

    /// A storage whose state must stay after all: what it receives depends on what it or others like it give. Of
    /// several the first is taken, as it may determine the others: a law without an inverse before others, then one
    /// with a start.
    pub(super) fn independent_after_all(&mut self) -> Option<NodeId> {
        let graph = self.graph;
        let mut found = Vec::new();
        for (node, Dependent { way, state, .. }) in self.dependent.clone() {
            let Some(element) = graph.element(node) else { continue };
            let is_replaced = state.is_some();
            let values = state.unwrap_or_else(|| self.received(node, element));
            let values = self.without_idle(values);
            if way != Way::Kept && self.given_in(&values).next().is_some() {
                found.push((way != Way::Held, element.start.is_none(), node));
            } else if let Some(dependent) = self.dependent.get_mut(&node).filter(|_| is_replaced) {
                dependent.state = Some(values);
            }
        }
        found.into_iter().min().map(|(_, _, node)| node)
    }

    /// The value without what storages give where that cancels.
    fn without_idle(&mut self, value: Value) -> Value {
        let zero = self.pool.zero();
        let given: Vec<Symbol> = self.given_in(&value).collect();
        given.into_iter().fold(value, |value, symbol| {
            let slopes = partial(&mut self.pool, &value.0, symbol);
            if !slopes.iter().all(|&slope| same_polynomial(&mut self.pool, slope, zero)) {
                return value;
            }
            Value(substitute(&mut self.pool, &value.0, &|other| (other == symbol).then_some(zero)))
        })
    }

    /// What storages in derivative causality give and a value contains.
    fn given_in(&self, value: &Value) -> impl Iterator<Item = Symbol> + use<> {
        let all = self.dependent.values().flat_map(|dependent| &dependent.given.0);
        let given = self.pool.symbols(&all.copied().collect::<Vec<_>>());
        self.pool.symbols(&value.0).into_iter().filter(move |symbol| given.contains(symbol))
    }

    /// Calculates what storages give whose states are replaced: the derivatives of these states, and puts it in its
    /// place.
    pub(super) fn solve_dependents(&mut self) {
        let graph = self.graph;
        let mut residuals = BTreeMap::new();
        let seeds = self.rate_seeds(&[]);
        for (node, Dependent { state, given, .. }) in self.dependent.clone() {
            let (Some(state), Some(element)) = (state, graph.element(node)) else { continue };
            if let Some(fault) = self.wrong(node, element, &state) {
                self.fault_once(fault);
                continue;
            }
            let rates = Value(derivative(&mut self.pool, &state.0, &seeds));
            self.unknowns.equate(&mut self.pool, &given, (&given, &rates));
            residuals.append(&mut self.unknowns.residuals);
        }
        let values = self.solved(&residuals);
        self.put(&values);
    }

    /// Why a state that others determine has no derivative.
    fn wrong(&self, node: NodeId, element: &Element, state: &Value) -> Option<Fault> {
        let (kind, name) = (element.kind, self.graph.node(node).name.text.clone());
        let symbols = self.pool.symbols(&state.0);
        let select = self.pool.reachable(&state.0).into_iter().find_map(|id| match self.pool.node(id) {
            Node::Select { switch, .. } => Some(*switch as usize),
            _ => None,
        });
        if let Some(input) =
            symbols.iter().find_map(|s| if let Symbol::Input(k) = s { Some(*k as usize) } else { None })
        {
            let input = self.graph.inputs[input].name.text.clone();
            return Some(self.fault_of(node, &EquationFault::DependentOnInput { kind, name, input }));
        }
        if let Some(switch) = select {
            let Switched { element, condition } = self.switched(switch);
            return Some(self.fault_of(node, &EquationFault::DependentJumps { kind, name, element, condition }));
        }
        // A reaction, or what an iteration finds: their rates of change are not known here.
        if symbols.iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_) | Symbol::Unsolved(_))) {
            let members = self.names(&[node]);
            let why =
                "its state depends on a reaction or on a loop that is not linear, whose rates are not known".to_owned();
            return Some(self.fault_of(node, &EquationFault::DependentOpen { members, why }));
        }
        let start = element.start.as_ref()?;
        let by = self.determining(state);
        Some(Fault::new(start.span, &EquationFault::DependentStart { kind, name, by }))
    }

    fn switched(&self, switch: usize) -> Switched {
        let switch = &self.switches[switch];
        Switched { element: switch.element.clone(), condition: switch.condition.clone() }
    }

    /// The states that a state depends on, for messages.
    fn determining(&self, state: &Value) -> Vec<String> {
        let states = self.pool.symbols(&state.0).into_iter().filter_map(Symbol::as_state);
        states.map(|state| format!("`{}`", self.states[state].name)).collect()
    }

    /// The motions that storages hold whose laws have no inverse: what they receive less what their states say.
    pub(super) fn dependent_slips(&mut self, node: NodeId) -> Vec<Slip> {
        let graph = self.graph;
        let Some(element) = graph.element(node) else { return Vec::new() };
        let bond = graph.bond(graph.node(node).bonds[0]);
        let unit = if element.kind == ElementKind::C { bond.effort_unit() } else { bond.flow_unit() };
        let received = self.received(node, element);
        let state = self.element_state(node);
        let own = self.storage_law(node, element, &state).negate(&mut self.pool);
        let excess: Vec<Id> = received.add(&mut self.pool, &own).0;
        let slip = |(k, flow)| Slip {
            joint: graph.node(node).name.text.clone(),
            direction: self.direction_of(node, k),
            unit: unit.clone(),
            flow,
            kept: None,
            gap: None,
            mobility: None,
        };
        excess.into_iter().enumerate().map(slip).collect()
    }
}

/// A comparison in messages.
struct Switched {
    element: String,
    condition: String,
}
