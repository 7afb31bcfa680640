//! What is translated.

use bg_expressions::schedule::Operation;

/// Flat single assignments.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The operations; the value of each may be an operand of those after it.
    pub operations: Vec<Operation<Operand>>,
    /// The results.
    pub results: Vec<Operand>,
}

/// A value that an operation takes: an entry of one of the [`Inputs`], or the value of an earlier operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operand {
    /// What stays as it is as long as the model is the same.
    Fixed(u32),
    /// A state.
    State(u32),
    /// Another number that changes.
    Read(u32),
    /// The value of an operation, by its place among them.
    Value(u32),
}

/// What a program reads: numbers of any kind, and of each switch whether its guard is negative.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a, S = f64, B = bool> {
    /// What stays as it is as long as the model is the same.
    pub fixed: &'a [S],
    /// The states.
    pub states: &'a [S],
    /// Other numbers that change.
    pub read: &'a [S],
    /// Whether the guards of switches are negative.
    pub negative: &'a [B],
}

/// How long slices have to be for a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lengths {
    pub fixed: usize,
    pub states: usize,
    pub read: usize,
    pub switches: usize,
}

impl Program {
    /// How long the slices that it reads have to be.
    ///
    /// # Panics
    /// An operation takes a value that does not come before it.
    pub(crate) fn lengths(&self) -> Lengths {
        let mut lengths = Lengths::default();
        let mut enter = |operand: Operand, known: usize| match operand {
            Operand::Fixed(place) => lengths.fixed = lengths.fixed.max(place as usize + 1),
            Operand::State(place) => lengths.states = lengths.states.max(place as usize + 1),
            Operand::Read(place) => lengths.read = lengths.read.max(place as usize + 1),
            Operand::Value(place) => assert!((place as usize) < known, "values are taken after they are there"),
        };
        for (known, operation) in self.operations.iter().enumerate() {
            operation.operands().into_iter().for_each(|operand| enter(operand, known));
        }
        self.results.iter().for_each(|&result| enter(result, self.operations.len()));
        let switches = self.operations.iter().filter_map(|operation| match operation {
            Operation::Select { switch, .. } => Some(*switch as usize + 1),
            _ => None,
        });
        Lengths { switches: switches.max().unwrap_or(0), ..lengths }
    }

    /// The operations that are needed, in an order in which machine code is short: first the arguments of functions and
    /// their calls, over which it can keep nothing in registers; then each result with what it needs.
    pub(crate) fn order(&self) -> Vec<usize> {
        let mut order = Order { program: self, is_done: vec![false; self.operations.len()], done: Vec::new() };
        let needed = order.needed();
        let is_call = |operation: &Operation<Operand>| matches!(operation, Operation::Call(..));
        let calls = (0..self.operations.len()).filter(|&of| needed[of] && is_call(&self.operations[of]));
        calls.for_each(|of| order.enter(of));
        self.results.iter().for_each(|&result| order.enter_operand(result));
        order.done
    }
}

/// Operations in order.
struct Order<'a> {
    program: &'a Program,
    is_done: Vec<bool>,
    done: Vec<usize>,
}

impl Order<'_> {
    /// Which operations results need.
    fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.program.operations.len()];
        let need = |needed: &mut Vec<bool>, operand: Operand| {
            if let Operand::Value(value) = operand {
                needed[value as usize] = true;
            }
        };
        self.program.results.iter().for_each(|&result| need(&mut needed, result));
        for (of, operation) in self.program.operations.iter().enumerate().rev() {
            if needed[of] {
                operation.operands().into_iter().for_each(|operand| need(&mut needed, operand));
            }
        }
        needed
    }

    fn enter_operand(&mut self, operand: Operand) {
        if let Operand::Value(value) = operand {
            self.enter(value as usize);
        }
    }

    /// Enters an operation after what it needs. On a stack of its own: programs are deep.
    fn enter(&mut self, of: usize) {
        let mut open = vec![of];
        while let Some(&top) = open.last() {
            let waits = self.program.operations[top].operands().into_iter().find_map(|operand| match operand {
                Operand::Value(value) if !self.is_done[value as usize] => Some(value as usize),
                _ => None,
            });
            match waits {
                Some(first) if !self.is_done[top] => open.push(first),
                _ => {
                    open.pop();
                    if !std::mem::replace(&mut self.is_done[top], true) {
                        self.done.push(top);
                    }
                }
            }
        }
    }
}
