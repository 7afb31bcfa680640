//! How large the parts are of which an expression consists.
//!
//! In: expressions. Out: each with the magnitudes of all parts added up: no sum or difference cancels. What rounding
//! leaves of an expression that should be zero is a small part of this.

use std::collections::BTreeMap;

use super::{Function, Id, Node, Pool};

/// The magnitudes of these expressions.
#[must_use]
pub fn magnitudes(pool: &mut Pool, of: &[Id]) -> Vec<Id> {
    let mut known = BTreeMap::new();
    // In ascending order: what an expression consists of comes first.
    for id in pool.reachable(of) {
        let magnitude = magnitude(pool, id, &known);
        known.insert(id, magnitude);
    }
    of.iter().map(|id| known[id]).collect()
}

fn magnitude(pool: &mut Pool, id: Id, known: &BTreeMap<Id, Id>) -> Id {
    match pool.node(id).clone() {
        Node::Sum { constant, terms } => {
            let terms: Vec<(Id, f64)> =
                terms.iter().map(|(term, coefficient)| (known[term], coefficient.value().abs())).collect();
            pool.linear(constant.value().abs(), &terms)
        }
        Node::Product(factors) => {
            let factors: Vec<Id> = factors
                .iter()
                .map(|&(factor, exponent)| {
                    let base = if exponent > 0 { known[&factor] } else { pool.call(Function::Abs, &[factor]) };
                    pool.powi(base, exponent)
                })
                .collect();
            pool.product(&factors)
        }
        Node::Number(number) => pool.number(number.value().abs()),
        Node::Symbol(_) | Node::Call(..) | Node::Select { .. } => pool.call(Function::Abs, &[id]),
    }
}
