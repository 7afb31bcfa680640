//! Which places of a square matrix are filled.
//!
//! In: places. Out: the filled places of each row and column, and what the elimination of a pivot does to them.

use std::collections::BTreeSet;

/// The filled places of a square matrix, by row and by column, and on its diagonal.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Pattern {
    /// The columns of every row.
    pub(super) rows: Vec<BTreeSet<usize>>,
    /// The rows of every column.
    pub(super) columns: Vec<BTreeSet<usize>>,
    /// Of each row whether its place on the diagonal is filled, whatever c is: no other can be a pivot.
    pub(super) diagonal: Vec<bool>,
    /// How many rows are of states.
    states: usize,
}

impl Pattern {
    /// The pattern of a matrix with these places of `n` rows of states, on whose diagonal is something, and of
    /// `unknowns`, on whose diagonal the last `late` may have nothing.
    pub(super) fn new(n: usize, unknowns: usize, late: usize, places: &[(usize, usize)]) -> Self {
        let size = n + unknowns;
        let diagonal = (0..size).map(|row| row < n).collect();
        let none = || vec![BTreeSet::new(); size];
        let mut pattern = Self { rows: none(), columns: none(), diagonal, states: n };
        let is_sure = |&&(row, column): &&(usize, usize)| row != column || row < size - late;
        places.iter().filter(is_sure).for_each(|&place| pattern.fill(place));
        pattern
    }

    fn fill(&mut self, (row, column): (usize, usize)) {
        if row == column {
            self.diagonal[row] = true;
            return;
        }
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
        // The row of a state fills with multiples of c.
        if pivot >= self.states {
            let both = self.columns[pivot].intersection(&self.rows[pivot]);
            both.for_each(|&row| self.diagonal[row] = true);
        }
        let (rows, columns) = (std::mem::take(&mut self.columns[pivot]), std::mem::take(&mut self.rows[pivot]));
        rows.iter().for_each(|&row| _ = self.rows[row].remove(&pivot));
        columns.iter().for_each(|&column| _ = self.columns[column].remove(&pivot));
        let filling = rows.iter().flat_map(|&row| &self.rows[row]).copied();
        filling.chain(rows.iter().copied()).chain(columns.iter().copied()).collect()
    }
}
