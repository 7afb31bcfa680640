//! Which cells of a plan are computed negated, so that fewest negations remain.
//!
//! In: a [`Plan`]. Out: for each cell whether its negative is computed.
//! Method: a sum with terms of both signs can be computed either way round, a product with a static factor too; every
//! other cell has the sign of its operands. A negation remains only where a function, a choice or a result wants the
//! other sign. Each of those is tried away by turning one cell under it round.

use super::plan::{Cell, Plan, Signed};

/// The cells that are computed negated.
#[derive(Debug)]
pub(super) struct Signs {
    /// By cell.
    pub(super) negative: Vec<bool>,
    turned: Vec<bool>,
}

/// Cells visited for all trials together: keeps the search below a tenth of the schedule's time.
const VISITS: usize = 400_000;

/// Cells tried for one negation.
const TRIALS: usize = 8;

impl Signs {
    /// The signs of the cells in this order, operands first.
    pub(super) fn new(plan: &Plan, order: &[u32]) -> Self {
        let mut signs = Self { negative: vec![false; plan.cells.len()], turned: vec![false; plan.cells.len()] };
        signs.determine(plan, order);
        signs.search(plan, order);
        signs
    }

    /// The sign of an operand as it is computed.
    pub(super) fn of(&self, operand: Signed) -> bool {
        operand.negative ^ self.negative[operand.cell as usize]
    }

    fn determine(&mut self, plan: &Plan, order: &[u32]) {
        for &cell in order {
            self.negative[cell as usize] = self.sign(plan, cell);
        }
    }

    fn sign(&self, plan: &Plan, cell: u32) -> bool {
        let turned = self.turned[cell as usize];
        match &plan.cells[cell] {
            Cell::Sum(terms) => {
                let negative = terms.iter().filter(|&&term| self.of(term)).count();
                let free = terms.iter().any(|term| is_static(plan, term.cell));
                if free || (negative > 0 && negative < terms.len()) { turned } else { negative > 0 }
            }
            Cell::Product(factors) => {
                let odd = |&&(cell, exponent): &&(u32, i32)| exponent % 2 != 0 && self.negative[cell as usize];
                let negative = factors.iter().filter(odd).count() % 2 == 1;
                negative ^ (turned && factors.iter().any(|factor| is_static(plan, factor.0)))
            }
            _ => false,
        }
    }

    /// The cells whose negative is wanted although they are computed as they are, or the other way round.
    fn negated(&self, plan: &Plan, order: &[u32]) -> Vec<u32> {
        let mut negated = Vec::new();
        let mut want = |operand: Signed| {
            if self.of(operand) && !is_static(plan, operand.cell) {
                negated.push(operand.cell);
            }
        };
        for &cell in order {
            if let cell @ (Cell::Call(..) | Cell::Select { .. }) = &plan.cells[cell] {
                cell.operands(&mut want);
            }
        }
        plan.roots.iter().copied().for_each(want);
        negated.sort_unstable();
        negated.dedup();
        negated
    }

    fn search(&mut self, plan: &Plan, order: &[u32]) {
        let mut visits = 0;
        let mut best = self.negated(plan, order);
        let mut at = 0;
        while at < best.len() && visits < VISITS {
            let before = best.len();
            for cell in turnable(plan, best[at]) {
                visits += order.len();
                self.turned[cell as usize] ^= true;
                self.determine(plan, order);
                let now = self.negated(plan, order);
                if now.len() < best.len() {
                    best = now;
                    break;
                }
                self.turned[cell as usize] ^= true;
            }
            if best.len() == before {
                at += 1;
            }
        }
        self.determine(plan, order);
    }
}

/// Whether a cell's sign costs nothing.
fn is_static(plan: &Plan, cell: u32) -> bool {
    matches!(plan.cells[cell], Cell::Static(_))
}

/// The sums and products that may give this cell its sign, the nearest first.
fn turnable(plan: &Plan, cell: u32) -> Vec<u32> {
    let mut found = vec![cell];
    let mut at = 0;
    while at < found.len() && found.len() < TRIALS {
        let cell = &plan.cells[found[at]];
        if matches!(cell, Cell::Sum(_) | Cell::Product(_)) {
            cell.operands(|operand| {
                let turnable = matches!(plan.cells[operand.cell], Cell::Sum(_) | Cell::Product(_));
                if turnable && !found.contains(&operand.cell) {
                    found.push(operand.cell);
                }
            });
        }
        at += 1;
    }
    found.truncate(TRIALS);
    found
}
