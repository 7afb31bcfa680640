//! Random expressions for tests.
//!
//! In: a seed. Out: expressions that are smooth and finite near the environment's values.

use super::{Function, Id, Pool, Symbol};
use crate::random::Random;

/// A reproducible source of expressions.
pub struct Source(Random);

impl Source {
    pub fn new(seed: u64) -> Self {
        Self(Random::new(seed))
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.0.below(end)
    }

    /// A number between -1 and 1.
    pub fn number(&mut self) -> f64 {
        self.below(2001) as f64 / 1000.0 - 1.0
    }

    /// Expressions over four states, each made of earlier ones.
    pub fn expressions(&mut self, pool: &mut Pool, count: usize) -> Vec<Id> {
        let mut found: Vec<_> = (0..4).map(|index| pool.symbol(Symbol::State(index))).collect();
        while found.len() < count {
            let next = self.expression(pool, &found);
            found.push(next);
        }
        found
    }

    fn expression(&mut self, pool: &mut Pool, found: &[Id]) -> Id {
        let (a, b) = (found[self.below(found.len())], found[self.below(found.len())]);
        match self.below(16) {
            0..=2 => pool.add(a, b),
            3 | 4 => pool.sub(a, b),
            5 | 6 => self.bounded_product(pool, a, b),
            7 => pool.linear(self.number(), &[(a, self.number()), (b, self.number())]),
            8 => pool.select(self.below(2) as u32, a, b),
            9 => {
                let bounded = self.above_one(pool, b);
                pool.div(a, bounded)
            }
            _ => self.call(pool, a, b),
        }
    }

    fn bounded_product(&mut self, pool: &mut Pool, a: Id, b: Id) -> Id {
        let sine = pool.call(Function::Sin, &[a]);
        pool.mul(sine, b)
    }

    /// `2 + sin(a)`
    fn above_one(&mut self, pool: &mut Pool, a: Id) -> Id {
        let sine = pool.call(Function::Sin, &[a]);
        pool.linear(2.0, &[(sine, 1.0)])
    }

    fn call(&mut self, pool: &mut Pool, a: Id, b: Id) -> Id {
        let above = self.above_one(pool, a);
        let inside = pool.scale(0.25, above);
        match self.below(12) {
            0 => pool.call(Function::Sin, &[a]),
            1 => pool.call(Function::Cos, &[a]),
            2 => pool.call(Function::Tanh, &[a]),
            3 => pool.call(Function::Sqrt, &[above]),
            4 => pool.call(Function::Ln, &[above]),
            5 => pool.call(Function::Abs, &[above]),
            6 => pool.call(Function::Asin, &[inside]),
            7 => pool.call(Function::Acos, &[inside]),
            8 => pool.call(Function::Tan, &[inside]),
            9 => pool.call(Function::Exp, &[inside]),
            10 => pool.call(Function::Atan2, &[b, above]),
            _ => pool.call(Function::Pow, &[above, inside]),
        }
    }
}
