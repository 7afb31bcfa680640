//! The factors of I - c J.
//!
//! In: a flow and its Jacobian. Out: factors made by the flow's own elimination where it has one and no pivot is too small,
//! else by the dense one.

use alloc::vec::Vec;

use crate::solve::integrator::Arch;

use super::Jacobian;
use super::dense::Dense;
use crate::model::capability::Elimination;
use crate::model::linear::{Field, Sparsity};
use crate::solve::integrator::Flow;
use crate::solve::integrator::vectors::{eliminate_in, substitute_in};

/// Factors of I - c J.
#[derive(Clone, Debug)]
pub(in crate::solve::integrator) struct Factors<F, const N: usize> {
    sparse: Vec<F>,
    dense: Option<Dense<F, N>>,
    is_dense: bool,
}

impl<F: Field<f64>, const N: usize> Factors<F, N> {
    /// Nothing yet; room is made at the first factorisation, for the dense one when it is first needed.
    pub fn new() -> Self {
        Self { sparse: Vec::new(), dense: None, is_dense: false }
    }

    /// Factors I - `c` J in the vectors `arch`. Gives whether the matrix is regular.
    pub fn factor(&mut self, arch: Arch, flow: &impl Flow<N>, c: F, jacobian: &Jacobian<N>) -> bool {
        let elimination = flow.elimination().filter(|_| !jacobian.is_replaced);
        self.is_dense = !elimination.is_some_and(|elimination| self.eliminate(arch, elimination, c, jacobian));
        flow.count_factorisation(self.is_dense && elimination.is_some());
        if !self.is_dense {
            return true;
        }
        let dense = self.dense.get_or_insert_with(Dense::new);
        dense.factor(|rows| fill(rows, jacobian.sparsity(flow), c, &jacobian.entries))
    }

    /// Factors I - `c` J along the planned order. Gives whether no pivot is too small.
    fn eliminate(&mut self, arch: Arch, elimination: &impl Elimination<f64, N>, c: F, jacobian: &Jacobian<N>) -> bool {
        self.sparse.resize(elimination.factors(), F::real(0.0));
        eliminate_in(arch, elimination, c, &jacobian.entries, &mut self.sparse)
    }

    /// Replaces `b` by the solution y of (I - c J) y = b, in the vectors `arch`. To be called after [`Factors::factor`].
    pub fn solve(&self, arch: Arch, flow: &impl Flow<N>, b: &mut [F; N]) {
        if let Some(dense) = self.dense.as_ref().filter(|_| self.is_dense) {
            dense.solve(b);
        } else if let Some(elimination) = flow.elimination() {
            substitute_in(arch, elimination, &self.sparse, b);
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
        Sparsity::Places(places) => {
            for ((i, j), entry) in places.iter().zip(entries) {
                rows[usize::from(*i)][usize::from(*j)] = -c.scaled(*entry);
            }
        }
        Sparsity::Bordered { .. } => {
            let matrix = sparsity.matrix(N, entries);
            for (j, column) in matrix.column_iter().enumerate() {
                column.iter().enumerate().for_each(|(i, entry)| rows[i][j] = -c.scaled(*entry));
            }
        }
    }
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = row[i] + F::real(1.0);
    }
}
