//! The multibond graph: nodes, bonds and expressions with every name resolved, every unit known.
//!
//! In: `ast` of bond-graph words. Out: [`BondGraph`]. No longer occurs: names, missing ports, unknown cardinalities,
//! units.

pub mod causality;
mod domains;
mod fault;
mod resolve;
mod table;
mod term;
mod typing;
pub mod units;

use bg_units::Unit;

use crate::graph::units::{Dimension, Domain};
use crate::source::ast::Name;
use crate::source::visibility::Visibility;

pub use crate::source::ast::{Axis, BinaryOperator, Comparison, Direction, ElementKind, Role, TrackKind};
pub use crate::source::clause::{Allowed, Clause};
pub use crate::source::drawing::{self, Drawing};
pub use causality::{CausalGraph, End};
pub use fault::{GraphFault, OF_BONDS};
pub use resolve::resolve;
pub use table::{Cubic, Patch, Period, Piece, Surface, Table};
pub use term::{Builtin, Lookup, Operation, Reference, Term, TermKind};
pub use typing::Shape;

/// A resolved multibond graph. Indices of its tables are typed by their names: `NodeId`, `BondId`, `JointId`.
#[derive(Clone, Debug)]
pub struct BondGraph {
    /// The generated type's name.
    pub name: Name,
    /// Documentation comment.
    pub docs: String,
    /// Visibility of the generated items.
    pub visibility: Visibility,
    /// Parameters in the order of declaration.
    pub parameters: Vec<Parameter>,
    /// Inputs in the order of declaration.
    pub inputs: Vec<Input>,
    /// Names for expressions; a let refers to others in any order without cycles.
    pub lets: Vec<Let>,
    /// Functions given by points, in the order of declaration.
    pub tables: Vec<Table>,
    /// Junctions and elements in the order of declaration.
    pub nodes: Vec<Node>,
    /// Bonds in the order of the chains.
    pub bonds: Vec<Bond>,
    /// Kinematic states in the order of declaration.
    pub tracks: Vec<Track>,
    /// The state-carrying items in the order of declaration.
    pub storages: Vec<Storage>,
    /// The names of the joints that have gaps or residual sinks.
    pub joints: Vec<String>,
    /// Gaps for the assembly of the start.
    pub closes: Vec<Close>,
    /// Whether impulses make start velocities fit rigid joints.
    pub impulse: bool,
    /// The rate of Baumgarte's terms, 1/s; none where rigid joints are kept by projection.
    pub baumgarte: Option<f64>,
    /// Whether a storage in derivative causality is a fault.
    pub expects_integral: bool,
    /// Observed outputs.
    pub observations: Vec<Observation>,
    /// The guesses in start expressions, each one unknown of the assembly.
    pub guesses: Vec<Term>,
    /// The angles that count turns; each one state where something reads it.
    pub turns: Vec<Turn>,
    /// The scalar 1-junctions whose displacement something reads, each one state.
    pub ways: Vec<NodeId>,
    /// Time integrals, each one state: those of the graph's own, then those that outputs ask for.
    pub integrals: Vec<Integral>,
    /// What computes samples.
    pub clocks: Vec<Clock>,
    /// The delays of signals at any time, one for each time.
    pub delays: Vec<Delay>,
    /// What the mechanism looks like.
    pub drawing: Drawing<Term>,
}

/// Index of a node.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct NodeId(pub usize);

/// Index of a bond.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct BondId(pub usize);

/// Index of a joint.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct JointId(pub usize);

/// What carries states, in the order of declaration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Storage {
    /// A C or I.
    Element(NodeId),
    /// A position or orientation, an index into `tracks`.
    Track(usize),
}

/// A parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: Name,
    /// Documentation comment.
    pub docs: String,
    /// Its unit as written.
    pub unit: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Its default.
    pub default: f64,
    /// Lower end and whether it is included.
    pub lower: Option<(f64, bool)>,
    /// Upper end and whether it is included.
    pub upper: Option<(f64, bool)>,
}

/// An input.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: Name,
    /// Documentation comment.
    pub docs: String,
    /// Its unit as written.
    pub unit: String,
    /// Its dimension.
    pub dimension: Dimension,
}

/// A name for an expression.
#[derive(Clone, Debug)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Term,
    /// Its unit, when declared.
    pub declared: Option<Unit>,
    /// The unit as written.
    pub unit: Option<String>,
    /// The clause of a mechanism word that it stands for, if any.
    pub clause: Option<Clause>,
}

/// A junction or an element.
#[derive(Clone, Debug)]
pub struct Node {
    /// Its name.
    pub name: Name,
    /// What it is.
    pub kind: NodeKind,
    /// Its bonds; a two-port's in order: the one that points in, the one that points out.
    pub bonds: Vec<BondId>,
}

/// What a node is.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "a graph has few nodes, and they are matched everywhere")]
pub enum NodeKind {
    /// Common effort.
    Zero,
    /// Common flow.
    One,
    /// An element.
    Element(Element),
}

/// An element.
#[derive(Clone, Debug)]
pub struct Element {
    /// What it is.
    pub kind: ElementKind,
    /// Its constitutive law.
    pub law: Law,
    /// The law as written.
    pub text: String,
    /// The orientation that a tensor turns with.
    pub frame: Option<Term>,
    /// The displacement that the poses determine.
    pub displacement: Option<Term>,
    /// The state at t = 0.
    pub start: Option<Term>,
    /// The stored energy of a nonlinear law.
    pub energy: Option<Term>,
    /// What a residual sink of a joint holds.
    pub held: Option<Held>,
    /// The effort up to which an R of dry friction sticks.
    pub sticking: Option<Term>,
    /// Of a residual sink that is a stop: its coefficient of restitution.
    pub restitution: Option<Term>,
    /// The speed of a rebound below which something rests on the stop.
    pub rest: Option<Term>,
}

/// The joint that a residual sink is part of, and the direction in which a scalar one holds it.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// The joint.
    pub joint: JointId,
    /// The direction.
    pub direction: Option<Direction>,
}

/// A constitutive law.
#[derive(Clone, Debug)]
pub enum Law {
    /// Value of a source, modulus of a two-port, resistance, inertia.
    Parameter(Term),
    /// A C's effort per displacement.
    Stiffness(Term),
    /// A C's displacement per effort.
    Compliance(Term),
    /// An expression of the law's variable.
    Of {
        /// Whether an R's or a two-port's variable is effort or flow.
        role: Role,
        /// The expression.
        value: Term,
    },
}

impl Law {
    /// The expression of the law.
    #[must_use]
    pub fn term(&self) -> &Term {
        match self {
            Self::Parameter(term) | Self::Stiffness(term) | Self::Compliance(term) => term,
            Self::Of { value, .. } => value,
        }
    }
}

/// A bond.
#[derive(Clone, Debug)]
pub struct Bond {
    /// Where the half arrow starts.
    pub from: NodeId,
    /// Where it points.
    pub to: NodeId,
    /// 1 or 3.
    pub cardinality: usize,
    /// Dimension of the effort.
    pub effort: Dimension,
    /// The bond's place in the source.
    pub span: proc_macro2::Span,
}

impl Bond {
    /// The node at the other end.
    #[must_use]
    pub fn other(&self, node: NodeId) -> NodeId {
        if self.from == node { self.to } else { self.from }
    }

    /// Dimension of the flow.
    #[must_use]
    pub fn flow(&self) -> Dimension {
        Dimension::WATT.per(self.effort)
    }

    /// Unit of the effort, as its domain writes it.
    #[must_use]
    pub fn effort_unit(&self) -> String {
        self.unit(|domain| domain.effort, self.effort)
    }

    /// Unit of the flow, as its domain writes it.
    #[must_use]
    pub fn flow_unit(&self) -> String {
        self.unit(|domain| domain.flow, self.flow())
    }

    /// Unit of the displacement, as its domain writes it.
    #[must_use]
    pub fn displacement_unit(&self) -> String {
        self.unit(|domain| domain.displacement, self.flow().times(Dimension::SECOND))
    }

    /// Unit of the momentum, as its domain writes it.
    #[must_use]
    pub fn momentum_unit(&self) -> String {
        self.unit(|domain| domain.momentum, self.effort.times(Dimension::SECOND))
    }

    fn unit(&self, written: fn(&Domain) -> &'static str, dimension: Dimension) -> String {
        Domain::of_effort(self.effort).map_or_else(|| dimension.to_string(), |domain| written(&domain).to_owned())
    }
}

/// A kinematic state.
#[derive(Clone, Debug)]
pub struct Track {
    /// Position or orientation.
    pub kind: TrackKind,
    /// Its name.
    pub name: Name,
    /// The 1-junction that it follows.
    pub junction: NodeId,
    /// Its value at t = 0.
    pub start: Option<Term>,
}

/// A gap to be closed at the start.
#[derive(Clone, Debug)]
pub struct Close {
    /// The joint.
    pub joint: JointId,
    /// The gap.
    pub gap: Term,
    /// Scalar or vector.
    pub shape: Shape,
    /// Its dimension.
    pub dimension: Dimension,
}

/// An observed output.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Its name.
    pub name: String,
    /// Its value as written.
    pub text: String,
    /// Its value.
    pub value: Term,
    /// Its shape.
    pub shape: Shape,
    /// Its unit as text.
    pub unit: String,
}

/// An angle that counts turns.
#[derive(Clone, Debug)]
pub struct Turn {
    /// The name of its state: that of the `let` or output in which it stands.
    pub name: String,
    /// The angle in one turn, `atan2` of its sine and its cosine.
    pub direction: Term,
    /// How fast it turns, or nearly.
    pub speed: Term,
    /// Whether something reads it.
    pub is_read: bool,
}

/// A time integral: one that an output asks for, or a state of the graph's own.
#[derive(Clone, Debug)]
pub struct Integral {
    /// The name of its state: its own, or that of the output which asks for it.
    pub name: String,
    /// The integrand.
    pub value: Term,
    /// The integrand's dimension.
    pub dimension: Dimension,
    /// Its dimension, where it is declared.
    pub declared: Option<Dimension>,
    /// Its value at t = 0.
    pub start: Option<Term>,
    /// The `let` that it becomes after each step, of a memory or a sample.
    pub follows: Option<usize>,
}

/// A clock, which computes samples, or what reads the signals of a delay.
#[derive(Clone, Debug)]
pub struct Clock {
    /// As written, without its samples.
    pub text: String,
    /// The `let` of the time between two instants, s.
    pub period: usize,
    /// The `let` of the first instant, s.
    pub first: usize,
    /// Of that of a delay, whose period is the time of that: the delay's index. The run says when it has an instant.
    pub delay: Option<usize>,
}

/// The delays of signals by one time. All indices are those of [`BondGraph::integrals`], but where it is said.
#[derive(Clone, Debug)]
pub struct Delay {
    /// The index of the clock that reads the signals.
    pub clock: usize,
    /// The states of the times from which and until which the polynomials hold, s.
    pub window: [usize; 2],
    /// The index of the `let` of the place in the window, from -1 to 1.
    pub place: usize,
    /// The signals.
    pub signals: Vec<DelayedSignal>,
}

/// A delayed signal.
#[derive(Clone, Debug)]
pub struct DelayedSignal {
    /// The states of the coefficients of its polynomial in the place in the window, from that of power 0 on.
    pub coefficients: Vec<usize>,
    /// Whether it is given what the signal was before the run.
    pub is_given: bool,
}

impl Turn {
    /// Its expressions.
    pub fn terms(&self) -> [&Term; 2] {
        [&self.direction, &self.speed]
    }
}

impl BondGraph {
    /// A node.
    #[must_use]
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0]
    }

    /// The name of a joint.
    #[must_use]
    pub fn joint(&self, id: JointId) -> &str {
        &self.joints[id.0]
    }

    /// A bond.
    #[must_use]
    pub fn bond(&self, id: BondId) -> &Bond {
        &self.bonds[id.0]
    }

    /// The element at a node, unless it is a junction.
    #[must_use]
    pub fn element(&self, id: NodeId) -> Option<&Element> {
        match &self.node(id).kind {
            NodeKind::Element(element) => Some(element),
            NodeKind::Zero | NodeKind::One => None,
        }
    }

    /// Whether a term is no more than the clause of a mechanism word, or a component of it.
    #[must_use]
    pub fn is_clause(&self, term: &Term) -> bool {
        match &term.kind {
            TermKind::Reference(Reference::Let(index)) => {
                self.lets[*index].clause.as_ref().is_some_and(|clause| !clause.is_argument)
            }
            TermKind::Component(inner, _) => self.is_clause(inner),
            _ => false,
        }
    }

    /// Hands every part of every expression to `each`.
    pub fn each_term<'g>(&'g self, each: &mut dyn FnMut(&'g Term)) {
        let lets = self.lets.iter().map(|definition| &definition.value);
        lets.chain(self.turns.iter().flat_map(Turn::terms)).for_each(|term| term.visit(each));
        self.each_root(&mut |root| root.visit(each));
    }

    /// Hands every expression that is no `let` and no angle to `each`: what a model evaluates, with what these name.
    pub fn each_root<'g>(&'g self, each: &mut dyn FnMut(&'g Term)) {
        for node in &self.nodes {
            let NodeKind::Element(element) = &node.kind else { continue };
            let clauses = [&element.frame, &element.displacement, &element.start, &element.energy, &element.sticking];
            each(element.law.term());
            let of_stop = [&element.restitution, &element.rest];
            clauses.into_iter().chain(of_stop).flatten().for_each(&mut *each);
        }
        self.tracks.iter().filter_map(|track| track.start.as_ref()).for_each(&mut *each);
        self.closes.iter().for_each(|close| each(&close.gap));
        self.observations.iter().for_each(|observation| each(&observation.value));
        self.guesses.iter().for_each(&mut *each);
        self.integrals.iter().for_each(|integral| each(&integral.value));
        self.integrals.iter().filter_map(|integral| integral.start.as_ref()).for_each(&mut *each);
        let clauses = self.lets.iter().filter(|definition| definition.clause.is_some());
        clauses.for_each(|definition| each(&definition.value));
    }

    /// +1 where the bond's half arrow points into the node, -1 where it points out.
    #[must_use]
    pub fn sign(&self, bond: BondId, node: NodeId) -> f64 {
        if self.bond(bond).to == node { 1.0 } else { -1.0 }
    }
}

impl NodeKind {
    /// The field's symbol.
    #[must_use]
    pub fn symbol(&self) -> &'static str {
        match self {
            Self::Zero => "0",
            Self::One => "1",
            Self::Element(element) => element.kind.symbol(),
        }
    }
}
