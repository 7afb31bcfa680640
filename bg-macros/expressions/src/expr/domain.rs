//! What is known of a value without its symbols' values.
//!
//! In: a node, what is known of its symbols. Out: what is known of it, in a [`Domain`] such as signs or bounds.
//! Method: the operations are followed in the domain (P. Cousot, R. Cousot, Abstract Interpretation, POPL 1977). It can
//! say too much, never too little.

use rustc_hash::FxHashMap;

use super::{Function, Id, Node, Pool, Symbol};

/// What can be known of a value.
pub(super) trait Domain: Copy {
    /// Of a number.
    fn of(value: f64) -> Self;
    fn plus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn power(self, exponent: i32) -> Self;
    /// Of what is either this or that.
    fn or(self, other: Self) -> Self;
    fn call(function: Function, arguments: &[Self]) -> Self;
}

/// What is known of the root.
pub(super) fn known<D: Domain>(pool: &Pool, root: Id, of: &dyn Fn(Symbol) -> D) -> D {
    let mut known: FxHashMap<Id, D> = FxHashMap::default();
    for id in pool.reachable(&[root]) {
        let value = match pool.node(id) {
            Node::Number(number) => D::of(number.value()),
            Node::Symbol(symbol) => of(*symbol),
            Node::Sum { constant, terms } => terms.iter().fold(D::of(constant.value()), |sum, (term, coefficient)| {
                sum.plus(known[term].times(D::of(coefficient.value())))
            }),
            Node::Product(factors) => {
                factors.iter().fold(D::of(1.0), |product, (base, exponent)| product.times(known[base].power(*exponent)))
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<D> = arguments.iter().map(|argument| known[argument]).collect();
                D::call(*function, &arguments)
            }
            Node::Select { negative, positive, .. } => known[negative].or(known[positive]),
        };
        known.insert(id, value);
    }
    known[&root]
}
