//! The inverse of a small matrix, in groups of numbers side by side.
//!
//! In: a matrix B and a number. Out: the inverse of I - number B, and products with it. Nothing here depends on a system, so it is
//! compiled once, for the vectors of every machine and for those of this one.

use alloc::vec::Vec;

use pulp::NullaryFnOnce;

use crate::solve::integrator::Arch;

/// Numbers of states side by side.
pub(super) const LANES: usize = 4;
pub(super) type Lanes = [f64; LANES];

/// The groups of a column of `n` rows: few of them, or blocks of four.
pub(super) fn groups(n: usize) -> usize {
    let groups = n.div_ceil(LANES);
    if groups > 4 { groups.next_multiple_of(4) } else { groups }
}

/// Takes the groups of a block and the blocks of a column as constants where a column has one block, so that loops over them are
/// written out.
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

/// The inverse, column by column; behind each column are zeros up to whole groups.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    pub arch: Arch,
    /// The groups of a column.
    groups: usize,
    pub columns: Vec<Lanes>,
    exchanges: Vec<usize>,
    pivot: Vec<Lanes>,
}

impl Inverse {
    /// Nothing yet, calculated in these vectors.
    pub fn new(arch: Arch) -> Self {
        Self { arch, groups: 0, columns: Vec::new(), exchanges: Vec::new(), pivot: Vec::new() }
    }

    /// Makes room for a matrix of `n` rows.
    pub fn resize(&mut self, n: usize) {
        self.groups = groups(n);
        self.columns.clear();
        self.columns.resize(n * self.groups, [0.0; LANES]);
        self.exchanges.resize(n, 0);
        self.pivot.resize(self.groups, [0.0; LANES]);
    }

    /// Inverts I - `factor` B, with `matrix` + `ahead` `slope` for B, which are stored as this one is. Gives whether it is regular.
    pub fn invert(&mut self, matrix: &[Lanes], slope: &[Lanes], ahead: f64, factor: f64) -> bool {
        let Self { arch, groups, columns, exchanges, pivot } = self;
        arch.dispatch(Invert { matrix, slope, ahead, factor, groups: *groups, columns, exchanges, pivot })
    }

    /// Writes the product with `vector`.
    pub fn times(&self, vector: &[Lanes], product: &mut [Lanes]) {
        self.arch.dispatch(Times { columns: &self.columns, vector, product });
    }
}

struct Invert<'a> {
    matrix: &'a [Lanes],
    slope: &'a [Lanes],
    ahead: f64,
    factor: f64,
    groups: usize,
    columns: &'a mut [Lanes],
    exchanges: &'a mut [usize],
    pivot: &'a mut [Lanes],
}

impl NullaryFnOnce for Invert<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { matrix, slope, ahead, factor, groups, columns, exchanges, pivot } = self;
        for ((to, matrix), slope) in columns.iter_mut().zip(matrix).zip(slope) {
            *to = core::array::from_fn(|lane| -factor * (matrix[lane] + ahead * slope[lane]));
        }
        exchanges.is_empty()
            || in_blocks!(groups, G, blocks => {
                invert::<G>(blocks, columns.as_chunks_mut().0, exchanges, pivot.as_chunks_mut().0)
            })
    }
}

/// Adds I and inverts in place, by elimination with exchanges; `pivot` is work space for a column. Gives whether the matrix is regular.
///
/// Columns take the part of rows: the inverse of the transpose is the transpose of the inverse.
#[inline(always)]
fn invert<const G: usize>(
    blocks: usize,
    columns: &mut [[Lanes; G]],
    exchanges: &mut [usize],
    pivot: &mut [[Lanes; G]],
) -> bool {
    let (n, pivot) = (exchanges.len(), &mut pivot[..blocks]);
    let columns = &mut columns[..n * blocks];
    for k in 0..n {
        *entry(blocks, columns, k, k) += 1.0;
    }
    for k in 0..n {
        let (mut best, mut largest) = (k, -1.0);
        for column in k..n {
            let size = entry(blocks, columns, column, k).abs();
            if size > largest {
                (best, largest) = (column, size);
            }
        }
        exchanges[k] = best;
        if best != k {
            (0..blocks).for_each(|block| columns.swap(k * blocks + block, best * blocks + block));
        }
        let reciprocal = -1.0 / core::mem::replace(entry(blocks, columns, k, k), 1.0);
        if !reciprocal.is_finite() {
            return false;
        }
        for (pivot, entries) in pivot.iter_mut().zip(&columns[k * blocks..][..blocks]) {
            *pivot = entries.map(|group| group.map(|entry| entry * reciprocal));
        }
        for column in 0..n {
            let factor = *entry(blocks, columns, column, k);
            for (entries, pivot) in columns[column * blocks..][..blocks].iter_mut().zip(&*pivot) {
                for (entries, pivot) in entries.iter_mut().zip(pivot) {
                    *entries = core::array::from_fn(|lane| entries[lane] + factor * pivot[lane]);
                }
            }
            // A zero there before would have to wait for its way through memory.
            *entry(blocks, columns, column, k) = factor * reciprocal;
        }
        for (entries, pivot) in columns[k * blocks..][..blocks].iter_mut().zip(&*pivot) {
            *entries = pivot.map(|group| group.map(|entry| -entry));
        }
    }
    for (k, &other) in exchanges.iter().enumerate().rev().filter(|(k, other)| *k != **other) {
        for column in 0..n {
            let swapped = core::mem::take(entry(blocks, columns, column, k));
            *entry(blocks, columns, column, k) = core::mem::replace(entry(blocks, columns, column, other), swapped);
        }
    }
    true
}

/// An entry of columns of so many blocks.
#[inline(always)]
fn entry<const G: usize>(blocks: usize, columns: &mut [[Lanes; G]], column: usize, row: usize) -> &mut f64 {
    let block = G * LANES;
    let within = if blocks == 1 { row } else { row % block };
    &mut columns[column * blocks + if blocks == 1 { 0 } else { row / block }].as_flattened_mut()[within]
}

struct Times<'a> {
    columns: &'a [Lanes],
    vector: &'a [Lanes],
    product: &'a mut [Lanes],
}

impl NullaryFnOnce for Times<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { columns, vector, product: out } = self;
        in_blocks!(vector.len(), G, blocks => product::<G>(blocks, columns, vector, out));
    }
}

/// Writes the product of a matrix, stored as an inverse is, with `vector`.
#[inline(always)]
pub(super) fn product<const G: usize>(blocks: usize, columns: &[Lanes], vector: &[Lanes], product: &mut [Lanes]) {
    let (columns, product) = (columns.as_chunks::<G>().0, product.as_chunks_mut::<G>().0);
    for (block, product) in product.iter_mut().enumerate() {
        let mut sums = [Lanes::default(); G];
        for (column, entry) in columns.chunks_exact(blocks).zip(vector.as_flattened()) {
            for (sum, group) in sums.iter_mut().zip(&column[block]) {
                *sum = core::array::from_fn(|lane| sum[lane] + group[lane] * entry);
            }
        }
        *product = sums;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of `n` rows whose entry in each row and column `entry` gives.
    fn stored(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Lanes> {
        let groups = groups(n);
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
            let whole = stored(n, |row, column| {
                let [matrix, slope] = [&matrix, &slope].map(|of| of.as_flattened()[column * groups(n) * LANES + row]);
                f64::from(row == column) - 0.7 * (matrix + 0.3 * slope)
            });
            let products = [Arch::Scalar, Arch::new()].map(|arch| {
                let mut inverse = Inverse::new(arch);
                inverse.resize(n);
                assert!(inverse.invert(&matrix, &slope, 0.3, 0.7), "{n}");
                let mut products = vec![[0.0; LANES]; whole.len()];
                let groups = groups(n);
                for (column, product) in whole.chunks_exact(groups).zip(products.chunks_exact_mut(groups)) {
                    inverse.times(column, product);
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
        inverse.resize(3);
        let one = stored(3, |row, column| f64::from(row == column));
        assert!(!inverse.invert(&one, &one, 0.0, 1.0));
    }
}
