//! What is translated.

use bg_expressions::schedule::Operation;

/// Flat single assignments.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The operations; the value of each may be an operand of those after it.
    pub operations: Vec<Operation<Operand>>,
    /// The results.
    pub results: Vec<Operand>,
    /// Whether operations are joined to pairs.
    pub pairing: Pairing,
}

/// Whether operations of one kind become one on pairs of numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// No.
    #[default]
    None,
    /// Where that saves operations: for what is evaluated again and again, as the search takes as long as the rest of
    /// the translation.
    Sought,
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

impl Operand {
    /// Which operation's value it is, if it is one's.
    pub(crate) fn value(self) -> Option<usize> {
        if let Self::Value(of) = self { Some(of as usize) } else { None }
    }
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
}
