//! The inverse of a symmetric definite matrix, in symbols.
//!
//! In: the lower triangle. Out: products with right sides as part of the flat code.
//! Method: up to three rows by cofactors, which takes one division, none of which waits for another; more by L D L^T.

use crate::expr::{Id, Pool};
use crate::system::equations::definite::Factors;

/// How a product with the inverse is calculated.
pub(super) enum Inverse {
    /// The cofactors by rows, and 1 over the determinant.
    Cofactors(Vec<Vec<Id>>, Id),
    Factors(Factors),
}

impl Inverse {
    /// Of the lower triangle `matrix`, given by rows.
    pub fn of(pool: &mut Pool, matrix: &[Vec<Id>]) -> Self {
        let entry = |i: usize, j: usize| matrix[i.max(j)][i.min(j)];
        let size = matrix.len();
        if size > 3 {
            return Self::Factors(Factors::of(pool, matrix, |pool, _, pivot, _| pool.powi(pivot, -1)));
        }
        let mut cofactor = |i: usize, j: usize| match size {
            1 => pool.one(),
            2 if i == j => entry(1 - i, 1 - i),
            2 => pool.neg(entry(1, 0)),
            _ => {
                let [a, b] = [(i + 1) % 3, (i + 2) % 3];
                let [c, d] = [(j + 1) % 3, (j + 2) % 3];
                let (first, second) = (pool.mul(entry(a, c), entry(b, d)), pool.mul(entry(a, d), entry(b, c)));
                pool.sub(first, second)
            }
        };
        let cofactors: Vec<Vec<Id>> = (0..size).map(|i| (0..size).map(|j| cofactor(i, j)).collect()).collect();
        let parts: Vec<Id> = (0..size).map(|j| pool.mul(entry(0, j), cofactors[0][j])).collect();
        let determinant = pool.sum(&parts);
        Self::Cofactors(cofactors, pool.powi(determinant, -1))
    }

    /// The inverse times `right` and a multiple of each of `columns`.
    pub fn times(&self, pool: &mut Pool, right: &[Id], columns: &[(Id, Vec<Id>)]) -> Vec<Id> {
        let mut solution = self.numerators(pool, right);
        for (by, column) in columns {
            let column = self.numerators(pool, column);
            for (value, part) in solution.iter_mut().zip(column) {
                let part = pool.mul(*by, part);
                *value = pool.add(*value, part);
            }
        }
        if let Self::Cofactors(_, inverse) = self {
            solution.iter_mut().for_each(|value| *value = pool.mul(*value, *inverse));
        }
        solution
    }

    /// The inverse times a column, with cofactors times the determinant.
    fn numerators(&self, pool: &mut Pool, column: &[Id]) -> Vec<Id> {
        let cofactors = match self {
            Self::Factors(factors) => return factors.solve(pool, column),
            Self::Cofactors(cofactors, _) => cofactors,
        };
        let row = |row: &Vec<Id>| {
            let parts: Vec<Id> = row.iter().zip(column).map(|(&a, &b)| pool.mul(a, b)).collect();
            pool.sum(&parts)
        };
        cofactors.iter().map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Symbol, evaluate};

    #[test]
    fn every_size_solves_its_equations() {
        for size in 1..=5 {
            let mut pool = Pool::new();
            let mut values = Vec::new();
            let mut symbol = |pool: &mut Pool, value: f64| {
                values.push(value);
                pool.symbol(Symbol::state(values.len() - 1))
            };
            let full = |i: usize, j: usize| if i == j { 4.0 + i as f64 } else { 1.0 / (1 + i + j) as f64 };
            let matrix: Vec<Vec<Id>> =
                (0..size).map(|i| (0..=i).map(|j| symbol(&mut pool, full(i, j))).collect()).collect();
            let mut column =
                |pool: &mut Pool, from: f64| (0..size).map(|k| symbol(pool, from + k as f64)).collect::<Vec<Id>>();
            let (right, more) = (column(&mut pool, -1.0), column(&mut pool, 2.5));
            let by = symbol(&mut pool, 0.3);
            let solution = Inverse::of(&mut pool, &matrix).times(&mut pool, &right, &[(by, more)]);
            let found = evaluate(&pool, &solution, &Environment { states: &values, ..Environment::default() });
            for i in 0..size {
                let product: f64 = (0..size).map(|j| full(i, j) * found[j]).sum();
                let expected = -1.0 + i as f64 + 0.3 * (2.5 + i as f64);
                assert!((product - expected).abs() < 1e-13, "{size}: {product} {expected}");
            }
        }
    }
}
