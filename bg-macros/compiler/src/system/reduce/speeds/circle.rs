//! Cosines and sines of one angle: the sum of their squares is 1.
//!
//! In: orientations that turn about one axis. Out: expressions without what cancels by that.
//! Method: the expression is expanded, the square of each cosine replaced by 1 - s^2; what is shorter then is taken.

use std::collections::BTreeMap;

use super::super::angle;
use super::choice::Choice;
use crate::expr::{Id, Monomials, Pool, Symbol, monomials};
use crate::system::equations::StateEquations;

/// What is left of a coefficient when parts cancel, beside the largest.
const ROUNDING: f64 = 1e-14;

/// Pairs of a cosine and a sine.
pub(super) struct Circles(Vec<(Id, Id)>);

impl Circles {
    /// The pairs among the states that stay.
    pub fn of(equations: &mut StateEquations, choice: &Choice) -> Self {
        let pairs = angle::circles(equations);
        let stays = |state: &usize| !choice.images.contains_key(state);
        let pairs = pairs.into_iter().filter(|(cosine, sine)| stays(cosine) && stays(sine));
        let mut symbol = |state: usize| equations.pool.symbol(Symbol::state(state));
        Self(pairs.map(|(cosine, sine)| (symbol(cosine), symbol(sine))).collect())
    }

    /// An expression without squares that add up to 1.
    pub fn tidied(&self, pool: &mut Pool, of: Id) -> Id {
        let Some(before) = monomials(pool, of) else { return of };
        let mut after = self.0.iter().fold(before.clone(), |after, &pair| without_square(after, pair));
        let largest = after.values().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        after.retain(|_, value| value.abs() > ROUNDING * largest);
        if after.len() >= before.len() {
            return of;
        }
        let terms: Vec<(Id, f64)> = after.into_iter().map(|(monomial, value)| (product(pool, &monomial), value)).collect();
        pool.linear(0.0, &terms)
    }
}

/// Every square of the cosine replaced.
fn without_square(of: Monomials, (cosine, sine): (Id, Id)) -> Monomials {
    let mut done: Monomials = BTreeMap::new();
    let mut open: Vec<(BTreeMap<Id, i32>, f64)> =
        of.into_iter().map(|(monomial, value)| (monomial.iter().copied().collect(), value)).collect();
    while let Some((mut monomial, value)) = open.pop() {
        let power = monomial.get(&cosine).copied().unwrap_or(0);
        if power < 2 {
            *done.entry(monomial.into_iter().collect()).or_insert(0.0) += value;
            continue;
        }
        raise(&mut monomial, cosine, -2);
        open.push((monomial.clone(), value));
        raise(&mut monomial, sine, 2);
        open.push((monomial, -value));
    }
    done
}

fn raise(monomial: &mut BTreeMap<Id, i32>, factor: Id, by: i32) {
    let power = monomial.remove(&factor).unwrap_or(0) + by;
    if power != 0 {
        monomial.insert(factor, power);
    }
}

fn product(pool: &mut Pool, monomial: &[(Id, i32)]) -> Id {
    let factors: Vec<Id> = monomial.iter().map(|&(factor, power)| pool.powi(factor, power)).collect();
    pool.product(&factors)
}
