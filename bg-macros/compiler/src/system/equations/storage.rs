//! Storages: their states' names, rates, start values and energies.
//!
//! In: laws of C and I, tracks. Out: states with start and rate, the stored energy, the power of modulated storages.

use std::collections::BTreeMap;

use super::EquationFault;
use super::Origin;
use super::requirements::is_rotation;
use super::signals::{Layout, Signals, orthogonalized};
use crate::expr::{Id, Node, Symbol, antiderivative, derivative, substitute};
use crate::fault::Fault;
use crate::graph::{BondGraph, Element, ElementKind, Law, NodeId, Storage, Term, TrackKind};
use crate::system::Value;

/// Name and unit of a storage's states.
pub(super) fn describe(graph: &BondGraph, storage: Storage) -> (String, String) {
    match storage {
        Storage::Track(index) => {
            let track = &graph.tracks[index];
            let unit = match track.kind {
                TrackKind::Position => "m",
                TrackKind::Orientation => "1",
            };
            (track.name.text.clone(), unit.to_owned())
        }
        Storage::Element(node) => {
            let definition = graph.node(node);
            let bond = graph.bond(definition.bonds[0]);
            let (letter, unit) =
                if is_compliance(graph, node) { ("q", bond.displacement_unit()) } else { ("p", bond.momentum_unit()) };
            (format!("{}.{letter}", definition.name.text), unit)
        }
    }
}

/// What a component of a storage's states is.
pub(super) fn origin(graph: &BondGraph, storage: Storage, component: usize) -> Origin {
    match storage {
        Storage::Track(track) => match graph.tracks[track].kind {
            TrackKind::Position => Origin::Position(track, component),
            TrackKind::Orientation => Origin::Orientation(track, component / 3, component % 3),
        },
        Storage::Element(node) if is_compliance(graph, node) => Origin::Displacement(node, component),
        Storage::Element(node) => Origin::Momentum(node, component),
    }
}

fn is_compliance(graph: &BondGraph, node: NodeId) -> bool {
    graph.element(node).is_some_and(|element| element.kind == ElementKind::C)
}

impl Signals<'_> {
    /// Every state's rate.
    pub(super) fn rates(&mut self) {
        for Layout { storage, components, .. } in self.layout.clone() {
            let rate = match storage {
                Storage::Element(node) => {
                    let bond = self.graph.node(node).bonds[0];
                    if is_compliance(self.graph, node) {
                        let flow = self.flow(bond);
                        flow.scale(&mut self.pool, self.graph.sign(bond, node))
                    } else {
                        self.effort(bond)
                    }
                }
                Storage::Track(index) => {
                    let track = &self.graph.tracks[index];
                    let flow = self.junction_flow(track.junction);
                    self.track_rate(storage, &flow)
                }
            };
            for (k, state) in components {
                self.states[state].rate = rate.0[k];
            }
        }
        self.way_rates();
    }

    /// A position moves with the flow, an orientation turns with it: R' = [w x] R.
    pub(super) fn track_rate(&mut self, storage: Storage, flow: &Value) -> Value {
        let Storage::Track(index) = storage else { return flow.clone() };
        match self.graph.tracks[index].kind {
            TrackKind::Position => flow.clone(),
            TrackKind::Orientation => {
                let orientation = self.state(storage).expect("every track has states");
                let spin = flow.skew(&mut self.pool);
                spin.multiply(&mut self.pool, &orientation)
            }
        }
    }

    /// Every state's value at t = 0.
    pub(super) fn starts(&mut self) {
        let graph = self.graph;
        for Layout { storage, shape, components } in self.layout.clone() {
            let (term, orientation) = match storage {
                Storage::Element(node) => (graph.element(node).and_then(|element| element.start.as_ref()), false),
                Storage::Track(index) => {
                    let track = &graph.tracks[index];
                    (track.start.as_ref(), track.kind == TrackKind::Orientation)
                }
            };
            let start = match term {
                Some(term) if orientation => self.orientation_of(term),
                Some(term) => self.evaluate(term, None),
                None if orientation => Value::identity(&mut self.pool),
                None => Value::zero(&mut self.pool, shape.suffixes().len()),
            };
            for (k, state) in components {
                self.states[state].start = start.0[k.min(start.0.len() - 1)];
            }
        }
        for (index, integral) in graph.integrals.iter().enumerate() {
            if let Some(start) = &integral.start {
                self.states[self.first_integral + index].start = self.evaluate(start, None).0[0];
            }
        }
        self.starts_by_pose();
        self.way_starts();
    }

    /// The rotation that a term means: one of numbers is one to few digits, and joints that it would close are to stay
    /// closed when a run makes it one to all digits. Two steps leave nothing of what is accepted.
    pub(super) fn orientation_of(&mut self, term: &Term) -> Value {
        let given = self.evaluate(term, None);
        if is_rotation(self.graph, term) || self.graph.is_clause(term) {
            return given;
        }
        let closer = orthogonalized(&mut self.pool, &given);
        orthogonalized(&mut self.pool, &closer)
    }

    /// The start of a storage may depend on the start pose.
    fn starts_by_pose(&mut self) {
        for index in 0..self.states.len() {
            let start = self.states[index].start;
            if self.pool.symbols(&[start]).into_iter().any(|symbol| symbol.as_state().is_some()) {
                self.states[index].start = self.at_start(&[start])[0];
            }
        }
    }

    /// The energy in all storages.
    pub(super) fn stored_energy(&mut self) -> Id {
        let energies = self.energies();
        self.pool.sum(&energies)
    }

    /// The energy in each storage.
    pub(super) fn energies(&mut self) -> Vec<Id> {
        let storages = self.elements(|kind| matches!(kind, ElementKind::I | ElementKind::C));
        storages.into_iter().map(|node| self.energy_of(node)).collect()
    }

    /// The energy stored in one C or I.
    pub(super) fn energy_of(&mut self, node: NodeId) -> Id {
        let graph = self.graph;
        let Some(element) = graph.element(node) else { return self.pool.zero() };
        let state = self.element_state(node);
        self.energy_at(node, element, &state)
    }

    /// The energy stored in a C or I at a state.
    fn energy_at(&mut self, node: NodeId, element: &Element, state: &Value) -> Id {
        match (&element.law, &element.energy) {
            (Law::Of { .. }, Some(term)) => {
                self.check_energy(node, element, term);
                self.evaluate(term, Some(state)).0[0]
            }
            (Law::Of { .. }, None) => self.found_energy(node, element, state),
            _ => {
                let effort = self.storage_law(node, element, state);
                let product = effort.dot(&mut self.pool, state);
                self.pool.scale(0.5, product)
            }
        }
    }

    /// Symbols in the place of a storage's own state.
    pub(super) fn own_symbols(&mut self, components: usize) -> (Vec<Symbol>, Value) {
        let symbols: Vec<Symbol> = (0..).take(components).map(Symbol::Storage).collect();
        let value = Value(symbols.iter().map(|&symbol| self.pool.symbol(symbol)).collect());
        (symbols, value)
    }

    /// The integral of a scalar law over its variable.
    fn found_energy(&mut self, node: NodeId, element: &Element, state: &Value) -> Id {
        let switches = self.switches.len();
        let (own, variable) = self.own_symbols(state.0.len());
        let (asked, law) = self.asking(|signals| signals.storage_law(node, element, &variable));
        // Switches over the storage's own symbols are of this calculation only; a law with any has no integral here.
        // The antiderivative would not see that a value depends on the variable by way of a guard alone.
        let is_own =
            |id: &Id| matches!(self.pool.node(*id), Node::Select { switch, .. } if *switch as usize >= switches);
        let is_free = law.0.len() == 1 && !self.pool.reachable(&law.0).iter().any(is_own);
        self.switches.truncate(switches);
        let found = if is_free {
            let rest = self.without_tables(&asked, law.0[0]);
            antiderivative(&mut self.pool, rest, own[0])
        } else {
            None
        };
        let of_tables = if is_free { self.integral_of_tables(&asked, law.0[0], own[0], state.0[0]) } else { None };
        let (Some(found), Some(of_tables)) = (found, of_tables) else {
            let definition = self.graph.node(node);
            let (symbol, name) = (element.kind.symbol(), definition.name.text.clone());
            self.fault_once(Fault::new(element.law.term().span, &EquationFault::NoEnergy { symbol, name }));
            return self.pool.zero();
        };
        let found = substitute(&mut self.pool, &[found], &|symbol| (symbol == own[0]).then_some(state.0[0]))[0];
        self.pool.add(found, of_tables)
    }

    /// Reports a fault unless it is known.
    pub(super) fn fault_once(&mut self, fault: Fault) {
        if self.faults.iter().all(|known| known.message != fault.message) {
            self.faults.push(fault);
        }
    }

    /// The power that enters through storages whose law other quantities modulate: the energy's change at rest of the
    /// storage's own state. A tensor that turns with its own flow has none: h . (w x w) = 0.
    pub(super) fn modulation_power(&mut self) -> Id {
        let graph = self.graph;
        let mut powers = Vec::new();
        for node in self.elements(|kind| matches!(kind, ElementKind::I | ElementKind::C)) {
            if graph.element(node).is_some_and(|element| element.frame.is_none()) {
                powers.push(self.modulation_of(node));
            }
        }
        self.pool.sum(&powers)
    }

    fn modulation_of(&mut self, node: NodeId) -> Id {
        let graph = self.graph;
        let Some(element) = graph.element(node) else { return self.pool.zero() };
        if element.displacement.is_some() {
            return self.modulation_of_displaced(node, element);
        }
        if self.dependent.get(&node).is_some_and(|dependent| dependent.replaced.iter().any(Option::is_some)) {
            return self.modulation_of_dependent(node, element);
        }
        // At rest of its own states: their seeds are missing.
        let own = self.element_state(node).0;
        let seeds = self.rate_seeds(&own);
        let energy = self.energy_of(node);
        derivative(&mut self.pool, &[energy], &seeds)[0]
    }

    /// Of a storage whose state others determine: that is held constant while the rest changes.
    fn modulation_of_dependent(&mut self, node: NodeId, element: &Element) -> Id {
        let state = self.element_state(node);
        let (own, variable) = self.own_symbols(state.0.len());
        let energy = self.energy_at(node, element, &variable);
        let seeds = self.rate_seeds(&[]);
        let change = derivative(&mut self.pool, &[energy], &seeds);
        let find = |symbol| own.iter().position(|&known| known == symbol).map(|k| state.0[k]);
        substitute(&mut self.pool, &change, &find)[0]
    }

    /// Of a C whose displacement the poses determine: the displacement is held constant while the rest changes.
    fn modulation_of_displaced(&mut self, node: NodeId, element: &Element) -> Id {
        let state = self.element_state(node);
        let switches = self.switches.len();
        let (own, variable) = self.own_symbols(state.0.len());
        let law = self.storage_law(node, element, &variable);
        let is_own = |symbol: &Symbol| own.contains(symbol) || matches!(symbol, Symbol::Parameter(_));
        let is_modulated = !self.pool.symbols(&law.0).iter().all(is_own);
        let is_linear = !matches!(element.law, Law::Of { .. }) && self.switches.len() == switches;
        self.switches.truncate(switches);
        if !is_modulated {
            return self.pool.zero();
        }
        if !is_linear {
            let (symbol, name) = (element.kind.symbol(), self.graph.node(node).name.text.clone());
            self.fault_once(Fault::new(element.law.term().span, &EquationFault::NoEnergy { symbol, name }));
            return self.pool.zero();
        }
        let product = law.dot(&mut self.pool, &variable);
        let energy = self.pool.scale(0.5, product);
        let seeds = self.rate_seeds(&[]);
        let change = derivative(&mut self.pool, &[energy], &seeds);
        let find = |symbol| own.iter().position(|&known| known == symbol).map(|k| state.0[k]);
        substitute(&mut self.pool, &change, &find)[0]
    }

    /// The rates of time and of all states but `held`.
    pub(super) fn rate_seeds(&mut self, held: &[Id]) -> BTreeMap<Symbol, Id> {
        let mut seeds = BTreeMap::from([(Symbol::Time, self.pool.one())]);
        for index in 0..self.states.len() {
            let symbol = self.state_symbol(index);
            if !held.contains(&symbol) {
                seeds.insert(Symbol::state(index), self.states[index].rate);
            }
        }
        seeds
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::{Environment, Function, Id, apply, evaluate};
    use crate::pipeline;
    use crate::source::syntax;

    /// A rod's orientation at the start and the place of its end, which is to be at (0, 1, 0).
    fn start(turned: &str) -> ([f64; 9], [f64; 3]) {
        let text = format!(
            "graph G {{ param unit: m = 1; body rod {{ mass 1; inertia [1, 1, 1]; point end = [-0.6, 0.2, 0]; \
            start end at [0, 1, 0];
             start turned {turned}; }} observe {{ end: m = rod.position + rod.orientation * (unit * [-0.6, 0.2, 0]); \
             }} }}"
        );
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let equations = pipeline::derive(&source.graphs[0]).expect("equations").equations;
        let starts: Vec<Id> = equations.states.iter().map(|state| state.start).collect();
        let states = evaluate(&equations.pool, &starts, &Environment::default());
        let first = equations.states.iter().position(|state| state.name == "rod.orientation_11").expect("a state");
        let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
        let end = evaluate(
            &equations.pool,
            &outputs,
            &Environment { states: &states, parameters: &[1.0], ..Environment::default() },
        );
        (states[first..first + 9].try_into().expect("nine"), end.try_into().expect("three"))
    }

    #[test]
    fn an_orientation_of_few_digits_starts_as_a_rotation_and_leaves_its_points_where_they_are_to_be() {
        let (r, end) = start("[[0.866025, -0.5, 0], [0.5, 0.866025, 0], [0, 0, 1]]");
        assert!((r[0] * r[0] + r[3] * r[3] - 1.0).abs() < 4e-16, "{r:?}");
        assert!((r[0] - 0.75_f64.sqrt()).abs() < 4e-7 && (r[3] - 0.5).abs() < 4e-7, "{r:?}");
        assert!(end.iter().zip([0.0, 1.0, 0.0]).all(|(found, wanted)| (found - wanted).abs() < 3e-16), "{end:?}");
    }

    #[test]
    fn what_is_a_rotation_as_it_is_written_keeps_its_bits() {
        let (r, _) = start("rotation_z(0.5)");
        let functions = [Function::Cos, Function::Sin].map(|function| apply(function, &[0.5]));
        assert_eq!([r[0], r[3]], functions);
    }
}
