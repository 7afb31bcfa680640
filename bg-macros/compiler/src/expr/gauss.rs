//! Linear systems in symbols.
//!
//! In: the rows of a square matrix and the right side. Out: the solution as expressions, with the pivots that may vanish; or what
//! has none.
//! Method: Gaussian elimination on sparse rows. Of the entries that cannot vanish, numbers before others, the pivot is the one with
//! the least product of other entries in its row and column (Markowitz 1957, The Elimination Form of the Inverse, Management Science
//! 3); of numbers in one column none is taken that is much smaller than another. The first in order decides what is left open.

use std::collections::{BTreeMap, BTreeSet};

use super::{Id, Pool, same_polynomial};

/// What remains of numbers that cancel, relative to their sizes.
const ROUNDING: f64 = 1e-12;

/// A number is no pivot beside one in its column that is larger by more than this factor.
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

/// A step of the elimination.
struct Step {
    row: usize,
    column: usize,
    pivot: Id,
}

/// An elimination under way.
struct Elimination<'a> {
    pool: &'a mut Pool,
    system: Linear,
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
    let rows = (0..system.rows.len()).collect();
    let mut elimination = Elimination { pool, system, is_proved, rows, steps: Vec::new(), doubtful: Vec::new() };
    while !elimination.rows.is_empty() {
        elimination.step()?;
    }
    Ok(elimination.solution())
}

impl Elimination<'_> {
    fn step(&mut self) -> Result<(), Vec<usize>> {
        let Some((surety, step)) = self.pivot() else { return Err(self.rows.iter().copied().collect()) };
        if surety == Surety::Open {
            self.doubtful.push(step.pivot);
        }
        self.rows.remove(&step.row);
        let below: Vec<usize> = self.rows.iter().copied().collect();
        for row in below {
            self.eliminate(row, &step);
        }
        self.steps.push(step);
        Ok(())
    }

    /// The best pivot of the rows that are left.
    fn pivot(&mut self) -> Option<(Surety, Step)> {
        let mut in_column: BTreeMap<usize, usize> = BTreeMap::new();
        let mut largest: BTreeMap<usize, f64> = BTreeMap::new();
        for (&column, &entry) in self.rows.iter().flat_map(|&row| &self.system.rows[row]) {
            *in_column.entry(column).or_default() += 1;
            let size = self.pool.as_number(entry).map_or(0.0, f64::abs);
            largest.entry(column).and_modify(|known| *known = known.max(size)).or_insert(size);
        }
        let mut candidates = Vec::new();
        for &row in &self.rows {
            let others = self.system.rows[row].len().saturating_sub(1);
            for (&column, &pivot) in &self.system.rows[row] {
                if let Some(surety) = self.surety(pivot, largest[&column]) {
                    let is_open = surety == Surety::Open;
                    candidates.push((is_open, others * (in_column[&column] - 1), surety, row, column, pivot));
                }
            }
        }
        candidates.sort_unstable();
        let found = candidates.into_iter().find(|candidate| candidate.2 != Surety::Open || !self.vanishes(candidate.5));
        found.map(|(_, _, surety, row, column, pivot)| (surety, Step { row, column, pivot }))
    }

    /// What is known of an entry as a pivot; none where it is a number that is too small beside the column's largest.
    fn surety(&self, entry: Id, largest: f64) -> Option<Surety> {
        match self.pool.as_number(entry) {
            Some(value) => (GROWTH * value.abs() >= largest && value.is_finite()).then_some(Surety::Number),
            None if (self.is_proved)(self.pool, entry) => Some(Surety::Proved),
            None => Some(Surety::Open),
        }
    }

    fn vanishes(&mut self, entry: Id) -> bool {
        let zero = self.pool.zero();
        same_polynomial(self.pool, entry, zero)
    }

    /// Takes the multiple of the pivot's row from another one that removes its entry in the pivot's column.
    fn eliminate(&mut self, row: usize, step: &Step) {
        let Some(entry) = self.system.rows[row].remove(&step.column) else { return };
        let factor = self.pool.div(entry, step.pivot);
        let others: Vec<(usize, Id)> = self.system.rows[step.row]
            .iter()
            .filter(|(column, _)| **column != step.column)
            .map(|(&c, &v)| (c, v))
            .collect();
        for (column, above) in others {
            let before = self.system.rows[row].remove(&column).unwrap_or(self.pool.zero());
            let after = self.less(before, factor, above);
            if !self.pool.is_zero(after) {
                self.system.rows[row].insert(column, after);
            }
        }
        self.system.right[row] = self.less(self.system.right[row], factor, self.system.right[step.row]);
    }

    /// `a - b c`; numbers that cancel give zero.
    fn less(&mut self, a: Id, b: Id, c: Id) -> Id {
        let product = self.pool.mul(b, c);
        if let (Some(a), Some(product)) = (self.pool.as_number(a), self.pool.as_number(product))
            && (a - product).abs() <= ROUNDING * a.abs()
        {
            return self.pool.zero();
        }
        self.pool.sub(a, product)
    }

    fn solution(self) -> Solution {
        let mut values = vec![self.pool.zero(); self.steps.len()];
        for step in self.steps.iter().rev() {
            let others = self.system.rows[step.row].iter().filter(|(column, _)| **column != step.column);
            let known: Vec<Id> = others.map(|(&column, &entry)| self.pool.mul(entry, values[column])).collect();
            let known = self.pool.sum(&known);
            let rest = self.pool.sub(self.system.right[step.row], known);
            values[step.column] = self.pool.div(rest, step.pivot);
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
