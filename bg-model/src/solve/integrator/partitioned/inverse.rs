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

/// Takes the common numbers of groups as constants, so that loops over the groups of a column are written out.
macro_rules! for_groups {
    ($count:expr, $groups:ident => $then:expr) => {
        match $count {
            1 => {
                let $groups = 1;
                $then
            }
            2 => {
                let $groups = 2;
                $then
            }
            3 => {
                let $groups = 3;
                $then
            }
            4 => {
                let $groups = 4;
                $then
            }
            $groups => $then,
        }
    };
}

pub(super) use for_groups;

/// The inverse, column by column; behind each column are zeros up to whole groups.
#[derive(Clone, Debug)]
pub(super) struct Inverse {
    pub arch: Arch,
    /// The groups of a column.
    groups: usize,
    pub columns: Vec<Lanes>,
    exchanges: Vec<usize>,
}

impl Inverse {
    /// Nothing yet, calculated in these vectors.
    pub fn new(arch: Arch) -> Self {
        Self { arch, groups: 0, columns: Vec::new(), exchanges: Vec::new() }
    }

    /// Makes room for a matrix of `n` rows.
    pub fn resize(&mut self, n: usize) {
        self.groups = n.div_ceil(LANES);
        self.columns.clear();
        self.columns.resize(n * self.groups, [0.0; LANES]);
        self.exchanges.resize(n, 0);
    }

    /// Inverts I - `factor` B, with `matrix` for B as this one is stored. Gives whether it is regular.
    pub fn invert(&mut self, matrix: &[Lanes], factor: f64) -> bool {
        let Self { arch, groups, columns, exchanges } = self;
        arch.dispatch(Invert { matrix, factor, groups: *groups, columns, exchanges })
    }

    /// Writes the product with `vector`.
    pub fn times(&self, vector: &[Lanes], product: &mut [Lanes]) {
        self.arch.dispatch(Times { columns: &self.columns, vector, product });
    }
}

struct Invert<'a> {
    matrix: &'a [Lanes],
    factor: f64,
    groups: usize,
    columns: &'a mut [Lanes],
    exchanges: &'a mut [usize],
}

impl NullaryFnOnce for Invert<'_> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        let Self { matrix, factor, groups, columns, exchanges } = self;
        for (to, from) in columns.iter_mut().zip(matrix) {
            *to = from.map(|entry| -factor * entry);
        }
        exchanges.is_empty() || for_groups!(groups, groups => invert(groups, columns, exchanges))
    }
}

/// Adds I and inverts in place, by elimination with exchanges. Gives whether the matrix is regular.
///
/// Columns take the part of rows: the inverse of the transpose is the transpose of the inverse.
#[inline(always)]
fn invert(groups: usize, columns: &mut [Lanes], exchanges: &mut [usize]) -> bool {
    for (k, column) in columns.chunks_exact_mut(groups).enumerate() {
        column[k / LANES][k % LANES] += 1.0;
    }
    for k in 0..exchanges.len() {
        let (group, lane) = (k / LANES, k % LANES);
        let (mut best, mut largest) = (k, -1.0);
        for (column, entries) in columns[k * groups..].chunks_exact(groups).enumerate() {
            let size = entries[group][lane].abs();
            if size > largest {
                (best, largest) = (k + column, size);
            }
        }
        exchanges[k] = best;
        if best != k {
            (0..groups).for_each(|group| columns.swap(k * groups + group, best * groups + group));
        }
        let (above, rest) = columns.split_at_mut(k * groups);
        let (pivot, below) = rest.split_at_mut(groups);
        let reciprocal = 1.0 / core::mem::replace(&mut pivot[group][lane], 1.0);
        if !reciprocal.is_finite() {
            return false;
        }
        pivot.as_flattened_mut().iter_mut().for_each(|entry| *entry *= reciprocal);
        for column in above.chunks_exact_mut(groups).chain(below.chunks_exact_mut(groups)) {
            let factor = core::mem::take(&mut column[group][lane]);
            for (entries, of_pivot) in column.iter_mut().zip(&*pivot) {
                *entries = core::array::from_fn(|lane| entries[lane] - factor * of_pivot[lane]);
            }
        }
    }
    for (k, &other) in exchanges.iter().enumerate().rev().filter(|(k, other)| *k != **other) {
        columns.as_flattened_mut().chunks_exact_mut(groups * LANES).for_each(|column| column.swap(k, other));
    }
    true
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
        for_groups!(vector.len(), groups => product(columns, &vector[..groups], &mut out[..groups]));
    }
}

/// Writes the product of a matrix, stored as an inverse is, with `vector`.
#[inline(always)]
pub(super) fn product(columns: &[Lanes], vector: &[Lanes], mut product: &mut [Lanes]) {
    let mut first = 0;
    while !product.is_empty() {
        let taken = product.len().min(4);
        let (these, behind) = product.split_at_mut(taken);
        match taken {
            1 => rows::<1>(columns, vector, first, these),
            2 => rows::<2>(columns, vector, first, these),
            3 => rows::<3>(columns, vector, first, these),
            _ => rows::<4>(columns, vector, first, these),
        }
        (product, first) = (behind, first + taken);
    }
}

/// Writes the `GROUPS` groups from `first` on of the product.
#[inline(always)]
fn rows<const GROUPS: usize>(columns: &[Lanes], vector: &[Lanes], first: usize, product: &mut [Lanes]) {
    let mut sums = [[0.0; LANES]; GROUPS];
    for (column, entry) in columns.chunks_exact(vector.len()).zip(vector.as_flattened()) {
        let groups = &column[first..first + GROUPS];
        for (sum, group) in sums.iter_mut().zip(groups) {
            *sum = core::array::from_fn(|lane| sum[lane] + group[lane] * entry);
        }
    }
    product.copy_from_slice(&sums);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of `n` rows whose entry in each row and column `entry` gives.
    fn stored(n: usize, entry: impl Fn(usize, usize) -> f64) -> Vec<Lanes> {
        let groups = n.div_ceil(LANES);
        let lanes = |k: usize| core::array::from_fn(|lane| (k % groups * LANES + lane, k / groups));
        let entry = |(row, column)| if row < n { entry(row, column) } else { 0.0 };
        (0..n * groups).map(|k| lanes(k).map(entry)).collect()
    }

    #[test]
    fn the_inverse_times_the_matrix_is_one_with_the_same_bytes_everywhere() {
        for n in 1..=21 {
            let matrix =
                stored(n, |row, column| ((7 * row + 5 * column) % 11) as f64 - 4.0 + (row * column) as f64 * 0.3);
            let whole = stored(n, |row, column| {
                f64::from(row == column) - 0.7 * matrix.as_flattened()[column * n.div_ceil(LANES) * LANES + row]
            });
            let products = [Arch::Scalar, Arch::new()].map(|arch| {
                let mut inverse = Inverse::new(arch);
                inverse.resize(n);
                assert!(inverse.invert(&matrix, 0.7), "{n}");
                let mut products = vec![[0.0; LANES]; whole.len()];
                let groups = n.div_ceil(LANES);
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
        assert!(!inverse.invert(&stored(3, |row, column| f64::from(row == column)), 1.0));
    }
}
