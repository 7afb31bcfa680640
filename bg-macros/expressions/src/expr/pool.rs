//! The store of nodes: equal nodes are stored once.
//!
//! In: nodes in canonical form, from the constructors in `sum`, `product` and `function`. Out: their [`Id`]s; a node's
//! children have smaller ids than the node itself.
//! Method: hash-consing (Ershov 1958, On programming of arithmetic operations).

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::{Id, Node, Number, Symbol};

/// A graph of expressions in which equal nodes are stored once.
#[derive(Clone, Debug)]
pub struct Pool {
    nodes: Vec<Node>,
    /// For look-up only; never iterated.
    ids: FxHashMap<Node, Id>,
}

const ZERO: Id = Id(0);
const ONE: Id = Id(1);

impl Default for Pool {
    fn default() -> Self {
        Self::new()
    }
}

#[allow(clippy::len_without_is_empty, reason = "a pool is never empty: it always has 0 and 1")]
impl Pool {
    /// A pool with the numbers 0 and 1.
    #[must_use]
    pub fn new() -> Self {
        let mut pool = Self { nodes: Vec::new(), ids: FxHashMap::default() };
        pool.number(0.0);
        pool.number(1.0);
        pool
    }

    /// The node of this id.
    #[must_use]
    pub fn node(&self, id: Id) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// A number.
    pub fn number(&mut self, value: f64) -> Id {
        self.intern(Node::Number(Number::new(value)))
    }

    /// The number 0.
    #[must_use]
    pub fn zero(&self) -> Id {
        ZERO
    }

    /// The number 1.
    #[must_use]
    pub fn one(&self) -> Id {
        ONE
    }

    /// A quantity that the expression does not define.
    pub fn symbol(&mut self, symbol: Symbol) -> Id {
        self.intern(Node::Symbol(symbol))
    }

    /// Whether this is the number 0.
    #[must_use]
    pub fn is_zero(&self, id: Id) -> bool {
        id == ZERO
    }

    /// The value, where this is a number.
    #[must_use]
    pub fn as_number(&self, id: Id) -> Option<f64> {
        if let Node::Number(number) = self.node(id) { Some(number.value()) } else { None }
    }

    /// All nodes that the roots are made of, the roots included; ascending, so children come before parents.
    #[must_use]
    pub fn reachable(&self, roots: &[Id]) -> Vec<Id> {
        // A bit for each node up to the last root, whose children are below it: a walk downwards meets parents first.
        let Some(last) = roots.iter().max() else { return Vec::new() };
        let mut seen = vec![0_u64; last.0 as usize / 64 + 1];
        let mark = |seen: &mut Vec<u64>, Id(id): Id| seen[id as usize / 64] |= 1 << (id % 64);
        roots.iter().for_each(|&root| mark(&mut seen, root));
        let mut found = Vec::new();
        for word in (0..seen.len()).rev() {
            let mut below = u64::MAX;
            while seen[word] & below != 0 {
                let bit = (seen[word] & below).ilog2();
                below = (1 << bit) - 1;
                let id = Id(64 * u32::try_from(word).expect("a pool has fewer than 2^32 nodes") + bit);
                found.push(id);
                children(self.node(id)).for_each(|child| mark(&mut seen, child));
            }
        }
        found.reverse();
        found
    }

    /// About how many operations the nodes take, each node once, before common factors are taken out.
    #[must_use]
    pub fn cost(&self, roots: &[Id]) -> usize {
        let cost = |id: Id| match self.node(id) {
            Node::Number(_) | Node::Symbol(_) => 0,
            Node::Sum { constant, terms } => {
                let scaled = terms.iter().filter(|(_, factor)| factor.value().abs() != 1.0).count();
                scaled + terms.len() - usize::from(constant.value() == 0.0)
            }
            Node::Product(factors) => factors.iter().map(|(_, power)| power.unsigned_abs() as usize).sum::<usize>() - 1,
            Node::Call(..) | Node::Select { .. } => 1,
        };
        self.reachable(roots).into_iter().map(cost).sum()
    }

    /// All symbols that the roots contain.
    #[must_use]
    pub fn symbols(&self, roots: &[Id]) -> BTreeSet<Symbol> {
        let symbol = |id| if let Node::Symbol(symbol) = self.node(id) { Some(*symbol) } else { None };
        self.reachable(roots).into_iter().filter_map(symbol).collect()
    }

    /// Whether the roots contain a switched value.
    #[must_use]
    pub fn has_select(&self, roots: &[Id]) -> bool {
        self.reachable(roots).into_iter().any(|id| matches!(self.node(id), Node::Select { .. }))
    }

    /// Gives each state another index, `to[k]` for `k`; the indices are the same as a set. Nodes keep their ids, and so
    /// the order of what they are sums and products of.
    pub fn renumber_states(&mut self, to: &[u32]) {
        let mut renumbered = Vec::new();
        for (node, id) in self.nodes.iter_mut().zip((0..).map(Id)) {
            let Node::Symbol(Symbol::State(index)) = *node else { continue };
            if let Some(&to) = to.get(index as usize) {
                self.ids.remove(node);
                *node = Node::Symbol(Symbol::State(to));
                renumbered.push((node.clone(), id));
            }
        }
        self.ids.extend(renumbered);
    }

    /// The id of a node in canonical form; stores the node if it is new.
    pub(super) fn intern(&mut self, node: Node) -> Id {
        if let Some(&id) = self.ids.get(&node) {
            return id;
        }
        let id = Id(u32::try_from(self.nodes.len()).expect("a pool has fewer than 2^32 nodes"));
        self.nodes.push(node.clone());
        self.ids.insert(node, id);
        id
    }
}

/// The nodes that this node is made of, ascending in sums and products, in order of the arguments elsewhere.
pub fn children(node: &Node) -> impl Iterator<Item = Id> {
    let (mut terms, mut factors, mut arguments, mut branches) = (&[][..], &[][..], &[][..], [None; 2]);
    match node {
        Node::Number(_) | Node::Symbol(_) => {}
        Node::Sum { terms: all, .. } => terms = all,
        Node::Product(all) => factors = all,
        Node::Call(_, all) => arguments = all,
        Node::Select { negative, positive, .. } => branches = [Some(*negative), Some(*positive)],
    }
    let terms = terms.iter().map(|&(id, _): &(Id, Number)| id);
    let factors = factors.iter().map(|&(id, _): &(Id, i32)| id);
    terms.chain(factors).chain(arguments.iter().copied()).chain(branches.into_iter().flatten())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Function, evaluate, random};

    #[test]
    fn equal_nodes_are_stored_once() {
        let mut pool = Pool::new();
        assert_eq!((pool.as_number(pool.zero()), pool.as_number(pool.one())), (Some(0.0), Some(1.0)));
        assert_eq!(pool.number(-0.0), pool.zero());
        assert!(pool.is_zero(pool.zero()) && !pool.is_zero(pool.one()));
        let x = pool.symbol(Symbol::State(7));
        assert_eq!(pool.symbol(Symbol::State(7)), x);
        assert_ne!(pool.symbol(Symbol::Input(7)), x);
        assert_eq!(pool.len(), 4);
    }

    #[test]
    fn same_input_same_ids() {
        let build = || {
            let mut pool = Pool::new();
            let roots = random::Source::new(11).expressions(&mut pool, 500);
            (pool, roots)
        };
        let ((left, left_roots), (right, right_roots)) = (build(), build());
        assert_eq!(left_roots, right_roots);
        assert_eq!(left.nodes, right.nodes);
    }

    #[test]
    fn every_node_is_canonical() {
        let mut pool = Pool::new();
        random::Source::new(5).expressions(&mut pool, 2000);
        for (index, node) in pool.nodes.iter().enumerate() {
            assert!(children(node).all(|child| (child.0 as usize) < index));
            match node {
                Node::Sum { constant, terms } => {
                    let addends = terms.len() + usize::from(constant.value() != 0.0);
                    assert!(terms.iter().map(|(id, _)| id).is_sorted_by(|a, b| a < b));
                    assert!(terms.iter().all(|(id, c)| c.value() != 0.0 && pool.as_scaled(*id).is_none()));
                    assert!(terms.iter().all(|(id, _)| pool.as_number(*id).is_none()));
                    assert!(if addends == 1 { terms[0].1.value() != 1.0 } else { terms[0].1.value() > 0.0 });
                }
                Node::Product(factors) => {
                    assert!(factors.iter().map(|(id, _)| id).is_sorted_by(|a, b| a < b));
                    for (id, exponent) in factors.iter() {
                        let is_root = matches!(pool.node(*id), Node::Call(Function::Sqrt, _));
                        assert!(*exponent != 0 && pool.as_scaled(*id).is_none() && pool.as_number(*id).is_none());
                        assert!(!matches!(pool.node(*id), Node::Product(_)) && (!is_root || exponent.abs() == 1));
                    }
                    assert!(factors.len() > 1 || factors[0].1 != 1);
                }
                _ => {}
            }
        }
    }

    #[test]
    fn constructors_keep_values() {
        let environment =
            Environment { states: &[0.4, -1.3, 0.7, 2.1], negative: &[true, false], ..Environment::default() };
        for seed in 0..20 {
            let mut pool = Pool::new();
            let roots = random::Source::new(seed).expressions(&mut pool, 24);
            let values = evaluate(&pool, &roots, &environment);
            for (a, b) in (0..24).flat_map(|a| (0..24).map(move |b| (a, b))) {
                let (left, right, x, y) = (roots[a], roots[b], values[a], values[b]);
                let linear = pool.linear(2.0, &[(left, 3.0), (right, -0.5)]);
                let made =
                    [pool.add(left, right), pool.sub(left, right), pool.mul(left, right), linear, pool.powi(left, 3)];
                let expected = [x + y, x - y, x * y, 2.0 + 3.0 * x - 0.5 * y, x.powi(3)];
                for (value, expected) in evaluate(&pool, &made, &environment).into_iter().zip(expected) {
                    let scale = 1.0 + x.abs() + y.abs() + expected.abs();
                    assert!((value - expected).abs() < 1e-10 * scale, "seed {seed}: {value} {expected}");
                }
            }
        }
    }

    #[test]
    fn reachable_nodes_and_symbols() {
        let mut pool = Pool::new();
        let (x, y) = (pool.symbol(Symbol::State(0)), pool.symbol(Symbol::Parameter(0)));
        let sine = pool.call(Function::Sin, &[x]);
        let select = pool.select(0, sine, y);
        let square = pool.powi(sine, 2);
        assert_eq!(pool.reachable(&[square, sine]), [x, sine, square]);
        assert_eq!(pool.reachable(&[select]), [x, y, sine, select]);
        assert_eq!(pool.symbols(&[square]), BTreeSet::from([Symbol::State(0)]));
        assert_eq!(pool.symbols(&[select]), BTreeSet::from([Symbol::State(0), Symbol::Parameter(0)]));
        assert!(pool.reachable(&[]).is_empty());
    }
}
