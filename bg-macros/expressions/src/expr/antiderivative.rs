//! Antiderivatives.
//!
//! In: a node and the symbol to integrate by. Out: the antiderivative that is 0 where the symbol is 0, or none.
//! Method: the node is expanded into a sum of terms `coefficient * wrt^n` and `coefficient * f(slope * wrt + offset)`,
//! and each term is integrated by table.

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use super::{Function, Id, Node, Pool, Symbol, children};

/// Gives up beyond this many terms, and beyond this exponent.
const MOST_TERMS: usize = 1000;

/// A function of `slope * wrt + offset`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Shape {
    function: Function,
    slope: Id,
    offset: Id,
}

/// Coefficients, free of the symbol, of `wrt^n` and of `wrt^n * f(..)`.
type Terms = BTreeMap<(u32, Option<Shape>), Id>;

/// The antiderivative of `of` by `wrt` that is 0 at `wrt` = 0, where `of` is a sum of terms free of `wrt` times a power
/// of `wrt` or times sin, cos, exp or tanh of an argument linear in `wrt`. A slope of such an argument must not be 0.
pub fn antiderivative(pool: &mut Pool, of: Id, wrt: Symbol) -> Option<Id> {
    let mut expansion = Expansion { pool, wrt, dependent: FxHashMap::default() };
    expansion.expand(of)?;
    let terms = expansion.terms(of);
    let symbol = pool.symbol(wrt);
    let parts: Option<Vec<_>> = terms.iter().map(|(&key, &factor)| integral(pool, symbol, key, factor)).collect();
    Some(pool.sum(&parts?))
}

/// The expansion of every node that contains the symbol.
struct Expansion<'p> {
    pool: &'p mut Pool,
    wrt: Symbol,
    dependent: FxHashMap<Id, Terms>,
}

impl Expansion<'_> {
    /// Expands the node and all that it is made of.
    fn expand(&mut self, root: Id) -> Option<()> {
        let mut contains: FxHashSet<Id> = FxHashSet::default();
        for id in self.pool.reachable(&[root]) {
            let node = self.pool.node(id);
            if *node == Node::Symbol(self.wrt) || children(node).any(|child| contains.contains(&child)) {
                contains.insert(id);
                let terms = self.expansion(id)?;
                self.dependent.insert(id, terms);
            }
        }
        Some(())
    }

    /// The terms of a node that is expanded or free of the symbol.
    fn terms(&self, id: Id) -> Terms {
        self.dependent.get(&id).cloned().unwrap_or_else(|| Terms::from([((0, None), id)]))
    }

    /// The terms of a node that contains the symbol, from those of its children.
    fn expansion(&mut self, id: Id) -> Option<Terms> {
        match self.pool.node(id).clone() {
            Node::Number(_) | Node::Select { .. } => None,
            Node::Symbol(_) => Some(Terms::from([((1, None), self.pool.one())])),
            Node::Sum { constant, terms } => {
                let (mut sum, constant) = (Terms::new(), self.pool.number(constant.value()));
                self.include(&mut sum, (0, None), constant)?;
                for (term, coefficient) in terms.iter() {
                    for (key, factor) in self.terms(*term) {
                        let factor = self.pool.scale(coefficient.value(), factor);
                        self.include(&mut sum, key, factor)?;
                    }
                }
                Some(sum)
            }
            Node::Product(factors) => self.product(&factors),
            Node::Call(function, arguments) => self.call(function, &arguments),
        }
    }

    fn product(&mut self, factors: &[(Id, i32)]) -> Option<Terms> {
        let (inner, free): (Vec<_>, Vec<_>) = factors.iter().partition(|(id, _)| self.dependent.contains_key(id));
        let mut product = Terms::from([((0, None), self.pool.powers(&free))]);
        for (id, exponent) in inner {
            let exponent = usize::try_from(exponent).ok().filter(|exponent| *exponent <= MOST_TERMS)?;
            let terms = self.terms(id);
            for _ in 0..exponent {
                product = self.multiplied(&product, &terms)?;
            }
        }
        Some(product)
    }

    fn multiplied(&mut self, left: &Terms, right: &Terms) -> Option<Terms> {
        let mut product = Terms::new();
        for (&(left_power, left_shape), &a) in left {
            for (&(right_power, right_shape), &b) in right {
                if left_shape.is_some() && right_shape.is_some() {
                    return None;
                }
                let factor = self.pool.mul(a, b);
                self.include(&mut product, (left_power + right_power, left_shape.or(right_shape)), factor)?;
            }
        }
        Some(product)
    }

    fn call(&mut self, function: Function, arguments: &[Id]) -> Option<Terms> {
        if !matches!(function, Function::Sin | Function::Cos | Function::Exp | Function::Tanh) {
            return None;
        }
        let argument = self.terms(arguments[0]);
        if argument.keys().any(|(power, shape)| *power > 1 || shape.is_some()) {
            return None;
        }
        let coefficient = |power| argument.get(&(power, None)).copied();
        let offset = coefficient(0).unwrap_or(self.pool.zero());
        Some(match coefficient(1) {
            None => Terms::from([((0, None), self.pool.call(function, &[offset]))]),
            Some(slope) => Terms::from([((0, Some(Shape { function, slope, offset })), self.pool.one())]),
        })
    }

    /// Adds a term; a term 0 is left out.
    fn include(&mut self, terms: &mut Terms, key: (u32, Option<Shape>), factor: Id) -> Option<()> {
        let total = terms.get(&key).map_or(factor, |&present| self.pool.add(present, factor));
        if self.pool.is_zero(total) {
            terms.remove(&key);
        } else {
            terms.insert(key, total);
        }
        (terms.len() <= MOST_TERMS).then_some(())
    }
}

/// The integral of one term from 0.
fn integral(pool: &mut Pool, symbol: Id, (power, shape): (u32, Option<Shape>), factor: Id) -> Option<Id> {
    let Some(Shape { function, slope, offset }) = shape else {
        let exponent = i32::try_from(power + 1).ok()?;
        let integral = pool.powers(&[(factor, 1), (symbol, exponent)]);
        return Some(pool.scale(1.0 / f64::from(exponent), integral));
    };
    if power > 0 {
        return None;
    }
    let advance = pool.mul(slope, symbol);
    let end = pool.add(advance, offset);
    let (end, start) = (primitive(pool, function, end), primitive(pool, function, offset));
    let difference = pool.sub(end, start);
    Some(pool.powers(&[(factor, 1), (difference, 1), (slope, -1)]))
}

/// A primitive of sin, cos, exp or tanh at u.
fn primitive(pool: &mut Pool, function: Function, u: Id) -> Id {
    match function {
        Function::Sin => {
            let cosine = pool.call(Function::Cos, &[u]);
            pool.neg(cosine)
        }
        Function::Cos => pool.call(Function::Sin, &[u]),
        Function::Tanh => logarithm_of_cosh(pool, u),
        _ => pool.call(function, &[u]),
    }
}

/// ln(cosh(u)) as `|u| + ln((1 + exp(-2 |u|)) / 2)`, which does not overflow.
fn logarithm_of_cosh(pool: &mut Pool, u: Id) -> Id {
    let size = pool.call(Function::Abs, &[u]);
    let exponent = pool.scale(-2.0, size);
    let decay = pool.call(Function::Exp, &[exponent]);
    let half = pool.linear(0.5, &[(decay, 0.5)]);
    let logarithm = pool.call(Function::Ln, &[half]);
    pool.add(size, logarithm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, derivative, evaluate, same_polynomial};

    const WRT: Symbol = Symbol::State(0);

    fn symbols(pool: &mut Pool) -> [Id; 4] {
        [0, 1, 2, 3].map(|index| pool.symbol(Symbol::State(index)))
    }

    /// Whether the antiderivative differentiates back and is 0 at 0, by values.
    fn check(pool: &mut Pool, of: Id) {
        let integral = antiderivative(pool, of, WRT).expect("has an antiderivative");
        let seeds = BTreeMap::from([(WRT, pool.one())]);
        let back = derivative(pool, &[integral], &seeds)[0];
        for x in [-3.0, -0.4, 0.3, 2.5] {
            let environment = Environment { states: &[x, 1.25, -0.75, 0.5], ..Environment::default() };
            let values = evaluate(pool, &[of, back], &environment);
            assert!((values[0] - values[1]).abs() < 1e-12 * (1.0 + values[0].abs()), "{values:?}");
        }
        let start = Environment { states: &[0.0, 1.25, -0.75, 0.5], ..Environment::default() };
        assert_eq!(evaluate(pool, &[integral], &start), [0.0]);
    }

    #[test]
    fn polynomials() {
        let mut pool = Pool::new();
        let [x, a, b, c] = symbols(&mut pool);
        let linear = pool.linear(2.0, &[(x, 3.0), (b, -1.0)]);
        let power = pool.powi(linear, 3);
        let sum = pool.add(a, c);
        let product = pool.powers(&[(power, 1), (sum, 2), (x, 1), (c, -1)]);
        let more = pool.linear(1.0, &[(product, 0.5), (x, -2.0)]);
        for of in [x, a, power, product, more, pool.zero(), pool.one()] {
            check(&mut pool, of);
        }
        let square = pool.powi(x, 2);
        let half = pool.scale(0.5, square);
        assert_eq!(antiderivative(&mut pool, x, WRT), Some(half));
        let whole = pool.mul(sum, x);
        assert_eq!(antiderivative(&mut pool, sum, WRT), Some(whole));
    }

    #[test]
    fn functions() {
        let mut pool = Pool::new();
        let [x, a, b, c] = symbols(&mut pool);
        let slope = pool.add(a, c);
        let advance = pool.mul(slope, x);
        let argument = pool.sub(b, advance);
        for function in [Function::Sin, Function::Cos, Function::Exp, Function::Tanh] {
            for argument in [x, argument] {
                let call = pool.call(function, &[argument]);
                let scaled = pool.mul(a, call);
                let mixed = pool.linear(1.0, &[(scaled, -3.0), (x, 2.0)]);
                check(&mut pool, call);
                check(&mut pool, mixed);
            }
        }
        let call = pool.call(Function::Tanh, &[x]);
        let integral = antiderivative(&mut pool, call, WRT).unwrap();
        let far = Environment { states: &[-2000.0], ..Environment::default() };
        assert_eq!(evaluate(&pool, &[integral], &far), [2000.0 - 2.0_f64.ln()]);
    }

    #[test]
    fn a_hidden_slope_of_zero() {
        let mut pool = Pool::new();
        let [x, a, b, _] = symbols(&mut pool);
        let (sum, product, other) = (pool.add(x, a), pool.mul(x, b), pool.mul(a, b));
        let whole = pool.mul(sum, b);
        let argument = pool.linear(0.0, &[(whole, 1.0), (product, -1.0), (other, 1.0)]);
        let sine = pool.call(Function::Sin, &[argument]);
        let integral = antiderivative(&mut pool, sine, WRT).unwrap();
        let double = pool.scale(2.0, other);
        let sine = pool.call(Function::Sin, &[double]);
        let expected = pool.mul(sine, x);
        assert!(same_polynomial(&mut pool, integral, expected));
    }

    #[test]
    fn what_has_none() {
        let mut pool = Pool::new();
        let [x, a, ..] = symbols(&mut pool);
        let (sine, square) = (pool.call(Function::Sin, &[x]), pool.powi(x, 2));
        let sum = pool.linear(1.0, &[(x, 1.0)]);
        let of = [
            pool.powi(x, -1),
            pool.powi(sum, -1),
            pool.powi(sine, 2),
            pool.mul(sine, x),
            pool.call(Function::Sin, &[square]),
            pool.call(Function::Sin, &[sine]),
            pool.call(Function::Sqrt, &[x]),
            pool.call(Function::Abs, &[x]),
            pool.select(0, x, a),
            pool.powi(sum, 5000),
        ];
        assert!(of.into_iter().all(|of| antiderivative(&mut pool, of, WRT).is_none()));
        let free = pool.select(0, a, square);
        let free = pool.add(free, sine);
        let other = antiderivative(&mut pool, free, Symbol::State(1));
        assert_eq!(other, None);
        let other = antiderivative(&mut pool, free, Symbol::State(2)).unwrap();
        let b = pool.symbol(Symbol::State(2));
        assert_eq!(other, pool.mul(free, b));
    }
}
