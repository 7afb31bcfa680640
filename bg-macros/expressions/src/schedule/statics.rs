//! Arithmetic of the values that are known before a routine runs.
//!
//! In: nodes of numbers (and, in a routine, parameters). Out: their signs, magnitudes, common factors and exact
//! quotients. Method: each is read as a monomial, number * product of node^exponent. A common factor never needs a
//! division by a parameter, which may be zero.

use rustc_hash::FxHashMap;

use crate::expr::{Id, Node, Pool};

/// number * product of node^exponent, factors sorted by node.
#[derive(Clone, Debug)]
struct Monomial {
    number: f64,
    factors: Vec<(Id, i32)>,
}

/// The pool, with what was found out about its static nodes.
pub(super) struct Statics<'a> {
    /// Where the static nodes live.
    pub(super) pool: &'a mut Pool,
    /// The number one.
    pub(super) one: Id,
    magnitudes: FxHashMap<Id, (bool, Id)>,
    commons: FxHashMap<(Id, Id), Common>,
}

/// Two static values over their common factor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Common {
    /// The common factor.
    pub(super) factor: Id,
    /// The first value over it.
    pub(super) first: Id,
    /// The second value over it.
    pub(super) second: Id,
}

impl<'a> Statics<'a> {
    /// The arithmetic over this pool.
    pub(super) fn new(pool: &'a mut Pool) -> Self {
        let one = pool.one();
        Self { pool, one, magnitudes: FxHashMap::default(), commons: FxHashMap::default() }
    }

    /// Whether the value is -1 or 1, which a product leaves out.
    pub(super) fn is_unit(&self, id: Id) -> bool {
        id == self.one || self.pool.as_number(id).is_some_and(|number| number.abs() == 1.0)
    }

    /// Whether the value is written with a minus, and the value without it.
    pub(super) fn magnitude(&mut self, id: Id) -> (bool, Id) {
        if id == self.one {
            return (false, id);
        }
        if let Some(&known) = self.magnitudes.get(&id) {
            return known;
        }
        let Monomial { number, factors } = self.monomial(id);
        let magnitude = self.compose(&Monomial { number: number.abs(), factors });
        let result = (number < 0.0, magnitude);
        self.magnitudes.insert(id, result);
        result
    }

    /// Whether the value is written with a minus.
    pub(super) fn is_negative(&mut self, id: Id) -> bool {
        self.magnitude(id).0
    }

    /// The product of two values.
    pub(super) fn times(&mut self, left: Id, right: Id) -> Id {
        if left == self.one {
            right
        } else if right == self.one {
            left
        } else {
            self.pool.mul(left, right)
        }
    }

    /// The value, negated if asked to.
    pub(super) fn signed(&mut self, negative: bool, id: Id) -> Id {
        if negative { self.pool.neg(id) } else { id }
    }

    /// The common factor of two values and what it leaves of them. It takes the first value's number, so that the first
    /// remainder is positive and has no number, unless the second remainder would leave the range of numbers.
    pub(super) fn common(&mut self, first: Id, second: Id) -> Common {
        if first == self.one {
            return Common { factor: first, first, second };
        }
        if let Some(&known) = self.commons.get(&(first, second)) {
            return known;
        }
        let (left, right) = (self.monomial(first), self.monomial(second));
        let number = if (right.number / left.number).is_normal() { left.number } else { 1.0 };
        let factor = Monomial { number, factors: shared(&left.factors, &right.factors) };
        let result = Common {
            first: self.compose(&quotient(&left, &factor)),
            second: self.compose(&quotient(&right, &factor)),
            factor: self.compose(&factor),
        };
        self.commons.insert((first, second), result);
        result
    }

    /// `dividend` over `divisor`, if that divides by nothing but numbers and stays in their range.
    pub(super) fn exact(&mut self, dividend: Id, divisor: Id) -> Option<Id> {
        let (left, right) = (self.monomial(dividend), self.monomial(divisor));
        if shared(&left.factors, &right.factors) != right.factors {
            return None;
        }
        let quotient = quotient(&left, &right);
        quotient.number.is_normal().then(|| self.compose(&quotient))
    }

    fn monomial(&mut self, id: Id) -> Monomial {
        match self.pool.node(id).clone() {
            Node::Number(number) => Monomial { number: number.value(), factors: Vec::new() },
            Node::Sum { constant, terms } if constant.value() == 0.0 && terms.len() == 1 => {
                let inner = self.product(terms[0].0);
                Monomial { number: inner.number * terms[0].1.value(), factors: inner.factors }
            }
            _ => self.product(id),
        }
    }

    fn product(&mut self, id: Id) -> Monomial {
        let factors = match self.pool.node(id) {
            Node::Product(factors) => factors.to_vec(),
            _ => vec![(id, 1)],
        };
        let mut monomial = Monomial { number: 1.0, factors: Vec::with_capacity(factors.len()) };
        for (factor, exponent) in factors {
            let negative = self.leads_with_minus(factor);
            if negative && exponent % 2 != 0 {
                monomial.number = -monomial.number;
            }
            monomial.factors.push((self.signed(negative, factor), exponent));
        }
        monomial.factors.sort_unstable();
        monomial
    }

    fn leads_with_minus(&self, id: Id) -> bool {
        matches!(self.pool.node(id), Node::Sum { terms, .. } if terms[0].1.value() < 0.0)
    }

    fn compose(&mut self, monomial: &Monomial) -> Id {
        if monomial.factors.is_empty() {
            return self.pool.number(monomial.number);
        }
        let powers: Vec<Id> = monomial.factors.iter().map(|&(id, exponent)| self.pool.powi(id, exponent)).collect();
        let product = self.pool.product(&powers);
        self.pool.scale(monomial.number, product)
    }
}

/// The factors that two monomials have in common, each with the exponent nearer to zero.
fn shared(left: &[(Id, i32)], right: &[(Id, i32)]) -> Vec<(Id, i32)> {
    let mut result = Vec::new();
    for &(id, exponent) in left {
        let Ok(found) = right.binary_search_by_key(&id, |entry| entry.0) else { continue };
        let other = right[found].1;
        if exponent.signum() == other.signum() {
            result.push((id, if exponent.abs() < other.abs() { exponent } else { other }));
        }
    }
    result
}

/// `dividend` over `divisor`, whose factors it has.
fn quotient(dividend: &Monomial, divisor: &Monomial) -> Monomial {
    let mut factors = Vec::with_capacity(dividend.factors.len());
    for &(id, exponent) in &dividend.factors {
        let taken = divisor.factors.binary_search_by_key(&id, |entry| entry.0).map_or(0, |at| divisor.factors[at].1);
        if exponent != taken {
            factors.push((id, exponent - taken));
        }
    }
    Monomial { number: dividend.number / divisor.number, factors }
}
