//! Which signs a value can have.
//!
//! In: a node and the signs of its symbols. Out: its signs, for all values of the symbols of theirs.
//! Method: interval arithmetic with the intervals below, at and above zero (Moore 1966, Interval Analysis); it can say
//! too much, never too little, but for underflow.

use super::domain::{Domain, known};
use super::{Function, Id, Pool, Symbol};

/// The signs that a value can have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Signs {
    /// Whether it can be below 0.
    pub below: bool,
    /// Whether it can be 0.
    pub zero: bool,
    /// Whether it can be above 0.
    pub above: bool,
}

impl Signs {
    /// Nothing is known.
    pub const ANY: Self = Self { below: true, zero: true, above: true };
    /// Above 0.
    pub const ABOVE: Self = Self { below: false, zero: false, above: true };
    /// 0 or above.
    pub const NOT_BELOW: Self = Self { below: false, zero: true, above: true };

    /// The signs of values in a range: each end with whether it is in it.
    #[must_use]
    pub fn between(lower: Option<(f64, bool)>, upper: Option<(f64, bool)>) -> Self {
        let reaches = |end: Option<(f64, bool)>, holds: fn(f64) -> bool| end.is_none_or(|(end, _)| holds(end));
        let has_zero = |end: Option<(f64, bool)>, holds: fn(f64) -> bool| {
            end.is_none_or(|(end, included)| holds(end) || end == 0.0 && included)
        };
        Self {
            below: reaches(lower, |end| end < 0.0),
            zero: has_zero(lower, |end| end < 0.0) && has_zero(upper, |end| end > 0.0),
            above: reaches(upper, |end| end > 0.0),
        }
    }

    fn without_below(self) -> Self {
        Self { below: false, ..self }
    }
}

impl Domain for Signs {
    fn of(value: f64) -> Self {
        if value.is_nan() { Self::ANY } else { Self { below: value < 0.0, zero: value == 0.0, above: value > 0.0 } }
    }

    fn plus(self, other: Self) -> Self {
        let opposed = self.below && other.above || self.above && other.below;
        Self {
            below: self.below || other.below,
            zero: opposed || self.zero && other.zero,
            above: self.above || other.above,
        }
    }

    fn times(self, other: Self) -> Self {
        Self {
            below: self.below && other.above || self.above && other.below,
            zero: self.zero || other.zero,
            above: self.above && other.above || self.below && other.below,
        }
    }

    fn or(self, other: Self) -> Self {
        Self { below: self.below || other.below, zero: self.zero || other.zero, above: self.above || other.above }
    }

    fn power(self, exponent: i32) -> Self {
        if exponent < 0 && self.zero {
            return Self::ANY;
        }
        if exponent % 2 == 0 { self.times(self).without_below() } else { self }
    }

    fn call(function: Function, arguments: &[Self]) -> Self {
        match (function, arguments) {
            (Function::Sqrt | Function::Abs, &[argument]) if argument.zero || argument.below => Self::NOT_BELOW,
            (Function::Sqrt | Function::Abs | Function::Exp, _) => Self::ABOVE,
            _ => Self::ANY,
        }
    }
}

/// The signs that the root can have.
#[must_use]
pub fn signs(pool: &Pool, root: Id, of: &dyn Fn(Symbol) -> Signs) -> Signs {
    known(pool, root, of)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranged(symbol: Symbol) -> Signs {
        match symbol {
            Symbol::Parameter(0) => Signs::between(Some((0.0, false)), None),
            Symbol::Parameter(1) => Signs::between(Some((0.0, true)), Some((3.0, true))),
            _ => Signs::between(None, Some((1.0, true))),
        }
    }

    #[test]
    fn ranges() {
        assert_eq!(Signs::between(None, None), Signs::ANY);
        assert_eq!(Signs::between(Some((0.0, false)), None), Signs::ABOVE);
        assert_eq!(Signs::between(Some((0.0, true)), Some((5.0, true))), Signs::NOT_BELOW);
        assert_eq!(
            Signs::between(Some((-1.0, true)), Some((0.0, false))),
            Signs { below: true, zero: false, above: false }
        );
        assert_eq!(Signs::between(Some((2.0, true)), None), Signs::ABOVE);
    }

    #[test]
    fn what_is_above_zero_and_what_may_not_be() {
        let mut pool = Pool::new();
        let [a, b, c] = [0, 1, 2].map(|index| pool.symbol(Symbol::Parameter(index)));
        let product = pool.mul(a, a);
        let double = pool.scale(2.0, product);
        let sum = pool.add(double, b);
        let quotient = pool.div(sum, a);
        for id in [a, product, sum, quotient] {
            assert_eq!(signs(&pool, id, &ranged), Signs::ABOVE);
        }
        let square = pool.powi(c, 2);
        let both = pool.add(square, b);
        assert_eq!(signs(&pool, both, &ranged), Signs::NOT_BELOW);
        let (difference, divided) = (pool.sub(a, b), pool.div(a, b));
        for id in [c, difference, divided] {
            assert_eq!(signs(&pool, id, &ranged), Signs::ANY);
        }
        let minus = pool.neg(a);
        assert_eq!(signs(&pool, minus, &ranged), Signs { below: true, zero: false, above: false });
    }
}
