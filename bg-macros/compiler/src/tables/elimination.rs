//! Factorisation and solution of I - c J as tables of steps.
//!
//! In: an [`Elimination`]. Out: an [`EliminationTable`], in the order of `bg_model::linear`'s tables: the same
//! operations, in the same order, as the steps one after the other.

use crate::program::elimination::{Elimination, Row, Step, Substep};

/// How I - c J is factored and solved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EliminationTable {
    /// The factors.
    pub slots: Vec<Slot>,
    /// Products of factors, slot by slot.
    pub products: Vec<(usize, usize)>,
    /// The solution: row, factor, column. Where row and column are equal, the row is multiplied by the factor.
    pub steps: Vec<(usize, usize, usize)>,
    /// The rows: states, then unknowns.
    pub rows: usize,
}

/// How one factor is calculated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// The entry of J, where it has one.
    pub entry: Option<usize>,
    /// The end of its products among all.
    pub end: usize,
    /// Whether it is a pivot, which becomes its reciprocal.
    pub is_pivot: bool,
    /// Whether its row is an unknown's equation.
    pub of_unknown: bool,
    /// The pivot that it is divided by, where it is.
    pub scale: Option<usize>,
}

/// The tables of an elimination.
#[must_use]
pub fn elimination(of: &Elimination) -> EliminationTable {
    let mut products = Vec::new();
    let slots = of.factorisation.chunk_by(|left, right| left.slot() == right.slot()).map(|steps| {
        let mut slot = Slot { entry: None, end: 0, is_pivot: false, of_unknown: false, scale: None };
        for step in steps {
            if let Step::Enter { of, .. } | Step::Fill { of, .. } = *step {
                slot.of_unknown = of == Row::Unknown;
            }
            match *step {
                Step::Enter { entry, .. } => slot.entry = Some(entry),
                Step::Fill { product, .. } | Step::Update { product, .. } => products.push(product),
                Step::Invert { .. } => slot.is_pivot = true,
                Step::Scale { by, .. } => slot.scale = Some(by),
            }
        }
        slot.end = products.len();
        slot
    });
    let slots = slots.collect();
    let steps = of.substitution.iter().map(|step| match *step {
        Substep::Subtract { row, slot, column } => (row, slot, column),
        Substep::Scale { row, slot } => (row, slot, row),
    });
    EliminationTable { slots, products, steps: steps.collect(), rows: of.order.len() }
}
