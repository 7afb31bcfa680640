//! A tape: values that are wanted for pictures only, as a table that is interpreted and not as code that is compiled.
//!
//! In: quantities of the equations. Out: a [`Tape`]. Every step of it gives one value from values of earlier steps; its
//! words are those of `bg_model::drawing`, which reads it. A table of numbers costs the user's build next to nothing,
//! and a picture asks for few evaluations.

use std::collections::{BTreeMap, BTreeSet};

use crate::expr::{Id, Node, Number, Pool, Symbol, children};
use crate::system::equations::{Quantity, Solution};

/// The steps and what is wanted of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tape {
    /// The numbers that steps refer to.
    pub numbers: Vec<f64>,
    /// The steps, each an operation and its operands.
    pub words: Vec<u32>,
    /// For each wanted component the step that gives it.
    pub results: Vec<u32>,
    /// For each quantity the place of its first component among the results; none where it is not known.
    pub places: Vec<Option<usize>>,
}

/// The tape that gives `quantities`, those with a symbol that has no value in a running model left out.
#[must_use]
pub fn tape(pool: &Pool, solution: &Solution, quantities: &[&Quantity]) -> Tape {
    let all: Vec<Id> = quantities.iter().copied().flatten().flatten().copied().collect();
    let mut without_value = BTreeSet::new();
    for id in pool.reachable(&all) {
        let node = pool.node(id);
        let is_unknown = matches!(node, Node::Symbol(symbol) if leaf(*symbol, solution).is_none());
        if is_unknown || children(node).into_iter().any(|child| without_value.contains(&child)) {
            without_value.insert(id);
        }
    }
    let has_values = |ids: &&Vec<Id>| !ids.iter().any(|id| without_value.contains(id));
    let known: Vec<Option<&Vec<Id>>> = quantities.iter().map(|quantity| quantity.as_ref().filter(has_values)).collect();
    let roots: Vec<Id> = known.iter().flatten().copied().flatten().copied().collect();
    let mut writer = Writer { solution, tape: Tape::default(), steps: BTreeMap::new(), numbers: BTreeMap::new() };
    for id in pool.reachable(&roots) {
        writer.step(id, pool.node(id));
    }
    let mut tape = writer.tape;
    for ids in known {
        tape.places.push(ids.map(|_| tape.results.len()));
        tape.results.extend(ids.into_iter().flatten().map(|id| writer.steps[id]));
    }
    tape
}

struct Writer<'a> {
    solution: &'a Solution,
    tape: Tape,
    /// The step that gives each node.
    steps: BTreeMap<Id, u32>,
    numbers: BTreeMap<Number, u32>,
}

impl Writer<'_> {
    fn step(&mut self, id: Id, node: &Node) {
        let words = match node {
            Node::Number(number) => vec![0, self.number(*number)],
            Node::Symbol(symbol) => {
                let (operation, index) = leaf(*symbol, self.solution).expect("a symbol that has a value");
                vec![operation, index]
            }
            Node::Sum { constant, terms } => {
                let mut words = vec![6, self.number(*constant), count(terms.len())];
                for (id, coefficient) in terms.iter() {
                    words.extend([self.steps[id], self.number(*coefficient)]);
                }
                words
            }
            Node::Product(factors) => {
                let mut words = vec![7, count(factors.len())];
                for (id, exponent) in factors.iter() {
                    words.extend([self.steps[id], exponent.cast_unsigned()]);
                }
                words
            }
            Node::Call(function, arguments) => {
                let arguments = arguments.iter().map(|id| self.steps[id]);
                [8, function.number()].into_iter().chain(arguments).collect()
            }
            Node::Select { switch, negative, positive } => {
                vec![9, *switch, self.steps[negative], self.steps[positive]]
            }
        };
        self.tape.words.extend(words);
        self.steps.insert(id, count(self.steps.len()));
    }

    /// The place of a number.
    fn number(&mut self, number: Number) -> u32 {
        let next = count(self.tape.numbers.len());
        let place = *self.numbers.entry(number).or_insert(next);
        if place == next {
            self.tape.numbers.push(number.value());
        }
        place
    }
}

/// The operation and the operand that read a symbol; none of one without a value in a running model.
fn leaf(symbol: Symbol, solution: &Solution) -> Option<(u32, u32)> {
    match symbol {
        Symbol::Time => Some((1, 0)),
        Symbol::State(index) => Some((2, index)),
        Symbol::Parameter(index) => Some((3, index)),
        Symbol::Input(index) => Some((4, index)),
        Symbol::Slope(index) => Some((5, index)),
        Symbol::Found(index) => Some((11, index)),
        Symbol::Side(index) => Some((12, index)),
        Symbol::Multiplier(_) => solution.row(symbol).map(|row| (10, count(row))),
        Symbol::Unknown(_)
        | Symbol::Law(_)
        | Symbol::Storage(_)
        | Symbol::Flow(_)
        | Symbol::Kept(_)
        | Symbol::Turned(_)
        | Symbol::Unsolved(_)
        | Symbol::Rate(_)
        | Symbol::Weight(_) => None,
    }
}

fn count(of: usize) -> u32 {
    u32::try_from(of).expect("fewer than 2^32 steps")
}
