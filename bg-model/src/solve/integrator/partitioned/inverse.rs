//! The inverse of a small matrix, in groups of numbers side by side.
//!
//! In: a matrix B and a number. Out: the inverse of I - number B, and products with it. Nothing here depends on a
//! system, so it is compiled once, for the vectors of every machine and for those of this one.

use alloc::vec::Vec;

use pulp::NullaryFnOnce;

use super::places::{LANES, Lanes, Places};
use crate::solve::integrator::Arch;

/// The part of the largest entry of its column from which on an entry on the diagonal serves as pivot.
const PIVOT: f64 = 0.1;

/// Takes the groups of a block and the blocks of a column as constants where a column has one block, so that loops over
/// them are written out.
macro_rules! in_blocks {
    ($groups:expr, $block:ident, $blocks:ident => $then:expr) => {
        match $groups {
            1 => {
                const $block: usize = 1;
                let $blocks = 1;
                $then
            }
            2 => {
                const $block: usize = 2;
                let $blocks = 1;
                $then
            }
            3 => {
                const $block: usize = 3;
                let $blocks = 1;
                $then
            }
            4 => {
                const $block: usize = 4;
                let $blocks = 1;
                $then
            }
            groups => {
                const $block: usize = 4;
                let $blocks = groups / 4;
                $then
            }
        }
    };
}

pub(super) use in_blocks;

/// The inverse, column by column; after each column are zeros up to whole groups.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    pub arch: Arch,
    pub columns: Vec<Lanes>,
    /// One, stored like the inverse.
    one: Vec<Lanes>,
    exchanges: Vec<usize>,
    pivot: Vec<Lanes>,
}

impl Inverse {
    /// Nothing yet, calculated in these vectors.
    pub fn new(arch: Arch) -> Self {
        Self { arch, columns: Vec::new(), one: Vec::new(), exchanges: Vec::new(), pivot: Vec::new() }
    }

    /// Makes room for the block at these places.
    pub fn resize(&mut self, places: &Places) {
        for matrix in [&mut self.columns, &mut self.one] {
            matrix.clear();
            matrix.resize(places.entries(), Lanes::default());
        }
        for k in 0..places.states.len() {
            self.one.as_flattened_mut()[k * (places.groups.len() * LANES + 1)] = 1.0;
        }
        self.exchanges.resize(places.states.len(), 0);
        self.pivot.resize(places.groups.len(), Lanes::default());
    }

    /// Inverts I - `factor` B, with `matrix` + `ahead` `slope` for B, which are stored as this one is. Gives whether it
    /// is regular.
    pub fn invert(&mut self, matrix: &[Lanes], slope: &[Lanes], ahead: f64, factor: f64) -> bool {
        let Self { arch, columns, one, exchanges, pivot } = self;
        arch.dispatch(Invert { matrix, slope, ahead, factor, columns, one, exchanges, pivot })
    }
}

struct Invert<'a> {
    matrix: &'a [Lanes],
    slope: &'a [Lanes],
    ahead: f64,
    factor: f64,
    columns: &'a mut [Lanes],
    one: &'a [Lanes],
    exchanges: &'a mut [usize],
    pivot: &'a mut [Lanes],
}

impl NullaryFnOnce for Invert<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { matrix, slope, ahead, factor, columns, one, exchanges, pivot } = self;
        for (((to, one), matrix), slope) in columns.iter_mut().zip(one).zip(matrix).zip(slope) {
            *to = core::array::from_fn(|lane| one[lane] - factor * (matrix[lane] + ahead * slope[lane]));
        }
        exchanges.is_empty()
            || in_blocks!(pivot.len(), G, blocks => {
                invert::<G>(blocks, columns.as_chunks_mut().0, one.as_chunks().0, exchanges, pivot.as_chunks_mut().0)
            })
    }
}

/// Inverts in place, by elimination with exchanges where an entry on the diagonal is small; `pivot` is work space for a
/// column. Gives whether the matrix is regular.
///
/// Columns take the part of rows: the inverse of the transpose is the transpose of the inverse.
#[inline(always)]
fn invert<const G: usize>(
    blocks: usize,
    columns: &mut [[Lanes; G]],
    one: &[[Lanes; G]],
    exchanges: &mut [usize],
    pivot: &mut [[Lanes; G]],
) -> bool {
    let (n, pivot) = (exchanges.len(), &mut pivot[..blocks]);
    let columns = &mut columns[..n * blocks];
    for k in 0..n {
        let (before, from) = columns.split_at_mut(k * blocks);
        exchanges[k] = exchange(blocks, from, k);
        let (own, behind) = from.split_at_mut(blocks);
        let reciprocal = -1.0 / *entry(own, k);
        if !reciprocal.is_finite() {
            return false;
        }
        let one = &one[k * blocks..][..blocks];
        for ((pivot, own), one) in pivot.iter_mut().zip(own).zip(one) {
            for ((pivot, own), one) in pivot.iter_mut().zip(own).zip(one) {
                // Of row k, to which the product is added, that is to be all that is left.
                *pivot = core::array::from_fn(|lane| (own[lane] + one[lane]) * reciprocal);
                *own = core::array::from_fn(|lane| -(pivot[lane] + one[lane]));
            }
        }
        // First what the next pivot is in.
        for columns in [behind, before] {
            for column in columns.chunks_exact_mut(blocks) {
                eliminate(column, pivot, k);
            }
        }
    }
    for (k, &other) in exchanges.iter().enumerate().rev().filter(|(k, other)| *k != **other) {
        for column in columns.chunks_exact_mut(blocks) {
            let swapped = core::mem::take(entry(column, k));
            *entry(column, k) = core::mem::replace(entry(column, other), swapped);
        }
    }
    true
}

/// Exchanges the first of these columns, where its entry in row `k`, the number of the first one, is small, for the one
/// with the largest entry there; gives that one's number.
#[inline(always)]
fn exchange<const G: usize>(blocks: usize, columns: &mut [[Lanes; G]], k: usize) -> usize {
    let own = entry(&mut columns[..blocks], k).abs();
    if own >= PIVOT * largest(&columns[..blocks]) {
        return k;
    }
    let (mut best, mut most) = (0, own);
    for (number, column) in columns.chunks_exact_mut(blocks).enumerate() {
        let size = entry(column, k).abs();
        if size > most {
            (best, most) = (number, size);
        }
    }
    (0..blocks).for_each(|block| columns.swap(block, best * blocks + block));
    k + best
}

/// Adds its entry in row `k` times the pivot to a column.
#[inline(always)]
fn eliminate<const G: usize>(column: &mut [[Lanes; G]], pivot: &[[Lanes; G]], k: usize) {
    let factor = *entry(column, k);
    for (column, pivot) in column.iter_mut().zip(pivot) {
        for (column, pivot) in column.iter_mut().zip(pivot) {
            *column = core::array::from_fn(|lane| column[lane] + factor * pivot[lane]);
        }
    }
}

/// The largest magnitude in a column.
#[inline(always)]
fn largest<const G: usize>(column: &[[Lanes; G]]) -> f64 {
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut largest = Lanes::default();
    for group in column.as_flattened() {
        largest = core::array::from_fn(|lane| larger(group[lane].abs(), largest[lane]));
    }
    let [a, b, c, d] = largest;
    larger(larger(a, c), larger(b, d))
}

/// An entry of a column.
#[inline(always)]
fn entry<const G: usize>(column: &mut [[Lanes; G]], row: usize) -> &mut f64 {
    &mut column.as_flattened_mut().as_flattened_mut()[row]
}

/// The product of a matrix, stored as an inverse is, with `vector`, by a block of rows.
#[inline(always)]
pub(super) fn product<const G: usize>(blocks: usize, block: usize, columns: &[Lanes], vector: &[f64]) -> [Lanes; G] {
    let mut sums = [Lanes::default(); G];
    for (column, entry) in columns.as_chunks::<G>().0.chunks_exact(blocks).zip(vector) {
        for (sum, group) in sums.iter_mut().zip(&column[block]) {
            *sum = core::array::from_fn(|lane| sum[lane] + group[lane] * entry);
        }
    }
    sums
}

#[cfg(test)]
mod tests {

    use super::*;

    fn places(n: usize) -> Places {
        let mut places = Places::default();
        places.take(&(0..n).collect::<Vec<_>>());
        places
    }

    /// A matrix of `n` rows whose entry in each row and column `entry` gives.
    fn stored(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Lanes> {
        let groups = places(n).groups.len();
        let lanes = |k: usize| core::array::from_fn(|lane| (k % groups * LANES + lane, k / groups));
        let entry = |(row, column)| if row < n { entry(row, column) } else { 0.0 };
        (0..n * groups).map(|k| lanes(k).map(entry)).collect()
    }

    #[test]
    fn the_inverse_times_the_matrix_is_one_with_the_same_bytes_everywhere() {
        for n in 1..=21 {
            let matrix =
                stored(n, |row, column| ((7 * row + 5 * column) % 11) as f64 - 4.0 + (row * column) as f64 * 0.3);
            let slope = stored(n, |row, column| 0.1 * (row as f64 - column as f64));
            let groups = places(n).groups.len();
            let whole = stored(n, |row, column| {
                let [matrix, slope] = [&matrix, &slope].map(|of| of.as_flattened()[column * groups * LANES + row]);
                f64::from(row == column) - 0.7 * (matrix + 0.3 * slope)
            });
            let products = [Arch::Scalar, Arch::new()].map(|arch| {
                let mut inverse = Inverse::new(arch);
                inverse.resize(&places(n));
                assert!(inverse.invert(&matrix, &slope, 0.3, 0.7), "{n}");
                let mut products = vec![[0.0; LANES]; whole.len()];
                for (column, out) in whole.chunks_exact(groups).zip(products.chunks_exact_mut(groups)) {
                    in_blocks!(groups, G, blocks => {
                        for (block, out) in out.as_chunks_mut().0.iter_mut().enumerate() {
                            *out = product::<G>(blocks, block, &inverse.columns, column.as_flattened());
                        }
                    });
                }
                products
            });
            assert_eq!(products[0], products[1], "{n}");
            let one = stored(n, |row, column| f64::from(row == column));
            let off = products[0].as_flattened().iter().zip(one.as_flattened()).map(|(a, b)| (a - b).abs());
            assert!(off.clone().fold(0.0, f64::max) < 1e-9, "{n}: {:?}", off.fold(0.0, f64::max));
        }
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut inverse = Inverse::new(Arch::new());
        inverse.resize(&places(3));
        let one = stored(3, |row, column| f64::from(row == column));
        assert!(!inverse.invert(&one, &one, 0.0, 1.0));
    }
}
