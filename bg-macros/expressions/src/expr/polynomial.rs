//! Whether two expressions are the same polynomial.
//!
//! In: two nodes. Out: whether their difference is zero for all values of the atoms, as far as expansion shows it.
//! Method: the difference is expanded into a sum of monomials over atoms: symbols, calls and switched values over
//! expanded arguments, and reciprocals of what is not a monomial. The square of a square root is its argument, and
//! denominators are multiplied out last. Each coefficient carries the sum of the sizes of all that it was added up
//! from, and counts as zero where it is rounding beside that (running error analysis, Higham 2002, Accuracy and
//! Stability of Numerical Algorithms, sec. 3.3).

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::{Function, Id, Node, Number, Pool, children};

/// Gives up above this many monomials in one polynomial.
const MOST_MONOMIALS: usize = 20_000;

/// Gives up after this many additions to polynomials in all.
const MOST_WORK: usize = 1_000_000;

/// A coefficient below this part of what it was added up from is rounding.
const ROUNDING: f64 = 1e-12;

/// Atoms in ascending order with their exponents, none zero.
type Monomial = Box<[(Id, i32)]>;

/// A sum of monomials: atoms in ascending order with their exponents, and the coefficient.
pub type Monomials = BTreeMap<Box<[(Id, i32)]>, f64>;

#[derive(Clone, Copy, Debug)]
struct Coefficient {
    value: f64,
    /// Sum of the sizes of the parts that make up the value.
    size: f64,
}

type Polynomial = BTreeMap<Monomial, Coefficient>;

/// Whether `a` and `b` expand to the same sum of monomials. `true` is a proof up to the rounding of coefficients,
/// wherever no denominator is zero; `false` may also mean that the expansion grew too large.
pub fn same_polynomial(pool: &mut Pool, a: Id, b: Id) -> bool {
    let difference = pool.sub(a, b);
    if pool.is_zero(difference) {
        return true;
    }
    let mut expansion = Expansion::new(pool, &[a, b]);
    expansion.vanishes(a, b) == Some(true)
}

/// The monomials of `of` over its atoms with their coefficients; none where the expansion grows too large.
pub fn monomials(pool: &mut Pool, of: Id) -> Option<Monomials> {
    let mut expansion = Expansion::new(pool, &[of]);
    for id in expansion.pool.reachable(&[of]) {
        let polynomial = expansion.expanded(id)?;
        expansion.known.insert(id, polynomial);
    }
    let polynomial = pruned(expansion.take(of));
    Some(polynomial.into_iter().map(|(monomial, coefficient)| (monomial, coefficient.value)).collect())
}

/// An expansion under way. Every method gives none where it gives up.
struct Expansion<'p> {
    pool: &'p mut Pool,
    /// The polynomials of the nodes that are still needed.
    known: FxHashMap<Id, Polynomial>,
    /// How often each node is still needed.
    parents: FxHashMap<Id, usize>,
    /// The polynomials of the denominators and of the arguments of calls and switched values.
    atoms: FxHashMap<Id, Polynomial>,
    work: usize,
}

impl<'p> Expansion<'p> {
    fn new(pool: &'p mut Pool, roots: &[Id]) -> Self {
        let mut parents = FxHashMap::default();
        let nodes = pool.reachable(roots);
        for id in nodes.iter().flat_map(|id| children(pool.node(*id))).chain(roots.iter().copied()) {
            *parents.entry(id).or_default() += 1;
        }
        Self { pool, known: FxHashMap::default(), parents, atoms: FxHashMap::default(), work: 0 }
    }

    /// Whether `a - b` is zero.
    fn vanishes(&mut self, a: Id, b: Id) -> Option<bool> {
        for id in self.pool.reachable(&[a, b]) {
            let polynomial = self.expanded(id)?;
            self.known.insert(id, polynomial);
        }
        let (mut rest, other) = (self.take(a), self.take(b));
        self.add(&mut rest, &other, &constant(-1.0))?;
        rest = pruned(rest);
        while let Some((denominator, exponent)) = self.denominator(&rest) {
            rest = pruned(self.cleared(&rest, denominator, exponent)?);
        }
        Some(rest.is_empty())
    }

    /// The polynomial of a node, from those of its children.
    fn expanded(&mut self, id: Id) -> Option<Polynomial> {
        match self.pool.node(id).clone() {
            Node::Number(number) => Some(constant(number.value())),
            Node::Symbol(_) => Some(atom(id, 1, 1.0)),
            Node::Sum { constant, terms } => self.sum(constant.value(), &terms),
            Node::Product(factors) => {
                let mut product = constant(1.0);
                for &(base, exponent) in factors.iter() {
                    let base = self.take(base);
                    product = self.times_power(product, &base, exponent)?;
                }
                Some(product)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|argument| self.canonical(*argument)).collect();
                Some(self.opaque(|pool| pool.call(function, &arguments)))
            }
            Node::Select { switch, negative, positive } => {
                let (negative, positive) = (self.canonical(negative), self.canonical(positive));
                Some(self.opaque(|pool| pool.select(switch, negative, positive)))
            }
        }
    }

    /// The polynomial of a child, which is dropped when no other node needs it.
    fn take(&mut self, child: Id) -> Polynomial {
        let parents = self.parents.entry(child).or_insert(1);
        *parents -= 1;
        let polynomial = if *parents == 0 { self.known.remove(&child) } else { self.known.get(&child).cloned() };
        polynomial.unwrap_or_default()
    }

    /// Adds the shorter polynomials to the longest, so that a long chain of sums costs little.
    fn sum(&mut self, number: f64, terms: &[(Id, Number)]) -> Option<Polynomial> {
        let mut parts: Vec<_> = terms.iter().map(|(id, coefficient)| (self.take(*id), coefficient.value())).collect();
        let longest = (0..parts.len()).max_by_key(|&part| parts[part].0.len())?;
        let (mut sum, factor) = parts.swap_remove(longest);
        if factor != 1.0 {
            self.work += sum.len();
            sum = multiple(sum, factor);
        }
        for (part, factor) in parts {
            self.add(&mut sum, &part, &constant(factor))?;
        }
        self.add(&mut sum, &constant(number), &constant(1.0))?;
        Some(sum)
    }

    /// `sum += a * b`
    fn add(&mut self, sum: &mut Polynomial, a: &Polynomial, b: &Polynomial) -> Option<()> {
        for (left, x) in a {
            self.work += b.len();
            for (right, y) in b {
                include(sum, joined(left, right), Coefficient { value: x.value * y.value, size: x.size * y.size });
            }
            if sum.len() > MOST_MONOMIALS || self.work > MOST_WORK {
                return None;
            }
        }
        Some(())
    }

    fn multiplied(&mut self, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
        let mut product = Polynomial::new();
        self.add(&mut product, a, b)?;
        self.without_squares_of_roots(product)
    }

    fn times_power(&mut self, mut product: Polynomial, base: &Polynomial, exponent: i32) -> Option<Polynomial> {
        if exponent < 0 {
            let reciprocal = self.reciprocal(base, exponent)?;
            return self.multiplied(&product, &reciprocal);
        }
        if let Some(power) = power_of_monomial(base, exponent) {
            return self.multiplied(&product, &power);
        }
        for _ in 0..if base.is_empty() { 1 } else { exponent } {
            product = self.multiplied(&product, base)?;
        }
        Some(product)
    }

    /// A negative power of a polynomial. That of several monomials is a power of an atom, the polynomial over its first
    /// coefficient. None where the polynomial is zero.
    fn reciprocal(&mut self, base: &Polynomial, exponent: i32) -> Option<Polynomial> {
        let base = pruned(base.clone());
        if let Some(power) = power_of_monomial(&base, exponent) {
            return Some(power);
        }
        let leading = *base.values().next()?;
        let monic = multiple(base, 1.0 / leading.value);
        let id = self.node(&monic);
        let (id, sign) = self.pool.as_scaled(id).unwrap_or((id, 1.0));
        self.atoms.insert(id, multiple(monic, 1.0 / sign));
        Some([([(id, exponent)].into(), power(scaled(leading, sign), exponent))].into())
    }

    /// The node of a known polynomial: equal polynomials have the same.
    fn canonical(&mut self, id: Id) -> Id {
        let polynomial = pruned(self.take(id));
        let node = self.node(&polynomial);
        self.atoms.insert(node, polynomial);
        node
    }

    fn node(&mut self, polynomial: &Polynomial) -> Id {
        let terms: Vec<_> = polynomial.iter().map(|(monomial, c)| (self.pool.powers(monomial), c.value)).collect();
        self.pool.linear(0.0, &terms)
    }

    /// What the constructor makes, as an atom with a coefficient.
    fn opaque(&mut self, construct: impl FnOnce(&mut Pool) -> Id) -> Polynomial {
        let id = construct(self.pool);
        if let Some(value) = self.pool.as_number(id) {
            return constant(value);
        }
        let (id, scale) = self.pool.as_scaled(id).unwrap_or((id, 1.0));
        atom(id, 1, scale)
    }

    /// Every square root in the power 0 or 1: its even powers become powers of its argument.
    fn without_squares_of_roots(&mut self, polynomial: Polynomial) -> Option<Polynomial> {
        if polynomial.keys().all(|monomial| self.square_of_root(monomial).is_none()) {
            return Some(polynomial);
        }
        let mut reduced = Polynomial::new();
        let mut pending: Vec<_> = polynomial.into_iter().rev().collect();
        while let Some((monomial, coefficient)) = pending.pop() {
            let Some((position, argument)) = self.square_of_root(&monomial) else {
                include(&mut reduced, monomial, coefficient);
                continue;
            };
            let (root, exponent) = monomial[position];
            let mut rest: Vec<_> = monomial.iter().copied().filter(|(id, _)| *id != root).collect();
            if exponent.rem_euclid(2) == 1 {
                rest.insert(position, (root, 1));
            }
            let rest = Polynomial::from([(rest.into(), coefficient)]);
            let argument = self.atoms[&argument].clone();
            pending.extend(self.times_power(rest, &argument, exponent.div_euclid(2))?);
        }
        Some(reduced)
    }

    /// The position of a square root in a power other than 1, and its argument.
    fn square_of_root(&self, monomial: &Monomial) -> Option<(usize, Id)> {
        monomial.iter().enumerate().find_map(|(position, (id, exponent))| match self.pool.node(*id) {
            Node::Call(Function::Sqrt, arguments) if *exponent != 1 && self.atoms.contains_key(&arguments[0]) => {
                Some((position, arguments[0]))
            }
            _ => None,
        })
    }

    /// The last denominator with its largest exponent: a sum, as atoms to a negative power are.
    fn denominator(&self, polynomial: &Polynomial) -> Option<(Id, i32)> {
        let factors = polynomial.keys().flat_map(|monomial| monomial.iter());
        let below = factors.filter(|(id, exponent)| {
            *exponent < 0 && matches!(self.pool.node(*id), Node::Sum { .. }) && self.atoms.contains_key(id)
        });
        below.map(|&(id, exponent)| (id, -exponent)).max()
    }

    /// The polynomial times `denominator^exponent`.
    fn cleared(&mut self, polynomial: &Polynomial, denominator: Id, exponent: i32) -> Option<Polynomial> {
        let base = self.atoms[&denominator].clone();
        let mut cleared = Polynomial::new();
        for (monomial, &coefficient) in polynomial {
            let (inside, rest): (Vec<_>, Vec<_>) = monomial.iter().partition(|(id, _)| *id == denominator);
            let remaining = exponent + inside.first().map_or(0, |(_, exponent)| *exponent);
            let rest = Polynomial::from([(rest.into(), coefficient)]);
            let term = self.times_power(rest, &base, remaining)?;
            self.add(&mut cleared, &term, &constant(1.0))?;
        }
        Some(cleared)
    }
}

fn constant(value: f64) -> Polynomial {
    if value == 0.0 { Polynomial::new() } else { [(Monomial::default(), exact(value))].into() }
}

fn atom(id: Id, exponent: i32, coefficient: f64) -> Polynomial {
    [([(id, exponent)].into(), exact(coefficient))].into()
}

fn exact(value: f64) -> Coefficient {
    Coefficient { value, size: value.abs() }
}

fn scaled(coefficient: Coefficient, factor: f64) -> Coefficient {
    Coefficient { value: coefficient.value * factor, size: coefficient.size * factor.abs() }
}

fn multiple(mut polynomial: Polynomial, factor: f64) -> Polynomial {
    polynomial.values_mut().for_each(|coefficient| *coefficient = scaled(*coefficient, factor));
    polynomial
}

/// A power of a coefficient, with the same relative error in each factor.
fn power(coefficient: Coefficient, exponent: i32) -> Coefficient {
    let value = coefficient.value.powi(exponent);
    let error = (coefficient.size / coefficient.value.abs()).powi(exponent.saturating_abs());
    Coefficient { value, size: value.abs() * error }
}

fn include(sum: &mut Polynomial, monomial: Monomial, coefficient: Coefficient) {
    let total = sum.entry(monomial).or_insert(Coefficient { value: 0.0, size: 0.0 });
    *total = Coefficient { value: total.value + coefficient.value, size: total.size + coefficient.size };
}

/// The polynomial without the monomials whose coefficients are rounding.
fn pruned(mut polynomial: Polynomial) -> Polynomial {
    polynomial.retain(|_, c| !c.size.is_finite() || c.value.abs() > ROUNDING * c.size);
    polynomial
}

/// The power of a polynomial of one monomial.
fn power_of_monomial(base: &Polynomial, exponent: i32) -> Option<Polynomial> {
    let [(monomial, coefficient)] = <[_; 1]>::try_from(base.iter().collect::<Vec<_>>()).ok()?;
    let powers = monomial.iter().map(|&(id, inner)| (id, inner.saturating_mul(exponent))).filter(|(_, e)| *e != 0);
    Some([(powers.collect(), power(*coefficient, exponent))].into())
}

/// The product of two monomials.
fn joined(left: &[(Id, i32)], right: &[(Id, i32)]) -> Monomial {
    let mut joined = Vec::with_capacity(left.len() + right.len());
    let (mut left, mut right) = (left.iter().peekable(), right.iter().peekable());
    while let (Some(&&(a, m)), Some(&&(b, n))) = (left.peek(), right.peek()) {
        if a == b && m.saturating_add(n) != 0 {
            joined.push((a, m.saturating_add(n)));
        } else if a != b {
            joined.push(if a < b { (a, m) } else { (b, n) });
        }
        if a <= b {
            left.next();
        }
        if b <= a {
            right.next();
        }
    }
    joined.extend(left.chain(right));
    joined.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Symbol, derivative, random, substitute};

    fn states<const N: usize>(pool: &mut Pool) -> [Id; N] {
        std::array::from_fn(|index| pool.symbol(Symbol::State(u32::try_from(index).unwrap())))
    }

    fn cross(pool: &mut Pool, a: [Id; 3], b: [Id; 3]) -> [Id; 3] {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| {
            let (left, right) = (pool.mul(a[i], b[j]), pool.mul(a[j], b[i]));
            pool.sub(left, right)
        })
    }

    fn dot(pool: &mut Pool, a: [Id; 3], b: [Id; 3]) -> Id {
        let products = [0, 1, 2].map(|i| pool.mul(a[i], b[i]));
        pool.sum(&products)
    }

    /// R a, w, and the seeds of R' = skew(w) R.
    fn rotated_vector(pool: &mut Pool) -> ([Id; 3], [Id; 3], BTreeMap<Symbol, Id>) {
        let symbols: [Id; 15] = states(pool);
        let r = [0, 1, 2].map(|row| [0, 1, 2].map(|column| symbols[3 * row + column]));
        let a = [9, 10, 11].map(|index| symbols[index]);
        let w = [12, 13, 14].map(|index| symbols[index]);
        let mut seeds = BTreeMap::new();
        for column in 0..3 {
            let rate = cross(pool, w, r.map(|row| row[column]));
            seeds.extend((0..3).map(|row| (Symbol::State(3 * row + column as u32), rate[row as usize])));
        }
        (r.map(|row| dot(pool, row, a)), w, seeds)
    }

    #[test]
    fn velocity_of_a_point_of_a_body() {
        let mut pool = Pool::new();
        let (arm, w, seeds) = rotated_vector(&mut pool);
        let velocity = derivative(&mut pool, &arm, &seeds);
        let expected = cross(&mut pool, w, arm);
        for (i, &rate) in velocity.iter().enumerate() {
            assert!(same_polynomial(&mut pool, rate, expected[i]));
            assert!(!same_polynomial(&mut pool, rate, expected[(i + 1) % 3]));
            let opposite = pool.neg(expected[i]);
            assert!(!same_polynomial(&mut pool, rate, opposite));
        }
    }

    #[test]
    fn length_of_a_rotated_vector_is_constant() {
        let mut pool = Pool::new();
        let (arm, _, mut seeds) = rotated_vector(&mut pool);
        let zero = pool.zero();
        let square = dot(&mut pool, arm, arm);
        let rate = derivative(&mut pool, &[square], &seeds)[0];
        assert!(same_polynomial(&mut pool, rate, zero));
        seeds.insert(Symbol::State(0), pool.one());
        let rate = derivative(&mut pool, &[square], &seeds)[0];
        assert!(!same_polynomial(&mut pool, rate, zero));
    }

    #[test]
    fn powers_and_rounding() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let sum = pool.linear(0.0, &[(x, 0.1), (y, 0.2)]);
        let cube = pool.powi(sum, 3);
        let terms = [(3, 0, 0.001), (2, 1, 0.006), (1, 2, 0.012), (0, 3, 0.008)];
        let terms: Vec<_> = terms.iter().map(|&(m, n, c)| (pool.powers(&[(x, m), (y, n)]), c)).collect();
        let expanded = pool.linear(0.0, &terms);
        assert!(same_polynomial(&mut pool, cube, expanded));
        let wrong = pool.linear(0.0, &[(expanded, 1.0), (x, 1e-9)]);
        assert!(!same_polynomial(&mut pool, cube, wrong));
    }

    #[test]
    fn a_large_coefficient_elsewhere_hides_nothing() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let a = pool.linear(0.0, &[(x, 1e15), (y, 1.0)]);
        let stiff = pool.scale(1e15, x);
        assert!(!same_polynomial(&mut pool, a, stiff));
    }

    #[test]
    fn arguments_of_calls_are_compared_expanded() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let sum = pool.add(x, y);
        let square = pool.powi(sum, 2);
        let terms = [(pool.powi(x, 2), 1.0), (pool.mul(x, y), 2.0), (pool.powi(y, 2), 1.0)];
        let expanded = pool.linear(0.0, &terms);
        let sines = [square, expanded].map(|argument| pool.call(Function::Sin, &[argument]));
        assert!(sines[0] != sines[1] && same_polynomial(&mut pool, sines[0], sines[1]));
        let selects = [square, expanded].map(|branch| pool.select(0, branch, x));
        assert!(same_polynomial(&mut pool, selects[0], selects[1]));
        let other = pool.select(1, square, x);
        assert!(!same_polynomial(&mut pool, selects[0], other));
    }

    #[test]
    fn fractions() {
        let mut pool = Pool::new();
        let [x, y, z] = states(&mut pool);
        let sum = pool.add(x, y);
        let (left, right) = (pool.div(x, sum), pool.div(y, sum));
        let one = pool.one();
        let whole = pool.add(left, right);
        assert!(same_polynomial(&mut pool, whole, one));
        assert!(!same_polynomial(&mut pool, left, right));
        let double = pool.linear(0.0, &[(x, -2.0), (y, -2.0)]);
        let (half, inverse) = (pool.powi(double, -1), pool.powi(sum, -1));
        let negative = pool.scale(-2.0, half);
        assert!(same_polynomial(&mut pool, negative, inverse));
        let nested = pool.add(inverse, z);
        let nested = pool.powi(nested, -1);
        let product = pool.mul(z, sum);
        let product = pool.linear(1.0, &[(product, 1.0)]);
        let simple = pool.div(sum, product);
        assert!(same_polynomial(&mut pool, nested, simple));
    }

    #[test]
    fn squares_of_roots() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let squares = [pool.powi(x, 2), pool.powi(y, 2)];
        let square = pool.sum(&squares);
        let root = pool.call(Function::Sqrt, &[square]);
        let (plus, minus) = (pool.linear(1.0, &[(root, 1.0)]), pool.linear(-1.0, &[(root, 1.0)]));
        let product = pool.mul(plus, minus);
        let expected = pool.linear(-1.0, &[(square, 1.0)]);
        assert!(same_polynomial(&mut pool, product, expected));
        let (inverse, fraction) = (pool.powi(root, -1), pool.div(root, square));
        assert!(same_polynomial(&mut pool, inverse, fraction));
    }

    #[test]
    fn a_zero_denominator_proves_nothing() {
        let mut pool = Pool::new();
        let [x, y, z] = states(&mut pool);
        let (sum, difference) = (pool.add(x, y), pool.sub(x, y));
        let terms = [(pool.mul(sum, difference), 1.0), (pool.powi(x, 2), -1.0), (pool.powi(y, 2), 1.0)];
        let zero = pool.linear(0.0, &terms);
        let fraction = pool.div(z, zero);
        assert!(!same_polynomial(&mut pool, fraction, z));
    }

    #[test]
    fn infinite_and_vanishing_coefficients() {
        let mut pool = Pool::new();
        let [x, y] = states(&mut pool);
        let (zero, infinite) = (pool.zero(), pool.scale(f64::INFINITY, x));
        assert!(!same_polynomial(&mut pool, infinite, zero));
        let sums = [(0.1, 0.1), (0.2, 0.2), (0.3, 0.3)].map(|(c, d)| pool.linear(c, &[(x, d), (y, 1.0)]));
        let products = sums.map(|sum| pool.mul(sum, y));
        let square = pool.powi(y, 2);
        let noise = pool.linear(0.0, &[(products[0], 1.0), (products[1], 1.0), (products[2], -1.0), (square, -1.0)]);
        assert!(same_polynomial(&mut pool, noise, zero));
        let (split, whole) = (pool.linear(0.1 + 0.2, &[(x, 1.0)]), pool.linear(0.3, &[(x, 1.0)]));
        assert!(split != whole && same_polynomial(&mut pool, split, whole));
        let inverse = pool.powi(noise, -1);
        assert!(!same_polynomial(&mut pool, inverse, zero));
    }

    #[test]
    fn gives_up_on_large_expansions() {
        let mut pool = Pool::new();
        let symbols: [Id; 12] = states(&mut pool);
        let sum = pool.sum(&symbols);
        let power = pool.powi(sum, 12);
        let zero = pool.zero();
        assert!(!same_polynomial(&mut pool, power, zero));
    }

    #[test]
    fn a_long_chain_of_sums() {
        let mut pool = Pool::new();
        let symbols: Vec<_> = (0..10_000).map(|index| pool.symbol(Symbol::Parameter(index))).collect();
        let forward = symbols.iter().fold(pool.zero(), |sum, &x| pool.add(sum, x));
        let backward = symbols.iter().rev().fold(pool.zero(), |sum, &x| pool.add(x, sum));
        assert!(same_polynomial(&mut pool, forward, backward));
    }

    #[test]
    fn random_expressions_times_a_sum() {
        for seed in 0..40 {
            let mut pool = Pool::new();
            let roots = random::Source::new(seed).expressions(&mut pool, 14);
            let (a, b, c) = (roots[13], roots[12], roots[11]);
            let sum = pool.add(a, b);
            let product = pool.mul(sum, c);
            let products = [pool.mul(a, c), pool.mul(b, c)];
            let expanded = pool.sum(&products);
            assert!(same_polynomial(&mut pool, product, expanded), "seed {seed}");
            let x = pool.symbol(Symbol::State(0));
            let more = pool.add(expanded, x);
            assert!(!same_polynomial(&mut pool, product, more), "seed {seed}");
            let moved = substitute(&mut pool, &[product], &|symbol| (symbol == Symbol::State(9)).then_some(x));
            assert_eq!(moved, [product]);
        }
    }
}
