//! Between which numbers a value is.
//!
//! In: a node and the bounds of its symbols. Out: its bounds, for all values of the symbols in theirs.
//! Method: interval arithmetic (Moore 1966, Interval Analysis), rounded to nearest: bounds are right to rounding. They
//! can be too wide.

use super::domain::{Domain, known};
use super::{Function, Id, Pool, Symbol};

/// The least and the largest value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bounds {
    /// The least value.
    pub least: f64,
    /// The largest value.
    pub most: f64,
}

impl Bounds {
    /// Nothing is known.
    pub const ANY: Self = Self { least: f64::NEG_INFINITY, most: f64::INFINITY };
}

impl Domain for Bounds {
    fn of(value: f64) -> Self {
        if value.is_nan() { Self::ANY } else { Self { least: value, most: value } }
    }

    fn plus(self, other: Self) -> Self {
        Self { least: self.least + other.least, most: self.most + other.most }
    }

    fn times(self, other: Self) -> Self {
        // Zero times anything is zero, however large that may be.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let ends = [self.least, self.most].map(|a| [other.least, other.most].map(|b| product(a, b)));
        let ends = ends.as_flattened();
        Self {
            least: ends.iter().copied().fold(f64::INFINITY, f64::min),
            most: ends.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    fn power(self, exponent: i32) -> Self {
        let has_zero = self.least <= 0.0 && self.most >= 0.0;
        if exponent < 0 && has_zero {
            return Self::ANY;
        }
        let [a, b] = [self.least, self.most].map(|end| end.powi(exponent));
        let least = if exponent % 2 == 0 && has_zero { 0.0 } else { a.min(b) };
        Self { least, most: a.max(b) }
    }

    fn or(self, other: Self) -> Self {
        Self { least: self.least.min(other.least), most: self.most.max(other.most) }
    }

    fn call(function: Function, arguments: &[Self]) -> Self {
        match (function, arguments) {
            (Function::Sqrt, &[Self { least, most }]) => {
                Self { least: least.max(0.0).sqrt(), most: most.max(0.0).sqrt() }
            }
            (Function::Sin | Function::Cos | Function::Tanh, _) => Self { least: -1.0, most: 1.0 },
            _ => Self::ANY,
        }
    }
}

/// The bounds of the root.
#[must_use]
pub fn bounds(pool: &Pool, root: Id, of: &dyn Fn(Symbol) -> Bounds) -> Bounds {
    known(pool, root, of)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranged(symbol: Symbol) -> Bounds {
        match symbol {
            Symbol::Parameter(0) => Bounds { least: 2.0, most: 3.0 },
            Symbol::Parameter(1) => Bounds { least: 0.5, most: f64::INFINITY },
            Symbol::State(_) => Bounds { least: -1.0, most: 1.0 },
            _ => Bounds::ANY,
        }
    }

    #[test]
    fn every_operation_keeps_within_its_bounds() {
        let mut pool = Pool::new();
        let [a, b, c] = [Symbol::Parameter(0), Symbol::Parameter(1), Symbol::state(0)].map(|of| pool.symbol(of));
        let free = pool.symbol(Symbol::Time);
        let cases = [
            (pool.linear(1.0, &[(a, -2.0), (c, 3.0)]), [-8.0, 0.0]),
            (pool.mul(a, c), [-3.0, 3.0]),
            (pool.powi(c, 2), [0.0, 1.0]),
            (pool.powi(c, 3), [-1.0, 1.0]),
            (pool.powi(a, -1), [1.0 / 3.0, 0.5]),
            (pool.powi(b, -1), [0.0, 2.0]),
            (pool.powi(c, -1), [f64::NEG_INFINITY, f64::INFINITY]),
            (pool.call(Function::Sqrt, &[a]), [2.0_f64.sqrt(), 3.0_f64.sqrt()]),
            (pool.call(Function::Sin, &[free]), [-1.0, 1.0]),
            (pool.call(Function::Exp, &[a]), [f64::NEG_INFINITY, f64::INFINITY]),
            (pool.select(0, a, c), [-1.0, 3.0]),
        ];
        for (k, (id, [least, most])) in cases.into_iter().enumerate() {
            assert_eq!(bounds(&pool, id, &ranged), Bounds { least, most }, "{k}");
        }
    }
}
