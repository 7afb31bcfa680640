//! How large a value is beside what it is added up from.
//!
//! In: a node, numbers for its symbols. Out: its value and the sum of the sizes of its parts: a value far below that is
//! what rounding leaves of parts that cancel.
//! Method: running error analysis (Higham 2002, Accuracy and Stability of Numerical Algorithms, sec. 3.3).

use rustc_hash::FxHashMap;

use super::{Id, Node, Pool, Symbol, apply};

/// A value with the size of what it is made of.
#[derive(Clone, Copy, Debug)]
pub struct Sized {
    /// The value.
    pub value: f64,
    /// Not below the value's own size.
    pub size: f64,
}

impl Sized {
    /// A value without a history.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self { value, size: value.abs() }
    }

    /// The product: each factor is as uncertain as it is large beside its value.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let size = self.size * other.value.abs() + self.value.abs() * other.size - value.abs();
        Self { value, size: size.max(value.abs()) }
    }

    /// The quotient.
    #[must_use]
    pub fn over(self, other: Self) -> Self {
        self.times(other.power(-1))
    }

    fn power(self, exponent: i32) -> Self {
        let value = self.value.powi(exponent);
        let excess = self.size / self.value.abs() - 1.0;
        Self { value, size: value.abs() * (1.0 + f64::from(exponent.abs()) * excess) }
    }
}

/// The values of nodes, where symbols have these values and switches these branches.
#[must_use]
pub fn sized(pool: &Pool, roots: &[Id], of: &dyn Fn(Symbol) -> f64, is_negative: &dyn Fn(u32) -> bool) -> Vec<Sized> {
    let mut known: FxHashMap<Id, Sized> = FxHashMap::default();
    for id in pool.reachable(roots) {
        let sized = match pool.node(id) {
            Node::Number(number) => Sized::exact(number.value()),
            Node::Symbol(symbol) => Sized::exact(of(*symbol)),
            Node::Sum { constant, terms } => {
                terms.iter().fold(Sized::exact(constant.value()), |sum, (term, coefficient)| {
                    let part = known[term].times(Sized::exact(coefficient.value()));
                    Sized { value: sum.value + part.value, size: sum.size + part.size }
                })
            }
            Node::Product(factors) => factors
                .iter()
                .fold(Sized::exact(1.0), |product, (base, exponent)| product.times(known[base].power(*exponent))),
            Node::Call(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(|argument| known[argument].value).collect();
                Sized::exact(apply(*function, &arguments))
            }
            Node::Select { switch, negative, positive } => {
                known[if is_negative(*switch) { negative } else { positive }]
            }
        };
        known.insert(id, sized);
    }
    roots.iter().map(|root| known[root]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_is_small_beside_its_size() {
        let mut pool = Pool::new();
        let [a, b] = [0, 1].map(|k| pool.symbol(Symbol::Parameter(k)));
        // (a + b) (a - b) - a^2 + b^2, and the same with one part in a million more.
        let (sum, difference) = (pool.add(a, b), pool.sub(a, b));
        let product = pool.mul(sum, difference);
        let squares = [pool.powi(a, 2), pool.powi(b, 2)];
        let of = |factor: f64| [(product, 1.0), (squares[0], -factor), (squares[1], 1.0)];
        let [zero, rest] = [1.0, 1.0 + 1e-6].map(|factor| pool.linear(0.0, &of(factor)));
        let value = |symbol| if symbol == Symbol::Parameter(0) { 0.37 } else { 1.13 };
        let [zero, rest] = sized(&pool, &[zero, rest], &value, &|_| false)[..] else { panic!("two values") };
        assert!(zero.value.abs() < 1e-15 * zero.size && rest.value.abs() > 1e-9 * rest.size, "{zero:?} {rest:?}");
        let inverse = pool.powi(difference, -2);
        let found = sized(&pool, &[inverse], &value, &|_| false)[0];
        assert!((found.value * 0.76 * 0.76 - 1.0).abs() < 1e-12 && found.size > found.value);
    }
}
