//! Repetition in long straight-line code.
//!
//! In: assignments. Out: the runs in which the same piece follows itself, and the piece with what each iteration reads.
//! Two stretches are the same piece where their operations are, and where each operand is made at the same place of the
//! piece, or in both outside of it. Method: a table of hashes tells where what stands at a place begins again, which
//! gives periods; each is held by comparing. The first place where a run begins is taken, with the period that saves
//! most.

use std::hash::{Hash, Hasher};

use rustc_hash::{FxHashMap, FxHasher};

use super::table::{Store, number};
use super::{Assignment, Operand};
use crate::expr::Symbol;

/// The same piece several times in a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Run {
    /// The place of its first assignment.
    pub start: usize,
    /// The assignments of each iteration.
    pub period: usize,
    /// The iterations.
    pub count: usize,
}

/// The code of all iterations of a run.
#[derive(Clone, PartialEq, Debug)]
pub struct Piece {
    /// Its assignments, numbered from 0; the temporaries that follow are its inputs.
    pub assignments: Vec<Assignment>,
    /// What it reads from outside, where that may differ from iteration to iteration.
    pub inputs: Vec<Input>,
}

/// What a piece reads from outside: entries of an array.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Input {
    /// The array.
    pub array: Array,
    /// The entry that each iteration reads.
    pub entries: Vec<u32>,
}

/// Where an operand that has a number stands.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Array {
    /// Among the states.
    States,
    /// Among their rates.
    Rates,
    /// In the constant table.
    Constants,
    /// Among the targets of assignments.
    Temporaries,
}

impl Array {
    /// The operand with this number.
    #[must_use]
    pub fn operand(self, index: u32) -> Operand {
        match self {
            Self::States => Operand::Symbol(Symbol::State(index)),
            Self::Rates => Operand::Symbol(Symbol::Rate(index)),
            Self::Constants => Operand::Constant(index),
            Self::Temporaries => Operand::Temporary(index),
        }
    }

    /// The array and the entry of an operand; none of what all iterations of a run have in common.
    #[must_use]
    pub fn entry(operand: &Operand) -> Option<(Self, u32)> {
        match *operand {
            Operand::Symbol(Symbol::State(index)) => Some((Self::States, index)),
            Operand::Symbol(Symbol::Rate(index)) => Some((Self::Rates, index)),
            Operand::Constant(index) => Some((Self::Constants, index)),
            Operand::Temporary(index) => Some((Self::Temporaries, index)),
            Operand::Number(_) | Operand::Symbol(_) => None,
        }
    }
}

/// What iterations have in common of an operand.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Leaf {
    Number(u64),
    Symbol(Symbol),
    /// An entry of an array, of this kind.
    Entry(Array, bool),
}

/// An assignment as iterations compare it.
struct Shape {
    /// The number of what they have in common.
    common: u32,
    /// The places of the assignments that make its operands; none of other operands.
    operands: Vec<Option<usize>>,
}

/// What begins again does so for at least so many assignments.
const ALIKE: usize = 12;
/// Periods that are tried at each place.
const PERIODS: usize = 8;
/// Shorter iterations are joined: each of them costs some instructions beside its operations.
const SHORTEST: usize = 128;
/// Longer ones are no piece: it is one scope inside of the other for each of them.
const LONGEST: usize = 2000;

/// The runs in assignments, in their order. Operands of which one is of a kind and the other is not do not stand at the
/// same place of a piece.
#[must_use]
pub fn runs(assignments: &[Assignment], kind: &dyn Fn(&Operand) -> bool) -> Vec<Run> {
    let shapes = shapes(assignments, kind);
    let next = begins_again(&shapes);
    let (mut runs, mut start) = (Vec::new(), 0);
    while start < shapes.len() {
        let run = run_at(&shapes, &next, start);
        start += run.map_or(1, |run| run.period * run.count);
        runs.extend(run);
    }
    runs
}

fn shapes(assignments: &[Assignment], kind: &dyn Fn(&Operand) -> bool) -> Vec<Shape> {
    let places: FxHashMap<u32, usize> = assignments.iter().map(|assignment| assignment.target).zip(0..).collect();
    let leaf = |operand: Operand| match operand {
        Operand::Number(value) => Leaf::Number(value.to_bits()),
        Operand::Symbol(symbol) => {
            Array::entry(&operand).map_or(Leaf::Symbol(symbol), |(array, _)| Leaf::Entry(array, kind(&operand)))
        }
        Operand::Constant(_) => Leaf::Entry(Array::Constants, kind(&operand)),
        Operand::Temporary(_) => Leaf::Entry(Array::Temporaries, kind(&operand)),
    };
    let place = |operand: &Operand| match operand {
        Operand::Temporary(temporary) => places.get(temporary).copied(),
        _ => None,
    };
    let mut store = Store::default();
    let shape = |Assignment { operation, .. }: &Assignment| Shape {
        common: store.intern(operation.map(leaf)),
        operands: operation.operands().iter().map(place).collect(),
    };
    assignments.iter().map(shape).collect()
}

/// For each place the next one that begins like it, if there is one.
fn begins_again(shapes: &[Shape]) -> Vec<Option<usize>> {
    // Operands count where they are made close by.
    let hash = |from: usize| {
        let mut hasher = FxHasher::default();
        for (place, shape) in shapes[from..from + ALIKE].iter().enumerate() {
            shape.common.hash(&mut hasher);
            for operand in &shape.operands {
                operand.and_then(|at| at.checked_sub(from)).filter(|at| *at < place).hash(&mut hasher);
            }
        }
        hasher.finish()
    };
    let (mut last, mut next) = (FxHashMap::default(), vec![None; shapes.len()]);
    for from in (0..(shapes.len() + 1).saturating_sub(ALIKE)).rev() {
        next[from] = last.insert(hash(from), from);
    }
    next
}

/// The run that begins at a place and saves most.
fn run_at(shapes: &[Shape], next: &[Option<usize>], start: usize) -> Option<Run> {
    let periods = std::iter::successors(next[start], |&at| next[at]).take(PERIODS).map(|at| at - start);
    let joined = periods.map(|period| period * SHORTEST.div_ceil(period)).filter(|period| *period <= LONGEST);
    let run = |period: usize| {
        let others = (1..).take_while(|count| is_same(shapes, start, start + count * period, period));
        Run { start, period, count: 1 + others.count() }
    };
    let runs = joined.map(run).filter(|run| run.count > 1);
    runs.max_by_key(|run| (run.period * (run.count - 1), std::cmp::Reverse(run.period)))
}

/// Whether the stretches of this length from two places on are the same piece.
fn is_same(shapes: &[Shape], first: usize, second: usize, length: usize) -> bool {
    let inside = |operand: &Option<usize>, start: usize| operand.and_then(|at| at.checked_sub(start));
    let is_same = |(left, right): (&Shape, &Shape)| {
        let mut operands = left.operands.iter().zip(&right.operands);
        left.common == right.common && operands.all(|(left, right)| inside(left, first) == inside(right, second))
    };
    let Some(right) = shapes.get(second..second + length) else { return false };
    shapes[first..first + length].iter().zip(right).all(is_same)
}

/// The piece of these assignments, all those of a run.
#[must_use]
pub fn piece(assignments: &[Assignment], period: usize) -> Piece {
    let iterations = assignments.chunks(period);
    let own: FxHashMap<u32, u32> = assignments[..period].iter().map(|assignment| assignment.target).zip(0..).collect();
    let mut inputs = Store::default();
    let mut assignment = |place: usize| {
        let read: Vec<Vec<Operand>> =
            iterations.clone().map(|iteration| iteration[place].operation.operands()).collect();
        let operands = read[0].iter().enumerate().map(|(at, operand)| match Array::entry(operand) {
            Some((Array::Temporaries, index)) if own.contains_key(&index) => Operand::Temporary(own[&index]),
            Some((array, _)) => {
                let entries = read.iter().filter_map(|operands| Array::entry(&operands[at]));
                let input = inputs.intern(Input { array, entries: entries.map(|(_, index)| index).collect() });
                Operand::Temporary(number(period) + input)
            }
            None => *operand,
        });
        let operands: Vec<Operand> = operands.collect();
        let mut operands = operands.into_iter();
        let operation = assignments[place].operation.map(|_| operands.next().expect("as many operands"));
        Assignment { target: number(place), operation }
    };
    let assignments = (0..period).map(&mut assignment).collect();
    Piece { assignments, inputs: inputs.items }
}

#[cfg(test)]
mod tests {
    use super::super::Operation;
    use super::*;
    use Operand::{Constant, Number, Temporary};

    const STATE: fn(u32) -> Operand = |index| Operand::Symbol(Symbol::State(index));

    /// The assignments of an iteration.
    const PERIOD: u32 = 130;

    /// `count` iterations, each of which reads a state, a constant and what the iteration before gives.
    fn chain(count: u32) -> Vec<Assignment> {
        let mut assignments = vec![Operation::Negate(STATE(0))];
        for iteration in 0..count {
            let before = number(assignments.len() - 1);
            assignments.push(Operation::Multiply(STATE(3 * iteration), Constant(iteration)));
            assignments.push(Operation::Add(Temporary(before), Temporary(before + 1)));
            for _ in 2..PERIOD {
                assignments.push(Operation::Multiply(Temporary(number(assignments.len() - 1)), Number(0.5)));
            }
        }
        numbered(assignments)
    }

    fn numbered(operations: Vec<Operation>) -> Vec<Assignment> {
        operations.into_iter().zip(0..).map(|(operation, target)| Assignment { target, operation }).collect()
    }

    fn all_alike(assignments: &[Assignment]) -> Vec<Run> {
        runs(assignments, &|_| false)
    }

    #[test]
    fn a_chain_is_a_run() {
        assert_eq!(all_alike(&chain(9)), [Run { start: 1, period: 130, count: 9 }]);
        assert_eq!(all_alike(&chain(1)), []);
    }

    #[test]
    fn the_piece_reads_what_each_iteration_reads() {
        let assignments = chain(9);
        let Piece { assignments, inputs } = piece(&assignments[1..], 130);
        let input = |array, entries: &dyn Fn(u32) -> u32| Input { array, entries: (0..9).map(entries).collect() };
        assert_eq!(
            inputs,
            [
                input(Array::States, &|iteration| 3 * iteration),
                input(Array::Constants, &|iteration| iteration),
                input(Array::Temporaries, &|iteration| PERIOD * iteration),
            ]
        );
        assert_eq!(assignments[0].operation, Operation::Multiply(Temporary(130), Temporary(131)));
        assert_eq!(assignments[1].operation, Operation::Add(Temporary(132), Temporary(0)));
        assert_eq!(
            assignments[129],
            Assignment { target: 129, operation: Operation::Multiply(Temporary(128), Number(0.5)) }
        );
    }

    #[test]
    fn another_number_operation_or_place_ends_a_run() {
        let run = |count| [Run { start: 1, period: 130, count }];
        let changed = |operation: Operation| {
            let mut assignments = chain(9);
            // The twentieth assignment of the sixth iteration.
            assignments[1 + 5 * 130 + 19].operation = operation;
            all_alike(&assignments)
        };
        let before = Temporary(5 * 130 + 19);
        assert_eq!(changed(Operation::Multiply(before, Number(0.5)))[..], run(9));
        let others = [
            Operation::Multiply(before, Number(0.25)),
            Operation::Add(before, Number(0.5)),
            Operation::Multiply(Temporary(5 * 130 + 18), Number(0.5)),
            Operation::Multiply(STATE(1), Number(0.5)),
            // Made by the iteration before.
            Operation::Multiply(Temporary(5 * 130), Number(0.5)),
        ];
        for operation in others {
            assert_eq!(changed(operation.clone())[0], run(5)[0], "{operation:?}");
        }
    }

    #[test]
    fn kinds_end_a_run() {
        let is_late = |operand: &Operand| matches!(operand, Constant(6..));
        let run = |start, count| Run { start, period: 130, count };
        assert_eq!(runs(&chain(9), &is_late), [run(1, 6), run(781, 3)]);
    }

    #[test]
    fn short_iterations_are_joined() {
        let operations = (0..256).map(|index| Operation::Multiply(STATE(index), STATE(index))).collect();
        assert_eq!(all_alike(&numbered(operations)), [Run { start: 0, period: 128, count: 2 }]);
    }

    #[test]
    fn targets_need_not_be_numbered_in_turn() {
        let mut assignments = chain(9);
        let moved = |temporary: u32| 7 * temporary + 3;
        for Assignment { target, operation } in &mut assignments {
            *target = moved(*target);
            *operation = operation.map(|operand| match operand {
                Temporary(temporary) => Temporary(moved(temporary)),
                other => other,
            });
        }
        assert_eq!(all_alike(&assignments), all_alike(&chain(9)));
    }
}
