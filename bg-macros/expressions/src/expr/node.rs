//! The nodes of the expression graph.
//!
//! In: nothing. Out: the types that [`super::Pool`] stores.

use std::sync::Arc;

/// A node of a [`super::Pool`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Id(pub(super) u32);

/// A quantity that an expression does not define.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Symbol {
    /// Time.
    Time,
    /// A state.
    State(u32),
    /// A parameter.
    Parameter(u32),
    /// An input.
    Input(u32),
    /// A start value that the assembly solves for.
    Unknown(u32),
    /// A component of the variable of a law, of which the law is to be linear.
    Law(u32),
    /// A component of a storage's own state, in calculations about its law.
    Storage(u32),
    /// A component of the flow of a junction, in proofs about poses.
    Flow(u32),
    /// A component of the reaction of a residual sink.
    Multiplier(u32),
    /// Whether a row of the rigid joints takes part, 1 or 0: one that follows from the others does not. Known before a
    /// run.
    Kept(u32),
    /// On which side of zero a root is by which a loop is closed, 1 or -1. Known before a run.
    Side(u32),
    /// 1, or 0 where it is proved that the state that counts the turns of an angle is the angle itself. No longer there
    /// where code is made.
    Turned(u32),
    /// A bond variable or state whose equation is not solved yet.
    Unsolved(u32),
    /// What an iteration has found for a bond variable, nearly its value. It has no derivatives: the last step of the
    /// iteration, which is in the equations, has them.
    Found(u32),
    /// The derivative of an input with respect to time.
    Slope(u32),
    /// The rate of a state.
    Rate(u32),
    /// The weight of a result, where routines are followed backwards.
    Weight(u32),
}

impl Symbol {
    /// The symbol of this index, such as `Symbol::numbered(Symbol::State, 3)`.
    #[must_use]
    pub fn numbered(symbol: fn(u32) -> Self, index: usize) -> Self {
        symbol(u32::try_from(index).expect("fewer than 2^32 symbols"))
    }

    /// The symbol of a state.
    #[must_use]
    pub fn state(index: usize) -> Self {
        Self::numbered(Self::State, index)
    }

    /// The index of the state that this is.
    #[must_use]
    pub fn as_state(self) -> Option<usize> {
        if let Self::State(index) = self { Some(index as usize) } else { None }
    }
}

/// An elementary function.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[expect(missing_docs, reason = "the names are those of the functions")]
pub enum Function {
    Sqrt,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan2,
    Exp,
    Ln,
    Tanh,
    Abs,
    Pow,
}

impl Function {
    /// Number of arguments.
    #[must_use]
    pub fn arity(self) -> usize {
        if matches!(self, Self::Atan2 | Self::Pow) { 2 } else { 1 }
    }

    /// The function's number in tables that are interpreted.
    #[must_use]
    pub fn number(self) -> u32 {
        match self {
            Self::Sqrt => 0,
            Self::Sin => 1,
            Self::Cos => 2,
            Self::Tan => 3,
            Self::Asin => 4,
            Self::Acos => 5,
            Self::Atan2 => 6,
            Self::Exp => 7,
            Self::Ln => 8,
            Self::Tanh => 9,
            Self::Abs => 10,
            Self::Pow => 11,
        }
    }

    /// The function's name in texts.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sqrt => "sqrt",
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan2 => "atan2",
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Tanh => "tanh",
            Self::Abs => "abs",
            Self::Pow => "pow",
        }
    }
}

/// A real number that can be compared, ordered and hashed; -0 is stored as 0.
#[derive(Clone, Copy, Debug)]
pub struct Number(f64);

impl Number {
    /// The number of this value.
    #[must_use]
    pub fn new(value: f64) -> Self {
        Self(if value == 0.0 { 0.0 } else { value })
    }

    /// Its value.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0
    }
}

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Number {}

impl PartialOrd for Number {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Number {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl std::hash::Hash for Number {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

/// What a node is. A pool has each one twice, so copies share what is long.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Node {
    /// A number.
    Number(Number),
    /// A quantity that the expression does not define.
    Symbol(Symbol),
    /// constant + sum of coefficient * node; terms sorted by node, no coefficient zero, no node a number.
    Sum {
        /// The constant.
        constant: Number,
        /// Nodes with their coefficients.
        terms: Arc<[(Id, Number)]>,
    },
    /// Product of node^exponent; factors sorted by node, no exponent zero, no node a number or a product.
    Product(Arc<[(Id, i32)]>),
    /// A function.
    Call(Function, Arc<[Id]>),
    /// `negative` where the switch's guard is below zero, `positive` elsewhere.
    Select {
        /// The switch's index.
        switch: u32,
        /// The value in the branch of the negative guard.
        negative: Id,
        /// The value in the other branch.
        positive: Id,
    },
}
