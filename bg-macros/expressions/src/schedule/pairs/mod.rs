//! Pairs of operations: straight-line code for vectors of two numbers.
//!
//! In: a [`Routine`]. Out: a [`Paired`] with the same results, each rounded as before; after a [`Search::Thorough`] the
//! sign of a zero may differ. Mechanisms repeat themselves, in x and y, at each joint: operations of the same kind
//! whose operands belong together become one operation on pairs, which costs what one on numbers does. `nodes` frees
//! the routine from signs, `choose` says which operations go together and `anneal` improves on it, or `trees` says so
//! in a hundredth of the time; `account` keeps what a choice costs, `signs` says with which sign each value is held,
//! `lower` writes the steps. Method: superword level parallelism (S. Larsen, S. Amarasinghe, PLDI 2000), grown from
//! neighbours among the states and the results.

mod account;
mod anneal;
mod choose;
mod lower;
mod nodes;
mod parity;
mod signs;
#[cfg(test)]
mod tests;
mod trees;

use crate::schedule::{Assignment, Operand, Routine};

/// Straight-line code with pairs.
#[derive(Clone, PartialEq, Debug)]
pub struct Paired {
    /// The steps; each value stands before its use.
    pub steps: Vec<Step>,
    /// The results, in the order of the routine's.
    pub results: Vec<Half>,
    /// Pairs of constants, with `true` where the constant's negative is meant. At least one of both is of the table.
    pub constants: Vec<[(Operand, bool); 2]>,
}

/// A step.
#[derive(Clone, PartialEq, Debug)]
pub enum Step {
    /// A number, by an operation on numbers.
    Single(Assignment),
    /// A number that is half of a pair.
    Half {
        /// The temporary.
        target: u32,
        /// The pair.
        pair: u32,
        /// 0 or 1.
        half: usize,
    },
    /// A pair, with its number; numbered from 0 in the order of the steps.
    Pair(u32, Value),
}

/// The value of a pair.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Value {
    /// A state and the next one.
    States(u32),
    /// Two numbers.
    Numbers([f64; 2]),
    /// An entry of [`Paired::constants`].
    Constants(u32),
    /// Two numbers from anywhere.
    Gather([Half; 2]),
    /// The sums of two pairs.
    Add(u32, u32),
    /// The first pair minus the second.
    Subtract(u32, u32),
    /// The products of two pairs.
    Multiply(u32, u32),
    /// The first pair over the second.
    Divide(u32, u32),
    /// A pair with other signs where `true`.
    Turn(u32, [bool; 2]),
}

/// A number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Half {
    /// One by itself.
    Of(Operand),
    /// One of a pair: the pair, 0 or 1.
    In(u32, usize),
}

impl Search {
    /// The part of the steps that may remain at most for pairs to pay. Machine code has fewer loads and stores as well.
    const fn part(self) -> f64 {
        match self {
            Self::Thorough => 0.9,
            Self::Short => 1.0,
        }
    }
}

/// Shorter routines stay as they are: they take few nanoseconds, and are easier to read.
const LEAST: usize = 40;

/// How pairs are sought.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Search {
    /// For code that is compiled once: some 0.4 ms for an operation, or 40 ms for a hundred of them. Zeros may have
    /// other signs.
    Thorough,
    /// For code that somebody waits for: 0.5 ms for a hundred operations. All bits are kept.
    Short,
}

/// What becomes of a result that is zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Zeros {
    /// It may have the other sign: a sum is held negated where that saves a negation.
    OfAnySign,
    /// It has the sign that the routine gives it.
    OfTheirSign,
}

/// The routine with pairs; none where they would save little, nor of a long routine.
#[must_use]
pub fn pair(routine: &Routine, search: Search) -> Option<Paired> {
    if routine.counts.total() < LEAST || routine.is_long() {
        return None;
    }
    let paired = paired(routine, search);
    let pays = (paired.operations() as f64) < search.part() * routine.counts.total() as f64;
    pays.then_some(paired)
}

/// The routine with pairs, whether they pay or not.
fn paired(routine: &Routine, search: Search) -> Paired {
    let nodes = nodes::Nodes::new(routine);
    let (choice, zeros) = match search {
        Search::Thorough => (anneal::anneal(&nodes, choose::choose(&nodes)), Zeros::OfAnySign),
        Search::Short => (trees::trees(&nodes), Zeros::OfTheirSign),
    };
    let negative = signs::signs(&nodes, &choice, zeros);
    lower::lower(routine, &nodes, &choice, &negative)
}

impl Paired {
    /// The number of steps that cost something: neither states nor constants nor the first half of a pair.
    #[must_use]
    pub fn operations(&self) -> usize {
        let is_there =
            |step: &&Step| matches!(step, Step::Pair(_, Value::States(_) | Value::Numbers(_) | Value::Constants(_)));
        self.steps.iter().filter(|step| !is_there(step)).count()
    }
}
