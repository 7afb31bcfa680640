//! What of a routine changes with time.
//!
//! In: its steps. Out: which temporaries and pairs change. Inputs and constants do not; a pair changes where one of its
//! numbers does.

use std::collections::BTreeSet;

use super::pairs::{Half, Step, Value};
use super::{Operand, Operation};
use crate::expr::Symbol;

/// What changes.
#[derive(Debug)]
pub struct Changes {
    temporaries: BTreeSet<u32>,
    pairs: BTreeSet<u32>,
}

impl Changes {
    /// What changes of these steps.
    pub fn of(steps: &[Step]) -> Self {
        let mut changes = Self { temporaries: BTreeSet::new(), pairs: BTreeSet::new() };
        for step in steps {
            match step {
                Step::Single(assignment) => {
                    if assignment.operation.operands().iter().any(|operand| changes.operand(operand)) {
                        changes.temporaries.insert(assignment.target);
                    }
                }
                Step::Half { target, pair, .. } => {
                    if changes.pair(*pair) {
                        changes.temporaries.insert(*target);
                    }
                }
                Step::Pair(index, value) => {
                    if changes.value(value) {
                        changes.pairs.insert(*index);
                    }
                }
            }
        }
        changes
    }

    /// What changes of a loop, whose temporaries are in its first iteration these.
    pub fn of_loop(&self, first: &[Operand]) -> Self {
        let temporaries = (0..).zip(first).filter(|(_, operand)| self.operand(operand)).map(|(index, _)| index);
        Self { temporaries: temporaries.collect(), pairs: BTreeSet::new() }
    }

    /// Whether what a step gives changes.
    pub fn includes(&self, step: &Step) -> bool {
        match step {
            Step::Single(assignment) => self.temporary(assignment.target),
            Step::Half { target, .. } => self.temporary(*target),
            Step::Pair(index, _) => self.pair(*index),
        }
    }

    /// Whether a temporary changes.
    pub fn temporary(&self, index: u32) -> bool {
        self.temporaries.contains(&index)
    }

    /// Whether a pair changes.
    pub fn pair(&self, index: u32) -> bool {
        self.pairs.contains(&index)
    }

    /// Whether an operand changes.
    pub fn operand(&self, operand: &Operand) -> bool {
        match *operand {
            Operand::Temporary(index) => self.temporary(index),
            Operand::Symbol(Symbol::Input(_)) | Operand::Number(_) | Operand::Constant(_) => false,
            Operand::Symbol(_) => true,
        }
    }

    /// Whether one of the numbers of pairs, or one by itself, changes.
    pub fn half(&self, half: &Half) -> bool {
        match half {
            Half::Of(operand) => self.operand(operand),
            Half::In(index, _) => self.pair(*index),
        }
    }

    /// Whether both factors of a product change.
    pub fn is_product(&self, operation: &Operation) -> bool {
        matches!(operation, Operation::Multiply(a, b) if self.operand(a) && self.operand(b))
    }

    /// The same of pairs.
    pub fn is_product_of_pairs(&self, value: &Value) -> bool {
        matches!(value, Value::Multiply(a, b) if self.pair(*a) && self.pair(*b))
    }

    fn value(&self, value: &Value) -> bool {
        match value {
            Value::States(_) => true,
            Value::Numbers(_) | Value::Constants(_) => false,
            Value::Gather(halves) => halves.iter().any(|half| self.half(half)),
            Value::Add(a, b) | Value::Subtract(a, b) | Value::Multiply(a, b) | Value::Divide(a, b) => {
                self.pair(*a) || self.pair(*b)
            }
            Value::Turn(of, _) => self.pair(*of),
        }
    }
}
