//! What the Taylor series of a routine takes.
//!
//! In: the routine of the rates. Out: how many numbers each order has in the work table, and what an order costs.

use super::pairs::Step;
use super::{Assignment, Changes, Operation, Routine};
use crate::expr::Function;

/// What a series takes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SeriesSize {
    /// The places of products in the work table, for left factors and as many for right ones: a multiple of 4.
    pub products: usize,
    /// The numbers of an order in the work table.
    pub width: usize,
    /// Operations of a rate.
    pub rate: usize,
    /// Operations of an order that do not grow with it.
    pub order: usize,
    /// Products of which an order has two more each time.
    pub product_count: usize,
    /// Sums of which an order has two more each time.
    pub sums: usize,
}

/// The places that a function has in the work table.
#[must_use]
pub fn places(function: Function, is_fixed_power: bool) -> usize {
    match function {
        Function::Sqrt | Function::Abs => 1,
        Function::Exp | Function::Ln => 2,
        Function::Sin | Function::Cos | Function::Tan | Function::Tanh | Function::Asin | Function::Acos => 3,
        Function::Atan2 => 4,
        Function::Pow if is_fixed_power => 2,
        Function::Pow => 6,
    }
}

/// What the series of a routine takes; where iterations find something, each order is gone through twice.
#[must_use]
pub fn series_size(routine: &Routine, is_twice: bool) -> SeriesSize {
    let steps: Vec<Step> = routine.assignments.iter().cloned().map(Step::Single).collect();
    let changes = Changes::of(&steps);
    let is_changing = |operand| changes.operand(operand);
    let (mut order, mut sums, mut product_count, mut others) = (routine.results.len(), 0, 0_usize, 0);
    for Assignment { target, operation } in &routine.assignments {
        if !changes.temporary(*target) {
            continue;
        }
        order += match operation {
            // Two products with the values at the start, and what is known already.
            Operation::Multiply(..) if changes.is_product(operation) => {
                product_count += 1;
                4
            }
            Operation::Divide(_, divisor) if is_changing(divisor) => {
                others += 2;
                sums += 1;
                2
            }
            Operation::Call(function, arguments) => {
                others += places(*function, *function == Function::Pow && !is_changing(&arguments[1]));
                sums += if matches!(function, Function::Abs | Function::Sqrt) { 1 } else { 2 };
                4
            }
            Operation::Add(a, b) | Operation::Subtract(a, b) => usize::from(is_changing(a) && is_changing(b)),
            _ => 1,
        };
    }
    let products = product_count.next_multiple_of(4);
    let width = (2 * products + others).next_multiple_of(4).max(1);
    let passes = if is_twice { 2 } else { 1 };
    SeriesSize {
        products,
        width,
        rate: routine.counts.total(),
        order: passes * order,
        product_count,
        sums: passes * sums,
    }
}
