//! The reverse sweep of straight-line code: how a weighted sum of its results depends on all that it reads, at once.
//!
//! In: a [`Routine`]. Out: a [`Reverse`], whose results are the derivatives of the sum by states, parameters and
//! constants; the weights are [`Symbol::Weight`]. Method: reverse accumulation (Griewank & Walther 2008, Evaluating
//! Derivatives, section 3.2). The operations are followed backwards; each hands the derivative by its value on to its
//! operands. Signs stay beside the values until a sum takes them up, equal operations are made once, and operations of
//! the routine whose values no derivative needs are dropped.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::{Assignment, Counts, Operand, Operation, Routine};
use crate::expr::{Function, Symbol};

/// A routine that is followed backwards.
#[derive(Clone, PartialEq, Debug)]
pub struct Reverse {
    /// The routine's operations as far as they are needed, then those of the sweep. Its results belong to the leaves.
    pub routine: Routine,
    /// What the sum is differentiated by, each once: states, then parameters, then constants. It does not depend on
    /// others.
    pub leaves: Vec<Operand>,
}

/// The reverse sweep of the first `weighted` results of a routine. Time, inputs, and what is found or known before a
/// run, are given.
#[must_use]
pub fn reverse(routine: &Routine, weighted: usize, name: &str) -> Reverse {
    let mut sweep = Sweep::over(&routine.assignments);
    for (index, &result) in routine.results.iter().take(weighted).enumerate() {
        sweep.give(result, (false, Operand::Symbol(Symbol::numbered(Symbol::Weight, index))));
    }
    for assignment in routine.assignments.iter().rev() {
        if let Some(value) = sweep.derivatives.remove(&Leaf::Temporary(assignment.target)) {
            sweep.through(assignment, value);
        }
    }
    let derivatives = std::mem::take(&mut sweep.derivatives);
    let results = derivatives.values().map(|&derivative| sweep.signed(derivative)).collect();
    let routine = live(name, &sweep.assignments, results);
    Reverse { routine, leaves: derivatives.into_keys().map(Leaf::operand).collect() }
}

/// What a sum can be differentiated by, in the order of a sweep's results.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Leaf {
    State(u32),
    Parameter(u32),
    Constant(u32),
    Temporary(u32),
}

impl Leaf {
    fn of(operand: Operand) -> Option<Self> {
        match operand {
            Operand::Symbol(Symbol::State(index)) => Some(Self::State(index)),
            Operand::Symbol(Symbol::Parameter(index)) => Some(Self::Parameter(index)),
            Operand::Constant(index) => Some(Self::Constant(index)),
            Operand::Temporary(index) => Some(Self::Temporary(index)),
            Operand::Symbol(_) | Operand::Number(_) => None,
        }
    }

    fn operand(self) -> Operand {
        match self {
            Self::State(index) => Operand::Symbol(Symbol::State(index)),
            Self::Parameter(index) => Operand::Symbol(Symbol::Parameter(index)),
            Self::Constant(index) => Operand::Constant(index),
            Self::Temporary(index) => Operand::Temporary(index),
        }
    }
}

/// A value, negated where `true`.
type Signed = (bool, Operand);

/// An operand as one that can be compared.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Key {
    Number(u64),
    Symbol(Symbol),
    Constant(u32),
    Temporary(u32),
}

fn key(operation: &Operation) -> Operation<Key> {
    let keys = operation.map(|operand| match operand {
        Operand::Number(number) => Key::Number(number.to_bits()),
        Operand::Symbol(symbol) => Key::Symbol(symbol),
        Operand::Constant(index) => Key::Constant(index),
        Operand::Temporary(index) => Key::Temporary(index),
    });
    match keys {
        Operation::Add(left, right) => Operation::Add(left.min(right), left.max(right)),
        Operation::Multiply(left, right) => Operation::Multiply(left.min(right), left.max(right)),
        other => other,
    }
}

struct Sweep {
    assignments: Vec<Assignment>,
    /// The temporary of each operation.
    known: FxHashMap<Operation<Key>, u32>,
    /// Whether each temporary of the routine depends on a leaf.
    depends: Vec<bool>,
    /// The derivative by each leaf, as far as it has been summed.
    derivatives: BTreeMap<Leaf, Signed>,
}

impl Sweep {
    fn over(forward: &[Assignment]) -> Self {
        let known = forward.iter().map(|assignment| (key(&assignment.operation), assignment.target)).collect();
        let mut sweep =
            Self { assignments: forward.to_vec(), known, depends: Vec::new(), derivatives: BTreeMap::new() };
        for assignment in forward {
            let depends = assignment.operation.operands().into_iter().any(|operand| sweep.leaf(operand).is_some());
            sweep.depends.push(depends);
        }
        sweep
    }

    /// The operand as a leaf, if the sum can depend on it.
    fn leaf(&self, operand: Operand) -> Option<Leaf> {
        let depends = |leaf: &Leaf| !matches!(leaf, Leaf::Temporary(index) if !self.depends[*index as usize]);
        Leaf::of(operand).filter(depends)
    }

    /// The value of an operation.
    fn value(&mut self, operation: Operation) -> Operand {
        let next = u32::try_from(self.assignments.len()).expect("fewer than 2^32 operations");
        let target = *self.known.entry(key(&operation)).or_insert(next);
        if target == next {
            self.assignments.push(Assignment { target, operation });
        }
        Operand::Temporary(target)
    }

    fn signed(&mut self, (negative, value): Signed) -> Operand {
        if negative { self.value(Operation::Negate(value)) } else { value }
    }

    /// Adds to the derivative by an operand, where the sum can depend on it.
    fn give(&mut self, to: Operand, (negative, value): Signed) {
        let Some(leaf) = self.leaf(to) else { return };
        let sum = match self.derivatives.get(&leaf).copied() {
            None => (negative, value),
            Some((before, sum)) => match (before, negative) {
                (false, true) => (false, self.value(Operation::Subtract(sum, value))),
                (true, false) => (false, self.value(Operation::Subtract(value, sum))),
                _ => (negative, self.value(Operation::Add(sum, value))),
            },
        };
        self.derivatives.insert(leaf, sum);
    }

    /// Adds the derivative times a factor, where the sum can depend on the operand.
    fn give_times(&mut self, to: Operand, (negative, value): Signed, factor: Operand) {
        if self.leaf(to).is_some() {
            let product = self.value(Operation::Multiply(value, factor));
            self.give(to, (negative, product));
        }
    }

    /// Hands the derivative by an operation's value on to its operands.
    fn through(&mut self, assignment: &Assignment, by: Signed) {
        let (negative, value) = by;
        match assignment.operation {
            Operation::Add(left, right) => {
                self.give(left, by);
                self.give(right, by);
            }
            Operation::Subtract(left, right) => {
                self.give(left, by);
                self.give(right, (!negative, value));
            }
            Operation::Multiply(left, right) if left == right => {
                let double = self.value(Operation::Multiply(Operand::Number(2.0), value));
                self.give_times(left, (negative, double), right);
            }
            Operation::Multiply(left, right) => {
                self.give_times(left, by, right);
                self.give_times(right, by, left);
            }
            Operation::Divide(left, right) => {
                let part = self.value(Operation::Divide(value, right));
                self.give(left, (negative, part));
                self.give_times(right, (!negative, part), Operand::Temporary(assignment.target));
            }
            Operation::Negate(only) => self.give(only, (!negative, value)),
            Operation::Call(function, ref arguments) => {
                self.through_call(function, arguments, Operand::Temporary(assignment.target), by);
            }
            Operation::Select { switch, negative: below, positive: above } => {
                let zero = Operand::Number(0.0);
                for (to, negative_value, positive_value) in [(below, value, zero), (above, zero, value)] {
                    if self.leaf(to).is_some() {
                        let part = Operation::Select { switch, negative: negative_value, positive: positive_value };
                        let part = self.value(part);
                        self.give(to, (negative, part));
                    }
                }
            }
        }
    }

    /// The same for a function's `result`.
    fn through_call(&mut self, function: Function, arguments: &[Operand], result: Operand, by: Signed) {
        let (negative, value) = by;
        let (of, number) = (arguments[0], Operand::Number);
        match function {
            Function::Sqrt => {
                let half = self.value(Operation::Multiply(number(0.5), value));
                let part = self.value(Operation::Divide(half, result));
                self.give(of, (negative, part));
            }
            Function::Sin => {
                let cosine = self.value(Operation::Call(Function::Cos, vec![of]));
                self.give_times(of, by, cosine);
            }
            Function::Cos => {
                let sine = self.value(Operation::Call(Function::Sin, vec![of]));
                self.give_times(of, (!negative, value), sine);
            }
            Function::Tan | Function::Tanh => {
                let square = self.value(Operation::Multiply(result, result));
                let derivative = if function == Function::Tan {
                    Operation::Add(number(1.0), square)
                } else {
                    Operation::Subtract(number(1.0), square)
                };
                let derivative = self.value(derivative);
                self.give_times(of, by, derivative);
            }
            Function::Asin | Function::Acos => {
                let square = self.value(Operation::Multiply(of, of));
                let other = self.value(Operation::Subtract(number(1.0), square));
                let root = self.value(Operation::Call(Function::Sqrt, vec![other]));
                let part = self.value(Operation::Divide(value, root));
                self.give(of, (negative ^ (function == Function::Acos), part));
            }
            Function::Atan2 => {
                let (y, x) = (of, arguments[1]);
                let [first, second] = [y, x].map(|of| self.value(Operation::Multiply(of, of)));
                let square = self.value(Operation::Add(first, second));
                let part = self.value(Operation::Divide(value, square));
                self.give_times(y, (negative, part), x);
                self.give_times(x, (!negative, part), y);
            }
            Function::Exp => self.give_times(of, by, result),
            Function::Ln => {
                let part = self.value(Operation::Divide(value, of));
                self.give(of, (negative, part));
            }
            Function::Abs => {
                // 1 or -1: the cosine of the direction of a point on the axis. There is no operation that gives a sign.
                let away = self.value(Operation::Call(Function::Atan2, vec![number(0.0), of]));
                let sign = self.value(Operation::Call(Function::Cos, vec![away]));
                self.give_times(of, by, sign);
            }
            Function::Pow => self.through_power([of, arguments[1]], result, by),
        }
    }

    fn through_power(&mut self, [base, exponent]: [Operand; 2], result: Operand, by: Signed) {
        let (negative, value) = by;
        if self.leaf(base).is_some() {
            let less = match exponent {
                Operand::Number(exponent) => Operand::Number(exponent - 1.0),
                other => self.value(Operation::Subtract(other, Operand::Number(1.0))),
            };
            let power = self.value(Operation::Call(Function::Pow, vec![base, less]));
            let derivative = self.value(Operation::Multiply(exponent, power));
            self.give_times(base, by, derivative);
        }
        if self.leaf(exponent).is_some() {
            let logarithm = self.value(Operation::Call(Function::Ln, vec![base]));
            let derivative = self.value(Operation::Multiply(result, logarithm));
            let part = self.value(Operation::Multiply(value, derivative));
            self.give(exponent, (negative, part));
        }
    }
}

/// The assignments under the results, numbered anew in their order.
fn live(name: &str, all: &[Assignment], results: Vec<Operand>) -> Routine {
    let temporary =
        |operand: &Operand| if let Operand::Temporary(index) = operand { Some(*index as usize) } else { None };
    let mut is_live = vec![false; all.len()];
    results.iter().filter_map(temporary).for_each(|index| is_live[index] = true);
    for (index, assignment) in all.iter().enumerate().rev() {
        if is_live[index] {
            assignment.operation.operands().iter().filter_map(temporary).for_each(|index| is_live[index] = true);
        }
    }
    let mut targets = vec![0; all.len()];
    let mut assignments = Vec::new();
    let moved = |targets: &[u32], operand: Operand| match operand {
        Operand::Temporary(index) => Operand::Temporary(targets[index as usize]),
        other => other,
    };
    for (index, assignment) in all.iter().enumerate().filter(|(index, _)| is_live[*index]) {
        let target = u32::try_from(assignments.len()).expect("fewer than 2^32 operations");
        targets[index] = target;
        let operation = assignment.operation.map(|operand| moved(&targets, operand));
        assignments.push(Assignment { target, operation });
    }
    let results = results.into_iter().map(|result| moved(&targets, result)).collect();
    let counts = Counts::of(&assignments);
    Routine { name: name.to_owned(), assignments, results, counts }
}
