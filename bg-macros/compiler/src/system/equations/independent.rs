//! How many states of storages in derivative causality are independent, and which.
//!
//! In: how much each component of a state changes with what each gives. Out: the components from which all others
//! follow.
//! Method: elimination with pivots on the diagonal, so that what the components give that are found follows from them;
//! where a gyrator leaves nothing there, two components are found together. Matrices of passive systems have such
//! pivots: what they map to zero is also what their transposes map to zero. Zero is what is within rounding at
//! arbitrary values of the symbols (`expr::sized`), beside the largest slope of the same storages, which has its unit.

use std::collections::{BTreeMap, BTreeSet};

use crate::expr::{Id, Pool, Sized, Symbol, partial, sized};
use crate::graph::NodeId;
use crate::random::Random;

/// A component of the state of a storage.
pub(super) type Component = (NodeId, usize);

/// Which components are taken first: the least.
pub(super) type Rank = (bool, bool, NodeId);

/// The largest slope of the components of one storage by what another gives.
pub(super) type Sizes = BTreeMap<(NodeId, NodeId), f64>;

/// What rounding leaves of parts that cancel, relative to the sum of their sizes.
const RESIDUE: f64 = 1e-12;

/// Components that stay states although their storages are in derivative causality.
#[derive(Clone, Default, Debug)]
pub(super) struct Kept {
    /// These.
    pub components: BTreeSet<Component>,
    /// The sizes of slopes while what follows from these is taken from them.
    pub sizes: Sizes,
}

impl Kept {
    /// Whether a component stays a state.
    pub fn has(&self, component: Component) -> bool {
        self.components.contains(&component)
    }

    /// The size of a slope then; 0 where it is not known.
    pub fn size(&self, of: NodeId, by: NodeId) -> f64 {
        self.sizes.get(&(of, by)).copied().unwrap_or_default()
    }

    /// These and more.
    pub fn extend(&mut self, more: Self) {
        self.components.extend(more.components);
        self.sizes.extend(more.sizes);
    }
}

/// How much components change with what each gives: a row and a column for each, at arbitrary values of all symbols.
#[derive(Clone, Debug)]
pub(super) struct Slopes(Vec<Vec<Sized>>);

/// The partial derivatives of values by symbols.
pub(super) fn slopes(pool: &mut Pool, values: &[Id], by: &[Symbol]) -> Slopes {
    let columns: Vec<Vec<Id>> = by.iter().map(|&symbol| partial(pool, values, symbol)).collect();
    let all: Vec<Id> = columns.iter().flatten().copied().collect();
    let mut random = Random::new(1);
    let at: BTreeMap<Symbol, f64> =
        pool.symbols(&all).into_iter().map(|symbol| (symbol, 0.5 + random.unit())).collect();
    let entries = sized(pool, &all, &|symbol| at[&symbol], &|_| false);
    let row = |row: usize| (0..by.len()).map(|column| entries[column * values.len() + row]).collect();
    Slopes((0..values.len()).map(row).collect())
}

impl Slopes {
    /// Whether a slope is what rounding leaves of parts of this size.
    pub fn is_rounding(&self, row: usize, column: usize, size: f64) -> bool {
        self.0[row][column].value.abs() <= RESIDUE * size
    }

    /// Notes that a slope is zero.
    pub fn clear(&mut self, row: usize, column: usize) {
        self.0[row][column] = Sized::exact(0.0);
    }

    /// The components from which all others follow, and the sizes of the slopes.
    pub fn independent(self, ranks: &BTreeMap<Component, Rank>) -> (Vec<Component>, Sizes) {
        let (components, ranks): (Vec<Component>, Vec<Rank>) = ranks.iter().map(|(&of, &rank)| (of, rank)).unzip();
        let mut open: Vec<usize> = (0..ranks.len()).collect();
        open.sort_by_key(|&row| ranks[row]);
        let mut search = Search { matrix: self.0, ranks, sizes: Sizes::new(), open };
        search.measure();
        let mut found = Vec::new();
        while let Some(pivots) = search.pivots() {
            search.eliminate(&pivots);
            found.extend(pivots.into_iter().map(|row| components[row]));
        }
        (found, search.sizes)
    }
}

struct Search {
    matrix: Vec<Vec<Sized>>,
    ranks: Vec<Rank>,
    sizes: Sizes,
    /// The rows that are left, those first that are to be taken first.
    open: Vec<usize>,
}

impl Search {
    /// Notes how large the slopes of the rows that are left have been.
    fn measure(&mut self) {
        for &row in &self.open {
            for &column in &self.open {
                let [(.., of), (.., by)] = [row, column].map(|k| self.ranks[k]);
                let size = self.sizes.entry((of, by)).or_default();
                *size = size.max(self.matrix[row][column].size);
            }
        }
    }

    /// Whether a slope differs from zero.
    fn is_there(&self, row: usize, column: usize) -> bool {
        let [(.., of), (.., by)] = [row, column].map(|k| self.ranks[k]);
        let Sized { value, size } = self.matrix[row][column];
        value.abs() > RESIDUE * size.max(self.sizes[&(of, by)])
    }

    /// The rows to take next: one, or two that need each other.
    fn pivots(&self) -> Option<Vec<usize>> {
        if let Some(&first) = self.open.iter().find(|&&row| self.is_there(row, row)) {
            // Of one storage the largest: its components have one unit.
            let alike = self.open.iter().copied().filter(|&row| self.ranks[row] == self.ranks[first]);
            let size = |row: usize| self.matrix[row][row].value.abs();
            return alike.max_by(|&a, &b| size(a).total_cmp(&size(b)).then(b.cmp(&a))).map(|row| vec![row]);
        }
        let mut pairs = self.open.iter().flat_map(|&row| self.open.iter().map(move |&other| (row, other)));
        let both = pairs.clone().find(|&(row, other)| self.is_there(row, other) && self.is_there(other, row));
        // What a row gives stays open that none of the others answers.
        let one = || pairs.find(|&(row, other)| self.is_there(row, other)).map(|(row, _)| vec![row]);
        both.map(|(row, other)| vec![row, other]).or_else(one)
    }

    /// Takes from the rows that are left what follows from these.
    fn eliminate(&mut self, pivots: &[usize]) {
        self.open.retain(|row| !pivots.contains(row));
        let inverse: Vec<(usize, usize, Sized)> = match *pivots {
            [row] if self.is_there(row, row) => vec![(row, row, self.matrix[row][row])],
            [row, other] => vec![(row, other, self.matrix[other][row]), (other, row, self.matrix[row][other])],
            _ => Vec::new(),
        };
        for &row in &self.open {
            for &column in &self.open {
                let before = self.matrix[row][column];
                self.matrix[row][column] = inverse.iter().fold(before, |entry, &(left, right, pivot)| {
                    let part = self.matrix[row][left].over(pivot).times(self.matrix[right][column]);
                    Sized { value: entry.value - part.value, size: entry.size + part.size }
                });
            }
        }
        self.measure();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows that are found in a matrix whose rows belong to these storages.
    fn found(matrix: &[&[f64]], storages: &[usize]) -> Vec<usize> {
        let slopes = Slopes(matrix.iter().map(|row| row.iter().map(|&value| Sized::exact(value)).collect()).collect());
        let of = |(row, &node): (usize, &usize)| ((NodeId(node), row), (true, true, NodeId(node)));
        let ranks = storages.iter().enumerate().map(of).collect();
        slopes.independent(&ranks).0.into_iter().map(|(_, row)| row).collect()
    }

    #[test]
    fn of_one_storage_the_largest_components_are_taken_as_many_as_are_independent() {
        // v v^T with v = (0.1, 0.7, -0.3): one.
        let vector = [0.1, 0.7, -0.3];
        let rows = vector.map(|a| vector.map(|b| a * b));
        assert_eq!(found(&[&rows[0], &rows[1], &rows[2]], &[0, 0, 0]), [1]);
        assert_eq!(found(&[&rows[0], &rows[1], &rows[2]], &[0, 1, 1]), [0]);
        assert_eq!(found(&[&[2.0, 0.0], &[0.0, 3.0]], &[0, 0]), [1, 0]);
        assert!(found(&[&[0.0, 0.0], &[0.0, 0.0]], &[0, 1]).is_empty());
    }

    #[test]
    fn two_that_only_a_gyrator_links_are_taken_together() {
        // A gyrator about an axis: its plane, whose third direction is idle.
        assert_eq!(found(&[&[0.0, -3.0, 2.0], &[3.0, 0.0, -1.0], &[-2.0, 1.0, 0.0]], &[0, 1, 2]), [0, 1]);
    }

    #[test]
    fn what_nothing_answers_is_taken_alone() {
        assert_eq!(found(&[&[0.0, 1.0], &[0.0, 0.0]], &[0, 1]), [0]);
    }
}
