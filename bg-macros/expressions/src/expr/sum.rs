//! Sums in canonical form.
//!
//! In: a constant and nodes with coefficients. Out: a number, a node, or a [`Node::Sum`].
//! Like terms are one term, dropped where its coefficients cancel to rounding (`0.1*x + 0.2*x - 0.3*x`); a scaled node
//! (`2*x`) counts as that node. A sum inside a sum stays a node of its own, so that it can be shared, unless some of
//! its addends merge with addends of the outer sum or cancel against those of another inner sum. Where a sum has two or
//! more addends (the constant counts), the coefficient of its first term is positive; its negative is that sum times
//! -1, so `a - b` and `b - a` share a node.

use std::collections::BTreeMap;

use super::{Id, Node, Number, Pool};

/// Coefficients cancel where their sum is below this part of them: it holds no digit of the exact sum.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A sum under construction.
struct Draft {
    constant: f64,
    terms: BTreeMap<Id, f64>,
}

impl Draft {
    /// Adds `coefficient * id` as it is.
    fn add(&mut self, id: Id, coefficient: f64) {
        let total = self.terms.get(&id).map_or(coefficient, |&present| combined(present, coefficient));
        if total == 0.0 {
            self.terms.remove(&id);
        } else {
            self.terms.insert(id, total);
        }
    }
}

/// The sum of two coefficients of one node; constants, in contrast, add up as at run time.
fn combined(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.abs() <= ROUNDING * a.abs() && a.is_finite() { 0.0 } else { sum }
}

impl Pool {
    /// `a + b`
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        self.linear(0.0, &[(a, 1.0), (b, 1.0)])
    }

    /// `a - b`
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        self.linear(0.0, &[(a, 1.0), (b, -1.0)])
    }

    /// `-a`
    pub fn neg(&mut self, a: Id) -> Id {
        self.scale(-1.0, a)
    }

    /// `factor * a`
    pub fn scale(&mut self, factor: f64, a: Id) -> Id {
        self.linear(0.0, &[(a, factor)])
    }

    /// Sum of all terms.
    pub fn sum(&mut self, terms: &[Id]) -> Id {
        let terms: Vec<_> = terms.iter().map(|&id| (id, 1.0)).collect();
        self.linear(0.0, &terms)
    }

    /// `constant` plus the sum of node times coefficient. A coefficient 0 removes its term, whatever the node.
    pub fn linear(&mut self, constant: f64, terms: &[(Id, f64)]) -> Id {
        if let (&[(id, coefficient)], true) = (terms, constant == 0.0)
            && let Some(scaled) = self.scaled_alone(id, coefficient)
        {
            return scaled;
        }
        let mut draft = Draft { constant, terms: BTreeMap::new() };
        for &(id, coefficient) in terms {
            self.include(&mut draft, id, coefficient);
        }
        while let Some(id) = self.merging(&draft) {
            self.flatten(&mut draft, id);
        }
        self.finish(&draft)
    }

    /// `coefficient * id`, where that is quick to say: nothing merges with one term, unless its addends vanish.
    fn scaled_alone(&mut self, id: Id, coefficient: f64) -> Option<Id> {
        if coefficient == 0.0 || self.as_number(id).is_some() {
            return None;
        }
        let (node, total) = self.as_scaled(id).map_or((id, coefficient), |(node, factor)| (node, coefficient * factor));
        let vanishes = |(constant, terms): (f64, &[(Id, Number)])| {
            (constant != 0.0 && total * constant == 0.0) || terms.iter().any(|(_, inner)| total * inner.value() == 0.0)
        };
        if total == 0.0 || self.as_addends(node).is_some_and(vanishes) {
            return None;
        }
        if total == 1.0 {
            return Some(node);
        }
        let terms = [(node, Number::new(total))].into();
        Some(self.intern(Node::Sum { constant: Number::new(0.0), terms }))
    }

    /// The node and its coefficient, where this is a scaled node.
    pub(super) fn as_scaled(&self, id: Id) -> Option<(Id, f64)> {
        match self.node(id) {
            Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => {
                Some((terms[0].0, terms[0].1.value()))
            }
            _ => None,
        }
    }

    /// Constant and terms, where this is a sum of two or more addends.
    fn as_addends(&self, id: Id) -> Option<(f64, &[(Id, Number)])> {
        match self.node(id) {
            Node::Sum { constant, terms } if terms.len() > 1 || constant.value() != 0.0 => {
                Some((constant.value(), terms))
            }
            _ => None,
        }
    }

    /// Adds `coefficient * id` to the draft: numbers to the constant, scaled nodes as the nodes.
    fn include(&self, draft: &mut Draft, id: Id, coefficient: f64) {
        if coefficient == 0.0 {
            return;
        }
        if let Some(value) = self.as_number(id) {
            draft.constant += coefficient * value;
        } else if let Some((node, factor)) = self.as_scaled(id) {
            draft.add(node, coefficient * factor);
        } else {
            draft.add(id, coefficient);
        }
    }

    /// Replaces an inner sum by its addends.
    fn flatten(&self, draft: &mut Draft, id: Id) {
        let (Some(factor), Some((constant, terms))) = (draft.terms.remove(&id), self.as_addends(id)) else { return };
        draft.constant += factor * constant;
        for &(inner, coefficient) in terms {
            self.include(draft, inner, factor * coefficient.value());
        }
    }

    /// The last inner sum with an addend that merges with the outer sum, or cancels against other inner sums.
    fn merging(&self, draft: &Draft) -> Option<Id> {
        let inner: Vec<_> = draft.terms.iter().filter_map(|(&id, &c)| Some((id, c, self.as_addends(id)?))).collect();
        if inner.is_empty() {
            return None;
        }
        let mut totals: BTreeMap<Id, f64> = BTreeMap::new();
        let mut constants = 0.0;
        for (_, factor, (constant, terms)) in &inner {
            constants += factor * constant;
            for (id, coefficient) in *terms {
                let total = totals.entry(*id).or_default();
                *total = combined(*total, factor * coefficient.value());
            }
        }
        let merges = |id: &Id| draft.terms.contains_key(id) || totals[id] == 0.0;
        let merges_constant = draft.constant != 0.0 || constants == 0.0;
        let found = inner.iter().rev().find(|(_, _, (constant, terms))| {
            (*constant != 0.0 && merges_constant) || terms.iter().any(|(id, _)| merges(id))
        });
        found.map(|(id, ..)| *id)
    }

    /// The node of a draft, with the canonical sign.
    fn finish(&mut self, draft: &Draft) -> Id {
        let Some((&first, &coefficient)) = draft.terms.first_key_value() else { return self.number(draft.constant) };
        let addends = draft.terms.len() + usize::from(draft.constant != 0.0);
        if addends == 1 && coefficient == 1.0 {
            return first;
        }
        if addends == 1 || coefficient > 0.0 {
            return self.store(draft, 1.0);
        }
        let opposite = self.store(draft, -1.0);
        let terms = [(opposite, Number::new(-1.0))].into();
        self.intern(Node::Sum { constant: Number::new(0.0), terms })
    }

    fn store(&mut self, draft: &Draft, sign: f64) -> Id {
        let terms = draft.terms.iter().map(|(&id, &coefficient)| (id, Number::new(sign * coefficient))).collect();
        self.intern(Node::Sum { constant: Number::new(sign * draft.constant), terms })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Symbol;

    fn letters(pool: &mut Pool) -> [Id; 4] {
        [0, 1, 2, 3].map(|index| pool.symbol(Symbol::State(index)))
    }

    fn node(constant: f64, terms: &[(Id, f64)]) -> Node {
        let terms = terms.iter().map(|(id, coefficient)| (*id, Number::new(*coefficient))).collect();
        Node::Sum { constant: Number::new(constant), terms }
    }

    #[test]
    fn numbers_fold() {
        let mut pool = Pool::new();
        let (two, three) = (pool.number(2.0), pool.number(3.0));
        assert_eq!(pool.add(two, three), pool.number(5.0));
        assert_eq!(pool.sub(two, two), pool.zero());
        assert_eq!(pool.neg(two), pool.number(-2.0));
        assert_eq!(pool.linear(1.0, &[(two, 3.0)]), pool.number(7.0));
        assert_eq!(pool.sum(&[]), pool.zero());
    }

    #[test]
    fn like_terms_are_one_term() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let double = pool.add(x, x);
        assert_eq!(*pool.node(double), node(0.0, &[(x, 2.0)]));
        assert_eq!(pool.sub(double, x), x);
        assert_eq!(pool.sub(x, x), pool.zero());
        assert_eq!(pool.scale(0.0, x), pool.zero());
        assert_eq!(pool.scale(1.0, x), x);
        let zero = pool.zero();
        assert_eq!(pool.add(x, zero), x);
        let sum = pool.linear(4.0, &[(y, 1.0), (double, -1.5), (y, 1.0)]);
        let opposite = pool.linear(-4.0, &[(y, -2.0), (x, 3.0)]);
        assert_eq!(*pool.node(opposite), node(-4.0, &[(x, 3.0), (y, -2.0)]));
        assert_eq!(sum, pool.neg(opposite));
        assert_eq!(pool.linear(0.0, &[(x, 0.1), (x, 0.2), (x, -0.3), (y, 1.0)]), y);
        assert_eq!(pool.linear(0.1, &[(pool.one(), 0.2)]), pool.number(0.1 + 0.2));
    }

    #[test]
    fn terms_are_sorted() {
        let mut pool = Pool::new();
        let [x, y, z, _] = letters(&mut pool);
        assert_eq!(pool.sum(&[z, x, y]), pool.sum(&[y, z, x]));
        assert_eq!(pool.add(x, y), pool.add(y, x));
    }

    #[test]
    fn the_first_coefficient_is_positive() {
        let mut pool = Pool::new();
        let [x, y, z, _] = letters(&mut pool);
        let (plus, minus) = (pool.sub(x, y), pool.sub(y, x));
        assert_eq!(*pool.node(plus), node(0.0, &[(x, 1.0), (y, -1.0)]));
        assert_eq!(*pool.node(minus), node(0.0, &[(plus, -1.0)]));
        assert_eq!(pool.neg(minus), plus);
        assert_eq!(pool.add(plus, minus), pool.zero());
        let (a, b) = (pool.sub(z, plus), pool.add(z, minus));
        assert_eq!(a, b);
        let (one_less, less_one) = (pool.linear(1.0, &[(x, -1.0)]), pool.linear(-1.0, &[(x, 1.0)]));
        assert_eq!(one_less, pool.neg(less_one));
        assert_eq!(*pool.node(one_less), node(0.0, &[(less_one, -1.0)]));
        let negative = pool.neg(x);
        assert_eq!(*pool.node(negative), node(0.0, &[(x, -1.0)]));
    }

    #[test]
    fn a_scaled_sum_stays_a_sum() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let sum = pool.add(x, y);
        let double = pool.scale(2.0, sum);
        assert_eq!(*pool.node(double), node(0.0, &[(sum, 2.0)]));
        assert_eq!(pool.scale(-0.5, double), pool.neg(sum));
    }

    #[test]
    fn an_addend_that_a_scale_makes_zero_is_left_out() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let sum = pool.linear(0.0, &[(x, 1e-200), (y, 1.0)]);
        assert_eq!(pool.scale(1e-200, sum), pool.scale(1e-200, y));
        let shifted = pool.linear(1e-200, &[(y, 1.0)]);
        assert_eq!(pool.scale(-1e-200, shifted), pool.scale(-1e-200, y));
        let small = pool.scale(1e-200, x);
        assert_eq!(pool.scale(1e-200, small), pool.zero());
    }

    #[test]
    fn inner_sums_stay_unless_terms_merge() {
        let mut pool = Pool::new();
        let [x, y, z, w] = letters(&mut pool);
        let sum = pool.add(x, y);
        let outer = pool.linear(0.0, &[(sum, 2.0), (z, 1.0)]);
        assert_eq!(*pool.node(outer), node(0.0, &[(z, 1.0), (sum, 2.0)]));
        assert_eq!(pool.sub(sum, x), y);
        let combined = pool.add(sum, x);
        assert_eq!(*pool.node(combined), node(0.0, &[(x, 2.0), (y, 1.0)]));
        assert_eq!(pool.sub(outer, z), pool.scale(2.0, sum));
        let other = pool.add(x, w);
        let cancelled = pool.sub(sum, other);
        assert_eq!(cancelled, pool.sub(y, w));
        let both = pool.add(sum, other);
        assert_eq!(*pool.node(both), node(0.0, &[(sum, 1.0), (other, 1.0)]));
    }

    #[test]
    fn inner_constants_merge_with_an_outer_constant() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let (left, right) = (pool.linear(1.0, &[(x, 1.0)]), pool.linear(1.0, &[(y, 1.0)]));
        assert_eq!(pool.linear(2.0, &[(left, 1.0)]), pool.linear(3.0, &[(x, 1.0)]));
        assert_eq!(pool.linear(-1.0, &[(left, 1.0)]), x);
        assert_eq!(pool.sub(left, right), pool.sub(x, y));
        let both = pool.add(left, right);
        assert_eq!(*pool.node(both), node(0.0, &[(left, 1.0), (right, 1.0)]));
    }

    #[test]
    fn merging_goes_all_the_way_down() {
        let mut pool = Pool::new();
        let symbols: Vec<_> = (0..40).map(|index| pool.symbol(Symbol::Parameter(index))).collect();
        let chain = symbols.iter().fold(pool.zero(), |sum, &x| pool.add(sum, x));
        let rest = symbols.iter().rev().fold(chain, |sum, &x| pool.sub(sum, x));
        assert_eq!(rest, pool.zero());
    }
}
