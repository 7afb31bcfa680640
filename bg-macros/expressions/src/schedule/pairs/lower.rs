//! The steps of paired code.
//!
//! In: a routine, its operations, the choice of pairs and the signs that values are held with. Out: the steps, operands
//! first, in depth-first order from the results.

use std::collections::BTreeMap;

use super::choose::{Choice, Pair};
use super::nodes::{Kind, Nodes, Place, Signed};
use super::{Half, Paired, Step, Value};
use crate::schedule::{Assignment, Operand, Operation, Routine};

/// The routine in steps.
pub(super) fn lower(routine: &Routine, nodes: &Nodes, choice: &Choice, negative: &[bool]) -> Paired {
    let mut lowering = Lowering {
        routine,
        nodes,
        choice,
        negative,
        steps: Vec::new(),
        constants: Vec::new(),
        pairs: 0,
        temporaries: u32::try_from(routine.assignments.len()).expect("a temporary's number"),
        done: vec![Done::No; nodes.all.len()],
        known: Vec::new(),
        negated: BTreeMap::new(),
    };
    let results = lowering.results();
    Paired { steps: lowering.steps, results, constants: lowering.constants }
}

/// How far an operation has come.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Done {
    No,
    /// Its value is half of this pair only.
    Pair(u32),
    /// Its value is the temporary of its number; as half of this pair, too.
    Single(Option<u32>),
}

struct Lowering<'l> {
    routine: &'l Routine,
    nodes: &'l Nodes,
    choice: &'l Choice,
    negative: &'l [bool],
    steps: Vec<Step>,
    constants: Vec<[(Operand, bool); 2]>,
    pairs: u32,
    temporaries: u32,
    done: Vec<Done>,
    /// Pairs of states, constants and gathered numbers that are there already.
    known: Vec<(Value, u32)>,
    /// The temporaries with the negatives of operations' held values.
    negated: BTreeMap<usize, u32>,
}

impl Lowering<'_> {
    fn results(&mut self) -> Vec<Half> {
        let mut written = Vec::new();
        let mut results = self.nodes.results.as_slice();
        while let [first, rest @ ..] = results {
            if let [second, rest @ ..] = rest
                && first.node().is_some()
                && self.choice.is_pair([first.place(), second.place()])
            {
                let pair = self.turned([*first, *second]);
                written.extend([Half::In(pair, 0), Half::In(pair, 1)]);
                results = rest;
            } else {
                written.push(Half::Of(self.true_value(*first)));
                results = rest;
            }
        }
        written
    }

    /// A pair of operations with the signs of these uses.
    fn turned(&mut self, values: [Signed; 2]) -> u32 {
        let pair = self.pair(values, [false; 2]);
        let turn = values.map(|value| self.is_turned(value));
        if turn == [false; 2] { pair } else { self.known_or_new(Value::Turn(pair, turn)) }
    }

    /// Whether a use wants the negative of what is held.
    fn is_turned(&self, value: Signed) -> bool {
        value.negative ^ value.node().is_some_and(|node| self.negative[node])
    }

    /// Makes an operation's value, and what it needs.
    fn make(&mut self, node: usize) {
        // Depth first without recursion: routines may be deep.
        let mut pending = vec![(node, false)];
        while let Some((node, is_ready)) = pending.pop() {
            if self.done[node] != Done::No {
                continue;
            }
            let others = self.choice.partner(node).map(|(other, _)| other);
            if is_ready {
                match self.choice.partner(node) {
                    None => self.single(node),
                    Some((other, half)) => self.both(if half == 0 { node } else { other }),
                }
            } else {
                pending.push((node, true));
                let first = pending.len();
                for member in std::iter::once(node).chain(others) {
                    let operands = self.nodes.all[member].operands.iter();
                    pending.extend(operands.filter_map(|operand| operand.node()).map(|operand| (operand, false)));
                }
                pending[first..].reverse();
            }
        }
    }

    /// An operation on numbers.
    fn single(&mut self, index: usize) {
        let nodes = self.nodes;
        let node = &nodes.all[index];
        let is_negative = self.negative[index];
        let target = u32::try_from(index).expect("a temporary's number");
        let operation = match (node.kind, node.operands.as_slice()) {
            (Kind::Sum, &[first, second]) => {
                let [turn_first, turn_second] = [first, second].map(|operand| self.is_turned(operand) ^ is_negative);
                let (a, b) = (self.held(first), self.held(second));
                match (turn_first, turn_second) {
                    (false, false) => Operation::Add(a, b),
                    (false, true) => Operation::Subtract(a, b),
                    (true, false) => Operation::Subtract(b, a),
                    (true, true) => Operation::Subtract(self.negative_of(first), b),
                }
            }
            (Kind::Product | Kind::Quotient, &[first, second]) => {
                let turns = [first, second].map(|operand| self.is_turned(operand));
                let (a, b) = (self.held(first), self.held(second));
                let (a, b) = match (turns[0] ^ turns[1] ^ is_negative, b) {
                    (false, _) => (a, b),
                    (true, Operand::Number(number)) => (a, Operand::Number(-number)),
                    (true, _) => (self.negative_of(first), b),
                };
                if node.kind == Kind::Product { Operation::Multiply(a, b) } else { Operation::Divide(a, b) }
            }
            _ => {
                let operands: Vec<Operand> = node.operands.iter().map(|&operand| self.true_value(operand)).collect();
                match &self.routine.assignments[index].operation {
                    Operation::Call(function, _) => Operation::Call(*function, operands),
                    Operation::Select { switch, .. } => {
                        Operation::Select { switch: *switch, negative: operands[0], positive: operands[1] }
                    }
                    other => unreachable!("{other:?} is no function and no choice"),
                }
            }
        };
        self.steps.push(Step::Single(Assignment { target, operation }));
        self.done[index] = Done::Single(None);
    }

    /// The pair of operations whose first one this is.
    fn both(&mut self, first: usize) {
        let pair = self.choice.pair_at(self.nodes, first).expect("the first of a pair");
        let target = match self.nodes.all[first].kind {
            Kind::Sum => self.sums(&pair),
            kind => self.products(&pair, kind),
        };
        for node in pair.nodes {
            self.done[node] = Done::Pair(target);
        }
    }

    fn sums(&mut self, pair: &Pair) -> u32 {
        // Which terms are subtracted; constants take the sign that they need.
        let mut subtracted = pair
            .operands
            .map(|operands| [0, 1].map(|half| self.is_turned(operands[half]) ^ self.negative[pair.nodes[half]]));
        let mut absorbed = [[false; 2]; 2];
        for (at, operands) in pair.operands.iter().enumerate() {
            for half in 0..2 {
                // A half that is gathered with a number of the other sign follows it.
                let follows = !operands[1 - half].is_constant() && subtracted[at][1 - half];
                if operands[half].is_constant() {
                    absorbed[at][half] = subtracted[at][half] ^ follows;
                    subtracted[at][half] = follows;
                }
            }
        }
        let [a, b] = [0, 1].map(|at| self.pair(pair.operands[at], absorbed[at]));
        match subtracted {
            [[false, false], [true, true]] => self.new_pair(Value::Subtract(a, b)),
            [[true, true], [false, false]] => self.new_pair(Value::Subtract(b, a)),
            [first, second] => {
                let [a, b] = [(a, first), (b, second)].map(|(operand, turn)| {
                    if turn == [false; 2] { operand } else { self.known_or_new(Value::Turn(operand, turn)) }
                });
                self.new_pair(Value::Add(a, b))
            }
        }
    }

    fn products(&mut self, pair: &Pair, kind: Kind) -> u32 {
        let mut turn = [0, 1].map(|half| {
            let turned = pair.operands.iter().fold(false, |turned, operands| turned ^ self.is_turned(operands[half]));
            turned ^ self.negative[pair.nodes[half]]
        });
        let mut absorbed = [[false; 2]; 2];
        for half in 0..2 {
            if let Some(at) = pair.operands.iter().position(|operands| operands[half].is_constant()) {
                // The sign of the constant itself is part of `turn` already.
                absorbed[at][half] = turn[half] ^ pair.operands[at][half].negative;
                turn[half] = false;
            }
        }
        let [a, b] = [0, 1].map(|at| self.pair(pair.operands[at], absorbed[at]));
        let value = if kind == Kind::Product { Value::Multiply(a, b) } else { Value::Divide(a, b) };
        let product = self.new_pair(value);
        if turn == [false; 2] { product } else { self.new_pair(Value::Turn(product, turn)) }
    }

    /// The pair of two values as they are held, constants with the other sign where `absorbed`.
    fn pair(&mut self, values: [Signed; 2], absorbed: [bool; 2]) -> u32 {
        match values.map(Signed::place) {
            [Place::Constant, Place::Constant] => {
                let numbers = [0, 1].map(|half| match values[half].operand {
                    Operand::Number(number) => Some(if absorbed[half] { -number } else { number }),
                    _ => None,
                });
                if let [Some(first), Some(second)] = numbers {
                    return self.known_or_new(Value::Numbers([first, second]));
                }
                let entry = [0, 1].map(|half| (values[half].operand, absorbed[half]));
                let index = self.constants.iter().position(|known| *known == entry).unwrap_or_else(|| {
                    self.constants.push(entry);
                    self.constants.len() - 1
                });
                self.known_or_new(Value::Constants(u32::try_from(index).expect("an index of a constant")))
            }
            [Place::State(first), Place::State(second)] if second == first + 1 => {
                self.known_or_new(Value::States(first))
            }
            [Place::Node(first), Place::Node(_)] if self.choice.is_pair(values.map(Signed::place)) => {
                self.make(first);
                match self.done[first] {
                    Done::Pair(pair) | Done::Single(Some(pair)) => pair,
                    _ => unreachable!("a pair is made as one"),
                }
            }
            _ => {
                let halves = [0, 1].map(|half| self.half(values[half], absorbed[half]));
                self.known_or_new(Value::Gather(halves))
            }
        }
    }

    /// A value as it is held, for a pair to be gathered.
    fn half(&mut self, value: Signed, is_absorbed: bool) -> Half {
        if let Some(node) = value.node()
            && let Some((_, half)) = self.choice.partner(node)
        {
            self.make(node);
            if let Done::Pair(pair) | Done::Single(Some(pair)) = self.done[node] {
                return Half::In(pair, half);
            }
        }
        let operand = self.held(value);
        match operand {
            Operand::Number(number) if is_absorbed => Half::Of(Operand::Number(-number)),
            operand if is_absorbed => {
                let target = self.new_temporary(Operation::Negate(operand));
                Half::Of(target)
            }
            operand => Half::Of(operand),
        }
    }

    /// A value as it is held, as a number.
    fn held(&mut self, value: Signed) -> Operand {
        let Some(node) = value.node() else { return value.operand };
        self.make(node);
        if let Done::Pair(pair) = self.done[node] {
            let (_, half) = self.choice.partner(node).expect("half of a pair");
            let target = u32::try_from(node).expect("a temporary's number");
            self.steps.push(Step::Half { target, pair, half });
            self.done[node] = Done::Single(Some(pair));
        }
        value.operand
    }

    /// The negative of a value as it is held.
    fn negative_of(&mut self, value: Signed) -> Operand {
        let held = self.held(value);
        if let Operand::Number(number) = held {
            return Operand::Number(-number);
        }
        let known = value.node().and_then(|node| self.negated.get(&node).copied());
        if let Some(known) = known {
            return Operand::Temporary(known);
        }
        let negated = self.new_temporary(Operation::Negate(held));
        if let (Some(node), Operand::Temporary(target)) = (value.node(), negated) {
            self.negated.insert(node, target);
        }
        negated
    }

    /// A value with its true sign.
    fn true_value(&mut self, value: Signed) -> Operand {
        if self.is_turned(value) { self.negative_of(value) } else { self.held(value) }
    }

    fn new_temporary(&mut self, operation: Operation) -> Operand {
        let target = self.temporaries;
        self.temporaries += 1;
        self.steps.push(Step::Single(Assignment { target, operation }));
        Operand::Temporary(target)
    }

    fn known_or_new(&mut self, value: Value) -> u32 {
        if let Some((_, known)) = self.known.iter().find(|(known, _)| *known == value) {
            return *known;
        }
        let pair = self.new_pair(value);
        self.known.push((value, pair));
        pair
    }

    fn new_pair(&mut self, value: Value) -> u32 {
        let pair = self.pairs;
        self.pairs += 1;
        self.steps.push(Step::Pair(pair, value));
        pair
    }
}
