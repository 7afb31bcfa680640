//! Storages: their states' names, rates, start values and energies.
//!
//! In: laws of C and I, tracks. Out: states with start and rate, the stored energy, the power of modulated storages.

use std::collections::BTreeMap;

use super::EquationFault;
use super::signals::Signals;
use super::value::Value;
use crate::ast::{ElementKind, TrackKind};
use crate::expr::{Environment, Id, Symbol, antiderivative, derivative, evaluate, substitute};
use crate::fault::Fault;
use crate::graph::{BondGraph, Element, Law, NodeId, Storage, Term};
use crate::units::{Dimension, Domain};

/// Atoms that stand for a storage's own state start here, apart from those of linear laws.
const STATE_ATOMS: u32 = 32;

/// Name, unit and kind of a storage's states.
pub(super) fn describe(graph: &BondGraph, storage: Storage) -> (String, String, &'static str) {
    match storage {
        Storage::Track(index) => {
            let track = &graph.tracks[index];
            match track.kind {
                TrackKind::Position => (track.name.text.clone(), "m".to_owned(), "position"),
                TrackKind::Orientation => (track.name.text.clone(), "1".to_owned(), "orientation"),
            }
        }
        Storage::Element(node) => {
            let definition = graph.node(node);
            let bond = graph.bond(definition.bonds[0]);
            let domain = Domain::of_effort(bond.effort);
            let second = Dimension::SECOND;
            let compliance = graph.element(node).is_some_and(|element| element.kind == ElementKind::C);
            let (letter, kind, unit) = if compliance {
                ("q", "C", domain.map_or_else(|| bond.flow().times(second).to_string(), |d| d.displacement.to_owned()))
            } else {
                ("p", "I", domain.map_or_else(|| bond.effort.times(second).to_string(), |d| d.momentum.to_owned()))
            };
            (format!("{}.{letter}", definition.name.text), unit, kind)
        }
    }
}

impl Signals<'_> {
    /// Every state's rate.
    pub(super) fn rates(&mut self) {
        for (storage, first, _) in self.layout.clone() {
            let rate = match storage {
                Storage::Element(node) => {
                    let bond = self.graph.node(node).bonds[0];
                    let compliance = self.graph.element(node).is_some_and(|e| e.kind == ElementKind::C);
                    if compliance {
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
            for (k, id) in rate.0.into_iter().enumerate() {
                self.states[first + k].rate = id;
            }
        }
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
        for (storage, first, shape) in self.layout.clone() {
            let components = shape.suffixes().len();
            let (term, orientation) = match storage {
                Storage::Element(node) => (graph.element(node).and_then(|element| element.start.as_ref()), false),
                Storage::Track(index) => {
                    let track = &graph.tracks[index];
                    (track.start.as_ref(), track.kind == TrackKind::Orientation)
                }
            };
            let start = match term {
                Some(term) => self.evaluate(term, None),
                None if orientation => Value::identity(&mut self.pool),
                None => Value::zero(&mut self.pool, components),
            };
            for k in 0..components {
                self.states[first + k].start = start.0[k.min(start.0.len() - 1)];
            }
        }
    }

    /// The energy in all storages.
    pub(super) fn stored_energy(&mut self) -> Id {
        let storages = self.elements(|kind| matches!(kind, ElementKind::I | ElementKind::C));
        let energies: Vec<Id> = storages.into_iter().map(|node| self.energy_of(node)).collect();
        self.pool.sum(&energies)
    }

    /// The energy stored in one C or I.
    pub(super) fn energy_of(&mut self, node: NodeId) -> Id {
        let state = self.element_state(node);
        let (energy, atoms) = self.energy_of_atoms(node, state.0.len());
        let find = |symbol| atoms.iter().position(|&atom| atom == symbol).map(|k| state.0[k]);
        substitute(&mut self.pool, &[energy], &find)[0]
    }

    /// The stored energy as an expression of atoms that stand for the storage's own state.
    fn energy_of_atoms(&mut self, node: NodeId, components: usize) -> (Id, Vec<Symbol>) {
        let graph = self.graph;
        let atoms: Vec<Symbol> = (STATE_ATOMS..).take(components).map(Symbol::Atom).collect();
        let state = Value(atoms.iter().map(|&atom| self.pool.symbol(atom)).collect());
        let Some(element) = graph.element(node) else { return (self.pool.zero(), atoms) };
        let law = self.storage_law(node, element, &state);
        let energy = match (&element.law, &element.energy) {
            (Law::Of { .. }, Some(term)) => self.given_energy(node, term, &state, &law, &atoms),
            (Law::Of { .. }, None) => self.found_energy(node, element, &law, &atoms),
            _ => {
                let product = law.dot(&mut self.pool, &state);
                self.pool.scale(0.5, product)
            }
        };
        (energy, atoms)
    }

    fn found_energy(&mut self, node: NodeId, element: &Element, law: &Value, atoms: &[Symbol]) -> Id {
        let found = if law.0.len() == 1 { antiderivative(&mut self.pool, law.0[0], atoms[0]) } else { None };
        found.unwrap_or_else(|| {
            let definition = self.graph.node(node);
            let (symbol, name) = (element.kind.symbol(), definition.name.text.clone());
            let fault = Fault::new(element.law.term().span, &EquationFault::NoEnergy { symbol, name });
            self.fault_once(fault);
            self.pool.zero()
        })
    }

    /// The user's energy, tested against the law at a few states: d(energy)/d(state) = law.
    fn given_energy(&mut self, node: NodeId, term: &Term, state: &Value, law: &Value, atoms: &[Symbol]) -> Id {
        let energy = self.evaluate(term, Some(state)).0[0];
        let one = self.pool.one();
        let mut pairs = Vec::new();
        for (&atom, &expected) in atoms.iter().zip(&law.0) {
            let slope = derivative(&mut self.pool, &[energy], &BTreeMap::from([(atom, one)]))[0];
            pairs.extend([slope, expected]);
        }
        if !self.agree_at_samples(&pairs) {
            let definition = self.graph.node(node);
            let (symbol, name) = (definition.kind.symbol(), definition.name.text.clone());
            self.fault_once(Fault::new(term.span, &EquationFault::EnergyOfOtherLaw { symbol, name }));
        }
        energy
    }

    fn fault_once(&mut self, fault: Fault) {
        if self.faults.iter().all(|known| known.message != fault.message) {
            self.faults.push(fault);
        }
    }

    /// Whether consecutive pairs of expressions have equal values at sample points, in either branch of every switch.
    fn agree_at_samples(&self, pairs: &[Id]) -> bool {
        let parameters: Vec<f64> = self.graph.parameters.iter().map(|parameter| parameter.default).collect();
        let guards: Vec<Id> = self.switches.iter().map(|switch| switch.guard).collect();
        // Irregular values of both signs, so that no term vanishes by symmetry.
        [0.37, -0.53, 1.21, -1.73].iter().all(|&scale| {
            let sample = |k: usize| scale * (1.0 + 0.11 * f64::from(u32::try_from(k % 97).unwrap_or(0)));
            let states: Vec<f64> = (0..self.states.len()).map(sample).collect();
            let atoms: Vec<f64> = (0..STATE_ATOMS as usize + 9).map(sample).collect();
            let inputs = vec![scale; self.graph.inputs.len()];
            let unknowns = vec![scale; self.graph.guesses.len()];
            let mut negative = vec![false; guards.len()];
            let point = |negative: &[bool], roots: &[Id]| {
                let environment = Environment {
                    time: scale.abs(),
                    states: &states,
                    parameters: &parameters,
                    inputs: &inputs,
                    unknowns: &unknowns,
                    atoms: &atoms,
                    negative,
                };
                evaluate(&self.pool, roots, &environment)
            };
            negative = point(&negative, &guards).iter().map(|&guard| guard < 0.0).collect();
            point(&negative, pairs).chunks_exact(2).all(|pair| {
                // Rounding of sums of a few terms; a wrong energy differs in the first digits.
                (pair[0] - pair[1]).abs() <= 1e-9 * (pair[0].abs() + pair[1].abs() + 1e-300)
                    || pair.iter().any(|value| !value.is_finite())
            })
        })
    }

    /// The power that enters through storages whose law other quantities modulate: the energy's change at rest of the
    /// storage's own state. A tensor that turns with its own flow has none: h . (w x w) = 0.
    pub(super) fn modulation_power(&mut self) -> Id {
        let graph = self.graph;
        let mut seeds: BTreeMap<Symbol, Id> = BTreeMap::new();
        for (index, state) in self.states.iter().enumerate() {
            seeds.insert(Symbol::State(u32::try_from(index).expect("fewer than 2^32 states")), state.rate);
        }
        let one = self.pool.one();
        seeds.insert(Symbol::Time, one);
        let mut powers = Vec::new();
        for node in self.elements(|kind| matches!(kind, ElementKind::I | ElementKind::C)) {
            if graph.element(node).is_some_and(|element| element.frame.is_some()) {
                continue;
            }
            let state = self.element_state(node);
            let (energy, atoms) = self.energy_of_atoms(node, state.0.len());
            let change = derivative(&mut self.pool, &[energy], &seeds);
            let find = |symbol| atoms.iter().position(|&atom| atom == symbol).map(|k| state.0[k]);
            powers.extend(substitute(&mut self.pool, &change, &find));
        }
        self.pool.sum(&powers)
    }
}
