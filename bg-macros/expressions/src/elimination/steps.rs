//! The operations of an elimination in a given order.
//!
//! In: the order of the pivots, the places of J and of the unknowns' equations. Out: an [`Elimination`].
//! Method: row by row in the order of the pivots; u_ij = a_ij - sum l_ik u_kj and l_ij likewise, k ascending (Golub,
//! Van Loan, Matrix Computations, 4th edition, section 3.2). The product l_ik u_kj takes the pivot's reciprocal once:
//! it goes into the column of L or the row of U, whichever is shorter, and the solution takes it on the other side.

use std::collections::BTreeMap;

use super::pattern::Pattern;
use super::{Elimination, Row, Step, Substep};

/// The elimination with the pivots in this order; `n` of the rows are of states.
pub(super) fn in_order(order: Vec<usize>, n: usize, places: &[(usize, usize)]) -> Elimination {
    let mut position = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, &row)| position[row] = at);
    let permuted = places.iter().map(|&(row, column)| (position[row], position[column]));
    let entries: BTreeMap<(usize, usize), usize> = permuted.zip(0..).collect();
    let filled = Filled::new(order.len(), &entries);
    let of: Vec<Row> = order.iter().map(|&row| if row < n { Row::State } else { Row::Unknown }).collect();
    let mut sweep = Sweep { filled, of, entries, slots: BTreeMap::new(), steps: Vec::new() };
    (0..order.len()).for_each(|row| sweep.row(row));
    let substitution = needed(sweep.substitution(&order), order.len(), n);
    let beside_pivots = sweep.slots.keys().filter(|place| place.0 != place.1);
    let fill = beside_pivots.filter(|place| !sweep.entries.contains_key(place)).count();
    Elimination { order, fill, slots: sweep.slots.len(), factorisation: sweep.steps, substitution }
}

/// The columns of L and the rows of U, without the diagonal, all in the order of the pivots.
struct Filled {
    columns: Vec<Vec<usize>>,
    rows: Vec<Vec<usize>>,
}

impl Filled {
    fn new(n: usize, entries: &BTreeMap<(usize, usize), usize>) -> Self {
        let mut pattern = Pattern::new(n, 0, 0, &entries.keys().copied().collect::<Vec<_>>());
        let mut filled = Self { columns: Vec::new(), rows: Vec::new() };
        for pivot in 0..n {
            filled.columns.push(pattern.columns[pivot].iter().copied().collect());
            filled.rows.push(pattern.rows[pivot].iter().copied().collect());
            pattern.eliminate(pivot);
        }
        filled
    }

    /// Whether the reciprocal of this pivot goes into L.
    fn scales_column(&self, pivot: usize) -> bool {
        self.columns[pivot].len() <= self.rows[pivot].len()
    }

    /// The columns of L in this row.
    fn lower(&self, row: usize) -> Vec<usize> {
        (0..row).filter(|&column| self.columns[column].binary_search(&row).is_ok()).collect()
    }
}

/// The steps without those that subtract what is zero, as the right sides of unknowns are, and without those that no
/// state needs.
fn needed(mut steps: Vec<Substep>, rows: usize, n: usize) -> Vec<Substep> {
    let rows_of = |step: &Substep| match *step {
        Substep::Subtract { row, column, .. } => (row, column),
        Substep::Scale { row, .. } => (row, row),
    };
    let of_states: Vec<bool> = (0..rows).map(|row| row < n).collect();
    let mut filled = of_states.clone();
    steps.retain(|step| {
        let (row, column) = rows_of(step);
        filled[row] |= filled[column];
        filled[column]
    });
    let mut used = of_states;
    steps.reverse();
    steps.retain(|step| {
        let (row, column) = rows_of(step);
        used[column] |= used[row];
        used[row]
    });
    steps.reverse();
    steps
}

struct Sweep {
    filled: Filled,
    /// What the rows are of, in the order of the pivots.
    of: Vec<Row>,
    /// The numbers of J's entries by place, in the order of the pivots.
    entries: BTreeMap<(usize, usize), usize>,
    /// The slots by place, in the order of the pivots; none for a pivot that is 1.
    slots: BTreeMap<(usize, usize), usize>,
    steps: Vec<Step>,
}

impl Sweep {
    /// The steps of one row of L and U.
    fn row(&mut self, row: usize) {
        let lower = self.filled.lower(row);
        for &column in &lower {
            let slot = self.value(row, column, &lower).expect("a filled place has a value");
            if self.filled.scales_column(column)
                && let Some(&by) = self.slots.get(&(column, column))
            {
                self.steps.push(Step::Scale { slot, by });
            }
        }
        let pivot = self.value(row, row, &lower);
        assert!(pivot.is_some() || self.of[row] == Row::State, "an unknown is in its equation");
        if let Some(slot) = pivot {
            self.steps.push(Step::Invert { slot });
        }
        for column in self.filled.rows[row].clone() {
            let slot = self.value(row, column, &lower).expect("a filled place has a value");
            if !self.filled.scales_column(row)
                && let Some(by) = pivot
            {
                self.steps.push(Step::Scale { slot, by });
            }
        }
    }

    /// The steps of one place, before it is scaled or inverted. None where a pivot stays 1.
    fn value(&mut self, row: usize, column: usize, lower: &[usize]) -> Option<usize> {
        let slot = self.slots.len();
        let is_pivot = row == column;
        let before = self.steps.len();
        if let Some(&entry) = self.entries.get(&(row, column)) {
            self.steps.push(Step::Enter { slot, entry, of: self.of[row], is_pivot });
        }
        for &k in lower.iter().take_while(|&&k| k < column) {
            let (Some(&left), Some(&right)) = (self.slots.get(&(row, k)), self.slots.get(&(k, column))) else {
                continue;
            };
            let product = (left, right);
            self.steps.push(if self.steps.len() == before {
                Step::Fill { slot, product, of: self.of[row], is_pivot }
            } else {
                Step::Update { slot, product, is_pivot }
            });
        }
        if self.steps.len() == before {
            return None;
        }
        self.slots.insert((row, column), slot);
        Some(slot)
    }

    fn substitution(&self, order: &[usize]) -> Vec<Substep> {
        let mut steps = Vec::new();
        let subtract = |row, column| Substep::Subtract {
            row: order[row],
            slot: self.slots[&(row, column)],
            column: order[column],
        };
        let scale = |row| self.slots.get(&(row, row)).map(|&slot| Substep::Scale { row: order[row], slot });
        for row in 0..order.len() {
            steps.extend(self.filled.lower(row).into_iter().map(|column| subtract(row, column)));
            steps.extend(scale(row).filter(|_| !self.filled.scales_column(row)));
        }
        for row in (0..order.len()).rev() {
            steps.extend(self.filled.rows[row].iter().map(|&column| subtract(row, column)));
            steps.extend(scale(row).filter(|_| self.filled.scales_column(row)));
        }
        steps
    }
}
