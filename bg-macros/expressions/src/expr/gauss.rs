//! Linear systems in symbols.
//!
//! In: the rows of a square matrix and the right side. Out: the solution as expressions, with the pivots that may
//! vanish; or what has none.
//! Method: Gaussian elimination on sparse rows. Of the entries that cannot vanish, numbers before others, the pivot is
//! the one with the least product of other entries in its row and column (Markowitz 1957, The Elimination Form of the
//! Inverse, Management Science 3); none is taken that is much smaller than another in its column, each as a share of
//! the largest that its row had: an equation may be written in any unit. The first in order decides what is left open.
//! An entry is zero where it is within rounding at arbitrary values of its symbols, by running error analysis: so a
//! system that has no solution whatever its parameters is known as such, although its coefficients are rounded.

use std::collections::{BTreeMap, BTreeSet};

use super::{Id, Pool, Sized, Symbol, same_polynomial, sized};
use crate::random::Random;

/// What rounding leaves of parts that cancel, relative to the sum of their sizes.
const RESIDUE: f64 = 64.0 * f64::EPSILON;

/// An entry is no pivot beside one in its column with a share of its row larger by more than this factor, at arbitrary
/// values of the symbols.
const GROWTH: f64 = 10.0;

/// A linear system; a row has its entries by their columns.
#[derive(Clone, Debug)]
pub struct Linear {
    /// The matrix.
    pub rows: Vec<BTreeMap<usize, Id>>,
    /// The right side.
    pub right: Vec<Id>,
}

/// What solves a system.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The unknowns.
    pub values: Vec<Id>,
    /// The pivots that are not proved to differ from zero.
    pub doubtful: Vec<Id>,
}

/// How sure it is that an entry differs from zero; the surest comes first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Surety {
    Number,
    Proved,
    Open,
}

/// An entry with its value at arbitrary values of the symbols, and the size of all that it was added up from.
#[derive(Clone, Copy)]
struct Entry {
    id: Id,
    at: Sized,
}

/// A step of the elimination.
#[derive(Clone, Copy)]
struct Step {
    row: usize,
    column: usize,
    pivot: Entry,
}

/// An elimination under way.
struct Elimination<'a> {
    pool: &'a mut Pool,
    matrix: Vec<BTreeMap<usize, Entry>>,
    /// The largest value in each row before the first step.
    scales: Vec<f64>,
    right: Vec<Id>,
    is_proved: &'a dyn Fn(&Pool, Id) -> bool,
    rows: BTreeSet<usize>,
    steps: Vec<Step>,
    doubtful: Vec<Id>,
}

/// Solves a system, where `is_proved` says of which entries it is known that they differ from zero.
///
/// # Errors
/// The rows that are left where no pivot is: they do not determine the unknowns that are left.
pub fn solve_linear(
    pool: &mut Pool,
    system: Linear,
    is_proved: &dyn Fn(&Pool, Id) -> bool,
) -> Result<Solution, Vec<usize>> {
    let mut elimination = Elimination::new(pool, system, is_proved);
    while !elimination.rows.is_empty() {
        elimination.step()?;
    }
    Ok(elimination.solution())
}

/// The entries with their values at arbitrary values of the symbols.
fn sampled(pool: &mut Pool, rows: &[BTreeMap<usize, Id>]) -> Vec<BTreeMap<usize, Entry>> {
    let all: Vec<Id> = rows.iter().flat_map(BTreeMap::values).copied().collect();
    let mut random = Random::new(1);
    let values: BTreeMap<Symbol, f64> =
        pool.symbols(&all).into_iter().map(|symbol| (symbol, 0.5 + random.unit())).collect();
    let mut at = sized(pool, &all, &|symbol| values[&symbol], &|_| false).into_iter();
    let mut entries = |row: &BTreeMap<usize, Id>| {
        row.iter().zip(at.by_ref()).map(|((&column, &id), at)| (column, Entry { id, at })).collect()
    };
    let mut matrix: Vec<BTreeMap<usize, Entry>> = rows.iter().map(&mut entries).collect();
    matrix.iter_mut().for_each(|row| row.retain(|_, entry| !vanishes(pool, *entry)));
    matrix
}

/// Whether an entry is zero, or what rounding leaves of parts that cancel.
fn vanishes(pool: &mut Pool, entry: Entry) -> bool {
    if pool.is_zero(entry.id) || entry.at.value.abs() <= RESIDUE * entry.at.size {
        return true;
    }
    let zero = pool.zero();
    !entry.at.value.is_finite() && same_polynomial(pool, entry.id, zero)
}

impl<'a> Elimination<'a> {
    fn new(pool: &'a mut Pool, system: Linear, is_proved: &'a dyn Fn(&Pool, Id) -> bool) -> Self {
        let Linear { rows, right } = system;
        let matrix = sampled(pool, &rows);
        let largest = |row: &BTreeMap<usize, Entry>| row.values().map(|entry| entry.at.value.abs()).fold(0.0, f64::max);
        let scales = matrix.iter().map(largest).collect();
        let rows = (0..rows.len()).collect();
        Self { pool, matrix, scales, right, is_proved, rows, steps: Vec::new(), doubtful: Vec::new() }
    }

    fn step(&mut self) -> Result<(), Vec<usize>> {
        let Some((surety, step)) = self.pivot() else { return Err(self.rows.iter().copied().collect()) };
        if surety == Surety::Open {
            self.doubtful.push(step.pivot.id);
        }
        self.rows.remove(&step.row);
        let below: Vec<usize> = self.rows.iter().copied().collect();
        for row in below {
            self.eliminate(row, step);
        }
        self.steps.push(step);
        Ok(())
    }

    /// The best pivot of the rows that are left.
    fn pivot(&self) -> Option<(Surety, Step)> {
        let mut in_column: BTreeMap<usize, usize> = BTreeMap::new();
        let mut largest: BTreeMap<usize, f64> = BTreeMap::new();
        for &row in &self.rows {
            for (&column, &entry) in &self.matrix[row] {
                *in_column.entry(column).or_default() += 1;
                let share = self.share(row, entry);
                largest.entry(column).and_modify(|known| *known = known.max(share)).or_insert(share);
            }
        }
        let mut candidates = Vec::new();
        for &row in &self.rows {
            for (&column, &pivot) in &self.matrix[row] {
                // What is not finite at arbitrary values cannot be compared.
                let is_small = GROWTH * self.share(row, pivot) < largest[&column];
                if !is_small {
                    let surety = self.surety(pivot.id);
                    let others = (self.matrix[row].len() - 1) * (in_column[&column] - 1);
                    candidates.push(((surety == Surety::Open, others, surety, row, column), pivot));
                }
            }
        }
        let ((_, _, surety, row, column), pivot) = candidates.into_iter().min_by_key(|(order, _)| *order)?;
        Some((surety, Step { row, column, pivot }))
    }

    /// The value of an entry as a share of the largest that its row had.
    fn share(&self, row: usize, entry: Entry) -> f64 {
        entry.at.value.abs() / self.scales[row]
    }

    /// What is known of an entry as a pivot.
    fn surety(&self, entry: Id) -> Surety {
        match self.pool.as_number(entry) {
            Some(_) => Surety::Number,
            None if (self.is_proved)(self.pool, entry) => Surety::Proved,
            None => Surety::Open,
        }
    }

    /// Takes the multiple of the pivot's row from another one that removes its entry in the pivot's column.
    fn eliminate(&mut self, row: usize, step: Step) {
        let Some(entry) = self.matrix[row].remove(&step.column) else { return };
        let id = self.pool.div(entry.id, step.pivot.id);
        let factor = Entry { id, at: entry.at.over(step.pivot.at) };
        let others: Vec<(usize, Entry)> =
            self.matrix[step.row].iter().filter(|(column, _)| **column != step.column).map(|(&c, &v)| (c, v)).collect();
        for (column, above) in others {
            let before = self.matrix[row].remove(&column);
            let after = self.less(before, factor, above);
            if !vanishes(self.pool, after) {
                self.matrix[row].insert(column, after);
            }
        }
        let product = self.pool.mul(factor.id, self.right[step.row]);
        self.right[row] = self.pool.sub(self.right[row], product);
    }

    /// `a - b c`
    fn less(&mut self, a: Option<Entry>, b: Entry, c: Entry) -> Entry {
        let product = self.pool.mul(b.id, c.id);
        let part = b.at.times(c.at);
        let none = Entry { id: self.pool.zero(), at: Sized::exact(0.0) };
        let a = a.unwrap_or(none);
        let at = Sized { value: a.at.value - part.value, size: a.at.size + part.size };
        Entry { id: self.pool.sub(a.id, product), at }
    }

    fn solution(self) -> Solution {
        let mut values = vec![self.pool.zero(); self.steps.len()];
        for step in self.steps.iter().rev() {
            let others = self.matrix[step.row].iter().filter(|(column, _)| **column != step.column);
            let known: Vec<Id> = others.map(|(&column, entry)| self.pool.mul(entry.id, values[column])).collect();
            let known = self.pool.sum(&known);
            let rest = self.pool.sub(self.right[step.row], known);
            values[step.column] = self.pool.div(rest, step.pivot.id);
        }
        Solution { values, doubtful: self.doubtful }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Symbol, evaluate};
    use crate::random::Random;

    fn system(pool: &mut Pool, rows: &[&[f64]], right: &[f64]) -> Linear {
        let mut id = |&value: &f64| pool.number(value);
        let rows = rows.iter().map(|row| {
            let entries = row.iter().enumerate().filter(|(_, value)| **value != 0.0);
            entries.map(|(column, value)| (column, id(value))).collect()
        });
        let rows = rows.collect();
        Linear { rows, right: right.iter().map(id).collect() }
    }

    fn never(_: &Pool, _: Id) -> bool {
        false
    }

    #[test]
    fn numbers_are_solved_with_pivots_anywhere() {
        let mut pool = Pool::new();
        let system = system(&mut pool, &[&[0.0, 2.0, 1.0], &[1e-9, 1.0, 0.0], &[3.0, 0.0, 1.0]], &[7.0, 2.0, 6.0]);
        let solution = solve_linear(&mut pool, system, &never).expect("a solution");
        let values = evaluate(&pool, &solution.values, &Environment::default());
        assert!(values.iter().zip([1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-8), "{values:?}");
        assert!(solution.doubtful.is_empty());
    }

    #[test]
    fn a_row_in_another_unit_does_not_change_the_pivots() {
        let mut pool = Pool::new();
        // An inertia and a resistor that a transformer of 3.5 has between them: 1 + 613 and 2.2 * 3.5 * 175 / 2.2
        // nearly cancel.
        for unit in [1.0, 1e-3, 1e3] {
            let rows = [[2.2, 7.7], [175.2674, 1.0 + 613.4359]].map(|row| row.map(|entry| unit * entry));
            let numbers = system(&mut pool, &[&[2.2, 7.7], &rows[1]], &[0.0; 2]);
            let mut elimination = Elimination::new(&mut pool, numbers, &never);
            assert!(elimination.step().is_ok());
            let pivot = elimination.steps[0];
            assert_eq!((pivot.row, pivot.column), (0, 0), "{unit}");
        }
    }

    #[test]
    fn rows_that_say_the_same_have_no_solution() {
        let mut pool = Pool::new();
        let rows: [&[f64]; 3] = [&[0.1, 0.2, 0.3], &[0.3, 0.1, 0.7], &[0.4, 0.3, 1.0]];
        let numbers = system(&mut pool, &rows, &[1.0, 2.0, 3.0]);
        assert_eq!(solve_linear(&mut pool, numbers, &never).expect_err("one row too few").len(), 1);
        // a + b and b + a, and a product that only expansion shows to be the same.
        let [a, b] = [0, 1].map(|k| pool.symbol(Symbol::Parameter(k)));
        let (sum, difference) = (pool.add(a, b), pool.sub(a, b));
        let (product, squares) = (pool.mul(sum, difference), [pool.powi(a, 2), pool.powi(b, 2)]);
        let square = pool.sub(squares[0], squares[1]);
        let rows = vec![BTreeMap::from([(0, product), (1, a)]), BTreeMap::from([(0, square), (1, a)])];
        let right = vec![pool.one(); 2];
        assert!(solve_linear(&mut pool, Linear { rows, right }, &never).is_err());
    }

    #[test]
    fn what_cannot_vanish_is_taken_first_and_the_rest_is_told() {
        let mut pool = Pool::new();
        let [a, b] = [0, 1].map(|k| pool.symbol(Symbol::Parameter(k)));
        let (one, two) = (pool.one(), pool.number(2.0));
        let rows = || vec![BTreeMap::from([(0, a), (1, one)]), BTreeMap::from([(0, b), (1, a)])];
        let is_a = |_: &Pool, id: Id| id == a;
        let solution = solve_linear(&mut pool, Linear { rows: rows(), right: vec![two, one] }, &is_a).expect("solved");
        // The number 1 is the first pivot; b - a^2 is left.
        assert_eq!(solution.doubtful.len(), 1);
        let environment = Environment { parameters: &[3.0, 5.0], ..Environment::default() };
        let values = evaluate(&pool, &solution.values, &environment);
        assert!(
            (3.0 * values[0] + values[1] - 2.0).abs() < 1e-15
                && (5.0 * values[0] + 3.0 * values[1] - 1.0).abs() < 1e-15
        );
    }

    #[test]
    fn random_symbols_solve_their_equations() {
        let mut random = Random::new(5);
        for size in 1..8 {
            let mut pool = Pool::new();
            let mut values = Vec::new();
            let mut symbol = |pool: &mut Pool| {
                values.push(2.0 * random.unit() - 1.0);
                pool.symbol(Symbol::numbered(Symbol::Parameter, values.len() - 1))
            };
            let rows: Vec<BTreeMap<usize, Id>> = (0..size)
                .map(|row| {
                    (0..size)
                        .filter(|column| (row + 2 * column) % 3 > 0 || row == *column)
                        .map(|c| (c, symbol(&mut pool)))
                        .collect()
                })
                .collect();
            let right: Vec<Id> = (0..size).map(|_| symbol(&mut pool)).collect();
            let system = Linear { rows: rows.clone(), right: right.clone() };
            let solution = solve_linear(&mut pool, system, &never).expect("a solution");
            let environment = Environment { parameters: &values, ..Environment::default() };
            let found = evaluate(&pool, &solution.values, &environment);
            for (row, right) in rows.iter().zip(&right) {
                let sum: f64 =
                    row.iter().map(|(&c, &entry)| evaluate(&pool, &[entry], &environment)[0] * found[c]).sum();
                let expected = evaluate(&pool, &[*right], &environment)[0];
                assert!((sum - expected).abs() < 1e-9 * found.iter().fold(1.0, |a: f64, b| a.max(b.abs())), "{size}");
            }
        }
    }
}
