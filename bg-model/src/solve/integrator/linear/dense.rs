//! Dense elimination with row exchanges.
//!
//! In: a matrix, row by row. Out: its factors L U with the exchanges, and solutions. Source: Golub, Van Loan, Matrix
//! Computations, 4th edition, algorithm 3.4.1.

use alloc::boxed::Box;
use alloc::vec;

use crate::model::linear::Field;

/// Factors of a matrix of `N` rows.
#[derive(Clone, Debug)]
pub(super) struct Dense<F, const N: usize> {
    /// Row by row; L below the diagonal without its ones, U from the diagonal on, the reciprocals of its pivots in it.
    rows: Box<[[F; N]]>,
    /// The row that came to each place.
    exchanges: [usize; N],
}

impl<F: Field<f64>, const N: usize> Dense<F, N> {
    /// Room for the factors.
    pub fn new() -> Self {
        Self { rows: vec![[F::real(0.0); N]; N].into_boxed_slice(), exchanges: [0; N] }
    }

    /// Factors the matrix that `fill` writes into rows of zeros. Gives whether it is regular.
    pub fn factor(&mut self, fill: impl FnOnce(&mut [[F; N]])) -> bool {
        self.rows.fill([F::real(0.0); N]);
        fill(&mut self.rows);
        for k in 0..N {
            let mut best = k;
            for i in k + 1..N {
                if self.rows[i][k].size() > self.rows[best][k].size() {
                    best = i;
                }
            }
            self.exchanges[k] = best;
            self.rows.swap(k, best);
            let size = self.rows[k][k].size();
            if !(size > 0.0 && size.is_finite()) {
                return false;
            }
            let (upper, lower) = self.rows.split_at_mut(k + 1);
            let pivot = &mut upper[k];
            pivot[k] = F::real(1.0) / pivot[k];
            // The square of a large complex pivot overflows.
            if pivot[k].size() == 0.0 {
                return false;
            }
            for row in lower {
                let factor = row[k] * pivot[k];
                row[k] = factor;
                if factor.size() > 0.0 {
                    for j in k + 1..N {
                        row[j] = row[j] - factor * pivot[j];
                    }
                }
            }
        }
        true
    }

    /// Replaces `b` by the solution.
    pub fn solve(&self, b: &mut [F; N]) {
        for k in 0..N {
            b.swap(k, self.exchanges[k]);
        }
        for i in 1..N {
            let row = &self.rows[i];
            for j in 0..i {
                b[i] = b[i] - row[j] * b[j];
            }
        }
        for i in (0..N).rev() {
            let row = &self.rows[i];
            for j in i + 1..N {
                b[i] = b[i] - row[j] * b[j];
            }
            b[i] = b[i] * row[i];
        }
    }
}
