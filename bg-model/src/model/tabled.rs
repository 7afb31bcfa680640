//! Straight-line programs as tables, for numbers in which a model calculates seldom: what is generated for doubles is
//! not compiled for these as well.
//!
//! In: the table that the compiler wrote (`bg_expressions::schedule::batches`), what its program reads. Out: its
//! results, with the bits of straight code, since each operation and its operands are the program's. Values stand in
//! one row: what is read, then what operations give, in batches of one kind each; what a batch reads stands before what
//! it writes.
//!
//! A table is words of four bytes, the lowest first. A batch is its kind, the function where it has one, how many
//! operations there are, then the operands of each: places in the row, the halves of a number, the number of a switch.
//!
//! | kind | operands | value |
//! |---|---|---|
//! | 0, 1, 2, 3 | a, b | a + b, a - b, a b, a / b |
//! | 4 | a, the lower half of a number, the upper one | a times the number |
//! | 5 | a | -a |
//! | 6 | function; a | function of a |
//! | 7 | function; a, b | function of a and b |
//! | 8 | switch, a, b | a where the switch is negative, else b |

use alloc::vec::Vec;

use crate::model::scalar::{DoubleDouble, Gradient, KnownAs, Scalar, compiled_for};

/// Four bytes, the lowest first.
pub type Word = [u8; 4];

/// A program as a table.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// The numbers in its first places, each of eight bytes, the lowest first.
    pub numbers: &'static [u8],
    /// How many operations there are.
    pub operations: usize,
    /// The batches, in words.
    pub batches: &'static [u8],
    /// The places of the results, in words.
    pub results: &'static [u8],
}

/// Whether these numbers are doubles.
#[must_use]
pub const fn are_doubles<S: Scalar>() -> bool {
    matches!(S::KNOWN_AS, KnownAs::Doubles)
}

/// Whether long functions in these numbers are interpreted from tables.
#[must_use]
pub const fn is_tabled<S: Scalar>() -> bool {
    matches!(S::KNOWN_AS, KnownAs::DoubleDoubles | KnownAs::Gradients)
}

/// What a program reads after its numbers: states, others, constants.
type Inputs<'a, S> = [&'a [S]; 3];

type Evaluate<S> = fn(&Table, Inputs<'_, S>, &[<S as Scalar>::Switch], &mut [S]);

static DOUBLES: Evaluate<f64> = evaluated;
static DOUBLE_DOUBLES: Evaluate<DoubleDouble> = evaluated;
static GRADIENTS: Evaluate<Gradient> = evaluated;

/// Writes what a program gives. Allocates. Compiled here for the numbers that this crate knows.
///
/// # Panics
/// The table is not of a program that reads so much and gives so many results.
pub fn evaluate<S: Scalar>(table: &Table, read: [&[S]; 3], negative: &[S::Switch], to: &mut [S]) {
    let evaluate = compiled_for!(
        S => Evaluate<S>,
        [&DOUBLES, &DOUBLE_DOUBLES, &GRADIENTS],
        const { &(evaluated::<S> as Evaluate<S>) }
    );
    evaluate(table, read, negative, to);
}

fn evaluated<S: Scalar>(table: &Table, read: Inputs<'_, S>, negative: &[S::Switch], to: &mut [S]) {
    let numbers = table.numbers.as_chunks().0;
    let mut row: Vec<S> = numbers.iter().map(|&bytes| S::from_f64(f64::from_le_bytes(bytes))).collect();
    read.into_iter().for_each(|read| row.extend_from_slice(read));
    let begin = row.len();
    row.resize(begin + table.operations, S::from_f64(0.0));
    run(table.batches.as_chunks().0, &mut row, begin, negative);
    for (to, &place) in to.iter_mut().zip(table.results.as_chunks().0) {
        *to = row[number(place)];
    }
}

/// Evaluates batches, whose values stand in `row` from the place `begin` on.
///
/// # Panics
/// The row has not all places of the program.
pub fn run<S: Scalar>(mut batches: &[Word], row: &mut [S], mut begin: usize, negative: &[S::Switch]) {
    while let Some((&kind, rest)) = batches.split_first() {
        let kind = number(kind);
        let (function, rest) = if matches!(kind, 6 | 7) { rest.split_at(1) } else { (&[][..], rest) };
        let (&count, rest) = rest.split_first().expect("a batch says how many operations it has");
        let (operands, rest) = rest.split_at(WIDTHS[kind] * number(count));
        let (known, next) = row.split_at_mut(begin);
        let next = &mut next[..number(count)];
        let value = |place: Word| known[number(place)];
        match kind {
            0 => each(next, operands, |[a, b]| value(a) + value(b)),
            1 => each(next, operands, |[a, b]| value(a) - value(b)),
            2 => each(next, operands, |[a, b]| value(a) * value(b)),
            3 => each(next, operands, |[a, b]| value(a) / value(b)),
            4 => each(next, operands, |[a, lower, upper]| value(a).times(joined(lower, upper))),
            5 => each(next, operands, |[a]| -value(a)),
            6 => {
                let function = of_one(number(function[0]));
                each(next, operands, |[a]| function(value(a)));
            }
            7 => {
                let function = of_two(number(function[0]));
                each(next, operands, |[a, b]| function(value(a), value(b)));
            }
            _ => each(next, operands, |[switch, a, b]| S::select(negative[number(switch)], value(a), value(b))),
        }
        begin += number(count);
        batches = rest;
    }
}

/// How many words the operands of an operation of each kind have.
const WIDTHS: [usize; 9] = [2, 2, 2, 2, 3, 1, 1, 2, 3];

#[inline(always)]
fn each<S, const K: usize>(next: &mut [S], operands: &[Word], value: impl Fn([Word; K]) -> S) {
    for (to, &operands) in next.iter_mut().zip(operands.as_chunks().0) {
        *to = value(operands);
    }
}

#[inline(always)]
fn number(word: Word) -> usize {
    u32::from_le_bytes(word) as usize
}

/// A number of its halves.
#[inline(always)]
fn joined([a, b, c, d]: Word, [e, f, g, h]: Word) -> f64 {
    f64::from_le_bytes([a, b, c, d, e, f, g, h])
}

/// A function of one argument, by its number in a table.
fn of_one<S: Scalar>(function: usize) -> fn(S) -> S {
    match function {
        0 => S::sqrt,
        1 => S::sin,
        2 => S::cos,
        3 => S::tan,
        4 => S::asin,
        5 => S::acos,
        7 => S::exp,
        8 => S::ln,
        9 => S::tanh,
        10 => S::abs,
        other => unreachable!("function {other} has not one argument"),
    }
}

/// A function of two arguments.
fn of_two<S: Scalar>(function: usize) -> fn(S, S) -> S {
    match function {
        6 => S::atan2,
        11 => S::powf,
        other => unreachable!("function {other} has not two arguments"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(words: &[u32]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    /// Of states x, y and a constant c: 2.5 (x + c), x - c, atan2 of both, the first where a switch is negative, a
    /// number.
    #[test]
    fn a_table_gives_what_its_operations_say() {
        let half = 2.5_f64.to_bits();
        let (lower, upper) = (half as u32, (half >> 32) as u32);
        // Places: the number 0, states 1 and 2, the constant 3, then values from 4 on.
        let batches =
            [0, 1, 1, 3, 1, 1, 1, 3, 4, 1, 4, lower, upper, 7, 6, 1, 6, 5, 8, 1, 0, 6, 5, 6, 1, 1, 2, 5, 1, 2];
        let leak = |bytes: Vec<u8>| -> &'static [u8] { Vec::leak(bytes) };
        let table = Table {
            numbers: leak(7.5_f64.to_le_bytes().to_vec()),
            operations: 7,
            batches: leak(bytes(&batches)),
            results: leak(bytes(&[6, 7, 8, 9, 10, 0])),
        };
        let (x, y, c) = (0.3, 1.25, 0.8);
        for is_negative in [true, false] {
            let of = |value: f64, slopes| Gradient::new(value, slopes);
            let mut found = [of(0.0, [0.0; 2]); 6];
            let states = [of(x, [1.0, 0.0]), of(y, [0.0, 1.0])];
            evaluate(&table, [&states, &[], &[of(c, [0.0; 2])]], &[is_negative], &mut found);
            let (first, second) = (2.5 * (x + c), x - c);
            let expected =
                [first, libm::atan2(first, second), if is_negative { first } else { second }, libm::sin(y), -y, 7.5];
            assert_eq!(found.map(|number| number.value), expected);
            let by_x = if is_negative { 2.5 } else { 1.0 };
            let slopes = [found[0], found[2], found[3], found[4]].map(|number| number.slopes());
            assert_eq!(slopes, [[2.5, 0.0], [by_x, 0.0], [0.0, libm::cos(y)], [0.0, -1.0]]);
        }
    }
}
