//! Reverse sweeps against derivatives of expressions.

use std::collections::BTreeMap;

use super::values::Source;
use super::{Routine, run, schedule};
use crate::expr::{Environment, Function, Id, Pool, Symbol, derivative, evaluate};
use crate::random::Random;
use crate::schedule::{Operand, Request, Reverse, reverse};

const STATES: usize = 6;
const PARAMETERS: usize = 4;

/// The derivatives of the weighted results by states, then by parameters: through the sweeps of the routine and of its
/// constants.
fn swept(sweeps: [&Reverse; 2], constants: &Routine, weights: &[f64], environment: &Environment) -> Vec<f64> {
    let [of_routine, of_constants] = sweeps;
    let table = run(constants, &[], environment);
    let mut by = vec![0.0; STATES + PARAMETERS];
    let mut by_constants = vec![0.0; table.len()];
    let values = run(&of_routine.routine, &table, &Environment { weights, ..*environment });
    for (leaf, value) in of_routine.leaves.iter().zip(values) {
        match *leaf {
            Operand::Symbol(Symbol::State(index)) => by[index as usize] = value,
            Operand::Constant(index) => by_constants[index as usize] = value,
            other => panic!("{other:?} is no leaf"),
        }
    }
    let values = run(&of_constants.routine, &[], &Environment { weights: &by_constants, ..*environment });
    for (leaf, value) in of_constants.leaves.iter().zip(values) {
        let Operand::Symbol(Symbol::Parameter(index)) = *leaf else { panic!("{leaf:?} is no leaf") };
        by[STATES + index as usize] = value;
    }
    by
}

/// The same by derivatives of the expressions, each with the sum of the magnitudes of its parts.
fn expected(pool: &mut Pool, roots: &[Id], weights: &[f64], environment: &Environment) -> Vec<(f64, f64)> {
    let symbols = (0..STATES).map(Symbol::state);
    let symbols = symbols.chain((0..PARAMETERS).map(|index| Symbol::numbered(Symbol::Parameter, index)));
    let one = pool.one();
    let of = |symbol| {
        let slopes = derivative(pool, roots, &BTreeMap::from([(symbol, one)]));
        let parts = evaluate(pool, &slopes, environment).into_iter().zip(weights).map(|(slope, weight)| slope * weight);
        parts.fold((0.0, 0.0), |(sum, size), part| (sum + part, size + part.abs()))
    };
    symbols.map(of).collect()
}

fn compare(pool: &mut Pool, roots: &[Id], source: &mut Source) {
    let program = schedule(pool, [Request { name: "rate", roots }]);
    let [routine] = &program.routines;
    let sweeps = [
        reverse(routine, roots.len(), "reverse_rate"),
        reverse(&program.constants, program.constants.results.len(), "reverse_constants"),
    ];
    for _ in 0..3 {
        let mut numbers = |count: usize| (0..count).map(|_| 0.6 + 0.3 * source.number()).collect::<Vec<_>>();
        let (states, parameters, unknowns, inputs) = (numbers(STATES), numbers(PARAMETERS), numbers(1), numbers(1));
        let weights = numbers(roots.len());
        let negative = [source.below(2) == 0, source.below(2) == 0];
        let environment = Environment {
            time: 0.3,
            states: &states,
            parameters: &parameters,
            unknowns: &unknowns,
            inputs: &inputs,
            negative: &negative,
            ..Environment::default()
        };
        let found = swept([&sweeps[0], &sweeps[1]], &program.constants, &weights, &environment);
        for (found, (expected, size)) in found.iter().zip(expected(pool, roots, &weights, &environment)) {
            assert!((found - expected).abs() <= 1e-11 * (1.0 + size), "{found} instead of {expected} of {size}");
        }
    }
}

#[test]
fn random_graphs() {
    for seed in 0..40 {
        let mut source = Source(Random::new(seed));
        let mut pool = Pool::new();
        let count = 20 + source.below(100);
        let found = source.expressions(&mut pool, count);
        let roots: Vec<Id> = (0..5).map(|_| found[found.len() - 1 - source.below(20)]).collect();
        compare(&mut pool, &roots, &mut source);
    }
}

#[test]
fn every_function() {
    use Function::{Abs, Acos, Asin, Atan2, Cos, Exp, Ln, Pow, Sin, Sqrt, Tan, Tanh};
    let mut pool = Pool::new();
    let [x, y] = [0, 1].map(|index| pool.symbol(Symbol::State(index)));
    let p = pool.symbol(Symbol::Parameter(0));
    let (two, below) = (pool.number(2.5), pool.neg(x));
    let mut roots: Vec<Id> = [Sqrt, Sin, Cos, Tan, Asin, Acos, Exp, Ln, Tanh, Abs]
        .into_iter()
        .flat_map(|function| {
            let of_product = pool.mul(x, p);
            [x, of_product].map(|argument| pool.call(function, &[argument]))
        })
        .collect();
    for [first, second] in [[x, y], [y, p], [x, two], [p, x]] {
        roots.extend([Atan2, Pow].map(|function| pool.call(function, &[first, second])));
    }
    roots.push(pool.call(Abs, &[below]));
    compare(&mut pool, &roots, &mut Source(Random::new(7)));
}

#[test]
fn what_no_derivative_needs_is_not_there() {
    let mut pool = Pool::new();
    let ([x, y], p) = ([0, 1].map(|index| pool.symbol(Symbol::State(index))), pool.symbol(Symbol::Parameter(0)));
    let time = pool.symbol(Symbol::Time);
    // p x + sin(t): its sweep needs neither the product nor the sine.
    let (product, sine) = (pool.mul(p, x), pool.call(Function::Sin, &[time]));
    let roots = [pool.add(product, sine), y];
    let program = schedule(&mut pool, [Request { name: "rate", roots: &roots }]);
    let sweep = reverse(&program.routines[0], 2, "reverse_rate");
    assert_eq!(sweep.routine.counts.total(), 2, "{:?}", sweep.routine.assignments);
    let only_first = reverse(&program.routines[0], 1, "reverse_rate");
    assert_eq!(only_first.leaves, [Operand::Symbol(Symbol::State(0)), Operand::Constant(0)]);
}
