//! What a criterion calculates: a tree of numbers, outputs, parameters and measures.
//!
//! In: the values of its leaves, in any number type, in coherent SI. Out: its value. A tree with outputs or the time in
//! it is a function of time, a signal; one without is a number.

use bg_model::scalar::Scalar;

use super::CriterionError;
use super::units::Shown;

/// A node.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A number in coherent SI; with its unit, where one was written.
    Number(f64, Option<Shown>),
    /// The time, s.
    Time,
    /// The output of this place in the model's description.
    Output(usize),
    /// The parameter of this place there.
    Parameter(usize),
    /// The measure of this place among those of its criteria.
    Measure(usize),
    /// The largest (or negated least) value of the signal of a measure in this part of its window.
    Piece {
        /// The measure.
        measure: usize,
        /// The part.
        part: usize,
    },
    /// A function of one.
    One(One, Box<Node>),
    /// A function of two.
    Two(Two, Box<Node>, Box<Node>),
    /// The length of a vector.
    Norm(Vec<Node>),
    /// The largest of several.
    Largest(Vec<Node>),
    /// The least of several.
    Least(Vec<Node>),
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum One {
    /// -x
    Negative,
    /// |x|
    Abs,
    /// Square root.
    Sqrt,
    /// Sine of an angle, rad.
    Sin,
    /// Cosine of an angle, rad.
    Cos,
    /// Tangent of an angle, rad.
    Tan,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
}

/// A function of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Two {
    /// a + b
    Plus,
    /// a - b
    Minus,
    /// a b
    Times,
    /// a / b
    Over,
    /// a to the power b
    Power,
}

/// Values of the leaves of a tree, in coherent SI. What a tree has none of may be left out.
#[derive(Clone, Copy, Debug)]
pub struct Leaves<'a, S> {
    /// The time, s.
    pub t: S,
    /// Of each output.
    pub outputs: &'a [S],
    /// Of each parameter.
    pub parameters: &'a [S],
    /// Of each measure.
    pub measures: &'a [S],
    /// Of the parts of each measure.
    pub pieces: &'a [Vec<S>],
}

impl Node {
    /// The value with these leaves.
    ///
    /// # Panics
    /// A leaf is left out.
    pub fn value<S: Scalar>(&self, leaves: &Leaves<'_, S>) -> S {
        let fold = |several: &[Self], better: fn(S, S) -> bool| {
            let values = several.iter().map(|node| node.value(leaves));
            values.reduce(|best, other| if better(other, best) { other } else { best }).expect("there is one")
        };
        match self {
            Self::Number(value, _) => S::from_f64(*value),
            Self::Time => leaves.t,
            Self::Output(index) => leaves.outputs[*index],
            Self::Parameter(index) => leaves.parameters[*index],
            Self::Measure(index) => leaves.measures[*index],
            Self::Piece { measure, part } => leaves.pieces[*measure][*part],
            Self::One(one, x) => one.value(x.value(leaves)),
            Self::Two(Two::Power, a, b) => power(a.value(leaves), b, leaves),
            Self::Two(two, a, b) => two.value(a.value(leaves), b.value(leaves)),
            Self::Norm(several) => {
                let squares = several.iter().map(|node| node.value(leaves)).map(|value| value * value);
                let sum = squares.fold(S::from_f64(0.0), |sum, square| sum + square);
                // At zero there is no derivative; there zero is one of those that are possible.
                if sum.to_f64() == 0.0 { S::from_f64(0.0) } else { sum.sqrt() }
            }
            Self::Largest(several) => fold(several, |a, b| a > b),
            Self::Least(several) => fold(several, |a, b| a < b),
        }
    }

    /// The nodes right below.
    fn below(&self) -> &[Self] {
        match self {
            Self::Norm(several) | Self::Largest(several) | Self::Least(several) => several,
            Self::One(_, x) => std::slice::from_ref(x),
            _ => &[],
        }
    }

    /// Calls `seen` with it and with all nodes below.
    pub fn each(&self, seen: &mut dyn FnMut(&Self)) {
        seen(self);
        if let Self::Two(_, a, b) = self {
            a.each(seen);
            b.each(seen);
        }
        self.below().iter().for_each(|node| node.each(seen));
    }

    /// Whether it is a function of time.
    pub fn is_signal(&self) -> bool {
        let mut is = false;
        self.each(&mut |node| is |= matches!(node, Self::Output(_) | Self::Time));
        is
    }

    /// Its value where it depends on nothing.
    pub fn constant(&self) -> Option<f64> {
        let mut is = true;
        let constant = |node: &Self| {
            matches!(
                node,
                Self::Number(..) | Self::One(..) | Self::Two(..) | Self::Norm(_) | Self::Largest(_) | Self::Least(_)
            )
        };
        self.each(&mut |node| is &= constant(node));
        let leaves = Leaves { t: 0.0, outputs: &[], parameters: &[], measures: &[], pieces: &[] };
        is.then(|| self.value(&leaves))
    }

    /// The same with every sign turned.
    pub fn negative(self) -> Self {
        Self::One(One::Negative, Box::new(self))
    }

    /// Several nodes whose largest value is that of this node, each smoother: the parts of largest values in time that
    /// this node grows with. `parts` says of each measure how many there are if it is a largest value, and of least
    /// values likewise.
    pub fn pieces(&self, parts: &impl Parts) -> Vec<Self> {
        self.split(parts, true)
    }

    /// As [`Node::pieces`]; with `largest` false several nodes whose least value it is.
    fn split(&self, parts: &impl Parts, largest: bool) -> Vec<Self> {
        let whole = || vec![self.clone()];
        let all = |several: &[Self]| several.iter().flat_map(|node| node.split(parts, largest)).collect();
        let one = |node: &Self, largest: bool, with: &dyn Fn(Self) -> Self| {
            node.split(parts, largest).into_iter().map(with).collect::<Vec<_>>()
        };
        let two = |two: Two, a: &Self, b: &Self| Self::Two(two, Box::new(a.clone()), Box::new(b.clone()));
        match self {
            Self::Measure(measure) => match parts.of(*measure) {
                Some((is_largest, count)) if is_largest == largest => {
                    (0..count).map(|part| Self::Piece { measure: *measure, part }).collect()
                }
                _ => whole(),
            },
            Self::Largest(several) if largest => all(several),
            Self::Least(several) if !largest => all(several),
            Self::One(One::Negative, x) => one(x, !largest, &Self::negative),
            Self::Two(way @ (Two::Plus | Two::Minus), a, b) => {
                let of_a = one(a, largest, &|a| two(*way, &a, b));
                if of_a.len() > 1 {
                    return of_a;
                }
                one(b, largest == (*way == Two::Plus), &|b| two(*way, a, &b))
            }
            Self::Two(Two::Times, a, b) => match (a.constant(), b.constant()) {
                (Some(factor), _) => one(b, largest == (factor > 0.0), &|b| two(Two::Times, a, &b)),
                (_, Some(factor)) => one(a, largest == (factor > 0.0), &|a| two(Two::Times, &a, b)),
                _ => whole(),
            },
            Self::Two(Two::Over, a, b) => match b.constant() {
                Some(divisor) => one(a, largest == (divisor > 0.0), &|a| two(Two::Over, &a, b)),
                None => whole(),
            },
            _ => whole(),
        }
    }
}

/// How many parts the largest or the least value of a measure has.
pub trait Parts {
    /// Whether the measure is a largest value, and not a least one, and how many parts it has; none of another measure.
    fn of(&self, measure: usize) -> Option<(bool, usize)>;
}

/// A power: of a whole exponent for negative bases, too.
fn power<S: Scalar>(base: S, exponent: &Node, leaves: &Leaves<'_, S>) -> S {
    const WHOLE: f64 = 64.0;
    match exponent.constant() {
        Some(whole) if whole.fract() == 0.0 && whole.abs() <= WHOLE => {
            let product = (0..whole.abs() as u32).fold(S::from_f64(1.0), |product, _| product * base);
            if whole < 0.0 { S::from_f64(1.0) / product } else { product }
        }
        _ => base.powf(exponent.value(leaves)),
    }
}

impl One {
    fn value<S: Scalar>(self, x: S) -> S {
        match self {
            Self::Negative => -x,
            Self::Abs => x.abs(),
            Self::Sqrt => x.sqrt(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
        }
    }
}

impl Two {
    fn value<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            Self::Plus => a + b,
            Self::Minus => a - b,
            Self::Times => a * b,
            Self::Over => a / b,
            Self::Power => a.powf(b),
        }
    }
}

/// The unit of a node: that of `leaf` for its leaves.
///
/// # Errors
/// What is added or compared has other units.
pub fn unit(node: &Node, leaf: &dyn Fn(&Node) -> Option<Shown>) -> Result<Option<Shown>, CriterionError> {
    let same = |several: &[&Node]| {
        let units = several.iter().map(|node| unit(node, leaf)).collect::<Result<Vec<_>, _>>()?;
        let mut all: Option<Shown> = None;
        for found in units.iter().flatten() {
            match &all {
                None => all = Some(found.clone()),
                Some(other) if other.unit.dimension != found.unit.dimension => {
                    return Err(CriterionError::Units { a: other.text.clone(), b: found.text.clone() });
                }
                Some(_) => {}
            }
        }
        if let Some(found) = all.as_ref().filter(|found| !found.unit.is_coherent() && units.contains(&None)) {
            return Err(CriterionError::BareNumber { unit: found.text.clone() });
        }
        Ok(all)
    };
    let none = |x: &Node| {
        unit(x, leaf)?
            .map_or(Ok(()), |found| found.is_number().then_some(()).ok_or(found.text))
            .map_err(CriterionError::NotANumber)
    };
    Ok(match node {
        Node::Number(_, unit) => unit.clone(),
        Node::Time | Node::Output(_) | Node::Parameter(_) | Node::Measure(_) | Node::Piece { .. } => leaf(node),
        Node::One(One::Negative | One::Abs, x) => unit(x, leaf)?,
        Node::One(One::Sqrt, x) => {
            unit(x, leaf)?.map(|found| found.root().ok_or(found.text)).transpose().map_err(CriterionError::NoRoot)?
        }
        Node::One(_, x) => {
            none(x)?;
            Some(Shown::number())
        }
        Node::Two(Two::Plus | Two::Minus, a, b) => same(&[a, b])?,
        Node::Two(way @ (Two::Times | Two::Over), a, b) => match (unit(a, leaf)?, unit(b, leaf)?) {
            (None, None) => None,
            (a, b) => {
                let [a, b] = [a, b].map(|unit| unit.unwrap_or_else(Shown::number));
                Some(if *way == Two::Times { a.times(&b) } else { a.over(&b) })
            }
        },
        Node::Two(Two::Power, a, b) => {
            none(b)?;
            match (unit(a, leaf)?, b.constant()) {
                (None, _) => None,
                (Some(a), Some(whole)) if whole.fract() == 0.0 && whole.abs() < 20.0 => Some(a.power(whole as i32)),
                (Some(a), _) if a.is_number() => Some(a),
                (Some(a), _) => return Err(CriterionError::NoPower(a.text)),
            }
        }
        Node::Norm(several) | Node::Largest(several) | Node::Least(several) => {
            same(&several.iter().collect::<Vec<_>>())?
        }
    })
}
