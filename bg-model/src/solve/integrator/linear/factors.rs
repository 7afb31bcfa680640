//! The factors of I - c J.
//!
//! In: a flow and its Jacobian. Out: factors made by the flow's own elimination where it has one and no pivot is too small,
//! else by the dense one.

use alloc::vec::Vec;

use nalgebra::Complex;
use pulp::NullaryFnOnce;

use super::Jacobian;
use super::dense::Dense;
use crate::model::linear::{Field, Sparsity};
use crate::solve::integrator::{Arch, Flow};

/// A number of factors: real or complex. What is done along a flow's own elimination is compiled for the vectors of the machine.
pub(in crate::solve::integrator) trait Number: Field<f64> {
    /// See [`Flow::eliminate`].
    fn eliminate(flow: &(impl Flow + ?Sized), c: Self, entries: &[f64], factors: &mut [Self]) -> bool;

    /// See [`Flow::substitute`].
    fn substitute(flow: &(impl Flow + ?Sized), factors: &[Self], b: &mut [Self]);
}

impl Number for f64 {
    #[inline(always)]
    fn eliminate(flow: &(impl Flow + ?Sized), c: Self, entries: &[f64], factors: &mut [Self]) -> bool {
        flow.eliminate(c, entries, factors)
    }

    #[inline(always)]
    fn substitute(flow: &(impl Flow + ?Sized), factors: &[Self], b: &mut [Self]) {
        flow.substitute(factors, b);
    }
}

impl Number for Complex<f64> {
    #[inline(always)]
    fn eliminate(flow: &(impl Flow + ?Sized), c: Self, entries: &[f64], factors: &mut [Self]) -> bool {
        flow.eliminate_complex(c, entries, factors)
    }

    #[inline(always)]
    fn substitute(flow: &(impl Flow + ?Sized), factors: &[Self], b: &mut [Self]) {
        flow.substitute_complex(factors, b);
    }
}

struct Eliminate<'a, F: ?Sized, T> {
    flow: &'a F,
    c: T,
    entries: &'a [f64],
    factors: &'a mut [T],
}

impl<F: Flow + ?Sized, T: Number> NullaryFnOnce for Eliminate<'_, F, T> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { flow, c, entries, factors } = self;
        T::eliminate(flow, c, entries, factors)
    }
}

struct Substitute<'a, F: ?Sized, T> {
    flow: &'a F,
    factors: &'a [T],
    b: &'a mut [T],
}

impl<F: Flow + ?Sized, T: Number> NullaryFnOnce for Substitute<'_, F, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { flow, factors, b } = self;
        T::substitute(flow, factors, b);
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

    /// Factors I - `c` J in the vectors `arch`. Gives whether the matrix is regular.
    pub fn factor(&mut self, arch: Arch, flow: &(impl Flow + ?Sized), c: T, jacobian: &Jacobian) -> bool {
        let factors = flow.factors().filter(|_| !jacobian.is_replaced);
        self.is_dense = !factors.is_some_and(|factors| self.eliminate(arch, flow, factors, c, &jacobian.entries));
        flow.count_factorisation(self.is_dense && factors.is_some());
        if !self.is_dense {
            return true;
        }
        let n = flow.states();
        let dense = self.dense.get_or_insert_with(|| Dense::new(n));
        dense.factor(|matrix| fill(matrix, n, jacobian.sparsity(flow), c, &jacobian.entries))
    }

    /// Factors I - `c` J along the planned order. Gives whether no pivot is too small.
    #[inline(never)]
    fn eliminate(&mut self, arch: Arch, flow: &(impl Flow + ?Sized), factors: usize, c: T, entries: &[f64]) -> bool {
        self.sparse.resize(factors, T::real(0.0));
        arch.dispatch(Eliminate { flow, c, entries, factors: &mut self.sparse })
    }

    /// Replaces `b` by the solution y of (I - c J) y = b, in the vectors `arch`. To be called after [`Factors::factor`].
    pub fn solve(&self, arch: Arch, flow: &(impl Flow + ?Sized), b: &mut [T]) {
        if let Some(dense) = self.dense.as_ref().filter(|_| self.is_dense) {
            dense.solve(b);
        } else {
            self.substitute(arch, flow, b);
        }
    }

    #[inline(never)]
    fn substitute(&self, arch: Arch, flow: &(impl Flow + ?Sized), b: &mut [T]) {
        arch.dispatch(Substitute { flow, factors: &self.sparse, b });
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
