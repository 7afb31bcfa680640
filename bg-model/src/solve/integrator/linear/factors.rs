//! The factors of I - c J.
//!
//! In: a flow and its Jacobian. Out: factors made by the flow's own elimination where it has one and no pivot is too
//! small, else by the dense one.

use alloc::vec::Vec;

use nalgebra::Complex;

use super::Jacobian;
use super::dense::Dense;
use crate::model::linear::{Field, Sparsity};
use crate::solve::integrator::Flow;

/// A number of factors: real or complex.
pub(in crate::solve::integrator) trait Number: Field<f64> {
    /// See [`Flow::eliminate`].
    fn eliminate(flow: &Flow<'_>, c: Self, entries: &[f64], factors: &mut [Self]) -> bool;

    /// See [`Flow::substitute`].
    fn substitute(flow: &Flow<'_>, factors: &[Self], b: &mut [Self]);
}

impl Number for f64 {
    fn eliminate(flow: &Flow<'_>, c: Self, entries: &[f64], factors: &mut [Self]) -> bool {
        flow.eliminate(c, entries, factors)
    }

    fn substitute(flow: &Flow<'_>, factors: &[Self], b: &mut [Self]) {
        flow.substitute(factors, b);
    }
}

impl Number for Complex<f64> {
    fn eliminate(flow: &Flow<'_>, c: Self, entries: &[f64], factors: &mut [Self]) -> bool {
        flow.eliminate_complex(c, entries, factors)
    }

    fn substitute(flow: &Flow<'_>, factors: &[Self], b: &mut [Self]) {
        flow.substitute_complex(factors, b);
    }
}

/// Factors of I - c J.
#[derive(Clone, Debug)]
pub(in crate::solve::integrator) struct Factors<T> {
    sparse: Vec<T>,
    dense: Option<Dense<T>>,
    is_dense: bool,
}

impl<T: Number> Factors<T> {
    /// Nothing yet; room is made at the first factorisation, for the dense one when it is first needed.
    pub fn new() -> Self {
        Self { sparse: Vec::new(), dense: None, is_dense: false }
    }

    /// Factors I - `c` J. Gives whether the matrix is regular.
    pub fn factor(&mut self, flow: &Flow<'_>, c: T, jacobian: &Jacobian) -> bool {
        let factors = flow.factors().filter(|_| !jacobian.is_replaced);
        self.is_dense = !factors.is_some_and(|factors| {
            self.sparse.resize(factors, T::real(0.0));
            T::eliminate(flow, c, &jacobian.entries, &mut self.sparse)
        });
        flow.count_factorisation(self.is_dense && factors.is_some());
        if !self.is_dense {
            return true;
        }
        let n = flow.states();
        let dense = self.dense.get_or_insert_with(|| Dense::new(n));
        dense.factor(|matrix| fill(matrix, n, jacobian.sparsity(flow), c, &jacobian.entries))
    }

    /// Replaces `b` by the solution y of (I - c J) y = b. To be called after [`Factors::factor`].
    pub fn solve(&self, flow: &Flow<'_>, b: &mut [T]) {
        match self.dense.as_ref().filter(|_| self.is_dense) {
            Some(dense) => dense.solve(b),
            None => T::substitute(flow, &self.sparse, b),
        }
    }
}

/// Writes I - c J into a matrix of `n` rows of zeros, row by row.
fn fill<T: Number>(matrix: &mut [T], n: usize, sparsity: Sparsity, c: T, entries: &[f64]) {
    match sparsity {
        Sparsity::Full => {
            for (j, column) in entries.chunks_exact(n.max(1)).enumerate() {
                for (i, entry) in column.iter().enumerate() {
                    matrix[i * n + j] = -c.scaled(*entry);
                }
            }
        }
        Sparsity::Places(places) => {
            for ((i, j), entry) in places.iter().zip(entries) {
                matrix[usize::from(*i) * n + usize::from(*j)] = -c.scaled(*entry);
            }
        }
        Sparsity::Bordered { .. } => {
            let states = sparsity.matrix(n, entries);
            for (j, column) in states.column_iter().enumerate() {
                column.iter().enumerate().for_each(|(i, entry)| matrix[i * n + j] = -c.scaled(*entry));
            }
        }
    }
    for i in 0..n {
        matrix[i * n + i] = matrix[i * n + i] + T::real(1.0);
    }
}
