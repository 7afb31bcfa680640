//! The order of the pivots.
//!
//! In: a pattern. Out: orders that promise little fill, the natural one among them.
//! Method: greedy, the next pivot being that with the least Markowitz count (r - 1)(c - 1) or with the least fill, ties
//! broken by another measure and then by the index (Duff, Erisman, Reid, Direct Methods for Sparse Matrices, 2nd
//! edition 2017, chapter 7; Davis, Direct Methods for Sparse Linear Systems, 2006, section 7.1). Pivots stay on the
//! diagonal, so one permutation orders rows and columns.

use std::collections::BTreeSet;

use super::pattern::Pattern;

/// What the next pivot has least of; the second decides between equal ones.
type Measure = fn(&Pattern, usize) -> [usize; 2];

/// Ways to choose the next pivot.
const MEASURES: [Measure; 3] = [
    |pattern, pivot| [pattern.updates_of(pivot), pattern.rows[pivot].len() + pattern.columns[pivot].len()],
    |pattern, pivot| [pattern.updates_of(pivot), pattern.fill_of(pivot).len()],
    |pattern, pivot| [pattern.fill_of(pivot).len(), pattern.updates_of(pivot)],
];

/// What an order costs that has a pivot on a place where nothing is; what such a pivot has of a measure.
const IMPOSSIBLE: [usize; 2] = [usize::MAX; 2];

/// The order with the least fill, of equal ones that with the fewest updates.
pub(super) fn best(pattern: &Pattern) -> Vec<usize> {
    let natural = (0..pattern.rows.len()).collect();
    let greedy = MEASURES.map(|measure| greedy(pattern.clone(), measure));
    let orders = std::iter::once(natural).chain(greedy);
    orders.min_by_key(|order| cost(pattern.clone(), order)).expect("there is the natural order")
}

/// The order that takes the pivot with the least measure at each step.
fn greedy(mut pattern: Pattern, measure: Measure) -> Vec<usize> {
    let measure = |pattern: &Pattern, pivot: usize| {
        if pattern.diagonal[pivot] { measure(pattern, pivot) } else { IMPOSSIBLE }
    };
    let mut measures: Vec<[usize; 2]> = (0..pattern.rows.len()).map(|pivot| measure(&pattern, pivot)).collect();
    let mut left: BTreeSet<([usize; 2], usize)> = measures.iter().copied().zip(0..).collect();
    let mut order = Vec::with_capacity(left.len());
    while let Some((_, pivot)) = left.pop_first() {
        for changed in pattern.eliminate(pivot) {
            let measure = measure(&pattern, changed);
            left.remove(&(std::mem::replace(&mut measures[changed], measure), changed));
            left.insert((measure, changed));
        }
        order.push(pivot);
    }
    order
}

/// The places that an order fills, and its updates.
fn cost(mut pattern: Pattern, order: &[usize]) -> [usize; 2] {
    let mut sum = [0, 0];
    for &pivot in order {
        if !pattern.diagonal[pivot] {
            return IMPOSSIBLE;
        }
        sum = [sum[0] + pattern.fill_of(pivot).len(), sum[1] + pattern.updates_of(pivot)];
        pattern.eliminate(pivot);
    }
    sum
}
