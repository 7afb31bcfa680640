//! Shorter sums where cosines and sines of the same angles are in them.
//!
//! In: nodes, pairs of a cosine and a sine. Out: the same nodes, written shorter where that is possible.
//! Method: from below, each sum is expanded into monomials. The square of a cosine becomes 1 - s^2; cosines and sines
//! of two angles are put together to those of their difference and sum, which many sums then share; common factors are
//! taken out. What costs fewer operations than before is taken.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::{Id, Monomials, Node, Pool, monomials};

/// Sums of more monomials stay as they are.
const MOST_MONOMIALS: usize = 16;

/// What is left of coefficients that cancel, beside the largest.
const ROUNDING: f64 = 1e-14;

/// Sums with cosines and sines of some angles.
#[derive(Clone, Debug, Default)]
pub struct Circles {
    pairs: Vec<(Id, Id)>,
}

impl Circles {
    /// With these pairs of a cosine and a sine.
    #[must_use]
    pub fn new(pairs: Vec<(Id, Id)>) -> Self {
        Self { pairs }
    }

    /// The nodes, written shorter.
    pub fn shortened(&self, pool: &mut Pool, roots: &[Id]) -> Vec<Id> {
        let mut images: FxHashMap<Id, Id> = FxHashMap::default();
        let mut sizes: FxHashMap<Id, usize> = FxHashMap::default();
        for id in pool.reachable(roots) {
            let mut image = pool.rebuilt(id, &images);
            if matches!(pool.node(image), Node::Sum { .. }) && self.size(pool, image, &mut sizes) <= MOST_MONOMIALS {
                image = self.shorter(pool, image);
            }
            images.insert(id, image);
        }
        roots.iter().map(|root| images[root]).collect()
    }

    /// How many monomials a node has at most when it is expanded.
    fn size(&self, pool: &Pool, id: Id, known: &mut FxHashMap<Id, usize>) -> usize {
        if let Some(&size) = known.get(&id) {
            return size;
        }
        let size = match pool.node(id) {
            Node::Sum { constant, terms } => {
                let terms = terms.iter().map(|(id, _)| self.size(pool, *id, known));
                terms.fold(usize::from(constant.value() != 0.0), usize::saturating_add)
            }
            Node::Product(factors) => factors.iter().fold(1, |size: usize, &(id, power)| {
                let power = u32::try_from(power).unwrap_or(0);
                size.saturating_mul(self.size(pool, id, known).saturating_pow(power))
            }),
            _ => 1,
        };
        known.insert(id, size);
        size
    }

    fn shorter(&self, pool: &mut Pool, of: Id) -> Id {
        let Some(expanded) = monomials(pool, of) else { return of };
        let reduced = self.pairs.iter().fold(expanded, |sum, &pair| without_square(sum, pair));
        let largest = reduced.values().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let mut sum: Monomials = reduced.into_iter().filter(|(_, value)| value.abs() > ROUNDING * largest).collect();
        self.join(pool, &mut sum);
        let found = factored(pool, sum);
        if pool.cost(&[found]) < pool.cost(&[of]) { found } else { of }
    }

    /// Puts products of two angles' cosines and sines together.
    fn join(&self, pool: &mut Pool, sum: &mut Monomials) {
        for (k, &(c, s)) in self.pairs.iter().enumerate() {
            for &(d, t) in &self.pairs[..k] {
                for (a, b) in [([c, d], [s, t]), ([s, d], [c, t])] {
                    let [first, second] = [a, b].map(|[x, y]| pool.mul(x, y));
                    join_two(pool, sum, (a, first), (b, second));
                }
            }
        }
    }
}

/// `m (x + y)` in place of `m x + m y`, `m (x - y)` of `m x - m y`, for two products of two factors.
fn join_two(pool: &mut Pool, sum: &mut Monomials, (a, x): ([Id; 2], Id), (b, y): ([Id; 2], Id)) {
    let with = |monomial: &[(Id, i32)], factors: [Id; 2], by: i32| {
        let mut all: BTreeMap<Id, i32> = monomial.iter().copied().collect();
        factors.into_iter().for_each(|factor| raise(&mut all, factor, by));
        all.into_iter().collect::<Box<[(Id, i32)]>>()
    };
    let has = |monomial: &[(Id, i32)], factor: Id| monomial.iter().any(|&(id, power)| id == factor && power > 0);
    let found: Vec<Box<[(Id, i32)]>> =
        sum.keys().filter(|monomial| a.into_iter().all(|factor| has(monomial, factor))).cloned().collect();
    for monomial in found {
        let rest = with(&monomial, a, -1);
        let other = with(&rest, b, 1);
        let (Some(&p), Some(&q)) = (sum.get(&monomial), sum.get(&other)) else { continue };
        if (p.abs() - q.abs()).abs() > ROUNDING * p.abs() {
            continue;
        }
        let together = pool.linear(0.0, &[(x, 1.0), (y, (p * q).signum())]);
        sum.remove(&monomial);
        sum.remove(&other);
        let mut all: BTreeMap<Id, i32> = rest.iter().copied().collect();
        raise(&mut all, together, 1);
        *sum.entry(all.into_iter().collect()).or_insert(0.0) += p;
    }
}

/// Every square of the cosine replaced.
fn without_square(of: Monomials, (cosine, sine): (Id, Id)) -> Monomials {
    let mut done = Monomials::new();
    let mut open: Vec<(BTreeMap<Id, i32>, f64)> =
        of.into_iter().map(|(monomial, value)| (monomial.iter().copied().collect(), value)).collect();
    while let Some((mut monomial, value)) = open.pop() {
        if monomial.get(&cosine).is_none_or(|&power| power < 2) {
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

/// The sum with the most common factor taken out, again and again.
fn factored(pool: &mut Pool, sum: Monomials) -> Id {
    let mut counts: BTreeMap<Id, usize> = BTreeMap::new();
    for monomial in sum.keys() {
        monomial
            .iter()
            .filter(|(_, power)| *power > 0)
            .for_each(|(factor, _)| *counts.entry(*factor).or_default() += 1);
    }
    let most = counts
        .into_iter()
        .filter(|(_, count)| *count > 1)
        .max_by_key(|&(factor, count)| (count, std::cmp::Reverse(factor)));
    let Some((factor, _)) = most else {
        let terms: Vec<(Id, f64)> =
            sum.into_iter().map(|(monomial, value)| (product(pool, &monomial), value)).collect();
        return pool.linear(0.0, &terms);
    };
    let (with, without): (Monomials, Monomials) =
        sum.into_iter().partition(|(monomial, _)| monomial.iter().any(|&(id, power)| id == factor && power > 0));
    let divided = with.into_iter().map(|(monomial, value)| {
        let mut rest: BTreeMap<Id, i32> = monomial.iter().copied().collect();
        raise(&mut rest, factor, -1);
        (rest.into_iter().collect(), value)
    });
    let inner = factored(pool, divided.collect());
    let taken = pool.mul(factor, inner);
    if without.is_empty() {
        return taken;
    }
    let rest = factored(pool, without);
    pool.add(taken, rest)
}

fn product(pool: &mut Pool, monomial: &[(Id, i32)]) -> Id {
    let factors: Vec<Id> = monomial.iter().map(|&(factor, power)| pool.powi(factor, power)).collect();
    pool.product(&factors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, Symbol, evaluate};

    /// Cosine and sine of two angles as states 0 to 3, two more symbols.
    fn circles(pool: &mut Pool) -> ([Id; 6], Circles) {
        let symbols: [Id; 6] = std::array::from_fn(|k| pool.symbol(Symbol::state(k)));
        let [c, s, d, t, ..] = symbols;
        (symbols, Circles::new(vec![(c, s), (d, t)]))
    }

    /// The value of a node where the angles are 0.3 and 1.1.
    fn value(pool: &Pool, id: Id) -> f64 {
        let (a, b) = (0.3_f64, 1.1_f64);
        let states = [a.cos(), a.sin(), b.cos(), b.sin(), 0.7, -1.9];
        evaluate(pool, &[id], &Environment { states: &states, ..Environment::default() })[0]
    }

    #[test]
    fn squares_add_up_to_one() {
        let mut pool = Pool::new();
        let ([c, s, _, _, x, _], circles) = circles(&mut pool);
        let [cosine, sine] = [c, s].map(|id| pool.product(&[id, id, x]));
        let sum = pool.linear(0.0, &[(cosine, 2.0), (sine, 2.0)]);
        let expected = pool.scale(2.0, x);
        assert_eq!(circles.shortened(&mut pool, &[sum]), [expected]);
    }

    #[test]
    fn products_of_two_angles_are_shared() {
        let mut pool = Pool::new();
        let ([c, s, d, t, x, y], circles) = circles(&mut pool);
        let of = |pool: &mut Pool, factor: Id| {
            let parts = [pool.product(&[factor, c, d]), pool.product(&[factor, s, t])];
            pool.sum(&parts)
        };
        let sums = [of(&mut pool, x), of(&mut pool, y)];
        let shortened = circles.shortened(&mut pool, &sums);
        assert!(sums.iter().zip(&shortened).all(|(&a, &b)| (value(&pool, a) - value(&pool, b)).abs() < 1e-15));
        // Two products and their sum, which both take, times x and y.
        assert_eq!((pool.cost(&sums), pool.cost(&shortened)), (10, 5));
    }

    #[test]
    fn parts_that_cancel_go_and_what_is_no_shorter_stays() {
        let mut pool = Pool::new();
        let ([c, s, d, t, x, y], circles) = circles(&mut pool);
        let inner = pool.linear(0.0, &[(c, 2.0), (d, 1.0)]);
        let whole = [pool.mul(x, inner), pool.mul(x, d)];
        let difference = pool.sub(whole[0], whole[1]);
        let shortened = circles.shortened(&mut pool, &[difference])[0];
        assert_eq!(pool.cost(&[shortened]), 2);
        assert!((value(&pool, difference) - value(&pool, shortened)).abs() < 1e-15);
        let [first, second] = [pool.add(c, y), pool.add(s, t)];
        let product = pool.mul(first, second);
        let kept = pool.add(product, x);
        assert_eq!(circles.shortened(&mut pool, &[kept]), [kept]);
    }
}
