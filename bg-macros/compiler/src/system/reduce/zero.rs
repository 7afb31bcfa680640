//! Whether expressions are zero.
//!
//! In: expressions of parameters and numbers. Out: whether they are zero whatever the parameters are. Method: the
//! polynomial identity; where that grows too large, as for the start of a long chain of turned bodies, values at places
//! drawn at random: an analytic function that is zero at them is zero everywhere, but for a set of places of measure
//! zero (Schwartz, Journal of the ACM 27, 1980, for polynomials).

use crate::expr::{Environment, Function, Id, Node, Pool, Symbol, evaluate, magnitudes, same_polynomial};
use crate::random::Random;

/// A gap at the start below it is rounding of the numbers that place the bodies, m.
pub(super) const ROUNDING: f64 = 1e-12;
/// What rounding leaves of zero, beside the parts that cancel.
const PART: f64 = 1e-12;
const PLACES: usize = 16;

/// Whether an expression is zero whatever its symbols are, or a number that is rounding.
pub(super) fn vanishes(pool: &mut Pool, of: Id) -> bool {
    let zero = pool.zero();
    value(pool, of).is_some_and(|value| value.abs() < ROUNDING)
        || same_polynomial(pool, of, zero)
        || vanishes_at_places(pool, of)
}

/// The value of an expression of numbers alone.
pub(super) fn value(pool: &Pool, of: Id) -> Option<f64> {
    pool.symbols(&[of]).is_empty().then(|| evaluate(pool, &[of], &Environment::default())[0])
}

/// Whether an analytic function of parameters is zero at places drawn at random.
fn vanishes_at_places(pool: &mut Pool, of: Id) -> bool {
    let symbols = pool.symbols(&[of]);
    let numbers = symbols.iter().map(|symbol| if let Symbol::Parameter(k) = symbol { Some(*k as usize) } else { None });
    let Some(numbers) = numbers.collect::<Option<Vec<usize>>>() else { return false };
    let is_analytic = |id: &Id| match pool.node(*id) {
        Node::Call(function, _) => matches!(function, Function::Sin | Function::Cos),
        Node::Select { .. } => false,
        Node::Number(_) | Node::Symbol(_) | Node::Sum { .. } | Node::Product(_) => true,
    };
    if !pool.reachable(&[of]).iter().all(is_analytic) {
        return false;
    }
    let size = magnitudes(pool, &[of])[0];
    let mut random = Random::new(1);
    let mut parameters = vec![0.0; numbers.iter().max().map_or(0, |most| most + 1)];
    (0..PLACES).all(|_| {
        parameters.iter_mut().for_each(|value| *value = 4.0 * random.unit() - 2.0);
        let given = Environment { parameters: &parameters, ..Environment::default() };
        let found = evaluate(pool, &[of, size], &given);
        found[0].abs() <= PART * found[1]
    })
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
