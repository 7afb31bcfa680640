//! Dense elimination with row exchanges.
//!
//! In: a matrix, row by row. Out: its factors L U with the exchanges, and solutions. Source: Golub, Van Loan, Matrix
//! Computations, 4th edition, algorithm 3.4.1.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::linear::Field;

/// Factors of a matrix.
#[derive(Clone, Debug)]
pub(super) struct Dense<F> {
    /// Row by row; L below the diagonal without its ones, U from the diagonal on, the reciprocals of its pivots in it.
    entries: Vec<F>,
    /// The row that came to each place.
    exchanges: Vec<usize>,
}

impl<F: Field<f64>> Dense<F> {
    /// Room for the factors of a matrix of `n` rows.
    pub fn new(n: usize) -> Self {
        Self { entries: vec![F::real(0.0); n * n], exchanges: vec![0; n] }
    }

    /// Factors the matrix that `fill` writes into zeros, row by row. Gives whether it is regular.
    pub fn factor(&mut self, fill: impl FnOnce(&mut [F])) -> bool {
        self.entries.fill(F::real(0.0));
        fill(&mut self.entries);
        let n = self.exchanges.len();
        for k in 0..n {
            let mut best = k;
            for i in k + 1..n {
                if self.entries[i * n + k].size() > self.entries[best * n + k].size() {
                    best = i;
                }
            }
            self.exchange(k, best);
            let size = self.entries[k * n + k].size();
            if !(size > 0.0 && size.is_finite()) {
                return false;
            }
            let (upper, lower) = self.entries.split_at_mut((k + 1) * n);
            let pivot = &mut upper[k * n..];
            pivot[k] = F::real(1.0) / pivot[k];
            // The square of a large complex pivot overflows.
            if pivot[k].size() == 0.0 {
                return false;
            }
            for row in lower.chunks_exact_mut(n) {
                let factor = row[k] * pivot[k];
                row[k] = factor;
                if factor.size() > 0.0 {
                    for (entry, pivot) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                        *entry = *entry - factor * *pivot;
                    }
                }
            }
        }
        true
    }

    /// Exchanges row `k` for a later one, or for itself.
    fn exchange(&mut self, k: usize, other: usize) {
        self.exchanges[k] = other;
        let n = self.exchanges.len();
        if other > k {
            let (upper, lower) = self.entries.split_at_mut(other * n);
            upper[k * n..][..n].swap_with_slice(&mut lower[..n]);
        }
    }

    /// Replaces `b` by the solution.
    pub fn solve(&self, b: &mut [F]) {
        for (k, &other) in self.exchanges.iter().enumerate() {
            b.swap(k, other);
        }
        let n = self.exchanges.len();
        let row = |i: usize| &self.entries[i * n..][..n];
        for i in 1..n {
            for (j, factor) in row(i)[..i].iter().enumerate() {
                b[i] = b[i] - *factor * b[j];
            }
        }
        for i in (0..n).rev() {
            let row = row(i);
            for j in i + 1..n {
                b[i] = b[i] - row[j] * b[j];
            }
            b[i] = b[i] * row[i];
        }
    }
}
