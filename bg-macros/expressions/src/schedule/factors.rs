//! Common pairs of factors in the products of a plan.
//!
//! In: a [`Plan`]. Out: the same plan, in which each pair of factors that several products have, or one product has
//! more than once, is a product of its own; a divisor of many products is one reciprocal.
//! Method: greedy elimination (`greedy`) on monomials, most frequent pair first; powers are pairs of equal factors, so
//! that they are taken by squaring.

use std::collections::BTreeMap;

use super::greedy::{Elimination, LONGEST, Seen, eliminate};
use super::plan::{Cell, Plan};

/// Two factors: ascending if they are multiplied (`true`), dividend and divisor otherwise.
type Pair = (u32, u32, bool);

/// Products with the same divisor from which on one reciprocal of it is cheaper: with two it would save one division
/// for two multiplications, which is no fewer operations.
const RECIPROCAL: usize = 3;

struct Products<'p> {
    plan: &'p mut Plan,
    /// Each product with its factors.
    all: Vec<(u32, Vec<(u32, i32)>)>,
    seen: Seen<Pair>,
}

/// Makes products of the pairs of factors that occur more than once.
pub(super) fn share_factors(plan: &mut Plan) {
    let mut products = Vec::new();
    for cell in plan.post_order() {
        if let Cell::Product(factors) = &plan.cells[cell] {
            products.push((cell, factors.clone()));
        }
    }
    let members = products.iter().flat_map(|product| &product.1).map(|factor| factor.0);
    let seen = Seen::new(members, plan.cells.len());
    let mut search = Products { plan, all: products, seen };
    let found = search.pairs();
    eliminate(&mut search, found);
    let mut products = search.all;
    share_divisors(plan, &mut products);
    for (cell, factors) in products {
        plan.cells[cell] = Cell::Product(factors);
    }
}

impl Elimination for Products<'_> {
    type Pair = Pair;
    /// The product, and how many times the pair is in it.
    type Occurrence = (usize, u32);

    fn places(&mut self, wanted: Pair) -> Vec<(usize, u32)> {
        let mut places = Vec::new();
        for product in self.seen.lines(wanted) {
            let factors = &self.all[product].1;
            let find = |cell| factors.iter().find(|factor| factor.0 == cell).copied();
            let (Some(first), Some(second)) = (find(wanted.0), find(wanted.1)) else { continue };
            if let Some((found, times)) = pair(first, second)
                && found == wanted
            {
                places.push((product, times));
            }
        }
        places
    }

    fn saving(&mut self, _: Pair, places: &[(usize, u32)]) -> i64 {
        places.iter().map(|&(_, times)| i64::from(times)).sum::<i64>() - 1
    }

    fn replace(&mut self, pair: Pair, places: &[(usize, u32)]) -> Vec<Pair> {
        let (first, second, multiplied) = pair;
        let factors = match (first == second, multiplied) {
            (true, _) => vec![(first, 2)],
            (false, true) => vec![(first, 1), (second, 1)],
            (false, false) if first < second => vec![(first, 1), (second, -1)],
            (false, false) => vec![(second, -1), (first, 1)],
        };
        let inner = self.plan.cells.intern(Cell::Product(factors));
        self.seen.add_lines(inner, places.len());
        let mut found = Vec::new();
        for &(product, times) in places {
            if self.all[product].0 != inner {
                self.exchange(product, pair, times, inner, &mut found);
            }
        }
        found
    }
}

impl Products<'_> {
    fn pairs(&mut self) -> Vec<Pair> {
        let mut found = Vec::new();
        for product in 0..self.all.len() {
            let factors = self.all[product].1.clone();
            for (at, &first) in factors.iter().enumerate() {
                for &second in factors[at..].iter().take(LONGEST) {
                    self.note(product, first, second, &mut found);
                }
            }
        }
        found
    }

    /// Notes the pair of these factors; `found` gets it when it occurs a second time or more.
    fn note(&mut self, product: usize, first: (u32, i32), second: (u32, i32), found: &mut Vec<Pair>) {
        let Some((pair, times)) = pair(first, second) else { return };
        if times < 2 && (self.seen.is_single(pair.0) || self.seen.is_single(pair.1)) {
            return;
        }
        if self.seen.note(pair, product) > 1 || times > 1 {
            found.push(pair);
        }
    }

    fn exchange(&mut self, product: usize, pair: Pair, times: u32, inner: u32, found: &mut Vec<Pair>) {
        let factors = &mut self.all[product].1;
        let mut direction = 1;
        let times = times.cast_signed();
        for factor in factors.iter_mut() {
            if factor.0 == pair.0 {
                direction = factor.1.signum();
                factor.1 -= direction * times * if pair.0 == pair.1 { 2 } else { 1 };
            } else if factor.0 == pair.1 {
                factor.1 -= factor.1.signum() * times;
            }
        }
        factors.retain(|factor| factor.1 != 0);
        match factors.iter_mut().find(|factor| factor.0 == inner) {
            Some(present) => present.1 += direction * times,
            None => factors.push((inner, direction * times)),
        }
        let factors = factors.clone();
        let Some(&new) = factors.iter().find(|factor| factor.0 == inner) else { return };
        for &other in factors.iter().rev().take(LONGEST) {
            self.note(product, other, new, found);
        }
    }
}

/// The pair of two factors of one product, and how many times they form it.
fn pair(first: (u32, i32), second: (u32, i32)) -> Option<(Pair, u32)> {
    let (left, right) = (first.1.unsigned_abs(), second.1.unsigned_abs());
    if first.0 == second.0 {
        return (left > 1).then_some(((first.0, first.0, true), left / 2));
    }
    let times = left.min(right);
    let pair = match (first.1 > 0, second.1 > 0) {
        (true, false) => (first.0, second.0, false),
        (false, true) => (second.0, first.0, false),
        _ => (first.0.min(second.0), first.0.max(second.0), true),
    };
    Some((pair, times))
}

/// Replaces divisors that many products have in common by their reciprocal.
fn share_divisors(plan: &mut Plan, products: &mut [(u32, Vec<(u32, i32)>)]) {
    let mut users: BTreeMap<Vec<(u32, i32)>, Vec<usize>> = BTreeMap::new();
    for (at, (_, factors)) in products.iter().enumerate() {
        let mut divisor: Vec<_> = factors.iter().copied().filter(|factor| factor.1 < 0).collect();
        divisor.sort_unstable();
        if !divisor.is_empty() {
            users.entry(divisor).or_default().push(at);
        }
    }
    for (divisor, users) in users {
        if users.len() < RECIPROCAL {
            continue;
        }
        let reciprocal = plan.cells.intern(Cell::Product(divisor));
        for at in users {
            let (cell, factors) = &mut products[at];
            if *cell != reciprocal {
                factors.retain(|factor| factor.1 > 0);
                factors.push((reciprocal, 1));
            }
        }
    }
}
