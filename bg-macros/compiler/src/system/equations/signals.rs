//! Effort and flow of every bond, each from the end that gives it.
//!
//! In: strokes. Out: component expressions, calculated when first asked for; a variable that needs itself is an unknown
//! until all are known.

use std::collections::{BTreeMap, BTreeSet};

use super::dependent::{Dependent, Way, dependents, way};
use super::fallible::Nature;
use super::independent::Kept;
use super::iteration::Loop;
use super::memo::{Entry, Memo};
use super::solving::Pivot;
use super::unknowns::{Unknown, Unknowns};
use super::{
    Assembly, Balance, FallibleLaw, Gap, Holding, Impacts, Kind, Origin, Output, State, StateEquations, Switch,
    storage, text,
};
use crate::expr::{Function, Id, Pool, Symbol, blended, magnitudes, substitute};
use crate::fault::{Fault, Staged};
use crate::graph::units::Dimension;
use crate::graph::{
    BondGraph, BondId, CausalGraph, ElementKind, End, Lookup, NodeId, NodeKind, Role, Shape, Storage, TrackKind,
};
use crate::system::Value;
use crate::system::equations::solution::Solution;

/// The states of a storage.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub storage: Storage,
    pub shape: Shape,
    /// Its components that are states, and the state of each: all, unless others determine some of them.
    pub components: Vec<(usize, usize)>,
}

/// The gap of a joint, with its unit and its components.
pub(super) type Open = (String, String, Vec<Id>);

/// What is added to a guard before a run, so that it is not zero: its square is a number.
const BESIDE: f64 = 1e-150;

/// The derivation in progress.
pub(super) struct Signals<'a> {
    pub(super) causal: &'a CausalGraph,
    pub(super) graph: &'a BondGraph,
    pub(super) pool: Pool,
    pub(super) memo: Memo,
    /// Flows of 1-junctions that stand for themselves (in the kinematic proof).
    pub(super) given_flows: BTreeMap<NodeId, Value>,
    pub(super) states: Vec<State>,
    /// The states of every storage, in their order.
    pub(super) layout: Vec<Layout>,
    pub(super) first_integral: usize,
    /// The states of angles that count turns, by their number.
    pub(super) turns: BTreeMap<usize, usize>,
    /// The states of displacements of junctions.
    pub(super) ways: BTreeMap<NodeId, usize>,
    /// First multiplier of every residual sink, of every storage that what it gives keeps in step, and of dry friction.
    pub(super) reactions: BTreeMap<NodeId, u32>,
    /// The storages in derivative causality.
    pub(super) dependent: BTreeMap<NodeId, Dependent>,
    /// What stays a state of them.
    pub(super) kept: &'a Kept,
    /// What has no value yet.
    pub(super) unknowns: Unknowns,
    /// The algebraic loops that are left to iterations.
    pub(super) loops: Vec<Loop>,
    /// What solutions divide by and parameters may make zero.
    pub(super) pivots: Vec<Pivot>,
    pub(super) switches: Vec<Switch>,
    /// While the energy of a law is found: the tables that the law asks, with their arguments.
    pub(super) asked: Option<Vec<(Lookup, Vec<Id>)>>,
    /// What is being evaluated, for the switches' names.
    pub(super) owner: String,
    pub(super) fallible: Vec<FallibleLaw>,
    /// What is known of the lets.
    pub(super) natures: Vec<Option<Nature>>,
    pub(super) path: Vec<(Role, BondId)>,
    pub(super) faults: Vec<Fault>,
}

impl<'a> Signals<'a> {
    /// The derivation's beginning; the components `kept` stay states although their storages are in derivative
    /// causality.
    pub(super) fn new(causal: &'a CausalGraph, kept: &'a Kept) -> Self {
        let mut signals = Self {
            causal,
            graph: &causal.graph,
            pool: Pool::new(),
            memo: Memo::new(&causal.graph),
            given_flows: BTreeMap::new(),
            states: Vec::new(),
            layout: Vec::new(),
            first_integral: 0,
            turns: BTreeMap::new(),
            ways: BTreeMap::new(),
            reactions: BTreeMap::new(),
            dependent: BTreeMap::new(),
            kept,
            unknowns: Unknowns::default(),
            loops: Vec::new(),
            pivots: Vec::new(),
            switches: Vec::new(),
            asked: None,
            owner: String::new(),
            fallible: Vec::new(),
            natures: vec![None; causal.graph.lets.len()],
            path: Vec::new(),
            faults: Vec::new(),
        };
        signals.lay_out();
        let tables = (&mut signals.pool, &mut signals.unknowns, &signals.reactions);
        signals.dependent = dependents(causal, kept, tables);
        signals
    }

    /// Effort and flow of every bond, the states' rates. What must stay a state after all although its storage is in
    /// derivative causality.
    pub(super) fn solve_bonds(&mut self) -> Kept {
        self.prove_displacements();
        self.fallible.clear();
        for bond in (0..self.graph.bonds.len()).map(BondId) {
            self.effort(bond);
            self.flow(bond);
        }
        self.rates();
        self.equate_dependents();
        let residuals = std::mem::take(&mut self.unknowns.residuals);
        let values = self.solved(&residuals);
        self.put(&values);
        self.independent_after_all()
    }

    /// Runs the derivation, where the bonds are solved.
    pub(super) fn derive(mut self) -> Staged<StateEquations> {
        self.solve_dependents();
        let bonds = (0..self.graph.bonds.len()).map(BondId);
        let bonds = bonds.map(|bond| [self.effort(bond), self.flow(bond)].map(|value| Some(value.0))).collect();
        let energies = self.energies();
        let stored = self.pool.sum(&energies);
        let (supplied, dissipated) = (self.supplied_power(), self.dissipated_power());
        if !self.faults.is_empty() {
            return Err(self.faults);
        }
        let outputs = self.outputs();
        self.integral_rates();
        self.starts();
        let (guesses, speeds, open) = (self.guesses(), self.speeds(), self.open());
        let gaps = self.gaps(&open);
        let holding = Holding { compliant: self.compliant_slips(&speeds), ..Holding::default() };
        let mut projections = self.projections();
        projections.extend(self.turn_projections());
        projections.extend(self.memories());
        let reactions = self.reactions();
        let texts = text::equations(&self);
        if !self.faults.is_empty() {
            return Err(self.faults);
        }
        let mut requirements = self.requirements();
        requirements.decide(&self.graph.parameters)?;
        let extents = extents(&mut requirements.pool, &open, &self.states);
        requirements.extents = extents;
        let shown = self.shown(bonds);
        let mut equations = StateEquations {
            pool: self.pool,
            parameters: self.graph.parameters.clone(),
            inputs: self.graph.inputs.clone(),
            tracks: self.graph.tracks.iter().map(|track| track.name.text.clone()).collect(),
            states: self.states,
            assembly: Assembly { guesses, speeds, gaps, sides: Vec::new(), impulse: self.graph.impulse },
            switches: self.switches,
            outputs,
            balance: Balance { stored, energies, supplied, dissipated },
            projections,
            delays: self.graph.delays.clone(),
            settled: Vec::new(),
            fallible: self.fallible,
            iterations: Vec::new(),
            reactions,
            solution: Solution::default(),
            holding,
            inverse: None,
            unlocked: None,
            impacts: Impacts::default(),
            baumgarte: self.graph.baumgarte,
            shown,
            requirements,
            texts,
        };
        equations.iterate(self.loops);
        Ok(equations)
    }

    /// Whether a component of a storage is no state.
    fn is_replaced(&self, storage: Storage, component: usize) -> bool {
        let Storage::Element(node) = storage else { return false };
        let is_dependent = self.causal.derivative.contains(&node);
        let element = self.graph.element(node).filter(|_| is_dependent);
        element.is_some_and(|element| way(element, self.kept.has((node, component))) == Way::Replaced)
    }

    /// Gives every storage its states' indices.
    fn lay_out(&mut self) {
        for &storage in &self.graph.storages {
            let shape = match storage {
                Storage::Element(node) => {
                    let bond = self.graph.node(node).bonds[0];
                    Shape::of_cardinality(self.graph.bond(bond).cardinality)
                }
                Storage::Track(index) => match self.graph.tracks[index].kind {
                    TrackKind::Position => Shape::Vector,
                    TrackKind::Orientation => Shape::Matrix,
                },
            };
            let (name, unit) = storage::describe(self.graph, storage);
            let zero = self.pool.zero();
            let mut components = Vec::new();
            for (component, suffix) in shape.suffixes().iter().enumerate() {
                if self.is_replaced(storage, component) {
                    continue;
                }
                components.push((component, self.states.len()));
                let name = format!("{name}{suffix}");
                let origin = storage::origin(self.graph, storage, component);
                self.states.push(State { name, unit: unit.clone(), origin, start: zero, rate: zero });
            }
            if !components.is_empty() {
                self.layout.push(Layout { storage, shape, components });
            }
        }
        let mut multipliers = 0;
        let is_held = |node: &NodeId| {
            let element = self.graph.element(*node);
            element.is_some_and(|element| way(element, self.kept.has((*node, 0))) == Way::Held)
        };
        let held: Vec<NodeId> = self.causal.derivative.iter().copied().filter(is_held).collect();
        let sinks = self.elements(|kind| kind == ElementKind::RSe);
        let unknown: Vec<NodeId> = sinks.into_iter().chain(held).chain(self.frictions()).collect();
        for node in unknown {
            self.reactions.insert(node, multipliers);
            let bond = self.graph.node(node).bonds[0];
            multipliers += u32::try_from(self.graph.bond(bond).cardinality).expect("1 or 3");
        }
        self.lay_out_ways();
        self.first_integral = self.states.len();
        let zero = self.pool.zero();
        for (index, integral) in self.graph.integrals.iter().enumerate() {
            let unit = integral.dimension.times(Dimension::SECOND).to_string();
            let name = integral.name.clone();
            let origin = if integral.follows.is_some() { Origin::Memory(index) } else { Origin::Integral(index) };
            self.states.push(State { name, unit, origin, start: zero, rate: zero });
        }
    }

    /// The states of a storage, in the order of its components.
    pub(super) fn state(&mut self, storage: Storage) -> Option<Value> {
        let components = self.layout.iter().find(|place| place.storage == storage)?.components.clone();
        Some(Value(components.into_iter().map(|(_, state)| self.state_symbol(state)).collect()))
    }

    /// The symbol of a state.
    pub(super) fn state_symbol(&mut self, index: usize) -> Id {
        self.pool.symbol(Symbol::state(index))
    }

    /// The effort of a bond.
    pub(super) fn effort(&mut self, bond: BondId) -> Value {
        self.variable(Role::Effort, bond)
    }

    /// The flow of a bond.
    pub(super) fn flow(&mut self, bond: BondId) -> Value {
        self.variable(Role::Flow, bond)
    }

    fn entry(&mut self, variable: Role, bond: BondId) -> &mut Entry {
        match variable {
            Role::Effort => &mut self.memo.efforts[bond.0],
            Role::Flow => &mut self.memo.flows[bond.0],
        }
    }

    fn variable(&mut self, variable: Role, bond: BondId) -> Value {
        match self.entry(variable, bond).clone() {
            Entry::Done(value) | Entry::Entered(Some(value)) => return value,
            Entry::Entered(None) => {
                let symbols = self.torn(variable, bond);
                *self.entry(variable, bond) = Entry::Entered(Some(symbols.clone()));
                return symbols;
            }
            Entry::Open => {}
        }
        *self.entry(variable, bond) = Entry::Entered(None);
        self.path.push((variable, bond));
        let ends = self.graph.bond(bond);
        let (stroke_node, other) = match self.causal.strokes[bond.0] {
            End::From => (ends.from, ends.to),
            End::To => (ends.to, ends.from),
        };
        let owner = std::mem::take(&mut self.owner);
        let value = match variable {
            Role::Effort => self.given_effort(other, bond),
            Role::Flow => self.given_flow(stroke_node, bond),
        };
        self.owner = owner;
        self.path.pop();
        let value = match self.entry(variable, bond).clone() {
            Entry::Entered(Some(symbols)) => {
                self.unknowns.equate(&mut self.pool, &symbols, (&symbols, &value));
                symbols
            }
            _ => value,
        };
        *self.entry(variable, bond) = Entry::Done(value.clone());
        value
    }

    /// A bond variable that has been calculated.
    pub(super) fn known(&self, variable: Role, bond: BondId) -> Option<&Value> {
        let entries = if variable == Role::Effort { &self.memo.efforts } else { &self.memo.flows };
        if let Entry::Done(value) = &entries[bond.0] { Some(value) } else { None }
    }

    /// A symbol's name in texts.
    pub(super) fn symbol_name(&self, symbol: Symbol) -> String {
        if let Symbol::Unsolved(number) = symbol
            && let Unknown::Variable(role, bond, _) = self.unknowns.all[number as usize]
        {
            return text::variable(self, role, bond);
        }
        super::symbol_name(symbol, &self.states, &self.graph.parameters, &self.graph.inputs)
    }

    /// Forgets what bonds carry and the faults found in that: they are found again.
    pub(super) fn forget(&mut self) {
        self.memo = Memo::new(self.graph);
        self.unknowns.residuals.clear();
        self.loops.clear();
        self.pivots.clear();
        self.faults.clear();
    }

    /// The effort that a node gives on one of its bonds.
    fn given_effort(&mut self, node: NodeId, bond: BondId) -> Value {
        match &self.graph.node(node).kind {
            NodeKind::Zero => match self.causal.strong_bond(node) {
                Some(strong) => self.effort(strong),
                None => Value::zero(&mut self.pool, self.graph.bond(bond).cardinality),
            },
            NodeKind::One => self.balance(node, bond, Role::Effort),
            NodeKind::Element(element) => {
                let effort = self.element_effort(node, element, bond);
                self.note_fallible(node, element, &effort);
                effort
            }
        }
    }

    /// The flow that a node gives on one of its bonds.
    fn given_flow(&mut self, node: NodeId, bond: BondId) -> Value {
        match &self.graph.node(node).kind {
            NodeKind::One => self.junction_flow(node),
            NodeKind::Zero => self.balance(node, bond, Role::Flow),
            NodeKind::Element(element) => {
                let flow = self.element_flow(node, element, bond);
                self.note_fallible(node, element, &flow);
                flow
            }
        }
    }

    /// The common flow of a 1-junction.
    pub(super) fn junction_flow(&mut self, node: NodeId) -> Value {
        if let Some(given) = self.given_flows.get(&node) {
            return given.clone();
        }
        match self.causal.strong_bond(node) {
            Some(strong) => self.flow(strong),
            None => Value::zero(&mut self.pool, 3),
        }
    }

    /// The variable of a junction's strong bond from the balance of the others.
    fn balance(&mut self, node: NodeId, bond: BondId, variable: Role) -> Value {
        let own = self.graph.sign(bond, node);
        let others = self.graph.node(node).bonds.iter().copied().filter(|&other| other != bond);
        let terms: Vec<(Value, f64)> =
            others.map(|other| (self.variable(variable, other), -own * self.graph.sign(other, node))).collect();
        let components = self.graph.bond(bond).cardinality;
        Value(
            (0..components)
                .map(|k| {
                    let parts: Vec<(Id, f64)> = terms.iter().map(|(value, sign)| (value.0[k], *sign)).collect();
                    self.pool.linear(0.0, &parts)
                })
                .collect(),
        )
    }

    fn outputs(&mut self) -> Vec<Output> {
        let graph = self.graph;
        let mut outputs = Vec::new();
        for observation in &graph.observations {
            self.owner.clone_from(&observation.name);
            let value = self.evaluate(&observation.value, None);
            for (suffix, id) in value.shape().suffixes().iter().zip(value.0) {
                let name = format!("{}{suffix}", observation.name);
                let (of, observes, unit) =
                    (observation.name.clone(), observation.text.clone(), observation.unit.clone());
                outputs.push(Output { name, of, observes, unit, value: id });
            }
        }
        outputs
    }

    /// What memories become after a step: while the condition holds, the value that they follow at its end.
    fn memories(&mut self) -> Vec<(usize, Id)> {
        let graph = self.graph;
        let followed = graph.integrals.iter().enumerate().filter_map(|(index, own)| Some((index, own.follows?)));
        followed.map(|(index, of)| (self.first_integral + index, self.named_expression(of).0[0])).collect()
    }

    fn integral_rates(&mut self) {
        let graph = self.graph;
        for (index, integral) in graph.integrals.iter().enumerate() {
            self.owner.clone_from(&integral.name);
            let value = self.evaluate(&integral.value, None);
            self.states[self.first_integral + index].rate = value.0[0];
        }
    }

    /// The guesses, over parameters; one that depends on the start pose takes that of the guesses before it.
    fn guesses(&mut self) -> Vec<Id> {
        let graph = self.graph;
        let mut guesses: Vec<Id> = Vec::new();
        for guess in &graph.guesses {
            let value = self.evaluate(guess, None).0[0];
            let value = self.at_start(&[value])[0];
            let known = |symbol| if let Symbol::Unknown(k) = symbol { guesses.get(k as usize).copied() } else { None };
            guesses.push(substitute(&mut self.pool, &[value], &known)[0]);
        }
        guesses
    }

    /// Expressions at t = 0, over parameters and unknowns.
    pub(super) fn at_start(&mut self, of: &[Id]) -> Vec<Id> {
        let of = self.without_switches(of);
        let start = |symbol: Symbol| symbol.as_state().map(|state| self.states[state].start);
        substitute(&mut self.pool, &of, &start)
    }

    /// The same where the sign of each guard decides: what is known before a run has no branches. A branch counts once
    /// where its guard has its sign, else zero times: atan2(0, g) is pi below zero and 0 above.
    fn without_switches(&mut self, of: &[Id]) -> Vec<Id> {
        let is_known = |switch: &u32| !self.switches[*switch as usize].remembers;
        let switches: BTreeSet<u32> = self.pool.switches(of).into_iter().filter(is_known).collect();
        let mut below: BTreeMap<u32, Id> = BTreeMap::new();
        for switch in switches {
            let guard = self.switches[switch as usize].guard;
            let guard = self.without_switches(&[guard])[0];
            let pool = &mut self.pool;
            // An angle has no slope at zero.
            let beside = pool.linear(BESIDE, &[(guard, 1.0)]);
            let zero = pool.zero();
            let angle = pool.call(Function::Atan2, &[zero, beside]);
            below.insert(switch, pool.scale(1.0 / std::f64::consts::PI, angle));
        }
        if below.is_empty() { of.to_vec() } else { blended(&mut self.pool, of, &below) }
    }

    /// What is to be closed, over the states: joint, unit, components.
    fn open(&mut self) -> Vec<Open> {
        let graph = self.graph;
        let mut open = Vec::new();
        for close in &graph.closes {
            let unit = if close.dimension == Dimension::NONE { "rad" } else { "m" };
            let gap = self.evaluate(&close.gap, None).0;
            open.push((graph.joint(close.joint).to_owned(), unit.to_owned(), self.without_switches(&gap)));
        }
        open.extend(self.gaps_of_sinks());
        open
    }

    /// The same at t = 0, over parameters and unknowns.
    fn gaps(&mut self, open: &[Open]) -> Vec<Gap> {
        let mut gaps = Vec::new();
        for (joint, unit, values) in open {
            let values = self.at_start(values);
            let components = if values.len() == 1 { &[""][..] } else { &["x", "y", "z"] };
            for (component, value) in components.iter().zip(values) {
                gaps.push(Gap { joint: joint.clone(), component, unit: unit.clone(), value });
            }
        }
        gaps
    }

    /// What makes orientations such again: one step.
    fn projections(&mut self) -> Vec<(usize, Id)> {
        let mut projections = Vec::new();
        for Layout { storage, components, .. } in
            self.layout.clone().into_iter().filter(|place| place.shape == Shape::Matrix)
        {
            let Some(turned) = self.state(storage) else { continue };
            let projected = orthogonalized(&mut self.pool, &turned);
            projections.extend(components.into_iter().map(|(k, state)| (state, projected.0[k])));
        }
        projections
    }
}

/// The extent of the machine for each gap at t = 0, over parameters and unknowns: how large the parts are of which the
/// gap consists, while the states are symbols, so that numbers do not cancel; of a length with all positions.
fn extents(pool: &mut Pool, open: &[Open], states: &[State]) -> Vec<Id> {
    let starts: Vec<Id> = states.iter().map(|state| state.start).collect();
    let starts = magnitudes(pool, &starts);
    let is_position = |state: &State| state.origin.kind() == Kind::Position;
    let positions: Vec<Id> =
        states.iter().zip(&starts).filter(|(state, _)| is_position(state)).map(|(_, &start)| start).collect();
    let all = pool.sum(&positions);
    let mut extents = Vec::new();
    for (_, unit, values) in open {
        let parts = magnitudes(pool, values);
        let parts = substitute(pool, &parts, &|symbol| symbol.as_state().map(|state| starts[state]));
        extents.extend(parts.into_iter().map(|part| if unit == "m" { pool.sum(&[part, all]) } else { part }));
    }
    extents
}

/// One Newton-Schulz step towards the nearest orthogonal matrix, R (3 - R^T R) / 2 (Higham 2008, eq. 8.20): of what it
/// is off by the square is left, times 3/2.
pub(super) fn orthogonalized(pool: &mut Pool, matrix: &Value) -> Value {
    let three = Value::identity(pool).scale(pool, 3.0);
    let square = matrix.transpose().multiply(pool, matrix).negate(pool);
    let factor = three.add(pool, &square);
    matrix.multiply(pool, &factor).scale(pool, 0.5)
}

#[cfg(test)]
mod tests {
    use crate::expr::{Environment, Id, Symbol, evaluate};
    use crate::pipeline;
    use crate::source::syntax;

    type Matrix = [[f64; 3]; 3];

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    }

    fn transpose(a: &Matrix) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
    }

    /// The largest difference of two entries.
    fn distance(a: &Matrix, b: &Matrix) -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    /// What an orientation's projection makes of a matrix.
    fn projected(matrix: &Matrix) -> Matrix {
        let text = "graph G { 1 j[3]: rotation; I m = 1; orientation R of j; j -> m; observe { R } }";
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let equations = pipeline::derive(&source.graphs[0]).expect("equations").equations;
        let mut states = vec![0.0; equations.states.len()];
        let first = equations.states.iter().position(|state| state.name == "R_11").expect("an orientation");
        states[first..first + 9].copy_from_slice(matrix.as_flattened());
        let (places, ids): (Vec<usize>, Vec<Id>) = equations.projections.iter().copied().unzip();
        assert_eq!(places, (first..first + 9).collect::<Vec<_>>());
        assert!(!equations.pool.symbols(&ids).contains(&Symbol::Time));
        let values = evaluate(&equations.pool, &ids, &Environment { states: &states, ..Environment::default() });
        std::array::from_fn(|i| std::array::from_fn(|j| values[3 * i + j]))
    }

    /// A rotation far from the identity, so that what is done on the left of a matrix and on its right are different
    /// things.
    fn rotation() -> Matrix {
        let ((s, c), (t, d)) = (0.9_f64.sin_cos(), 0.6_f64.sin_cos());
        product(&[[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]], &[[1.0, 0.0, 0.0], [0.0, d, -t], [0.0, t, d]])
    }

    /// Nearest to Q (1 + E) with symmetric E is Q (polar factor); one step leaves 3/2 Q E^2 of it.
    #[test]
    fn a_projection_is_a_step_to_the_nearest_orientation() {
        let rotation = rotation();
        let stretch = |size: f64| {
            let strain: Matrix = [[0.9, -0.4, 0.3], [-0.4, -0.7, 0.5], [0.3, 0.5, 0.2]];
            std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j)) + size * strain[i][j]))
        };
        for size in [1e-2, 1e-4] {
            let result = projected(&product(&rotation, &stretch(size)));
            let far = distance(&result, &rotation) / (size * size);
            assert!(far > 0.5 && far < 3.0, "{size:e}: {far}");
        }
        assert!(distance(&projected(&rotation), &rotation) < 4e-16);
    }

    /// R (3 - R^T R) / 2, far from an orientation.
    #[test]
    fn a_projection_is_that_of_newton_and_schulz() {
        let matrix: Matrix = [[1.1, 0.3, -0.2], [-0.4, 0.8, 0.5], [0.7, -0.1, 1.3]];
        let square = product(&transpose(&matrix), &matrix);
        let factor =
            std::array::from_fn(|i| std::array::from_fn(|j| 1.5 * f64::from(u8::from(i == j)) - 0.5 * square[i][j]));
        assert!(distance(&projected(&matrix), &product(&matrix, &factor)) < 1e-15);
        // The other product makes something else of it.
        assert!(distance(&square, &product(&matrix, &transpose(&matrix))) > 0.1);
    }
}
