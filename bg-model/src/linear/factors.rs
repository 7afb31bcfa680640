//! The factors of I - c J.
//!
//! In: a flow and its Jacobian. Out: factors made by the flow's own elimination where it has one and no pivot is too small,
//! else by the dense one.

use super::dense::Dense;
use super::{Field, Jacobian, Sparsity};
use crate::integrator::Flow;

/// Factors of I - c J.
#[derive(Clone, Debug)]
pub(crate) struct Factors<F, const N: usize> {
    sparse: Vec<F>,
    dense: Option<Dense<F, N>>,
    is_dense: bool,
}

impl<F: Field<f64>, const N: usize> Factors<F, N> {
    /// Nothing yet; room is made at the first factorisation, for the dense one when it is first needed.
    pub fn new() -> Self {
        Self { sparse: Vec::new(), dense: None, is_dense: false }
    }

    /// Factors I - `c` J. Gives whether the matrix is regular.
    pub fn factor(&mut self, flow: &mut impl Flow<N>, c: F, jacobian: &Jacobian<N>) -> bool {
        let sparsity = flow.sparsity();
        if let Sparsity::Places { factors, .. } = sparsity {
            self.sparse.resize(factors, F::real(0.0));
            if flow.eliminate(c, &jacobian.entries, &mut self.sparse) {
                self.is_dense = false;
                flow.count_factorisation(false);
                return true;
            }
        }
        self.is_dense = true;
        flow.count_factorisation(matches!(sparsity, Sparsity::Places { .. }));
        self.dense.get_or_insert_with(Dense::new).factor(|rows| fill(rows, sparsity, c, &jacobian.entries))
    }

    /// Replaces `b` by the solution y of (I - c J) y = b.
    pub fn solve(&self, flow: &mut impl Flow<N>, b: &mut [F; N]) {
        match &self.dense {
            Some(dense) if self.is_dense => dense.solve(b),
            _ => flow.substitute(&self.sparse, b),
        }
    }
}

/// Writes I - c J into rows of zeros.
fn fill<F: Field<f64>, const N: usize>(rows: &mut [[F; N]], sparsity: Sparsity, c: F, entries: &[f64]) {
    match sparsity {
        Sparsity::Full => {
            for (j, column) in entries.chunks_exact(N.max(1)).enumerate() {
                for (i, entry) in column.iter().enumerate() {
                    rows[i][j] = -c.scaled(*entry);
                }
            }
        }
        Sparsity::Places { entries: places, .. } => {
            for ((i, j), entry) in places.iter().zip(entries) {
                rows[usize::from(*i)][usize::from(*j)] = -c.scaled(*entry);
            }
        }
    }
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = row[i] + F::real(1.0);
    }
}
