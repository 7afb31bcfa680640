//! Derivatives.
//!
//! In: nodes and what to differentiate by. Out: the derivatives as nodes.
//! Method: forward and reverse accumulation over the graph (Griewank & Walther 2008, Evaluating Derivatives, ch. 3).

use std::collections::BTreeMap;

use rustc_hash::{FxHashMap, FxHashSet};

use super::{Function, Id, Node, Pool, Symbol, children};

/// The directional derivatives of the nodes, where each symbol changes at the rate `seeds[symbol]`, or not at all.
pub fn derivative(pool: &mut Pool, of: &[Id], seeds: &BTreeMap<Symbol, Id>) -> Vec<Id> {
    let mut tangents: FxHashMap<Id, Id> = FxHashMap::default();
    for id in pool.reachable(of) {
        let tangent = tangent(pool, id, seeds, &tangents);
        if !pool.is_zero(tangent) {
            tangents.insert(id, tangent);
        }
    }
    of.iter().map(|id| tangents.get(id).copied().unwrap_or(pool.zero())).collect()
}

/// The partial derivatives of the nodes by one symbol.
pub fn partial(pool: &mut Pool, of: &[Id], wrt: Symbol) -> Vec<Id> {
    let seeds = BTreeMap::from([(wrt, pool.one())]);
    derivative(pool, of, &seeds)
}

/// The partial derivatives of one node by each of the symbols.
pub fn gradient(pool: &mut Pool, of: Id, wrt: &[Symbol]) -> Vec<Id> {
    let nodes = pool.reachable(&[of]);
    let active = dependents(pool, &nodes, wrt);
    let slopes = slopes_of_selects(pool, &nodes, &active, wrt);
    let mut adjoints: FxHashMap<Id, Vec<Id>> = FxHashMap::from_iter([(of, vec![pool.one()])]);
    let mut parts: Vec<Vec<Id>> = vec![Vec::new(); wrt.len()];
    for &id in nodes.iter().rev().filter(|id| active.contains(id)) {
        let Some(contributions) = adjoints.remove(&id) else { continue };
        let adjoint = pool.sum(&contributions);
        if let Some(slopes) = slopes.get(&id) {
            for (part, &slope) in parts.iter_mut().zip(slopes) {
                part.push(pool.mul(adjoint, slope));
            }
        } else if let Node::Symbol(symbol) = *pool.node(id) {
            let equal = parts.iter_mut().zip(wrt).filter(|(_, other)| **other == symbol);
            equal.for_each(|(part, _)| part.push(adjoint));
        }
        for (child, partial) in partials(pool, id, &|child| active.contains(&child)) {
            adjoints.entry(child).or_default().push(pool.mul(adjoint, partial));
        }
    }
    parts.iter().map(|part| pool.sum(part)).collect()
}

/// The rate of a node whose children's rates are known, where they are not zero.
fn tangent(pool: &mut Pool, id: Id, seeds: &BTreeMap<Symbol, Id>, tangents: &FxHashMap<Id, Id>) -> Id {
    match *pool.node(id) {
        Node::Symbol(symbol) => seeds.get(&symbol).copied().unwrap_or(pool.zero()),
        Node::Select { switch, negative, positive } => {
            let rate = |id| tangents.get(&id).copied().unwrap_or(pool.zero());
            let (negative, positive) = (rate(negative), rate(positive));
            pool.select(switch, negative, positive)
        }
        _ => {
            let partials = partials(pool, id, &|child| tangents.contains_key(&child));
            let parts: Vec<_> = partials.iter().map(|(child, partial)| pool.mul(*partial, tangents[child])).collect();
            pool.sum(&parts)
        }
    }
}

/// The nodes that contain one of the symbols.
fn dependents(pool: &Pool, nodes: &[Id], wrt: &[Symbol]) -> FxHashSet<Id> {
    let mut found = FxHashSet::default();
    for &id in nodes {
        let node = pool.node(id);
        let is_wrt = matches!(node, Node::Symbol(symbol) if wrt.contains(symbol));
        if is_wrt || children(node).any(|child| found.contains(&child)) {
            found.insert(id);
        }
    }
    found
}

/// The derivatives of all switched values by each of the symbols. They are differentiated forward, branch by branch: in
/// a reverse sweep the branch that is switched off would contribute 0 times a value that may not be finite.
fn slopes_of_selects(pool: &mut Pool, nodes: &[Id], active: &FxHashSet<Id>, wrt: &[Symbol]) -> BTreeMap<Id, Vec<Id>> {
    let is_select = |id: &Id| active.contains(id) && matches!(pool.node(*id), Node::Select { .. });
    let selects: Vec<_> = nodes.iter().copied().filter(is_select).collect();
    let mut slopes: BTreeMap<Id, Vec<Id>> = BTreeMap::new();
    if selects.is_empty() {
        return slopes;
    }
    for &symbol in wrt {
        for (id, slope) in selects.iter().zip(partial(pool, &selects, symbol)) {
            slopes.entry(*id).or_default().push(slope);
        }
    }
    slopes
}

/// The active children of a sum, product or call, each with the partial derivative by it. An angle of its own sine and
/// cosine changes as it does, without either.
fn partials(pool: &mut Pool, id: Id, active: &dyn Fn(Id) -> bool) -> Vec<(Id, Id)> {
    match pool.node(id).clone() {
        Node::Number(_) | Node::Symbol(_) | Node::Select { .. } => Vec::new(),
        Node::Sum { terms, .. } => {
            let terms = terms.iter().filter(|(term, _)| active(*term));
            terms.map(|(term, coefficient)| (*term, pool.number(coefficient.value()))).collect()
        }
        Node::Product(factors) => {
            let factors = factors.iter().filter(|(base, _)| active(*base));
            factors.map(|&(base, exponent)| (base, slope_of_power(pool, id, base, exponent))).collect()
        }
        Node::Call(Function::Atan2, arguments) if let Some(angle) = angle_of_itself(pool, &arguments) => {
            [angle].into_iter().filter(|&angle| active(angle)).map(|angle| (angle, pool.one())).collect()
        }
        Node::Call(function, arguments) => {
            let positions = (0..arguments.len()).filter(|&position| active(arguments[position]));
            positions
                .map(|position| (arguments[position], slope_of_call(pool, id, function, &arguments, position)))
                .collect()
        }
    }
}

/// The angle a of `atan2(sin a, cos a)`.
fn angle_of_itself(pool: &Pool, arguments: &[Id]) -> Option<Id> {
    let (Node::Call(Function::Sin, angle), Node::Call(Function::Cos, other)) =
        (pool.node(arguments[0]), pool.node(*arguments.get(1)?))
    else {
        return None;
    };
    (angle == other).then_some(angle[0])
}

/// The partial derivative of a product by the base of one of its factors.
fn slope_of_power(pool: &mut Pool, product: Id, base: Id, exponent: i32) -> Id {
    let rest = pool.div(product, base);
    pool.scale(f64::from(exponent), rest)
}

/// The partial derivative of a call by one of its arguments.
fn slope_of_call(pool: &mut Pool, call: Id, function: Function, arguments: &[Id], position: usize) -> Id {
    let x = arguments[0];
    match function {
        Function::Sqrt => {
            let inverse = pool.powi(call, -1);
            pool.scale(0.5, inverse)
        }
        Function::Sin => pool.call(Function::Cos, &[x]),
        Function::Cos => {
            let sine = pool.call(Function::Sin, &[x]);
            pool.neg(sine)
        }
        Function::Tan => one_plus_square(pool, call, 1.0),
        Function::Asin => inverse_sine_slope(pool, x),
        Function::Acos => {
            let slope = inverse_sine_slope(pool, x);
            pool.neg(slope)
        }
        Function::Atan2 => slope_of_atan2(pool, arguments, position),
        Function::Exp => call,
        Function::Ln => pool.powi(x, -1),
        Function::Tanh => one_plus_square(pool, call, -1.0),
        Function::Abs => pool.div(x, call),
        Function::Pow if position == 0 => {
            let exponent = pool.linear(-1.0, &[(arguments[1], 1.0)]);
            let power = pool.call(Function::Pow, &[x, exponent]);
            pool.mul(arguments[1], power)
        }
        Function::Pow => {
            let logarithm = pool.call(Function::Ln, &[x]);
            pool.mul(call, logarithm)
        }
    }
}

/// `1 + factor * a^2`
fn one_plus_square(pool: &mut Pool, a: Id, factor: f64) -> Id {
    let square = pool.powi(a, 2);
    pool.linear(1.0, &[(square, factor)])
}

/// `1 / sqrt(1 - x^2)`
fn inverse_sine_slope(pool: &mut Pool, x: Id) -> Id {
    let radicand = one_plus_square(pool, x, -1.0);
    let root = pool.call(Function::Sqrt, &[radicand]);
    pool.powi(root, -1)
}

/// `x / (x^2 + y^2)` by y, which is the first argument, and `-y / (x^2 + y^2)` by x.
fn slope_of_atan2(pool: &mut Pool, arguments: &[Id], position: usize) -> Id {
    let squares = [pool.powi(arguments[0], 2), pool.powi(arguments[1], 2)];
    let radius = pool.sum(&squares);
    let slope = pool.div(arguments[1 - position], radius);
    if position == 0 { slope } else { pool.neg(slope) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, evaluate, random};

    const STATES: [Symbol; 4] = [Symbol::State(0), Symbol::State(1), Symbol::State(2), Symbol::State(3)];
    const POINT: [f64; 4] = [0.37, -0.81, 0.54, 1.13];
    const SWITCHES: [[bool; 2]; 3] = [[false, false], [true, false], [false, true]];

    fn environment<'a>(states: &'a [f64], negative: &'a [bool]) -> Environment<'a> {
        Environment { states, negative, ..Environment::default() }
    }

    fn is_near(a: f64, b: f64, tolerance: f64) -> bool {
        (a - b).abs() <= tolerance * (1.0 + a.abs() + b.abs())
    }

    /// Central difference of fourth order along a direction.
    fn difference(pool: &Pool, of: Id, direction: &[f64; 4], negative: &[bool]) -> f64 {
        let step = 1e-3;
        let at = |factor: f64| {
            let states = std::array::from_fn::<_, 4, _>(|i| POINT[i] + factor * step * direction[i]);
            evaluate(pool, &[of], &environment(&states, negative))[0]
        };
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step)
    }

    #[test]
    fn derivatives_are_the_limits_of_differences() {
        for seed in 0..300 {
            let mut pool = Pool::new();
            let mut source = random::Source::new(seed);
            let roots = source.expressions(&mut pool, 16);
            let direction = std::array::from_fn(|_| source.number());
            let seeds = STATES.into_iter().zip(direction.map(|rate| pool.number(rate))).collect();
            let rates = derivative(&mut pool, &roots, &seeds);
            for negative in SWITCHES {
                let values = evaluate(&pool, &rates, &environment(&POINT, &negative));
                for (root, value) in roots.iter().zip(values) {
                    let expected = difference(&pool, *root, &direction, &negative);
                    assert!(is_near(value, expected, 1e-6), "seed {seed}: {value} {expected}");
                }
            }
        }
    }

    #[test]
    fn gradients_are_derivatives() {
        for seed in 0..300 {
            let mut pool = Pool::new();
            let roots = random::Source::new(seed).expressions(&mut pool, 30);
            let wrt = [STATES[2], STATES[0], STATES[2], Symbol::Time];
            let gradient = gradient(&mut pool, roots[29], &wrt);
            let rates = wrt.map(|symbol| {
                let seeds = BTreeMap::from([(symbol, pool.one())]);
                derivative(&mut pool, &roots[29..], &seeds)[0]
            });
            for negative in SWITCHES {
                let environment = environment(&POINT, &negative);
                let (left, right) = (evaluate(&pool, &gradient, &environment), evaluate(&pool, &rates, &environment));
                let near = left.iter().zip(&right).all(|(a, b)| is_near(*a, *b, 1e-10));
                assert!(near && left[3] == 0.0, "seed {seed}: {left:?} {right:?}");
            }
        }
    }

    #[test]
    fn seeds_may_be_expressions() {
        let mut pool = Pool::new();
        let [x, y, ..] = STATES.map(|symbol| pool.symbol(symbol));
        let product = pool.mul(x, y);
        let sine = pool.call(Function::Sin, &[x]);
        let seeds = BTreeMap::from([(STATES[0], y), (STATES[1], sine)]);
        let rates = derivative(&mut pool, &[product, x, y], &seeds);
        let (square, other) = (pool.powi(y, 2), pool.mul(x, sine));
        assert_eq!(rates, [pool.add(square, other), y, sine]);
        let one = pool.one();
        assert_eq!(derivative(&mut pool, &[one, product], &BTreeMap::new()), [pool.zero(), pool.zero()]);
    }

    #[test]
    fn slopes_in_canonical_form() {
        let mut pool = Pool::new();
        let x = pool.symbol(STATES[0]);
        let seeds = BTreeMap::from([(STATES[0], pool.one())]);
        let size = pool.call(Function::Abs, &[x]);
        let sine = pool.call(Function::Sin, &[x]);
        let cube = pool.powi(x, 3);
        let rates = derivative(&mut pool, &[size, sine, cube], &seeds);
        let square = pool.powi(x, 2);
        let expected = [pool.div(x, size), pool.call(Function::Cos, &[x]), pool.scale(3.0, square)];
        assert_eq!(rates, expected);
    }

    #[test]
    fn the_branch_that_is_off_does_not_matter() {
        let mut pool = Pool::new();
        let x = pool.symbol(STATES[0]);
        let root = pool.call(Function::Sqrt, &[x]);
        let select = pool.select(0, x, root);
        let of = pool.powi(select, 2);
        let slope = gradient(&mut pool, of, &STATES[..1]);
        assert_eq!(evaluate(&pool, &slope, &environment(&[-3.0], &[true])), [-6.0]);
    }

    #[test]
    fn chains_of_50_000_nodes() {
        let mut pool = Pool::new();
        let [x, y, ..] = STATES.map(|symbol| pool.symbol(symbol));
        let chain = (0..25_000).fold(x, |link, index| {
            let parameter = pool.symbol(Symbol::Parameter(index));
            let part = pool.mul(parameter, y);
            pool.add(link, part)
        });
        assert!(pool.reachable(&[chain]).len() > 50_000);
        let seeds = BTreeMap::from([(STATES[1], pool.one())]);
        let rate = derivative(&mut pool, &[chain], &seeds)[0];
        let slopes = gradient(&mut pool, chain, &STATES[..2]);
        let parameters = vec![0.5; 25_000];
        let environment = Environment { parameters: &parameters, states: &POINT, ..Environment::default() };
        assert_eq!(evaluate(&pool, &[rate, slopes[0], slopes[1]], &environment), [12_500.0, 1.0, 12_500.0]);
    }
}
