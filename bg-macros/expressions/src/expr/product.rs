//! Products and powers in canonical form.
//!
//! In: nodes with whole exponents. Out: a number, a node, a [`Node::Product`], or one of these times a number.
//! Numbers and signs stand in front of the product, powers of one base are one factor, an inner product is flattened,
//! the square of a square root is its argument, and `x^2/abs(x)` is `abs(x)`. `x/x` is 1 for every x; a zero factor
//! makes the product 0, and 1/0 is the number infinity. A power beyond [`MOST_EXPONENT`] is a call of `pow`, so that
//! exponents never overflow.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Function, Id, Node, Pool};

/// The largest size of an exponent in a product.
pub(crate) const MOST_EXPONENT: i32 = 1024;

/// A product under construction.
struct Draft {
    coefficient: f64,
    factors: BTreeMap<Id, i32>,
}

impl Draft {
    fn multiply(&mut self, base: Id, exponent: i32) {
        let total = self.factors.get(&base).map_or(exponent, |present| present.saturating_add(exponent));
        if total == 0 {
            self.factors.remove(&base);
        } else {
            self.factors.insert(base, total);
        }
    }
}

impl Pool {
    /// `a * b`
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        self.powers(&[(a, 1), (b, 1)])
    }

    /// `a / b`
    pub fn div(&mut self, a: Id, b: Id) -> Id {
        self.powers(&[(a, 1), (b, -1)])
    }

    /// `a` to a whole power.
    pub fn powi(&mut self, a: Id, exponent: i32) -> Id {
        self.powers(&[(a, exponent)])
    }

    /// Product of all factors.
    pub fn product(&mut self, factors: &[Id]) -> Id {
        let factors: Vec<_> = factors.iter().map(|&id| (id, 1)).collect();
        self.powers(&factors)
    }

    /// Product of node to the power of exponent.
    pub(super) fn powers(&mut self, factors: &[(Id, i32)]) -> Id {
        if factors.iter().any(|&(id, exponent)| exponent > 0 && self.is_zero(id)) {
            return self.zero();
        }
        let mut draft = Draft { coefficient: 1.0, factors: BTreeMap::new() };
        for &(id, exponent) in factors {
            self.multiply(&mut draft, id, exponent);
        }
        while let Some((root, argument, exponent)) = self.whole_power_of_root(&draft) {
            draft.multiply(root, -(exponent / 2 * 2));
            self.multiply(&mut draft, argument, exponent / 2);
        }
        while let Some((size, argument)) = self.square_over_size(&draft) {
            draft.multiply(argument, -2);
            draft.multiply(size, 2);
        }
        self.complete(draft)
    }

    /// Multiplies the draft by `id^exponent`: numbers and scales into the coefficient, products by their factors.
    fn multiply(&self, draft: &mut Draft, id: Id, exponent: i32) {
        if exponent == 0 {
            return;
        }
        if let Some((node, scale)) = self.as_scaled(id) {
            draft.coefficient *= scale.powi(exponent);
            return self.multiply(draft, node, exponent);
        }
        match self.node(id) {
            Node::Number(number) => draft.coefficient *= number.value().powi(exponent),
            Node::Product(factors) => {
                for &(base, inner) in factors.iter() {
                    draft.multiply(base, inner.saturating_mul(exponent));
                }
            }
            _ => draft.multiply(id, exponent),
        }
    }

    /// A square root in a power beyond ±1, with its argument and its exponent.
    fn whole_power_of_root(&self, draft: &Draft) -> Option<(Id, Id, i32)> {
        draft.factors.iter().find_map(|(&id, &exponent)| match self.node(id) {
            Node::Call(Function::Sqrt, arguments) if exponent.unsigned_abs() > 1 => Some((id, arguments[0], exponent)),
            _ => None,
        })
    }

    /// `abs(x)` that the square of `x` is divided by, and `x`: derivatives of `x*abs(x)` have it, and a value at 0
    /// without it.
    fn square_over_size(&self, draft: &Draft) -> Option<(Id, Id)> {
        draft.factors.iter().find_map(|(&id, &exponent)| match self.node(id) {
            Node::Call(Function::Abs, arguments) if exponent < 0 => {
                let squared = draft.factors.get(&arguments[0]).is_some_and(|&exponent| exponent > 1);
                squared.then_some((id, arguments[0]))
            }
            _ => None,
        })
    }

    /// The draft with calls of `pow` in place of its large powers.
    fn without_large_powers(&mut self, mut draft: Draft) -> Draft {
        let factors = draft.factors.iter().map(|(&id, &exponent)| (id, exponent));
        let large: Vec<_> = factors.filter(|(_, exponent)| exponent.unsigned_abs() > MOST_EXPONENT as u32).collect();
        for (base, exponent) in large {
            draft.factors.remove(&base);
            let exponent = self.number(f64::from(exponent));
            let power = self.call(Function::Pow, &[base, exponent]);
            draft.multiply(power, 1);
        }
        draft
    }

    fn complete(&mut self, draft: Draft) -> Id {
        let draft = self.without_large_powers(draft);
        let factors: Arc<[_]> = draft.factors.into_iter().collect();
        let product = match *factors {
            [] => return self.number(draft.coefficient),
            [(base, 1)] => base,
            _ => self.intern(Node::Product(factors)),
        };
        self.scale(draft.coefficient, product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Symbol;

    fn letters(pool: &mut Pool) -> [Id; 4] {
        [0, 1, 2, 3].map(|index| pool.symbol(Symbol::State(index)))
    }

    #[test]
    fn numbers_fold_and_stand_in_front() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let (two, three) = (pool.number(2.0), pool.number(3.0));
        assert_eq!(pool.mul(two, three), pool.number(6.0));
        assert_eq!(pool.div(three, two), pool.number(1.5));
        assert_eq!(pool.mul(two, x), pool.scale(2.0, x));
        assert_eq!(pool.product(&[]), pool.one());
        let (double, triple, product) = (pool.scale(2.0, x), pool.scale(-3.0, y), pool.mul(x, y));
        assert_eq!(pool.mul(double, triple), pool.scale(-6.0, product));
        assert_eq!(*pool.node(product), Node::Product([(x, 1), (y, 1)].into()));
        let (one, zero) = (pool.one(), pool.zero());
        assert_eq!(pool.mul(one, x), x);
        assert_eq!(pool.mul(x, zero), zero);
    }

    #[test]
    fn a_square_over_its_size_has_a_value_at_zero() {
        let mut pool = Pool::new();
        let [x, ..] = letters(&mut pool);
        let size = pool.call(Function::Abs, &[x]);
        let square = pool.powi(x, 2);
        assert_eq!(pool.div(square, size), size);
        let drag = pool.mul(x, size);
        let slope = crate::expr::partial(&mut pool, &[drag], Symbol::State(0))[0];
        assert_eq!(slope, pool.scale(2.0, size));
        // Odd powers keep the sign: x^3/abs(x)^3 is x/abs(x).
        let cubes = [pool.powi(x, 3), pool.powi(size, 3)];
        let ratio = pool.div(cubes[0], cubes[1]);
        assert_eq!(ratio, pool.div(x, size));
    }

    #[test]
    fn signs_of_sums_stand_in_front() {
        let mut pool = Pool::new();
        let [x, y, z, _] = letters(&mut pool);
        let (plus, minus) = (pool.sub(x, y), pool.sub(y, x));
        let (left, right) = (pool.mul(plus, z), pool.mul(minus, z));
        assert_eq!(right, pool.neg(left));
        assert_eq!(pool.powi(plus, 2), pool.powi(minus, 2));
        let square = pool.powi(plus, 2);
        assert_eq!(pool.mul(plus, minus), pool.neg(square));
    }

    #[test]
    fn powers_combine() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let square = pool.mul(x, x);
        assert_eq!(*pool.node(square), Node::Product([(x, 2)].into()));
        assert_eq!(pool.powi(x, 2), square);
        assert_eq!(pool.div(x, x), pool.one());
        assert_eq!(pool.div(square, x), x);
        assert_eq!(pool.powi(x, 0), pool.one());
        assert_eq!(pool.powi(x, 1), x);
        let (scaled, ratio) = (pool.scale(-2.0, x), pool.div(x, y));
        let cube = pool.powi(x, 3);
        assert_eq!(pool.powi(scaled, 3), pool.scale(-8.0, cube));
        assert_eq!(pool.powi(ratio, -2), pool.powers(&[(x, -2), (y, 2)]));
        let product = pool.mul(ratio, square);
        assert_eq!(*pool.node(product), Node::Product([(x, 3), (y, -1)].into()));
    }

    #[test]
    fn squares_of_roots_are_arguments() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let sum = pool.linear(0.0, &[(x, 1.0), (y, 2.0)]);
        let product = pool.scale(-3.0, sum);
        let roots = [sum, product].map(|argument| pool.call(Function::Sqrt, &[argument]));
        assert_eq!(pool.powi(roots[0], 2), sum);
        assert_eq!(pool.mul(roots[1], roots[1]), product);
        assert_eq!(pool.powi(roots[0], -2), pool.powi(sum, -1));
        assert_eq!(pool.powi(roots[0], 5), pool.powers(&[(roots[0], 1), (sum, 2)]));
        assert_eq!(pool.powi(roots[0], -3), pool.powers(&[(roots[0], -1), (sum, -1)]));
        let nested = pool.call(Function::Sqrt, &[roots[0]]);
        assert_eq!(pool.powi(nested, 4), sum);
    }

    #[test]
    fn large_powers_are_calls() {
        let mut pool = Pool::new();
        let [x, y, ..] = letters(&mut pool);
        let largest = pool.powi(x, MOST_EXPONENT);
        assert_eq!(*pool.node(largest), Node::Product([(x, MOST_EXPONENT)].into()));
        let exponent = pool.number(2048.0);
        let call = pool.call(Function::Pow, &[x, exponent]);
        assert_eq!(pool.mul(largest, largest), call);
        let mut tower = pool.mul(x, y);
        for _ in 0..50 {
            tower = pool.powi(tower, -16);
        }
        for id in pool.reachable(&[tower]) {
            if let Node::Product(factors) = pool.node(id) {
                assert!(factors.iter().all(|(_, exponent)| exponent.abs() <= MOST_EXPONENT));
            }
        }
    }

    #[test]
    fn division_by_zero_is_infinite() {
        let mut pool = Pool::new();
        let [x, ..] = letters(&mut pool);
        let (zero, one) = (pool.zero(), pool.one());
        assert_eq!(pool.div(one, zero), pool.number(f64::INFINITY));
        assert_eq!(pool.div(x, zero), pool.scale(f64::INFINITY, x));
        assert_eq!(pool.div(zero, zero), zero);
        let infinite = pool.div(one, zero);
        assert_eq!(pool.mul(zero, infinite), zero);
    }
}
