//! Whether expressions are zero.
//!
//! In: expressions of parameters, states and numbers. Out: whether they are zero whatever these are. Method: the
//! polynomial identity; where that grows too large, as for the start of a long chain of turned bodies, or other
//! functions are in it, as the sine of an arcsine, values at places drawn at random, of many magnitudes: an analytic
//! function that is zero at them is zero wherever it is defined without a gap between, but for a set of places of
//! measure zero (Schwartz, Journal of the ACM 27, 1980, for polynomials).

use crate::expr::{Environment, Function, Id, Node, Pool, Symbol, evaluate, magnitudes, same_polynomial};
use crate::random::Random;

/// A gap at the start below it is rounding of the numbers that place the bodies, m.
pub(super) const ROUNDING: f64 = 1e-12;
/// What rounding leaves of zero, beside the parts that cancel.
const PART: f64 = 1e-12;
const PLACES: usize = 16;
/// Places are drawn until so many have values.
const DRAWS: usize = 1000;
/// The magnitudes of half of the places are powers of ten between this and its inverse.
const MAGNITUDE: f64 = 1.5;

/// Whether an expression is zero whatever its symbols are, or a number that is rounding.
pub(super) fn vanishes(pool: &mut Pool, of: Id) -> bool {
    let zero = pool.zero();
    value(pool, of).is_some_and(|value| value.abs() < ROUNDING)
        || same_polynomial(pool, of, zero)
        || vanishes_at_places(pool, of) == Some(true)
}

/// The value of an expression of numbers alone.
pub(super) fn value(pool: &Pool, of: Id) -> Option<f64> {
    pool.symbols(&[of]).is_empty().then(|| evaluate(pool, &[of], &Environment::default())[0])
}

/// Whether an analytic function of parameters, states and coordinates is zero at places drawn at random; none where it
/// is no such function, or hardly anywhere defined.
pub(super) fn vanishes_at_places(pool: &mut Pool, of: Id) -> Option<bool> {
    let mut values: [Vec<f64>; 3] = [const { Vec::new() }; 3];
    for symbol in pool.symbols(&[of]) {
        let (values, index) = match symbol {
            Symbol::Parameter(index) => (&mut values[0], index),
            Symbol::State(index) => (&mut values[1], index),
            Symbol::Weight(index) => (&mut values[2], index),
            _ => return None,
        };
        values.resize(values.len().max(index as usize + 1), 0.0);
    }
    let is_analytic = |id: &Id| match pool.node(*id) {
        Node::Call(function, _) => *function != Function::Abs,
        Node::Select { .. } => false,
        Node::Number(_) | Node::Symbol(_) | Node::Sum { .. } | Node::Product(_) => true,
    };
    if !pool.reachable(&[of]).iter().all(is_analytic) {
        return None;
    }
    let size = magnitudes(pool, &[of])[0];
    let mut random = Random::new(1);
    let seen = (0..DRAWS).filter_map(|draw| {
        values.iter_mut().flatten().for_each(|value| {
            let [size, sign] = [random.unit(), random.unit()].map(|unit| 2.0 * unit - 1.0);
            *value = if draw % 2 == 0 { 2.0 * size } else { 10.0_f64.powf(MAGNITUDE * size).copysign(sign) };
        });
        let [parameters, states, weights] = &values;
        let given = Environment { parameters, states, weights, ..Environment::default() };
        let found = evaluate(pool, &[of, size], &given);
        found.iter().all(|value| value.is_finite()).then(|| found[0].abs() <= PART * found[1])
    });
    let seen: Vec<bool> = seen.take(PLACES).collect();
    (seen.len() == PLACES).then(|| seen.iter().all(|is_zero| *is_zero))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::Value;

    /// Rows of a product of twelve rotations are perpendicular; its expansion would have some 4^12 terms.
    #[test]
    fn a_long_identity_is_seen_at_places() {
        let pool = &mut Pool::new();
        let mut turned = Value::identity(pool);
        for k in 0..12 {
            let angle = pool.symbol(Symbol::numbered(Symbol::Parameter, k));
            let turn = Value::rotation(pool, k % 3, angle);
            turned = turned.multiply(pool, &turn);
        }
        let row = |k: usize| Value(turned.0[3 * k..3 * k + 3].to_vec());
        let across = row(0).dot(pool, &row(1));
        let zero = pool.zero();
        assert!(!same_polynomial(pool, across, zero));
        assert!(vanishes(pool, across));
        let little = pool.scale(1e-9, turned.0[0]);
        let apart = pool.add(across, little);
        assert!(!vanishes(pool, apart));
    }

    /// Where it is defined, the sine of an arcsine is its argument; its cosine has one sign only.
    #[test]
    fn functions_of_inverses_are_seen_at_places() {
        let pool = &mut Pool::new();
        let [a, b] = [0, 1].map(|k| pool.symbol(Symbol::numbered(Symbol::Parameter, k)));
        let ratio = pool.div(a, b);
        let angle = pool.call(Function::Asin, &[ratio]);
        let [sine, cosine] = [Function::Sin, Function::Cos].map(|of| pool.call(of, &[angle]));
        let product = pool.mul(sine, b);
        let apart = pool.sub(product, a);
        assert!(vanishes(pool, apart));
        let squares = [pool.mul(a, a), pool.mul(b, b)];
        let rest = pool.sub(squares[1], squares[0]);
        let root = pool.call(Function::Sqrt, &[rest]);
        let across = pool.mul(cosine, b);
        let apart = pool.sub(across, root);
        assert!(!vanishes(pool, apart), "b may be below zero");
        let arc = pool.call(Function::Sin, &[a]);
        let arc = pool.call(Function::Asin, &[arc]);
        let apart = pool.sub(arc, a);
        assert!(!vanishes(pool, apart), "for small angles only");
    }

    /// |a| - a is zero at half of all places.
    #[test]
    fn what_is_not_analytic_is_not_seen_at_places() {
        let pool = &mut Pool::new();
        let a = pool.symbol(Symbol::numbered(Symbol::Parameter, 0));
        let size = pool.call(Function::Abs, &[a]);
        let square = pool.mul(a, a);
        let root = pool.call(Function::Sqrt, &[square]);
        let apart = pool.sub(size, root);
        assert!(!vanishes(pool, apart));
    }
}
