//! Names to indices, chains to bonds, expressions to terms.
//!
//! In: one `ast::Graph` of bond-graph words. Out: a [`BondGraph`] that every later stage can trust.

mod connect;
mod delays;
mod dependencies;
mod expressions;
mod quantity;
mod samples;
mod tables;

use std::collections::{BTreeMap, BTreeSet};

use bg_units::Unit;
use proc_macro2::Span;

use self::quantity::scaled;
use super::term::{Reference, Term, TermKind};
use super::typing::Shape;
use super::{
    BondGraph, Close, Drawing, Element, GraphFault, Held, Input, Integral, JointId, Law, Let, Node, NodeId, NodeKind,
    Observation, Parameter, Storage, Track, domains,
};
use crate::fault::{DeclaredTwice, Explain, Fault, Staged, near_miss};
use crate::graph::units::{self, Dimension, Domain};
use crate::source::ast::{self, BinaryOperator, ElementKind, Expression, Item, JunctionKind, Name, Role, Watch};

/// What a name stands for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Entity {
    /// A parameter.
    Parameter(usize),
    /// An input.
    Input(usize),
    /// A named expression.
    Let(usize),
    /// A function given by points.
    Table(usize),
    /// A state of the graph's own.
    Own(usize),
    /// A sample, an index into those of the resolver.
    Sample(usize),
    /// What was held of a sample before the instant.
    Last(usize),
    /// A junction or element.
    Node(NodeId),
    /// A position or orientation.
    Track(usize),
    /// Several of these, which is a fault: what uses the name is none.
    Several,
}

/// Resolves one graph of bond-graph words.
///
/// # Errors
/// All faults of names, ports and cardinalities; where there are none, all faults of shapes and units.
pub fn resolve(source: &ast::Graph) -> Staged<BondGraph> {
    let mut resolver = Resolver::new(source);
    resolver.declare(source);
    let chains: Vec<Vec<Name>> = source
        .items
        .iter()
        .filter_map(|item| if let Item::Chain(chain) = item { Some(chain.clone()) } else { None })
        .collect();
    resolver.define(source);
    resolver.graph.lets.append(&mut resolver.more);
    resolver.tracks(source);
    resolver.graph.drawing = source.drawing.map(&mut |quantity| resolver.term(quantity, Context::Plain));
    connect::bonds(&mut resolver.graph, &chains, &resolver.names, &resolver.junctions, &mut resolver.faults);
    if resolver.graph.bonds.is_empty() && resolver.faults.is_empty() {
        let name = source.name.text.clone();
        resolver.faults.push(Fault::new(source.name.span, &GraphFault::EmptyGraph { name }));
    }
    resolver.let_circles();
    resolver.mark_what_is_read();
    resolver.checked()?;
    domains::assign(&mut resolver.graph, &resolver.domains, &mut resolver.faults);
    resolver.clauses();
    resolver.dependencies();
    resolver.finish_outputs();
    resolver.checked()?;
    Ok(resolver.graph)
}

/// Where an expression stands, which decides what it may contain.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Context<'a> {
    Plain,
    Let,
    Law(Option<&'a str>),
    Start,
    Observed,
    /// At the instants of a clock, its index.
    Instant(usize),
}

/// A sample: its state, and the `let` of what this becomes at an instant.
#[derive(Clone, Copy)]
struct Sampled {
    own: usize,
    new: usize,
}

struct Resolver {
    graph: BondGraph,
    names: BTreeMap<String, Entity>,
    /// Where each name is declared first.
    declared: BTreeMap<String, Span>,
    junctions: BTreeMap<NodeId, usize>,
    /// The 1-junctions.
    ones: BTreeSet<NodeId>,
    domains: Vec<(NodeId, Domain)>,
    /// In what the numbers of the parameters are.
    parameters: Vec<Unit>,
    /// In what those of the inputs are.
    inputs: Vec<Unit>,
    observed: Vec<Option<Unit>>,
    samples: Vec<Sampled>,
    /// The `let`s as written, by their indices; none of those that stand for something else.
    written: Vec<Option<ast::Let>>,
    /// What `let`s that depend on samples are at an instant: by their indices, the index of another one.
    at_instants: BTreeMap<usize, usize>,
    /// Whether what is read at an instant stands outside of blocks.
    is_outside_of_blocks: bool,
    /// The `let`s that come after those that have names.
    more: Vec<Let>,
    /// Where each output is.
    outputs: BTreeMap<String, Span>,
    faults: Vec<Fault>,
}

impl Resolver {
    fn new(source: &ast::Graph) -> Self {
        let graph = BondGraph {
            name: source.name.clone(),
            docs: source.docs.clone(),
            visibility: source.visibility.clone(),
            parameters: Vec::new(),
            inputs: Vec::new(),
            lets: Vec::new(),
            tables: Vec::new(),
            nodes: Vec::new(),
            bonds: Vec::new(),
            tracks: Vec::new(),
            storages: Vec::new(),
            joints: Vec::new(),
            closes: Vec::new(),
            impulse: false,
            baumgarte: None,
            expects_integral: false,
            observations: Vec::new(),
            guesses: Vec::new(),
            turns: Vec::new(),
            ways: Vec::new(),
            integrals: Vec::new(),
            clocks: Vec::new(),
            delays: Vec::new(),
            drawing: Drawing::default(),
        };
        Self {
            graph,
            names: BTreeMap::new(),
            declared: BTreeMap::new(),
            junctions: BTreeMap::new(),
            ones: BTreeSet::new(),
            domains: Vec::new(),
            parameters: Vec::new(),
            inputs: Vec::new(),
            observed: Vec::new(),
            samples: Vec::new(),
            written: Vec::new(),
            is_outside_of_blocks: false,
            at_instants: BTreeMap::new(),
            more: Vec::new(),
            outputs: BTreeMap::new(),
            faults: Vec::new(),
        }
    }

    fn checked(&mut self) -> Staged<()> {
        if self.faults.is_empty() { Ok(()) } else { Err(std::mem::take(&mut self.faults)) }
    }

    fn fault(&mut self, span: Span, fault: &impl Explain) {
        self.faults.push(Fault::new(span, fault));
    }

    fn name(&mut self, name: &Name, mut entity: Entity) {
        if name.text == "t" {
            self.fault(name.span, &GraphFault::Reserved { name: name.text.clone() });
        } else if let Some(&first) = self.declared.get(&name.text) {
            self.fault(name.span, &DeclaredTwice::new(&name.text, name.span, first));
            entity = Entity::Several;
        } else {
            self.declared.insert(name.text.clone(), name.span);
        }
        self.names.insert(name.text.clone(), entity);
    }

    fn unit(&mut self, unit: &ast::Unit) -> Unit {
        units::unit(unit).unwrap_or_else(|fault| {
            self.faults.push(fault);
            Unit::ONE
        })
    }

    /// First pass: every name gets its index.
    fn declare(&mut self, source: &ast::Graph) {
        let (mut lets, mut tracks, mut nodes) = (0, 0, 0);
        for item in &source.items {
            match item {
                Item::Parameter(parameter) => self.parameter(parameter),
                Item::Input(input) => {
                    let measured = self.unit(&input.unit);
                    self.name(&input.name, Entity::Input(self.graph.inputs.len()));
                    let (name, docs, unit) = (input.name.clone(), input.docs.clone(), input.unit.to_string());
                    self.graph.inputs.push(Input { name, docs, unit, dimension: measured.dimension });
                    self.inputs.push(measured);
                }
                Item::Let(definition) => {
                    self.name(&definition.name, Entity::Let(lets));
                    self.written.resize(lets, None);
                    self.written.push(Some(definition.clone()));
                    lets += 1;
                }
                Item::Table(table) => self.table(table),
                Item::State(state) => self.declare_state(&state.name, &state.unit),
                Item::Memory(memory) => {
                    self.declare_state(&ast::Memory::kept(&memory.name), &memory.unit);
                    self.name(&memory.name, Entity::Let(lets));
                    lets += 1;
                }
                Item::Every(every) => {
                    // Those of the clock come first.
                    lets += 2;
                    for sample in &every.samples {
                        self.declare_sample(sample, lets);
                        lets += 1;
                    }
                }
                Item::Junction(junction) => {
                    self.junction(junction, NodeId(nodes));
                    nodes += 1;
                }
                Item::Element(element) => {
                    self.name(&element.name, Entity::Node(NodeId(nodes)));
                    nodes += 1;
                }
                Item::Track(track) => {
                    self.name(&track.name, Entity::Track(tracks));
                    tracks += 1;
                }
                _ => {}
            }
        }
        self.written.resize(lets, None);
    }

    fn parameter(&mut self, parameter: &ast::Parameter) {
        let measured = self.unit(&parameter.unit);
        self.name(&parameter.name, Entity::Parameter(self.graph.parameters.len()));
        let name = &parameter.name;
        let mut number = |value: &Expression| self.number(value, &parameter.unit, measured);
        let default = number(&parameter.default);
        let [lower, upper] = [&parameter.lower, &parameter.upper]
            .map(|bound| bound.as_ref().map(|bound| (number(&bound.value), bound.included)));
        let is_empty = match (lower, upper) {
            (Some((low, with_low)), Some((high, with_high))) => low > high || low == high && !(with_low && with_high),
            _ => false,
        };
        if is_empty {
            self.fault(name.span, &GraphFault::RangeEmpty { name: name.text.clone() });
        }
        let above = lower.is_none_or(|(low, included)| default > low || included && default == low);
        let below = upper.is_none_or(|(high, included)| default < high || included && default == high);
        if !(is_empty || above && below) {
            self.fault(parameter.default.span, &GraphFault::DefaultOutOfRange { name: name.text.clone() });
        }
        let (docs, unit) = (parameter.docs.clone(), parameter.unit.to_string());
        let dimension = measured.dimension;
        self.graph.parameters.push(Parameter { name: name.clone(), docs, unit, dimension, default, lower, upper });
        self.parameters.push(measured);
    }

    /// The rate of Baumgarte's terms, 1/s.
    fn decay(&mut self, rate: &Expression) -> f64 {
        match rate.number() {
            Some(value) if value.is_finite() && value > 0.0 => value,
            _ => {
                self.fault(rate.span, &GraphFault::Decay);
                1.0
            }
        }
    }

    fn junction(&mut self, junction: &ast::Junction, id: NodeId) {
        self.name(&junction.name, Entity::Node(id));
        self.junctions.insert(id, junction.cardinality);
        if junction.kind == JunctionKind::One {
            self.ones.insert(id);
        }
        if let Some(word) = &junction.domain {
            match Domain::named(&word.text) {
                Some(domain) => self.domains.push((id, domain)),
                None => {
                    let near = near_miss(&word.text, units::DOMAINS.iter().map(|domain| domain.name));
                    let near = near.map(str::to_owned);
                    self.fault(word.span, &GraphFault::UnknownDomain { name: word.text.clone(), near });
                }
            }
        }
    }

    /// A state of the graph's own, without its terms.
    fn declare_state(&mut self, name: &Name, unit: &ast::Unit) {
        self.name(name, Entity::Own(self.graph.integrals.len()));
        self.own(name, unit);
    }

    /// The state of this name.
    fn own(&mut self, name: &Name, unit: &ast::Unit) {
        let unit = self.unit(unit);
        let value = Term { kind: TermKind::Number(0.0), span: name.span };
        let (name, declared) = (name.text.clone(), Some(unit.dimension));
        let (dimension, start, follows) = (Dimension::NONE, None, None);
        self.graph.integrals.push(Integral { name, value, dimension, declared, start, follows });
    }

    /// A value that is kept: a `let`, which its state follows.
    fn memory(&mut self, memory: &ast::Memory, own: usize) {
        let kind = ast::ExpressionKind::If(Box::new(memory.following.clone()));
        let value = self.term(&Expression { kind, span: memory.name.span }, Context::Law(None));
        let start = memory.start.as_ref().map(|start| self.term(start, Context::Start));
        let (declared, unit) = (Some(self.unit(&memory.unit)), Some(memory.unit.to_string()));
        self.graph.integrals[own].start = start;
        self.graph.integrals[own].follows = Some(self.graph.lets.len());
        self.graph.lets.push(Let { name: memory.name.clone(), value, declared, unit, clause: None });
    }

    /// Second pass: every item gets its terms.
    fn define(&mut self, source: &ast::Graph) {
        let (mut tracks, mut own) = (0, 0);
        for item in &source.items {
            match item {
                Item::Let(definition) => {
                    let first_turn = self.graph.turns.len();
                    let value = self.term(&definition.value, Context::Let);
                    self.name_turns(first_turn, &definition.name.text, &value);
                    let declared = definition.unit.as_ref().map(|unit| self.unit(unit));
                    let unit = definition.unit.as_ref().map(ToString::to_string);
                    let (name, clause) = (definition.name.clone(), definition.clause.clone());
                    self.graph.lets.push(Let { name, value, declared, unit, clause });
                }
                Item::Junction(junction) => {
                    let kind = match junction.kind {
                        JunctionKind::Zero => NodeKind::Zero,
                        JunctionKind::One => NodeKind::One,
                    };
                    self.graph.nodes.push(Node { name: junction.name.clone(), kind, bonds: Vec::new() });
                }
                Item::State(state) => {
                    let rate = self.term(&state.rate, Context::Law(None));
                    let start = state.start.as_ref().map(|start| self.term(start, Context::Start));
                    let known = &mut self.graph.integrals[own];
                    (known.value, known.start) = (rate, start);
                    own += 1;
                }
                Item::Memory(memory) => {
                    self.memory(memory, own);
                    own += 1;
                }
                Item::Every(every) => {
                    self.every(every, own);
                    own += every.samples.len();
                }
                Item::Element(element) => self.element(element),
                Item::Track(_) => {
                    self.graph.storages.push(Storage::Track(tracks));
                    tracks += 1;
                }
                Item::Close(close) => {
                    let gap = self.term(&close.gap, Context::Plain);
                    let (shape, dimension) = (Shape::Scalar, Dimension::NONE);
                    let joint = self.joint(&close.joint);
                    self.graph.closes.push(Close { joint, gap, shape, dimension });
                }
                Item::Impulse(_) => self.graph.impulse = true,
                Item::Baumgarte(baumgarte) => self.graph.baumgarte = Some(self.decay(&baumgarte.rate)),
                Item::IntegralCausality => self.graph.expects_integral = true,
                Item::Observe(watched) => {
                    let values = watched.iter().filter_map(Watch::value);
                    values.for_each(|observation| self.observe(observation));
                }
                _ => {}
            }
        }
    }

    fn tracks(&mut self, source: &ast::Graph) {
        for item in &source.items {
            let Item::Track(track) = item else { continue };
            let junction = match self.names.get(&track.junction.text) {
                Some(Entity::Node(id)) if self.junctions.get(id) == Some(&3) => Some(*id),
                _ => None,
            };
            let one = junction.filter(|&id| matches!(self.graph.node(id).kind, NodeKind::One));
            if one.is_none() {
                let span = track.junction.span;
                let (track, junction) = (track.name.text.clone(), track.junction.text.clone());
                self.faults.push(Fault::new(span, &GraphFault::TrackOfNoJunction { track, junction }));
            }
            let start = track.start.as_ref().map(|start| self.term(start, Context::Start));
            let (kind, name) = (track.kind, track.name.clone());
            self.graph.tracks.push(Track { kind, name, junction: one.unwrap_or(NodeId(0)), start });
        }
    }

    fn element(&mut self, element: &ast::Element) {
        let kind = element.kind;
        let id = NodeId(self.graph.nodes.len());
        self.clauses_fit(element);
        let variable = element.variable.as_ref().map(|variable| variable.name.text.as_str());
        let law = self.term(&element.law, Context::Law(variable));
        let law = match &element.variable {
            Some(variable) => Law::Of { role: variable.role.unwrap_or(Role::Flow), value: law },
            None => Law::Parameter(law),
        };
        let frame = element.frame.as_ref().map(|term| self.term(term, Context::Plain));
        let displacement = element.displacement.as_ref().map(|term| self.term(term, Context::Plain));
        let start = element.start.as_ref().map(|term| self.term(term, Context::Start));
        let energy = element.energy.as_ref().map(|term| self.term(term, Context::Law(variable)));
        let sticking = element.sticking.as_ref().map(|term| self.term(term, Context::Plain));
        let [restitution, rest] =
            [&element.restitution, &element.rest].map(|term| term.as_ref().map(|term| self.term(term, Context::Plain)));
        let stores = matches!(kind, ElementKind::I) || (kind == ElementKind::C && displacement.is_none());
        if stores {
            self.graph.storages.push(Storage::Element(id));
        }
        let text = law_text(element);
        let held = element.held.as_ref().map(|held| Held { joint: self.joint(&held.joint), direction: held.direction });
        let element_node =
            Element { kind, law, text, frame, displacement, start, energy, held, sticking, restitution, rest };
        let node = Node { name: element.name.clone(), kind: NodeKind::Element(element_node), bonds: Vec::new() };
        self.graph.nodes.push(node);
    }

    /// The joint of this name, declared by what mentions it first.
    fn joint(&mut self, name: &Name) -> JointId {
        let joints = &mut self.graph.joints;
        let known = joints.iter().position(|known| *known == name.text);
        JointId(known.unwrap_or_else(|| {
            joints.push(name.text.clone());
            joints.len() - 1
        }))
    }

    /// A clause that its kind of element does not have is a fault.
    fn clauses_fit(&mut self, element: &ast::Element) {
        use ElementKind as K;
        let (kind, name) = (element.kind, &element.name);
        let clauses = [
            ("start", element.start.is_some(), matches!(kind, K::I | K::C)),
            ("energy", element.energy.is_some(), matches!(kind, K::I | K::C)),
            ("at", element.displacement.is_some(), matches!(kind, K::C | K::RSe)),
            ("in", element.frame.is_some(), kind == K::I),
            ("of", element.held.is_some(), kind == K::RSe),
            ("holds", element.sticking.is_some(), is_of_flow(element)),
            ("restitution", element.restitution.is_some(), is_one_sided(element)),
            ("rest below", element.rest.is_some(), is_one_sided(element)),
        ];
        for (clause, given, fits) in clauses {
            if given && !fits {
                self.fault(name.span, &GraphFault::NotStorage { name: name.text.clone(), clause });
            }
        }
        let role = element.variable.as_ref().and_then(|variable| variable.role);
        let has_variable = element.variable.is_some();
        let fits = match kind {
            K::I | K::C => role.is_none(),
            K::R | K::Mr | K::Tf | K::Mtf => true,
            _ => !has_variable,
        };
        if !fits {
            let fault = GraphFault::VariableRole { name: name.text.clone(), symbol: kind.symbol() };
            self.fault(name.span, &fault);
        }
    }

    fn observe(&mut self, observation: &ast::Observation) {
        let first = self.graph.integrals.len();
        let first_turn = self.graph.turns.len();
        let value = self.term(&observation.value, Context::Observed);
        let text = observation.value.to_string();
        let name = observation.name.as_ref().map_or_else(|| text.clone(), |name| name.text.clone());
        let alone = matches!(value.kind, TermKind::Integral(_));
        for (k, integral) in self.graph.integrals[first..].iter_mut().enumerate() {
            integral.name = if alone { name.clone() } else { format!("{name}.integral_{}", k + 1) };
        }
        self.name_turns(first_turn, &name, &value);
        let declared = observation.unit.as_ref().map(|unit| self.unit(unit));
        let value = scaled(value, BinaryOperator::Divide, declared.unwrap_or(Unit::ONE));
        let unit = observation.unit.as_ref().map(ToString::to_string).unwrap_or_default();
        let span = observation.name.as_ref().map_or(observation.value.span, |name| name.span);
        match self.outputs.get(&name) {
            Some(&first) => self.fault(span, &DeclaredTwice::new(&name, span, first)),
            None => _ = self.outputs.insert(name.clone(), span),
        }
        self.observed.push(declared);
        self.graph.observations.push(Observation { name, text, value, shape: Shape::Scalar, unit });
    }

    /// Names the angles from `first` on that count turns after what they stand in.
    fn name_turns(&mut self, first: usize, name: &str, value: &Term) {
        let alone = matches!(value.kind, TermKind::Reference(Reference::Turn(_)));
        for (k, turn) in self.graph.turns[first..].iter_mut().enumerate() {
            turn.name = if alone { name.to_owned() } else { format!("{name}.turn_{}", k + 1) };
        }
    }
}

/// Whether an element is an R whose effort follows from its flow.
fn is_of_flow(element: &ast::Element) -> bool {
    let is_flow = |variable: &ast::LawVariable| variable.role != Some(Role::Effort);
    matches!(element.kind, ElementKind::R | ElementKind::Mr) && element.variable.as_ref().is_some_and(is_flow)
}

/// Whether an element can be a stop: a residual sink of no joint that keeps its flow at zero and knows its
/// displacement.
fn is_one_sided(element: &ast::Element) -> bool {
    let ast::Element { kind, law, displacement, held, .. } = element;
    *kind == ElementKind::RSe && law.number() == Some(0.0) && displacement.is_some() && held.is_none()
}

/// The law as the user wrote it.
fn law_text(element: &ast::Element) -> String {
    let holds = element.sticking.as_ref().map_or_else(String::new, |limit| format!(" holds {limit}"));
    match &element.variable {
        Some(variable) => format!("({}) = {}{holds}", variable.name.text, element.law),
        None => element.law.to_string(),
    }
}
