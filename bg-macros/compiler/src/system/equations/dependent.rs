//! Storages in derivative causality: others determine their states.
//!
//! In: strokes, laws. Out: their states as expressions of other states, and what they give on their bonds.
//! Method: an I receives its flow, so its momentum is that of this flow, p(f), and it gives the effort dp/dt; a C
//! receives its effort and gives the flow dq/dt. The derivative is that along the rates of the states that are
//! integrated, which depend on what is given: a linear system, in which the storage adds to those that determine it
//! (Karnopp, Margolis and Rosenberg, System Dynamics (2012), section 5.6). Where a law has no inverse in symbols the
//! state stays, and what is given keeps it in step, as the residual sink of a rigid joint does. Where what is received
//! depends on what is given without any derivative, the state stays as well: it is independent, and the two follow from
//! each other at once. Of a vector some components may stay and others be replaced: behind a transformer to a scalar
//! one component determines all.

use std::collections::BTreeMap;

use super::independent::{Component, Kept, Rank, Slopes, slopes};
use super::signals::Signals;
use super::unknowns::{Unknown, Unknowns};
use super::{EquationFault, Slip};
use crate::expr::{Id, Node, Pool, Symbol, derivative, partial, same_polynomial, substitute};
use crate::fault::Fault;
use crate::graph::{CausalGraph, Element, ElementKind, Law, NodeId, Storage};
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
    /// How each component is calculated.
    pub ways: Vec<Way>,
    /// What is known of each component instead of a state; none of those that stay.
    pub replaced: Vec<Option<Id>>,
    /// What it gives: the rate of its state.
    pub given: Value,
}

/// The storages in derivative causality with symbols for what is not known of them; those components of their states
/// stay that are `kept`.
pub(super) fn dependents(
    causal: &CausalGraph,
    kept: &Kept,
    (pool, unknowns, reactions): (&mut Pool, &mut Unknowns, &BTreeMap<NodeId, u32>),
) -> BTreeMap<NodeId, Dependent> {
    let graph = &causal.graph;
    let mut dependents = BTreeMap::new();
    for &node in &causal.derivative {
        let Some(element) = graph.element(node) else { continue };
        let components = graph.bond(graph.node(node).bonds[0]).cardinality;
        let ways: Vec<Way> = (0..components).map(|k| way(element, kept.has((node, k)))).collect();
        let replaced = ways
            .iter()
            .map(|way| (*way == Way::Replaced).then(|| unknowns.symbols(pool, Unknown::State(node), 1).0[0]));
        let replaced = replaced.collect();
        let given = match reactions.get(&node) {
            Some(&first) => Value((first..).take(components).map(|k| pool.symbol(Symbol::Multiplier(k))).collect()),
            None => unknowns.symbols(pool, Unknown::Given(node), components),
        };
        dependents.insert(node, Dependent { ways, replaced, given });
    }
    dependents
}

/// How a component of a storage in derivative causality is calculated; `is_kept` says that what it receives depends on
/// what it gives.
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
        for (node, Dependent { ways, given, .. }) in self.dependent.clone() {
            let Some(element) = graph.element(node) else { continue };
            let received = self.received(node, element);
            let state = self.element_state(node);
            if ways.contains(&Way::Replaced) {
                let value = self.storage_inverse(node, element, &received);
                for (k, way) in ways.into_iter().enumerate() {
                    let of = if way == Way::Replaced { state.0[k] } else { given.0[k] };
                    let component = |value: &Value| Value(vec![value.0[k]]);
                    self.unknowns.equate(&mut self.pool, &Value(vec![of]), (&component(&state), &component(&value)));
                }
            } else if ways.contains(&Way::Kept) {
                let value = self.storage_law(node, element, &state);
                self.unknowns.equate(&mut self.pool, &given, (&value, &received));
            }
        }
    }

    /// Components of states that must stay after all: what their storages receive depends on what these or others like
    /// them give. As many stay as the others follow from; those of a law without an inverse before others, then those
    /// with a start. A law without an inverse keeps its whole state.
    pub(super) fn independent_after_all(&mut self) -> Kept {
        let graph = self.graph;
        let mut ranks: BTreeMap<Component, Rank> = BTreeMap::new();
        let mut received = BTreeMap::new();
        for (node, Dependent { ways, replaced, .. }) in self.dependent.clone() {
            let Some(element) = graph.element(node) else { continue };
            if ways.iter().all(|way| *way == Way::Kept) {
                continue;
            }
            let value = self.received(node, element);
            for (k, way) in ways.into_iter().enumerate().filter(|(_, way)| *way != Way::Kept) {
                ranks.insert((node, k), (way != Way::Held, element.start.is_none(), node));
                received.insert((node, k), replaced[k].unwrap_or(value.0[k]));
            }
        }
        let given: Vec<Symbol> = ranks.keys().map(|&component| self.given_by(component)).collect();
        let mut values: Vec<Id> = received.into_values().collect();
        let components: Vec<Component> = ranks.keys().copied().collect();
        let mut slopes = slopes(&mut self.pool, &values, &given);
        self.leave_idle_out((&components, &given), &mut values, &mut slopes);
        for (&(node, k), value) in components.iter().zip(values) {
            if let Some(place) = self.dependent.get_mut(&node).and_then(|known| known.replaced[k].as_mut()) {
                *place = value;
            }
        }
        let whole = |(node, k): Component| {
            let (has_inverse, ..) = ranks[&(node, k)];
            let components = self.dependent[&node].given.0.len();
            if has_inverse { k..k + 1 } else { 0..components }.map(move |k| (node, k))
        };
        let (found, sizes) = slopes.independent(&ranks);
        Kept { components: found.into_iter().flat_map(whole).collect(), sizes }
    }

    /// Takes what storages give out of values in which that cancels: of each the slope is zero, or what rounding leaves
    /// of the parts that an earlier elimination has found it to consist of.
    fn leave_idle_out(
        &mut self,
        (components, given): (&[Component], &[Symbol]),
        values: &mut [Id],
        slopes: &mut Slopes,
    ) {
        let zero = self.pool.zero();
        for ((row, value), component) in values.iter_mut().enumerate().zip(components) {
            for ((column, &symbol), by) in given.iter().enumerate().zip(components) {
                let slope = partial(&mut self.pool, &[*value], symbol)[0];
                let is_rounding = slopes.is_rounding(row, column, self.kept.size(component.0, by.0));
                if is_rounding || same_polynomial(&mut self.pool, slope, zero) {
                    *value = substitute(&mut self.pool, &[*value], &|other| (other == symbol).then_some(zero))[0];
                    slopes.clear(row, column);
                }
            }
        }
    }

    /// The symbol of what a storage gives, one component.
    fn given_by(&self, (node, k): Component) -> Symbol {
        let Node::Symbol(symbol) = *self.pool.node(self.dependent[&node].given.0[k]) else {
            unreachable!("what a storage in derivative causality gives is a symbol")
        };
        symbol
    }

    /// Calculates what storages give whose states are replaced: the derivatives of these states, and puts it in its
    /// place.
    pub(super) fn solve_dependents(&mut self) {
        let graph = self.graph;
        let mut residuals = BTreeMap::new();
        let seeds = self.rate_seeds(&[]);
        for (node, Dependent { replaced, given, .. }) in self.dependent.clone() {
            let Some(element) = graph.element(node) else { continue };
            let (of, states): (Vec<Id>, Vec<Id>) =
                given.0.into_iter().zip(replaced).filter_map(|(given, state)| Some((given, state?))).unzip();
            if states.is_empty() {
                continue;
            }
            if let Some(fault) = self.wrong(node, element, &states) {
                self.fault_once(fault);
                continue;
            }
            let (of, rates) = (Value(of), Value(derivative(&mut self.pool, &states, &seeds)));
            self.unknowns.equate(&mut self.pool, &of, (&of, &rates));
            residuals.append(&mut self.unknowns.residuals);
        }
        let values = self.solved(&residuals);
        self.put(&values);
    }

    /// Why a state that others determine has no derivative.
    fn wrong(&self, node: NodeId, element: &Element, state: &[Id]) -> Option<Fault> {
        let (kind, name) = (element.kind, self.graph.node(node).name.text.clone());
        let symbols = self.pool.symbols(state);
        let select = self.pool.reachable(state).into_iter().find_map(|id| match self.pool.node(id) {
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
        let own = self.layout.iter().find(|place| place.storage == Storage::Element(node));
        let free: Vec<String> = own
            .into_iter()
            .flat_map(|place| &place.components)
            .map(|&(_, state)| format!("`{}`", self.states[state].name))
            .collect();
        let fault = if free.is_empty() {
            EquationFault::DependentStart { kind, name, by: self.determining(state) }
        } else {
            EquationFault::PartlyDependentStart { kind, name, free }
        };
        Some(Fault::new(start.span, &fault))
    }

    fn switched(&self, switch: usize) -> Switched {
        let switch = &self.switches[switch];
        Switched { element: switch.element.clone(), condition: switch.condition.clone() }
    }

    /// The states that a state depends on, for messages.
    fn determining(&self, state: &[Id]) -> Vec<String> {
        let states = self.pool.symbols(state).into_iter().filter_map(Symbol::as_state);
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
