//! Which places of a square matrix are filled.
//!
//! In: places. Out: the filled places of each row and column, and what the elimination of a pivot does to them.

use std::collections::BTreeSet;

/// The filled places of a square matrix beside its diagonal, by row and by column.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Pattern {
    /// The columns of every row.
    pub(super) rows: Vec<BTreeSet<usize>>,
    /// The rows of every column.
    pub(super) columns: Vec<BTreeSet<usize>>,
}

impl Pattern {
    /// The pattern of a matrix of `n` rows with these places.
    pub(super) fn new(n: usize, places: &[(usize, usize)]) -> Self {
        let mut pattern = Self { rows: vec![BTreeSet::new(); n], columns: vec![BTreeSet::new(); n] };
        places.iter().filter(|place| place.0 != place.1).for_each(|&place| pattern.fill(place));
        pattern
    }

    fn fill(&mut self, (row, column): (usize, usize)) {
        self.rows[row].insert(column);
        self.columns[column].insert(row);
    }

    /// The products that the elimination of this pivot subtracts.
    pub(super) fn updates_of(&self, pivot: usize) -> usize {
        self.rows[pivot].len() * self.columns[pivot].len()
    }

    /// The places that the elimination of this pivot fills.
    pub(super) fn fill_of(&self, pivot: usize) -> Vec<(usize, usize)> {
        let mut filled = Vec::new();
        for &row in &self.columns[pivot] {
            let free = self.rows[pivot].difference(&self.rows[row]).filter(|&&column| column != row);
            filled.extend(free.map(|&column| (row, column)));
        }
        filled
    }

    /// Eliminates a pivot: fills what that fills, then takes its row and column out. Gives the pivots whose updates or
    /// fill that may have changed: those of the rows and columns that it has changed, and those that fill the rows.
    pub(super) fn eliminate(&mut self, pivot: usize) -> BTreeSet<usize> {
        for place in self.fill_of(pivot) {
            self.fill(place);
        }
        let (rows, columns) = (std::mem::take(&mut self.columns[pivot]), std::mem::take(&mut self.rows[pivot]));
        rows.iter().for_each(|&row| _ = self.rows[row].remove(&pivot));
        columns.iter().for_each(|&column| _ = self.columns[column].remove(&pivot));
        let filling = rows.iter().flat_map(|&row| &self.rows[row]).copied();
        filling.chain(rows.iter().copied()).chain(columns.iter().copied()).collect()
    }
}
