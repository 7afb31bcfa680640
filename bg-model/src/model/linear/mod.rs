//! What the Jacobian of a system and its elimination are made of.
//!
//! In: nothing. Out: the pattern of a Jacobian, the numbers an elimination calculates with, the pivots of a generated one. A
//! generated model eliminates along the known pattern, in an order chosen at compile time and without a search for pivots.

mod differences;
mod field;
pub(crate) mod pivot;
pub(crate) mod table;

pub(crate) use differences::differences;
pub use field::Field;
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
}

impl Sparsity {
    /// The number of entries of an `n` by `n` Jacobian.
    #[must_use]
    pub const fn len(&self, n: usize) -> usize {
        match self {
            Self::Full => n * n,
            Self::Places(entries) => entries.len(),
        }
    }

    /// Row and column of entry `k` of an `n` by `n` Jacobian.
    pub(crate) fn place(&self, k: usize, n: usize) -> (usize, usize) {
        match self {
            Self::Full => (k % n, k / n),
            Self::Places(entries) => (usize::from(entries[k].0), usize::from(entries[k].1)),
        }
    }
}

/// A pivot below this part of the largest value that its place has had during the elimination, 1 included, counts as too
/// small: rounding leaves fewer than half of its digits. The measure does not depend on the units of the states.
pub const SMALLEST_PIVOT: f64 = 1e-8;
