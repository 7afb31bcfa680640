//! Symmetric definite systems in symbols.
//!
//! In: the lower triangle of A. Out: its factors L D L^T, and solutions of A y = r as part of the flat code.
//! Method: without pivots, in the order of the rows (Golub and Van Loan, Matrix Computations, algorithm 4.1.2). What is
//! identically zero costs nothing, so a band stays a band.

use crate::expr::{Id, Pool};

/// A = L D L^T.
#[derive(Clone, Debug, Default)]
pub struct Factors {
    /// The rows of L left of the diagonal, which is 1.
    pub lower: Vec<Vec<Id>>,
    /// 1 / D.
    pub inverses: Vec<Id>,
}

impl Factors {
    /// The factors of the lower triangle `matrix`, given by rows; `inverse` makes 1 / D_i of row, D_i and A_ii.
    pub fn of(pool: &mut Pool, matrix: &[Vec<Id>], inverse: impl Fn(&mut Pool, usize, Id, Id) -> Id) -> Self {
        let mut factors = Self::default();
        for (i, row) in matrix.iter().enumerate() {
            let mut row = row.clone();
            // The row's entries are L_ij D_j until all of them are known.
            for (j, above) in factors.lower.iter().enumerate() {
                let known: Vec<Id> = (0..j).map(|k| pool.mul(row[k], above[k])).collect();
                let known = pool.sum(&known);
                row[j] = pool.sub(row[j], known);
            }
            let entry = row.pop().expect("a row ends on the diagonal");
            let mut squares = Vec::with_capacity(i);
            for (part, &inverse) in row.iter_mut().zip(&factors.inverses) {
                let scaled = *part;
                *part = pool.mul(scaled, inverse);
                squares.push(pool.mul(scaled, *part));
            }
            let squares = pool.sum(&squares);
            let pivot = pool.sub(entry, squares);
            factors.inverses.push(inverse(pool, i, pivot, entry));
            factors.lower.push(row);
        }
        factors
    }

    /// y of A y = `right`.
    pub fn solve(&self, pool: &mut Pool, right: &[Id]) -> Vec<Id> {
        let n = self.lower.len();
        let mut solution: Vec<Id> = Vec::with_capacity(n);
        for (row, &right) in self.lower.iter().zip(right) {
            let known: Vec<Id> = row.iter().zip(&solution).map(|(&entry, &value)| pool.mul(entry, value)).collect();
            let known = pool.sum(&known);
            solution.push(pool.sub(right, known));
        }
        for (value, &inverse) in solution.iter_mut().zip(&self.inverses) {
            *value = pool.mul(*value, inverse);
        }
        for i in (0..n).rev() {
            let known: Vec<Id> = (i + 1..n).map(|k| pool.mul(self.lower[k][i], solution[k])).collect();
            let known = pool.sum(&known);
            solution[i] = pool.sub(solution[i], known);
        }
        solution
    }

    /// Every expression.
    pub fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        self.lower.iter_mut().flatten().chain(&mut self.inverses)
    }

    /// Forgets the rows that are not kept; none that is kept has a part of them.
    pub fn retain(&mut self, kept: &[bool]) {
        filter(&mut self.lower, kept);
        self.lower.iter_mut().for_each(|row| filter(row, kept));
        filter(&mut self.inverses, kept);
    }
}

/// The items whose place is kept; there may be fewer items than places.
pub fn filter<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    items.retain(|_| *kept.next().expect("a mark for each"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Symbol, evaluate};

    #[test]
    fn a_definite_system_is_solved() {
        let mut pool = Pool::new();
        let symbols: Vec<Id> = (0..6).map(|k| pool.symbol(Symbol::State(k))).collect();
        let matrix = vec![vec![symbols[0]], vec![symbols[1], symbols[2]], vec![symbols[3], symbols[4], symbols[5]]];
        let right = [1.0, -2.0, 3.0].map(|value| pool.number(value));
        let factors = Factors::of(&mut pool, &matrix, |pool, _, pivot, _| pool.powi(pivot, -1));
        let solution = factors.solve(&mut pool, &right);
        let states = [4.0, 1.0, 5.0, -1.0, 2.0, 6.0];
        let y = evaluate(&pool, &solution, &Environment { states: &states, ..Environment::default() });
        let rows = [[4.0, 1.0, -1.0], [1.0, 5.0, 2.0], [-1.0, 2.0, 6.0]];
        for (row, right) in rows.iter().zip([1.0, -2.0, 3.0]) {
            let product: f64 = row.iter().zip(&y).map(|(a, y)| a * y).sum();
            assert!((product - right).abs() < 1e-14, "{y:?}");
        }
    }
}
