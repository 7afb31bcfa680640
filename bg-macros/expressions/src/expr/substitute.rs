//! Substitution of symbols.
//!
//! In: nodes, and an expression for each symbol to be replaced. Out: the same nodes over the new symbols, in canonical
//! form.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::{Id, Node, Pool, Symbol, children};

/// What becomes of a switch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Branch {
    /// It stays, under this index.
    Kept(u32),
    /// Its guard is negative always.
    Negative,
    /// Its guard is never negative.
    Positive,
}

/// The roots with every symbol replaced for which `replace` gives an expression. Replacements are not searched again.
pub fn substitute(pool: &mut Pool, roots: &[Id], replace: &dyn Fn(Symbol) -> Option<Id>) -> Vec<Id> {
    substitute_switched(pool, roots, replace, &Branch::Kept)
}

/// As [`substitute`]; every switched value becomes what `branch` says of its switch.
pub fn substitute_switched(
    pool: &mut Pool,
    roots: &[Id],
    replace: &dyn Fn(Symbol) -> Option<Id>,
    branch: &dyn Fn(u32) -> Branch,
) -> Vec<Id> {
    let mut images: FxHashMap<Id, Id> = FxHashMap::default();
    for id in pool.reachable(roots) {
        let image = match *pool.node(id) {
            Node::Symbol(symbol) => replace(symbol).unwrap_or(id),
            Node::Select { switch, negative, positive } => match branch(switch) {
                Branch::Kept(kept) => pool.select(kept, images[&negative], images[&positive]),
                Branch::Negative => images[&negative],
                Branch::Positive => images[&positive],
            },
            _ => pool.rebuilt(id, &images),
        };
        images.insert(id, image);
    }
    roots.iter().map(|root| images[root]).collect()
}

/// The roots with nodes in the places of others. What takes a place is not searched again.
pub fn exchange(pool: &mut Pool, roots: &[Id], places: &BTreeMap<Id, Id>) -> Vec<Id> {
    let mut images: FxHashMap<Id, Id> = FxHashMap::default();
    for id in pool.reachable(roots) {
        let image = places.get(&id).copied().unwrap_or_else(|| pool.rebuilt(id, &images));
        images.insert(id, image);
    }
    roots.iter().map(|root| images[root]).collect()
}

/// The nodes without the switched values of which `below` has the switch: the part of the branch of a negative guard is
/// what stands there, 1 or 0, that of the other one the rest.
pub fn blended(pool: &mut Pool, roots: &[Id], below: &BTreeMap<u32, Id>) -> Vec<Id> {
    let mut images: FxHashMap<Id, Id> = FxHashMap::default();
    for id in pool.reachable(roots) {
        let image = match *pool.node(id) {
            Node::Select { switch, negative, positive } if below.contains_key(&switch) => {
                let difference = pool.sub(images[&negative], images[&positive]);
                let part = pool.mul(below[&switch], difference);
                pool.add(part, images[&positive])
            }
            _ => pool.rebuilt(id, &images),
        };
        images.insert(id, image);
    }
    roots.iter().map(|root| images[root]).collect()
}

impl Pool {
    /// The switches of all values that the roots are made of.
    #[must_use]
    pub fn switches(&self, roots: &[Id]) -> BTreeSet<u32> {
        let switch = |id: &Id| if let Node::Select { switch, .. } = self.node(*id) { Some(*switch) } else { None };
        self.reachable(roots).iter().filter_map(switch).collect()
    }

    /// The node over the images of its children.
    pub(super) fn rebuilt(&mut self, id: Id, images: &FxHashMap<Id, Id>) -> Id {
        if children(self.node(id)).all(|child| images[&child] == child) {
            return id;
        }
        match self.node(id).clone() {
            Node::Number(_) | Node::Symbol(_) => id,
            Node::Sum { constant, terms } => {
                let terms: Vec<_> = terms.iter().map(|(id, c)| (images[id], c.value())).collect();
                self.linear(constant.value(), &terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|(id, exponent)| (images[id], *exponent)).collect();
                self.powers(&factors)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|id| images[id]).collect();
                self.call(function, &arguments)
            }
            Node::Select { switch, negative, positive } => self.select(switch, images[&negative], images[&positive]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Function, random};

    #[test]
    fn replaces_and_simplifies() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        let sum = pool.add(x, y);
        let product = pool.mul(sum, x);
        let minus = pool.neg(y);
        let replace = |symbol| (symbol == Symbol::State(0)).then_some(minus);
        assert_eq!(substitute(&mut pool, &[product, y], &replace), [pool.zero(), y]);
    }

    #[test]
    fn swaps_symbols_at_once() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        let difference = pool.sub(x, y);
        let swap = |symbol| Some(if symbol == Symbol::State(0) { y } else { x });
        let image = substitute(&mut pool, &[difference], &swap)[0];
        assert_eq!(image, pool.neg(difference));
    }

    #[test]
    fn no_replacement_changes_nothing() {
        let mut pool = Pool::new();
        let roots = random::Source::new(3).expressions(&mut pool, 60);
        let length = pool.len();
        assert_eq!(substitute(&mut pool, &roots, &|_| None), roots);
        assert_eq!(pool.len(), length);
    }

    #[test]
    fn a_chain_of_50_000_nodes() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::State(1)));
        let chain = |pool: &mut Pool, start| {
            (0..25_000).fold(start, |link, _| {
                let sine = pool.call(Function::Sin, &[link]);
                pool.add(sine, y)
            })
        };
        let of_x = chain(&mut pool, x);
        let z = pool.symbol(Symbol::State(2));
        let of_z = chain(&mut pool, z);
        assert!(pool.reachable(&[of_x]).len() > 50_000);
        let replace = |symbol| (symbol == Symbol::State(0)).then_some(z);
        assert_eq!(substitute(&mut pool, &[of_x], &replace), [of_z]);
    }
}
