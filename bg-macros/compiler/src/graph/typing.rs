//! Shape and dimension of every expression.
//!
//! In: [`Term`]. Out: [`Typed`]; faults where shapes or units disagree. A number takes the unit that its place asks for
//! (`Quantity::Any`); a quantity whose bond has no unit yet is `Quantity::Unknown` and disagrees with nothing.

use std::cell::RefCell;

use proc_macro2::Span;

use super::term::{Builtin, Lookup, Operation, Reference, Term, TermKind};
use super::{BondGraph, GraphFault, Integral, NodeId, NodeKind};
use crate::fault::{Explain, Fault};
use bg_units::Unit;

use crate::graph::units::Dimension;
use crate::source::ast::{BinaryOperator, TrackKind};
pub use crate::source::functions::Shape;

impl Shape {
    /// The shape of a bond's variables.
    #[must_use]
    pub fn of_cardinality(cardinality: usize) -> Self {
        if cardinality == 1 { Self::Scalar } else { Self::Vector }
    }

    /// The shape of this many components: 1, 3 or 9.
    #[must_use]
    pub fn of_components(components: usize) -> Self {
        match components {
            1 => Self::Scalar,
            3 => Self::Vector,
            _ => Self::Matrix,
        }
    }

    /// The names of the components after a quantity's name: none, `_x`.., `_11`..
    #[must_use]
    pub fn suffixes(self) -> &'static [&'static str] {
        match self {
            Self::Scalar => &[""],
            Self::Vector => &["_x", "_y", "_z"],
            Self::Matrix => &["_11", "_12", "_13", "_21", "_22", "_23", "_31", "_32", "_33"],
        }
    }
}

impl std::fmt::Display for Shape {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Scalar => "scalar",
            Self::Vector => "vector",
            Self::Matrix => "matrix",
        })
    }
}

/// What is known of a unit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Quantity {
    /// A bare number: any unit that fits.
    Any,
    /// Not known (yet).
    Unknown,
    /// This one.
    Known(Dimension),
}

/// Shape and unit of an expression.
pub type Typed = (Shape, Quantity);

/// What the types of expressions depend on.
pub struct Types<'a> {
    graph: &'a BondGraph,
    efforts: &'a [Option<Dimension>],
    /// The lets' types, calculated when first asked for; no let is defined by itself.
    lets: RefCell<Vec<Option<Typed>>>,
}

impl<'a> Types<'a> {
    /// Types where bond k has effort unit `efforts[k]`, if known.
    pub fn new(graph: &'a BondGraph, efforts: &'a [Option<Dimension>]) -> Self {
        Self { graph, efforts, lets: RefCell::new(vec![None; graph.lets.len()]) }
    }

    /// The effort and flow unit of a bond.
    pub fn bond_units(&self, bond: super::BondId) -> (Quantity, Quantity) {
        match self.efforts[bond.0] {
            Some(effort) => (Quantity::Known(effort), Quantity::Known(Dimension::WATT.per(effort))),
            None => (Quantity::Unknown, Quantity::Unknown),
        }
    }

    /// Shape and unit of `term`; `variable` is those of the law's variable.
    pub fn of(&self, term: &Term, variable: Option<Typed>, faults: &mut Vec<Fault>) -> Typed {
        Checker { types: self, variable, number: Quantity::Any, faults }.check(term)
    }

    /// Shape and unit where every bare number is a pure number.
    pub fn with_pure_numbers(&self, term: &Term, faults: &mut Vec<Fault>) -> Typed {
        Checker { types: self, variable: None, number: Quantity::Known(Dimension::NONE), faults }.check(term)
    }

    /// Shape and unit of what may be declared in a unit. Where that is not coherent, bare numbers are pure numbers:
    /// nobody could say whether they are in SI or in that unit.
    pub fn declared(&self, term: &Term, unit: Option<Unit>, faults: &mut Vec<Fault>) -> Typed {
        if unit.is_none_or(Unit::is_coherent) {
            self.of(term, None, faults)
        } else {
            self.with_pure_numbers(term, faults)
        }
    }

    /// Shape and unit without reporting faults.
    pub fn silently(&self, term: &Term, variable: Option<Typed>) -> Typed {
        self.of(term, variable, &mut Vec::new())
    }

    /// A state of the graph's own, or of a delay, which is what its signal is.
    pub fn of_own(&self, index: usize) -> Typed {
        let Integral { declared, follows, .. } = &self.graph.integrals[index];
        match (declared, follows) {
            (Some(declared), _) => (Shape::Scalar, Quantity::Known(*declared)),
            (None, Some(follows)) => self.of_let(*follows),
            (None, None) => (Shape::Scalar, Quantity::Unknown),
        }
    }

    fn of_let(&self, index: usize) -> Typed {
        let known = self.lets.borrow()[index];
        known.unwrap_or_else(|| {
            let definition = &self.graph.lets[index];
            if let (TermKind::AtInstant(..), Some(unit)) = (&definition.value.kind, definition.declared) {
                // Its value may depend on what it was before.
                return (Shape::Scalar, Quantity::Known(unit.dimension));
            }
            // What a delay of itself is, is found where this is.
            self.lets.borrow_mut()[index] = Some((Shape::Scalar, Quantity::Unknown));
            let (found, quantity) = self.silently(&definition.value, None);
            let shape = definition.clause.as_ref().map_or(found, |clause| Shape::of_components(clause.components));
            let typed = (shape, definition.declared.map_or(quantity, |unit| Quantity::Known(unit.dimension)));
            self.lets.borrow_mut()[index] = Some(typed);
            typed
        })
    }

    fn of_reference(&self, reference: Reference, variable: Option<Typed>) -> Typed {
        let known = |dimension| (Shape::Scalar, Quantity::Known(dimension));
        match reference {
            Reference::Time => known(Dimension::SECOND),
            Reference::Variable => variable.unwrap_or((Shape::Scalar, Quantity::Unknown)),
            Reference::Parameter(index) => known(self.graph.parameters[index].dimension),
            Reference::Input(index) => known(self.graph.inputs[index].dimension),
            Reference::Let(_) => (Shape::Scalar, Quantity::Unknown),
            Reference::Track(index) => match self.graph.tracks[index].kind {
                TrackKind::Position => (Shape::Vector, Quantity::Known(Dimension::METRE)),
                TrackKind::Orientation => (Shape::Matrix, Quantity::Known(Dimension::NONE)),
            },
            Reference::Turn(_) => known(Dimension::NONE),
            Reference::Own(index) => self.of_own(index),
            Reference::Flow(node) => self.of_node(node, |_, flow| flow),
            Reference::Effort(node) => self.of_node(node, |effort, _| effort),
            Reference::Displacement(node) => self.of_node(node, |_, flow| flow.times(Dimension::SECOND)),
            Reference::Momentum(node) => self.of_node(node, |effort, _| effort.times(Dimension::SECOND)),
            Reference::Power(_) | Reference::SuppliedPower | Reference::DissipatedPower => known(Dimension::WATT),
            Reference::Energy(_) | Reference::StoredEnergy => known(Dimension::JOULE),
        }
    }

    fn of_node(&self, node: NodeId, unit: impl Fn(Dimension, Dimension) -> Dimension) -> Typed {
        let Some(&bond) = self.graph.node(node).bonds.first() else {
            return (Shape::Scalar, Quantity::Unknown);
        };
        let shape = Shape::of_cardinality(self.graph.bond(bond).cardinality);
        let quantity = match self.efforts[bond.0] {
            Some(effort) => Quantity::Known(unit(effort, Dimension::WATT.per(effort))),
            None => Quantity::Unknown,
        };
        (shape, quantity)
    }
}

/// The left or right side of an operator.
#[derive(Clone, Copy)]
struct Operand {
    typed: Typed,
    /// Whether it is a literal zero, which fits any shape.
    is_zero: bool,
}

struct Checker<'a, 'g> {
    types: &'a Types<'g>,
    variable: Option<Typed>,
    /// The unit of a bare number.
    number: Quantity,
    faults: &'a mut Vec<Fault>,
}

impl Checker<'_, '_> {
    fn fault(&mut self, span: Span, fault: &impl Explain) {
        self.faults.push(Fault::new(span, fault));
    }

    fn check(&mut self, term: &Term) -> Typed {
        match &term.kind {
            TermKind::Number(_) => (Shape::Scalar, self.number),
            TermKind::Quantity(_, dimension) => (Shape::Scalar, Quantity::Known(*dimension)),
            TermKind::Reference(Reference::Let(index)) => self.types.of_let(*index),
            TermKind::Reference(reference) => self.types.of_reference(*reference, self.variable),
            TermKind::Negate(inner) => self.check(inner),
            TermKind::Lookup(lookup, arguments) => self.lookup(*lookup, arguments),
            TermKind::Component(inner, _) => {
                let (shape, quantity) = self.check(inner);
                if shape != Shape::Vector {
                    self.fault(term.span, &GraphFault::NoComponent { found: shape });
                }
                (Shape::Scalar, quantity)
            }
            TermKind::Chain(first, rest) => self.chain(first, rest),
            TermKind::Call(builtin, arguments) => self.call(term, *builtin, arguments),
            TermKind::Vector(parts) => self.vector(term, parts),
            TermKind::If(_, _, parts) => {
                let [left, right, then, otherwise] = &**parts;
                self.alike(term, "compare", left, right);
                self.alike(term, "choose between", then, otherwise)
            }
            TermKind::AtInstant(_, parts) => self.check(&parts[0]),
            TermKind::Guess(index) => {
                let guess = self.types.graph.guesses[*index].clone();
                self.shaped("guess", &guess, Shape::Scalar)
            }
            TermKind::Integral(index) => {
                let integrand = self.types.graph.integrals[*index].value.clone();
                let (_, quantity) = self.check(&integrand);
                (Shape::Scalar, times(quantity, Quantity::Known(Dimension::SECOND)))
            }
        }
    }

    /// The value of a table, whose arguments have the declared units, or a derivative of it.
    fn lookup(&mut self, Lookup { table, order }: Lookup, arguments: &[Term]) -> Typed {
        let table = &self.types.graph.tables[table];
        for (argument, &declared) in arguments.iter().zip(&table.arguments) {
            let (shape, quantity) = self.check(argument);
            let what = || format!("the argument of the table `{}`", table.name);
            if shape != Shape::Scalar {
                let fault = GraphFault::ShapeOf { what: what(), expected: Shape::Scalar, found: shape };
                self.fault(argument.span, &fault);
            }
            if let Quantity::Known(found) = quantity
                && found != declared
            {
                self.fault(argument.span, &GraphFault::UnitOf { what: what(), expected: declared, found });
            }
        }
        let dimension = (0..order).fold(table.value, |dimension, _| dimension.per(table.arguments[0]));
        (Shape::Scalar, Quantity::Known(dimension))
    }

    /// Two terms that must have the same shape and unit.
    fn alike(&mut self, term: &Term, what: &'static str, left: &Term, right: &Term) -> Typed {
        let (left, right) = (self.operand(left), self.operand(right));
        self.joined(term.span, what, left, right).typed
    }

    fn operand(&mut self, term: &Term) -> Operand {
        Operand { typed: self.check(term), is_zero: is_zero(term) }
    }

    /// Two operands that must have the same shape and unit.
    fn joined(&mut self, span: Span, what: &'static str, left: Operand, right: Operand) -> Operand {
        let ((left_shape, left_unit), (right_shape, right_unit)) = (left.typed, right.typed);
        if left_shape != right_shape && !left.is_zero && !right.is_zero {
            self.fault(span, &GraphFault::Shapes { what, left: left_shape, right: right_shape });
        }
        let shape = if left.is_zero { right_shape } else { left_shape };
        Operand { typed: (shape, self.same_unit(span, what, left_unit, right_unit)), is_zero: false }
    }

    fn same_unit(&mut self, span: Span, what: &str, left: Quantity, right: Quantity) -> Quantity {
        match (left, right) {
            (Quantity::Known(a), Quantity::Known(b)) if a != b => {
                self.fault(span, &GraphFault::Units { what: format!("cannot {what} these"), left: a, right: b });
                Quantity::Unknown
            }
            (Quantity::Known(dimension), _) | (_, Quantity::Known(dimension)) => Quantity::Known(dimension),
            (Quantity::Unknown, _) | (_, Quantity::Unknown) => Quantity::Unknown,
            (Quantity::Any, Quantity::Any) => Quantity::Any,
        }
    }

    /// Operations from left to right.
    fn chain(&mut self, first: &Term, rest: &[Operation]) -> Typed {
        let mut left = self.operand(first);
        for Operation { operator, span, operand } in rest {
            let right = self.operand(operand);
            left = match operator {
                BinaryOperator::Add => self.joined(*span, "add", left, right),
                BinaryOperator::Subtract => self.joined(*span, "subtract", left, right),
                BinaryOperator::Multiply => {
                    Operand { typed: self.product(*span, left.typed, right.typed), is_zero: false }
                }
                BinaryOperator::Divide => {
                    Operand { typed: self.quotient(*span, left.typed, right.typed), is_zero: false }
                }
            };
        }
        left.typed
    }

    fn product(&mut self, span: Span, (a, left_unit): Typed, (b, right_unit): Typed) -> Typed {
        let shape = match (a, b) {
            (Shape::Scalar, other) | (other, Shape::Scalar) => other,
            (Shape::Matrix, other) => other,
            (Shape::Vector, _) => {
                self.fault(span, &GraphFault::Shapes { what: "multiply", left: a, right: b });
                a
            }
        };
        (shape, times(left_unit, right_unit))
    }

    fn quotient(&mut self, span: Span, (a, left_unit): Typed, (b, right_unit): Typed) -> Typed {
        if b != Shape::Scalar {
            self.fault(span, &GraphFault::Shapes { what: "divide", left: a, right: b });
        }
        (a, per(left_unit, right_unit))
    }

    fn vector(&mut self, term: &Term, parts: &[Term]) -> Typed {
        let mut shape = None;
        let mut unit = Quantity::Any;
        if parts.len() != 3 {
            self.fault(term.span, &GraphFault::VectorLength { found: parts.len() });
        }
        for part in parts {
            let (part_shape, part_unit) = self.check(part);
            let first = *shape.get_or_insert(part_shape);
            if part_shape != first || part_shape == Shape::Matrix {
                self.fault(
                    part.span,
                    &GraphFault::Shapes { what: "put into one vector", left: first, right: part_shape },
                );
            }
            unit = self.same_unit(part.span, "put into one vector", unit, part_unit);
        }
        let shape = if shape == Some(Shape::Vector) { Shape::Matrix } else { Shape::Vector };
        (shape, unit)
    }

    fn argument(&mut self, builtin: Builtin, argument: &Term, expected: Shape) -> Quantity {
        self.shaped(builtin.name(), argument, expected).1
    }

    /// The argument of a function of this name, which is to have this shape.
    fn shaped(&mut self, name: &str, argument: &Term, expected: Shape) -> Typed {
        let (found, unit) = self.check(argument);
        if found != expected {
            let what = format!("the argument of `{name}`");
            self.fault(argument.span, &GraphFault::ShapeOf { what, expected, found });
        }
        (found, unit)
    }

    fn number(&mut self, builtin: Builtin, argument: &Term) {
        if let Quantity::Known(found) = self.argument(builtin, argument, Shape::Scalar)
            && found != Dimension::NONE
        {
            let what = format!("the argument of `{}`", builtin.name());
            self.fault(argument.span, &GraphFault::NotDimensionless { what, found });
        }
    }

    fn call(&mut self, term: &Term, builtin: Builtin, arguments: &[Term]) -> Typed {
        use Builtin as B;
        use Shape::{Matrix, Scalar, Vector};
        let pure = Quantity::Known(Dimension::NONE);
        match builtin {
            B::Sin | B::Cos | B::Tan | B::Asin | B::Acos | B::Exp | B::Ln | B::Tanh => {
                self.number(builtin, &arguments[0]);
                (Scalar, pure)
            }
            B::Sqrt => {
                let unit = self.argument(builtin, &arguments[0], Scalar);
                (Scalar, self.root(term, unit))
            }
            B::Root => {
                self.argument(builtin, &arguments[0], Scalar);
                let (_, unit) = self.alike(term, "compare", &arguments[0], &arguments[1]);
                (Scalar, self.root(term, unit))
            }
            B::Atan2 => {
                self.argument(builtin, &arguments[0], Scalar);
                self.alike(term, "compare", &arguments[0], &arguments[1]);
                (Scalar, pure)
            }
            B::Abs => (Scalar, self.argument(builtin, &arguments[0], Scalar)),
            B::Pow => (Scalar, self.power(&arguments[0], &arguments[1])),
            B::Dot => (Scalar, self.pair(builtin, arguments, Vector)),
            B::Cross => (Vector, self.pair(builtin, arguments, Vector)),
            B::Outer => (Matrix, self.pair(builtin, arguments, Vector)),
            B::Norm => (Scalar, self.argument(builtin, &arguments[0], Vector)),
            B::Skew | B::Diagonal => (Matrix, self.argument(builtin, &arguments[0], Vector)),
            B::Transpose => (Matrix, self.argument(builtin, &arguments[0], Matrix)),
            B::Inverse => (Matrix, per(pure, self.argument(builtin, &arguments[0], Matrix))),
            B::Identity => (Matrix, Quantity::Any),
            B::RotationX | B::RotationY | B::RotationZ => {
                self.number(builtin, &arguments[0]);
                (Matrix, pure)
            }
        }
    }

    fn pair(&mut self, builtin: Builtin, arguments: &[Term], shape: Shape) -> Quantity {
        let left = self.argument(builtin, &arguments[0], shape);
        let right = self.argument(builtin, &arguments[1], shape);
        times(left, right)
    }

    /// The unit of a square root of a quantity in `unit`.
    fn root(&mut self, term: &Term, unit: Quantity) -> Quantity {
        match unit {
            Quantity::Known(found) => match found.root() {
                Some(root) => Quantity::Known(root),
                None => {
                    self.fault(term.span, &GraphFault::NoRoot { found });
                    Quantity::Unknown
                }
            },
            other => other,
        }
    }

    /// A power with a whole literal exponent keeps units; any other needs pure numbers.
    fn power(&mut self, base: &Term, exponent: &Term) -> Quantity {
        match exponent.kind {
            TermKind::Number(n) if n.fract() == 0.0 && n.abs() <= 16.0 => {
                match self.argument(Builtin::Pow, base, Shape::Scalar) {
                    #[expect(clippy::cast_possible_truncation, reason = "whole and at most 16, tested above")]
                    Quantity::Known(dimension) => Quantity::Known(dimension.power(n as i32)),
                    other => other,
                }
            }
            _ => {
                self.number(Builtin::Pow, base);
                self.number(Builtin::Pow, exponent);
                Quantity::Known(Dimension::NONE)
            }
        }
    }
}

/// A literal zero fits any shape and unit.
fn is_zero(term: &Term) -> bool {
    matches!(term.kind, TermKind::Number(0.0))
}

/// The unit of a product.
fn times(left: Quantity, right: Quantity) -> Quantity {
    combine(left, right, Dimension::times)
}

/// The unit of a quotient.
fn per(left: Quantity, right: Quantity) -> Quantity {
    combine(left, right, Dimension::per)
}

/// A bare number in a product may carry any unit, so the product may, too.
fn combine(left: Quantity, right: Quantity, of: impl Fn(Dimension, Dimension) -> Dimension) -> Quantity {
    match (left, right) {
        (Quantity::Known(a), Quantity::Known(b)) => Quantity::Known(of(a, b)),
        (Quantity::Unknown, _) | (_, Quantity::Unknown) => Quantity::Unknown,
        (Quantity::Any, _) | (_, Quantity::Any) => Quantity::Any,
    }
}

/// Whether a node is a junction.
pub fn is_junction(kind: &NodeKind) -> bool {
    matches!(kind, NodeKind::Zero | NodeKind::One)
}
