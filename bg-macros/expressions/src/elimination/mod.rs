//! The elimination of I - c J along the pattern of J.
//!
//! In: the places of J, and of the equations of unknowns beside the states, if there are any. Out: an [`Elimination`]:
//! the order of the pivots and the operations of factorisation and solution in single steps, without a search and
//! without loops. No place that stays zero occurs in them. Method: L U with pivots on the diagonal (`order`), each
//! place of L and U calculated at once as in Doolittle's algorithm (`steps`; Golub, Van Loan, Matrix Computations, 4th
//! edition, section 3.2), fill found on the way (Duff, Erisman, Reid, Direct Methods for Sparse Matrices, 2nd edition
//! 2017, chapters 5 and 7).

mod order;
mod pattern;
mod steps;
#[cfg(test)]
mod tests;

use pattern::Pattern;

use crate::schedule::Counts;

/// How I - c J is factored and solved: with unknowns, the matrix of the rows (I - c f_x, -c f_l) of states and (r_x,
/// r_l) of unknowns, whose right sides are zero. A slot is an index into the factors: the places of L and U beside the
/// diagonal, and the reciprocals of the pivots that are not 1.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Elimination {
    /// The pivots' rows in order.
    pub order: Vec<usize>,
    /// The number of places of L and U that I - c J does not have.
    pub fill: usize,
    /// The number of slots.
    pub slots: usize,
    /// The factorisation. Each slot is entered before it is used, and final before another slot is.
    pub factorisation: Vec<Step>,
    /// The solution.
    pub substitution: Vec<Substep>,
}

/// A step of the factorisation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Step {
    /// The slot becomes its place of the matrix, with this entry of J.
    Enter {
        /// What is entered.
        slot: usize,
        /// The entry's number.
        entry: usize,
        /// What the row is of.
        of: Row,
        /// Whether the slot is a pivot's.
        is_pivot: bool,
    },
    /// The slot, without an entry of J, becomes minus this product of slots, plus 1 on the diagonal of a state.
    Fill {
        /// What is filled.
        slot: usize,
        /// The factors.
        product: (usize, usize),
        /// What the row is of.
        of: Row,
        /// Whether the slot is a pivot's.
        is_pivot: bool,
    },
    /// This product of slots is subtracted from the slot.
    Update {
        /// What is updated.
        slot: usize,
        /// The factors.
        product: (usize, usize),
        /// Whether the slot is a pivot's.
        is_pivot: bool,
    },
    /// The slot becomes its reciprocal, if it is not too small.
    Invert {
        /// A pivot.
        slot: usize,
    },
    /// The slot is multiplied by a pivot's reciprocal.
    Scale {
        /// What is scaled.
        slot: usize,
        /// The pivot's reciprocal.
        by: usize,
    },
}

/// What a row of the matrix is of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Row {
    /// A state: -c times entries of J, plus 1 on the diagonal.
    State,
    /// An unknown: the entries of its equation.
    Unknown,
}

impl Step {
    /// The slot that the step changes.
    #[must_use]
    pub fn slot(self) -> usize {
        match self {
            Self::Enter { slot, .. }
            | Self::Fill { slot, .. }
            | Self::Update { slot, .. }
            | Self::Invert { slot }
            | Self::Scale { slot, .. } => slot,
        }
    }
}

/// A step of the solution, in place.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Substep {
    /// Slot times component `column` is subtracted from component `row`.
    Subtract {
        /// What it is subtracted from.
        row: usize,
        /// The factor.
        slot: usize,
        /// The other factor.
        column: usize,
    },
    /// The component is multiplied by the slot, a pivot's reciprocal.
    Scale {
        /// The component.
        row: usize,
        /// The factor.
        slot: usize,
    },
}

/// Plans the elimination for a Jacobian of `n` states and `unknowns` after them with these places. Of the equations of
/// the last `late` unknowns the place on the diagonal may be zero until others are eliminated.
///
/// # Panics
/// If no order has something on the diagonal of each pivot.
#[must_use]
pub fn plan(n: usize, unknowns: usize, late: usize, places: &[(usize, usize)]) -> Elimination {
    let order = order::best(&Pattern::new(n, unknowns, late, places));
    steps::in_order(order, n, places)
}

impl Elimination {
    /// The operations of a real factorisation; tests of pivots are not counted.
    #[must_use]
    pub fn factorisation_counts(&self) -> Counts {
        let mut counts = Counts { additions: usize::from(!self.factorisation.is_empty()), ..Counts::default() };
        for step in &self.factorisation {
            match step {
                Step::Enter { of: Row::State, is_pivot, .. } => {
                    counts.multiplications += 1;
                    counts.additions += usize::from(*is_pivot);
                }
                Step::Enter { of: Row::Unknown, .. } => {}
                Step::Fill { .. } | Step::Update { .. } => {
                    counts.multiplications += 1;
                    counts.additions += 1;
                }
                Step::Invert { .. } => counts.divisions += 1,
                Step::Scale { .. } => counts.multiplications += 1,
            }
        }
        counts
    }

    /// The operations of a real solution.
    #[must_use]
    pub fn substitution_counts(&self) -> Counts {
        let subtractions = self.substitution.iter().filter(|step| matches!(step, Substep::Subtract { .. })).count();
        Counts { additions: subtractions, multiplications: self.substitution.len(), ..Counts::default() }
    }
}
