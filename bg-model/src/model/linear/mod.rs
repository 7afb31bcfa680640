//! What the Jacobian of a system and its elimination are made of.
//!
//! In: nothing. Out: the pattern of a Jacobian, the numbers an elimination calculates with, the pivots of a generated
//! one. A generated model eliminates along the known pattern, in an order chosen at compile time and without a search
//! for pivots.

mod differences;
mod field;
pub(crate) mod pivot;
pub mod table;

pub(crate) use differences::differences;
pub use field::Field;
use nalgebra::DMatrix;
pub(crate) use pivot::Pivot;

/// Where a Jacobian can differ from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sparsity {
    /// Everywhere; the entries are stored column by column.
    Full,
    /// At these places only.
    ///
    /// Row and column of every entry, in the order of storage.
    Places(&'static [(u16, u16)]),
    /// At these places only, with unknowns l beside the states that equations r(x, l) = 0 give: df/dx is
    /// f_x - f_l (r_l)^-1 r_x of the rates f(x, l).
    Bordered {
        /// Row and column of every entry, in the order of storage: those of the unknowns and their equations are after
        /// those of the states.
        places: &'static [(u16, u16)],
        /// How many unknowns there are.
        unknowns: usize,
    },
}

impl Sparsity {
    /// The number of entries of an `n` by `n` Jacobian.
    #[must_use]
    pub const fn len(&self, n: usize) -> usize {
        match self {
            Self::Full => n * n,
            Self::Places(places) | Self::Bordered { places, .. } => places.len(),
        }
    }

    /// Row and column of entry `k` of an `n` by `n` Jacobian.
    pub(crate) fn place(&self, k: usize, n: usize) -> (usize, usize) {
        match self {
            Self::Full => (k % n, k / n),
            Self::Places(places) | Self::Bordered { places, .. } => {
                (usize::from(places[k].0), usize::from(places[k].1))
            }
        }
    }

    /// The `n` by `n` matrix df/dx of these entries; where the unknowns are not determined, numbers that are not
    /// finite.
    #[must_use]
    pub fn matrix(&self, n: usize, entries: &[f64]) -> DMatrix<f64> {
        let unknowns = if let Self::Bordered { unknowns, .. } = self { *unknowns } else { 0 };
        let mut whole = DMatrix::zeros(n + unknowns, n + unknowns);
        for (k, &entry) in entries.iter().enumerate() {
            whole[self.place(k, n)] = entry;
        }
        let states = whole.view((0, 0), (n, n)).into_owned();
        if unknowns == 0 {
            return states;
        }
        let by_states = whole.view((n, 0), (unknowns, n)).into_owned();
        let by_unknowns = whole.view((n, n), (unknowns, unknowns)).into_owned();
        match by_unknowns.lu().solve(&by_states) {
            Some(change) => states - whole.view((0, n), (n, unknowns)) * change,
            None => states * f64::NAN,
        }
    }
}

/// A pivot below this part of the largest value that its place has had during the elimination, 1 included, counts as
/// too small: rounding leaves fewer than half of its digits. The measure does not depend on the units of the states.
pub const SMALLEST_PIVOT: f64 = 1e-8;
