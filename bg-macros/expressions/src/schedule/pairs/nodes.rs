//! The operations of a routine, freed from signs.
//!
//! In: a routine. Out: sums, products and quotients of signed operands; a difference is a sum, a negation is no
//! operation.

use std::collections::BTreeMap;

use crate::expr::Symbol;
use crate::schedule::{Operand, Operation, Routine};

/// A value or its negative.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Signed {
    pub operand: Operand,
    pub negative: bool,
}

/// What is done with the operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Sum,
    Product,
    Quotient,
    /// A function or a choice; its operands and its value have their true signs.
    Other,
    /// Nothing: every use of it is a use of its operand.
    Negation,
}

/// An operation.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub kind: Kind,
    pub operands: Vec<Signed>,
}

/// The operations of a routine, by target, and its results.
#[derive(Debug)]
pub(super) struct Nodes {
    pub all: Vec<Node>,
    pub results: Vec<Signed>,
    users: BTreeMap<Place, Vec<usize>>,
}

/// Where a value comes from, as far as pairs are concerned.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) enum Place {
    /// Numbers and entries of the constant table: a pair of them costs nothing.
    Constant,
    State(u32),
    Symbol(Symbol),
    Node(usize),
}

impl Nodes {
    pub fn new(routine: &Routine) -> Self {
        let mut all: Vec<Node> = Vec::with_capacity(routine.assignments.len());
        // What a use of each target means.
        let mut means: Vec<Signed> = Vec::with_capacity(routine.assignments.len());
        let signed = |operand: Operand, negative: bool, means: &[Signed]| match operand {
            Operand::Temporary(target) => {
                let meant = means[target as usize];
                Signed { operand: meant.operand, negative: meant.negative ^ negative }
            }
            operand => Signed { operand, negative },
        };
        for assignment in &routine.assignments {
            let (kind, subtracts) = match assignment.operation {
                Operation::Add(..) => (Kind::Sum, false),
                Operation::Subtract(..) => (Kind::Sum, true),
                Operation::Multiply(..) => (Kind::Product, false),
                Operation::Divide(..) => (Kind::Quotient, false),
                Operation::Negate(_) => (Kind::Negation, false),
                Operation::Call(..) | Operation::Select { .. } => (Kind::Other, false),
            };
            let operands = assignment.operation.operands();
            let mut operands: Vec<Signed> =
                operands.iter().enumerate().map(|(at, &value)| signed(value, subtracts && at == 1, &means)).collect();
            let value = Operand::Temporary(assignment.target);
            means.push(match kind {
                Kind::Negation => Signed { negative: !operands[0].negative, ..operands[0] },
                Kind::Product | Kind::Quotient => {
                    let negative = operands.iter().fold(false, |negative, operand| negative ^ operand.negative);
                    operands.iter_mut().for_each(|operand| operand.negative = false);
                    Signed { operand: value, negative }
                }
                Kind::Sum | Kind::Other => Signed { operand: value, negative: false },
            });
            all.push(Node { kind, operands });
        }
        let results = routine.results.iter().map(|&result| signed(result, false, &means)).collect();
        let mut users: BTreeMap<Place, Vec<usize>> = BTreeMap::new();
        for (index, node) in all.iter().enumerate().filter(|(_, node)| node.kind != Kind::Negation) {
            for operand in &node.operands {
                let users = users.entry(operand.place()).or_default();
                if users.last() != Some(&index) {
                    users.push(index);
                }
            }
        }
        Self { all, results, users }
    }

    /// The operations that use a value, in ascending order.
    pub fn users(&self, of: Place) -> &[usize] {
        self.users.get(&of).map_or(&[], Vec::as_slice)
    }

    /// The states that operations use, in ascending order.
    pub fn states(&self) -> impl Iterator<Item = u32> + '_ {
        self.users.keys().filter_map(|place| if let Place::State(index) = place { Some(*index) } else { None })
    }
}

impl Signed {
    /// The operation that gives the value, if one does.
    pub fn node(self) -> Option<usize> {
        if let Operand::Temporary(node) = self.operand { Some(node as usize) } else { None }
    }

    pub fn is_constant(self) -> bool {
        self.place() == Place::Constant
    }

    pub fn place(self) -> Place {
        match self.operand {
            Operand::Number(_) | Operand::Constant(_) => Place::Constant,
            Operand::Symbol(Symbol::State(index)) => Place::State(index),
            Operand::Symbol(symbol) => Place::Symbol(symbol),
            Operand::Temporary(node) => Place::Node(node as usize),
        }
    }
}
