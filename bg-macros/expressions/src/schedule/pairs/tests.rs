//! Paired code gives the routine's results, in fewer operations where things repeat themselves.

use super::{Half, Paired, Search, Step, Value, pair, paired};
use crate::expr::random::Source;
use crate::expr::{Environment, Function, Id, Pool, Symbol};
use crate::schedule::tests::{apply_operation, run, value};
use crate::schedule::{Program, Request, schedule};

/// The results of paired code, by an interpreter.
fn results(of: &Paired, constants: &[f64], environment: &Environment) -> Vec<f64> {
    let mut temporaries = vec![f64::NAN; 10_000];
    let mut pairs: Vec<[f64; 2]> = Vec::new();
    for step in &of.steps {
        match step {
            Step::Single(assignment) => {
                let result = apply_operation(&assignment.operation, &temporaries, constants, environment);
                temporaries[assignment.target as usize] = result;
            }
            Step::Half { target, pair, half } => temporaries[*target as usize] = pairs[*pair as usize][*half],
            Step::Pair(index, pair) => {
                assert_eq!(*index as usize, pairs.len());
                let of_both = |a: &u32, b: &u32, operation: fn(f64, f64) -> f64| {
                    let [a, b] = [a, b].map(|index| pairs[*index as usize]);
                    [operation(a[0], b[0]), operation(a[1], b[1])]
                };
                let signed = |value: f64, is_negative: bool| if is_negative { -value } else { value };
                let pair = match pair {
                    Value::States(index) => {
                        [*index as usize, *index as usize + 1].map(|index| environment.states[index])
                    }
                    Value::Numbers(numbers) => *numbers,
                    Value::Constants(index) => of.constants[*index as usize].map(|(constant, is_negative)| {
                        signed(value(&constant, &temporaries, constants, environment), is_negative)
                    }),
                    Value::Gather(halves) => {
                        halves.map(|half| half_of(&half, &pairs, &temporaries, constants, environment))
                    }
                    Value::Add(a, b) => of_both(a, b, |a, b| a + b),
                    Value::Subtract(a, b) => of_both(a, b, |a, b| a - b),
                    Value::Multiply(a, b) => of_both(a, b, |a, b| a * b),
                    Value::Divide(a, b) => of_both(a, b, |a, b| a / b),
                    Value::Turn(of, turn) => {
                        let of = pairs[*of as usize];
                        [signed(of[0], turn[0]), signed(of[1], turn[1])]
                    }
                };
                pairs.push(pair);
            }
        }
    }
    of.results.iter().map(|half| half_of(half, &pairs, &temporaries, constants, environment)).collect()
}

fn half_of(half: &Half, pairs: &[[f64; 2]], temporaries: &[f64], constants: &[f64], environment: &Environment) -> f64 {
    match half {
        Half::Of(operand) => value(operand, temporaries, constants, environment),
        Half::In(pair, half) => pairs[*pair as usize][*half],
    }
}

fn program(pool: &mut Pool, roots: &[Id]) -> Program<1> {
    schedule(pool, [Request { name: "rate", roots }])
}

/// Every value that is read has been written, and the bits of the results are the routine's, but for the sign of a
/// zero where the search may change it. Gives what each search finds.
fn agrees(pool: &mut Pool, roots: &[Id], environments: &[Environment]) -> [Paired; 2] {
    let program = program(pool, roots);
    let routine = &program.routines[0];
    [Search::Thorough, Search::Short].map(|search| {
        let paired = paired(routine, search);
        for environment in environments {
            let constants = run(&program.constants, &[], environment);
            let expected = run(routine, &constants, environment);
            let found = results(&paired, &constants, environment);
            assert_eq!(expected.len(), found.len());
            for (expected, found) in expected.iter().zip(&found) {
                let is_zero = search == Search::Thorough && *expected == 0.0 && *found == 0.0;
                assert!(expected.to_bits() == found.to_bits() || is_zero, "{search:?}: {expected} {found}");
            }
        }
        paired
    })
}

#[test]
fn random_routines_keep_every_bit() {
    for seed in 0..60 {
        let mut source = Source::new(seed);
        let mut pool = Pool::new();
        let expressions = source.expressions(&mut pool, 8 + 4 * seed as usize);
        let roots = &expressions[expressions.len() / 2..];
        // Zeros of both signs are among the states.
        let states = [[0.3, -0.7, 1.1, 0.9], [0.0, -0.7, -0.0, 0.9], [-0.0, 0.0, 0.0, -0.0]];
        let environments =
            states.each_ref().map(|states| Environment { states, negative: &[false, true], ..Environment::default() });
        agrees(&mut pool, roots, &environments);
    }
}

/// A point mass on a damped spring in the plane, with a constant force and the spring in x turned round.
fn planar_oscillator(pool: &mut Pool) -> Vec<Id> {
    let [x, y, p_x, p_y] = [0, 1, 2, 3].map(|index| pool.symbol(Symbol::State(index)));
    let [k, c, mass, force] = [0, 1, 2, 3].map(|index| pool.symbol(Symbol::Parameter(index)));
    let mut axis = |position: Id, momentum: Id, is_turned: bool| {
        let speed = pool.div(momentum, mass);
        let (spring, damper) = (pool.mul(k, position), pool.mul(c, speed));
        let spring = if is_turned { pool.neg(spring) } else { spring };
        let sum = pool.add(spring, damper);
        let rate = pool.sub(force, sum);
        (speed, rate)
    };
    let ((v_x, f_x), (v_y, f_y)) = (axis(x, p_x, true), axis(y, p_y, false));
    vec![v_x, v_y, f_x, f_y]
}

#[test]
fn two_axes_take_as_many_operations_as_one() {
    let mut pool = Pool::new();
    let roots = planar_oscillator(&mut pool);
    let environment =
        Environment { states: &[0.1, -0.2, 3.0, 4.0], parameters: &[20.0, 0.5, 2.0, 9.81], ..Environment::default() };
    let found = agrees(&mut pool, &roots, &[environment]);
    let program = program(&mut pool, &roots);
    assert_eq!((program.routines[0].counts.total(), found.each_ref().map(Paired::operations)), (10, [5, 5]));
    assert!(found.iter().flat_map(|paired| &paired.results).all(|result| matches!(result, Half::In(..))));
    assert_eq!(pair(&program.routines[0], Search::Thorough), None, "too short for pairs to matter");
}

#[test]
fn where_nothing_repeats_there_are_no_pairs() {
    let mut pool = Pool::new();
    let x = pool.symbol(Symbol::State(0));
    let chain = (0..40).fold(x, |value, index| {
        let (square, number) = (pool.mul(value, value), pool.number(f64::from(index) + 0.5));
        pool.add(square, number)
    });
    let program = program(&mut pool, &[chain]);
    assert_eq!(pair(&program.routines[0], Search::Thorough), None);
    assert_eq!(pair(&program.routines[0], Search::Short), None);
}

/// Two sums that start from neighbouring states and are neighbouring results, but the second needs the first.
#[test]
fn operations_that_need_each_other_are_no_pair() {
    let mut pool = Pool::new();
    let [x, y, z] = [0, 1, 2].map(|index| pool.symbol(Symbol::State(index)));
    let first = pool.add(x, z);
    let sine = pool.call(Function::Sin, &[first]);
    let second = pool.add(y, sine);
    let environment = Environment { states: &[0.3, 0.7, -0.2], ..Environment::default() };
    let found = agrees(&mut pool, &[first, second], &[environment]);
    assert!(found.iter().flat_map(|paired| &paired.steps).all(|step| matches!(step, Step::Single(_))));
}
