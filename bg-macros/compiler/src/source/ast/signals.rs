//! What has a value by itself: parameters, inputs, values, states and memories of a graph's own, samples, tables; and
//! their units.

use proc_macro2::Span;

use crate::source::ast::{Choice, Expression, Name};
use crate::source::clause::Clause;

/// A parameter: a number that stays the same during a run.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Documentation comment.
    pub docs: String,
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// Its default: an expression of numbers only.
    pub default: Expression,
    /// `, above E` or `, at least E`.
    pub lower: Option<Bound>,
    /// `, below E` or `, at most E`.
    pub upper: Option<Bound>,
}

/// One end of a parameter's range.
#[derive(Clone, Debug)]
pub struct Bound {
    /// The end: an expression of numbers only.
    pub value: Expression,
    /// Whether the end itself is allowed (`at least`, `at most`).
    pub included: bool,
}

/// An input: a function of time given at run time.
#[derive(Clone, Debug)]
pub struct Input {
    /// Documentation comment.
    pub docs: String,
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
}

/// A name for an expression.
#[derive(Clone, Debug)]
pub struct Let {
    /// Its name.
    pub name: Name,
    /// Its unit, checked against the value's when given.
    pub unit: Option<Unit>,
    /// Its value.
    pub value: Expression,
    /// The clause of a mechanism word that it stands for, if any.
    pub clause: Option<Clause>,
}

/// A state of the graph's own, which no element stores: a controller's.
#[derive(Clone, Debug)]
pub struct State {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// How fast it changes.
    pub rate: Expression,
    /// Its value at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

/// A value that is kept: it follows another one while a condition holds.
#[derive(Clone, Debug)]
pub struct Memory {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// What it follows, by the condition, and otherwise what is kept: a state named `NAME.kept`.
    pub following: Choice,
    /// What is kept at t = 0; 0 when left out.
    pub start: Option<Expression>,
}

impl Memory {
    /// The name of the state that keeps the value.
    #[must_use]
    pub fn kept(name: &Name) -> Name {
        Name::new(format!("{}.kept", name.text), name.span)
    }
}

/// Values that are computed at the instants of a clock and held in between: a digital controller's.
#[derive(Clone, Debug)]
pub struct Every {
    /// The time from one instant to the next.
    pub period: Expression,
    /// The first instant; 0 when left out.
    pub offset: Option<Expression>,
    /// What is computed.
    pub samples: Vec<Sample>,
}

/// A value of a clock.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Its name.
    pub name: Name,
    /// Its unit.
    pub unit: Unit,
    /// What it becomes at an instant.
    pub value: Expression,
    /// What is held before the first instant; 0 when left out.
    pub start: Option<Expression>,
}

impl Every {
    /// What says when, as written.
    #[must_use]
    pub fn times(&self) -> String {
        let offset = self.offset.as_ref().map_or_else(String::new, |offset| format!(" offset {offset}"));
        format!("every {}{offset}", self.period)
    }
}

impl Sample {
    /// The name of the value that is held before an instant.
    #[must_use]
    pub fn last(name: &Name) -> Name {
        Name::new(format!("{}.{}", name.text, Self::LAST), name.span)
    }

    /// What follows the name of a sample for the value before an instant.
    pub const LAST: &'static str = "last";
}

/// A function of one variable or two that is given by points.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name, by which expressions call it.
    pub name: Name,
    /// The unit of its argument.
    pub argument: Unit,
    /// The unit of its second argument, if it has one.
    pub second: Option<Unit>,
    /// The unit of its value.
    pub value: Unit,
    /// The points: pairs of numbers, the arguments ascending. With two arguments a row of the second ones, then rows of
    /// a first one with the values.
    pub points: Expression,
    /// What it is between its points.
    pub between: Between,
    /// What it is beyond them.
    pub beyond: Beyond,
}

/// What a table is between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Between {
    /// Straight lines.
    #[default]
    Straight,
    /// Cubics with a continuous slope that rise and fall only where the points do.
    Monotone,
    /// A cubic spline: its second derivative is continuous.
    Spline,
}

/// What a table is beyond its first and last point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Beyond {
    /// Nothing: a run that gets there ends with an error.
    #[default]
    Refused,
    /// The value at its end.
    Held,
    /// A straight line with the slope at its end.
    Continued,
    /// The same again and again: its last point is its first one, a period later.
    Periodic,
}

/// A unit as written, `kg*m^2/s`: factors with their exponents (negative after a `/`). `1` has none.
#[derive(Clone, Debug)]
pub struct Unit {
    /// Unit symbol and exponent, in the order written.
    pub factors: Vec<(Name, i32)>,
    /// Where it stands.
    pub span: Span,
}

impl Unit {
    /// The second, at this place.
    #[must_use]
    pub fn second(span: Span) -> Self {
        Self { factors: vec![(Name::new("s", span), 1)], span }
    }

    /// The unit that this stands for; none where a symbol is not known.
    #[must_use]
    pub fn meaning(&self) -> Option<bg_units::Unit> {
        self.factors.iter().try_fold(bg_units::Unit::ONE, |product, (symbol, exponent)| {
            bg_units::Unit::of_symbol(&symbol.text).map(|unit| product.times(unit.power(*exponent)))
        })
    }

    /// Whether a number in it is one in SI; also where nothing is known of it.
    #[must_use]
    pub fn is_coherent(&self) -> bool {
        self.meaning().is_none_or(bg_units::Unit::is_coherent)
    }
}
