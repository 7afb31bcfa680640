//! Values of programs against the interpreter of expressions, and the properties of all programs.

use super::*;
use crate::expr::{Function, Number, evaluate};
use crate::expr::{Node, children};
use crate::random::Random;
use std::collections::BTreeMap;

pub(super) struct Source(pub Random);

impl Source {
    pub fn below(&mut self, end: usize) -> usize {
        self.0.below(end)
    }

    pub fn number(&mut self) -> f64 {
        self.below(2001) as f64 / 1000.0 - 1.0
    }

    /// Expressions over six states, four parameters and an unknown; the later ones are made of the earlier ones.
    pub fn expressions(&mut self, pool: &mut Pool, count: usize) -> Vec<Id> {
        let mut found: Vec<Id> = (0..6).map(|index| pool.symbol(Symbol::State(index))).collect();
        found.extend((0..4).map(|index| pool.symbol(Symbol::Parameter(index))));
        found.extend([Symbol::Time, Symbol::Unknown(0), Symbol::Input(0)].map(|symbol| pool.symbol(symbol)));
        while found.len() < count {
            let pick: [Id; 4] = std::array::from_fn(|_| {
                let near = self.below(3) > 0;
                let first = if near { found.len().saturating_sub(40) } else { 0 };
                found[first + self.below(found.len() - first)]
            });
            let new = self.expression(pool, pick);
            found.push(new);
        }
        found
    }

    fn expression(&mut self, pool: &mut Pool, [a, b, c, d]: [Id; 4]) -> Id {
        match self.below(14) {
            0 => pool.add(a, b),
            1 => pool.sub(a, b),
            2 | 3 => {
                let terms = [(a, self.number()), (b, 1.0), (c, -1.0), (d, self.number())];
                let sum = pool.linear(self.number(), &terms);
                let three = pool.number(3.0);
                pool.div(sum, three)
            }
            4..=6 => {
                let [ab, ac, bd] = [pool.mul(a, b), pool.mul(a, c), pool.mul(b, d)];
                let sum = pool.linear(0.0, &[(ab, 1.0), (ac, -1.0), (bd, 2.0)]);
                self.bounded(pool, sum)
            }
            7 => {
                let product = pool.product(&[a, b, c]);
                self.bounded(pool, product)
            }
            8 => {
                let sine = pool.call(Function::Sin, &[a]);
                let above = pool.linear(2.0, &[(sine, 1.0)]);
                let exponent = 1 + i32::try_from(self.below(2)).unwrap();
                let power = pool.powi(above, -exponent);
                pool.mul(power, b)
            }
            9 => pool.select(u32::try_from(self.below(2)).unwrap(), a, b),
            10 => {
                let square = pool.powi(a, 2);
                let above = pool.linear(1.0, &[(square, 1.0)]);
                pool.call(Function::Sqrt, &[above])
            }
            11 => pool.call(Function::Cos, &[a]),
            _ => {
                let negative = pool.neg(b);
                pool.call(Function::Tanh, &[negative])
            }
        }
    }

    fn bounded(&mut self, pool: &mut Pool, id: Id) -> Id {
        if self.below(2) == 0 { pool.call(Function::Tanh, &[id]) } else { id }
    }
}

/// The values of the roots, and for each a bound of the magnitudes that were added up on the way, one rounding each.
fn magnitudes(pool: &Pool, roots: &[Id], environment: &Environment) -> Vec<(f64, f64)> {
    let order = pool.reachable(roots);
    let values: BTreeMap<Id, f64> = order.iter().copied().zip(evaluate(pool, &order, environment)).collect();
    let mut errors: BTreeMap<Id, f64> = BTreeMap::new();
    for id in order {
        let scale = |id: &Id| values[id].abs();
        let own = scale(&id);
        let error = match pool.node(id) {
            Node::Number(_) | Node::Symbol(_) => 0.0,
            Node::Sum { constant, terms } => {
                let terms = terms.iter().map(|(id, c): &(Id, Number)| c.value().abs() * (errors[id] + scale(id)));
                constant.value().abs() + terms.sum::<f64>()
            }
            Node::Product(factors) => {
                let power = |&(id, e): &(Id, i32)| scale(&id).powi(e);
                let slope =
                    |&(id, e): &(Id, i32)| f64::from(e.abs()) * scale(&id).powi(e - 1) * (errors[&id] + scale(&id));
                let others = |at: usize| -> f64 {
                    factors.iter().enumerate().filter(|other| other.0 != at).map(|other| power(other.1)).product()
                };
                factors.iter().enumerate().map(|(at, factor)| slope(factor) * others(at)).sum()
            }
            // Each function here has a derivative of at most 1.
            Node::Call(..) | Node::Select { .. } => own + children(pool.node(id)).map(|id| errors[&id]).sum::<f64>(),
        };
        errors.insert(id, error + own);
    }
    roots.iter().map(|root| (values[root], errors[root])).collect()
}

fn assert_equal<const R: usize>(pool: &Pool, program: &Program<R>, requests: &[Request; R], environment: &Environment) {
    let constants = run(&program.constants, &[], environment);
    for (routine, request) in program.routines.iter().zip(requests) {
        let values = run(routine, &constants, environment);
        for (value, (expected, magnitude)) in values.iter().zip(magnitudes(pool, request.roots, environment)) {
            let near = (value - expected).abs() <= 1e-12 * magnitude.max(f64::MIN_POSITIVE);
            assert!(near || !expected.is_finite(), "{}: {value} instead of {expected} ± {magnitude}", request.name);
        }
    }
}

#[test]
fn random_graphs() {
    for seed in 0..60 {
        let mut source = Source(Random::new(seed));
        let mut pool = Pool::new();
        let count = 20 + source.below(180);
        let found = source.expressions(&mut pool, count);
        let mut pick = || found[found.len() - 1 - source.below(30.min(count))];
        let picks: [[Id; 6]; 3] = std::array::from_fn(|_| std::array::from_fn(|_| pick()));
        let names = ["rate", "outputs", "energy"];
        let requests: [Request; 3] = std::array::from_fn(|k| Request { name: names[k], roots: &picks[k] });
        let program = schedule(&mut pool, requests);
        check(&program);
        for _ in 0..3 {
            let mut numbers = |count: usize| (0..count).map(|_| source.number()).collect::<Vec<_>>();
            let (states, mut parameters, unknowns, inputs) = (numbers(6), numbers(4), numbers(1), numbers(1));
            parameters[source.below(4)] = 0.0;
            let negative = [source.below(2) == 0, source.below(2) == 0];
            let environment = Environment {
                time: 0.3,
                states: &states,
                parameters: &parameters,
                inputs: &inputs,
                unknowns: &unknowns,
                negative: &negative,
                ..Environment::default()
            };
            assert_equal(&pool, &program, &requests, &environment);
        }
    }
}

#[test]
fn parameters_may_be_zero() {
    let mut pool = Pool::new();
    let ([x, y, z], k, l) = (states(&mut pool), parameter(&mut pool, 0), parameter(&mut pool, 1));
    let [kx, ky, lz] = [pool.mul(k, x), pool.mul(k, y), pool.mul(l, z)];
    let roots = [pool.sum(&[kx, ky, lz]), pool.sum(&[kx, lz]), pool.linear(1.0, &[(kx, 2.0)])];
    let requests = [Request { name: "rate", roots: &roots }];
    let program = schedule(&mut pool, requests);
    let environment = Environment { states: &[1.0, 2.0, 3.0], parameters: &[0.0, 0.0], ..Environment::default() };
    assert_eq!(run(&program.routines[0], &run(&program.constants, &[], &environment), &environment), [0.0, 0.0, 1.0]);
}

#[test]
fn constants_are_shared() {
    let mut pool = Pool::new();
    let ([x, y], k, m) = (states(&mut pool), parameter(&mut pool, 0), parameter(&mut pool, 1));
    let ratio = pool.div(k, m);
    let (first, second) = ([pool.mul(ratio, x)], [pool.mul(ratio, y), ratio]);
    let program = schedule(&mut pool, [Request { name: "a", roots: &first }, Request { name: "b", roots: &second }]);
    check(&program);
    assert_eq!(program.constants.results.len(), 1);
    assert_eq!(program.routines[1].results[1], Operand::Constant(0));
}

#[test]
fn deep_chain() {
    let mut pool = Pool::new();
    let [x, y] = states(&mut pool);
    let (mut before, mut last) = (x, y);
    for at in 0..20_000 {
        let next = match at % 4 {
            0 => pool.call(Function::Sin, &[last]),
            1 => pool.add(last, before),
            2 => pool.mul(last, before),
            _ => pool.linear(0.5, &[(last, 0.25)]),
        };
        (before, last) = (last, next);
    }
    let program = single(&mut pool, &[last]);
    assert!(program.routines[0].counts.total() > 20_000);
    // A chain of sums that are used once each is one long sum.
    let mut sum = x;
    for at in 0..20_000 {
        let angle = pool.linear(f64::from(at), &[(y, 1.0)]);
        let term = pool.call(Function::Sin, &[angle]);
        sum = pool.add(sum, term);
    }
    let counts = single(&mut pool, &[sum]).routines[0].counts;
    assert_eq!(counts, Counts { additions: 39_999, functions: 20_000, ..Counts::default() });
}

#[test]
fn same_program_every_time() {
    let program = || {
        let mut pool = Pool::new();
        let found = Source(Random::new(7)).expressions(&mut pool, 400);
        schedule(&mut pool, [Request { name: "rate", roots: &found[380..] }])
    };
    assert_eq!(program(), program());
}

/// The expression graph of a chain of rigid bodies in space with Euler angles, of about the size of a large mechanism.
fn bodies(pool: &mut Pool, count: u32) -> Vec<Id> {
    let mut roots = Vec::new();
    let mut frame = identity(pool);
    let mut point = [pool.zero(); 3];
    let mut speed = [pool.zero(); 3];
    for body in 0..count {
        for axis in 0..3 {
            let angle = pool.symbol(Symbol::State(6 * body + axis));
            let turn = turn(pool, angle, axis as usize);
            frame = multiply(pool, &frame, &turn);
            let rate = pool.symbol(Symbol::State(6 * body + 3 + axis));
            for (component, row) in speed.iter_mut().zip(&frame) {
                let part = pool.mul(rate, row[axis as usize]);
                *component = pool.add(*component, part);
            }
        }
        let arm: Vec<Id> = (0..3).map(|axis| pool.symbol(Symbol::Parameter(4 * body + axis))).collect();
        let mass = pool.symbol(Symbol::Parameter(4 * body + 3));
        let arm = apply_rotation(pool, &frame, &arm);
        let velocity = cross(pool, &speed, &arm);
        let centripetal = cross(pool, &speed, &velocity);
        for axis in 0..3 {
            point[axis] = pool.add(point[axis], arm[axis]);
            let force = pool.mul(mass, centripetal[axis]);
            roots.push(pool.add(force, point[axis]));
        }
    }
    roots
}

fn identity(pool: &Pool) -> [[Id; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| if row == column { pool.one() } else { pool.zero() }))
}

fn turn(pool: &mut Pool, angle: Id, axis: usize) -> [[Id; 3]; 3] {
    let (cosine, sine) = (pool.call(Function::Cos, &[angle]), pool.call(Function::Sin, &[angle]));
    let mut matrix = identity(pool);
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    matrix[next][next] = cosine;
    matrix[last][last] = cosine;
    matrix[last][next] = sine;
    matrix[next][last] = pool.neg(sine);
    matrix
}

fn multiply(pool: &mut Pool, left: &[[Id; 3]; 3], right: &[[Id; 3]; 3]) -> [[Id; 3]; 3] {
    let columns: Vec<[Id; 3]> =
        (0..3).map(|column| apply_rotation(pool, left, &[0, 1, 2].map(|row| right[row][column]))).collect();
    std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row]))
}

fn apply_rotation(pool: &mut Pool, matrix: &[[Id; 3]; 3], vector: &[Id]) -> [Id; 3] {
    matrix.map(|row| {
        let terms: Vec<Id> = row.iter().zip(vector).map(|(&entry, &component)| pool.mul(entry, component)).collect();
        pool.sum(&terms)
    })
}

fn cross(pool: &mut Pool, left: &[Id; 3], right: &[Id; 3]) -> [Id; 3] {
    [0, 1, 2].map(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let (first, second) = (pool.mul(left[next], right[last]), pool.mul(left[last], right[next]));
        pool.sub(first, second)
    })
}

#[test]
fn a_large_mechanism_keeps_its_values() {
    let mut pool = Pool::new();
    let roots = bodies(&mut pool, 25);
    let requests = [Request { name: "rate", roots: &roots }, Request { name: "outputs", roots: &roots[30..] }];
    assert!(pool.reachable(&roots).len() > 3000);
    let program = schedule(&mut pool, requests);
    check(&program);
    let mut source = Source(Random::new(1));
    let numbers: Vec<f64> = (0..200).map(|_| source.number()).collect();
    let environment = Environment { states: &numbers, parameters: &numbers, ..Environment::default() };
    assert_equal(&pool, &program, &requests, &environment);
}

/// Sums and products of which two each have a pair in common, so that every pair becomes a value of its own.
fn pairs_in_common(pool: &mut Pool, count: u32) -> Vec<Id> {
    let four = |pool: &mut Pool, first: u32| [0, 1, 2, 3].map(|k| pool.symbol(Symbol::State(4 * first + k)));
    let mut roots = Vec::new();
    for first in 0..count {
        let [a, b, c, d] = four(pool, first);
        roots.extend([[a, b, c], [a, b, d]].map(|terms| pool.sum(&terms)));
        roots.extend([[a, b, c], [a, b, d]].map(|factors| pool.product(&factors)));
    }
    roots
}

/// The nodes of a routine, and how often and how many bytes its schedule allocates: the same in every run.
fn cost(routine: fn(&mut Pool, u32) -> Vec<Id>, size: u32) -> [u64; 3] {
    let mut pool = Pool::new();
    let roots = routine(&mut pool, size);
    let nodes = pool.reachable(&roots).len() as u64;
    let allocated = allocation_counter::measure(|| {
        schedule(&mut pool, [Request { name: "rate", roots: &roots }]);
    });
    [nodes, allocated.count_total, allocated.bytes_total]
}

/// Steps of the schedule allocate: one that looks at all of the rest makes the cost grow as the square of the nodes.
#[test]
fn the_cost_of_a_schedule_grows_as_its_nodes_do() {
    for (routine, size) in [(bodies as fn(&mut Pool, u32) -> Vec<Id>, 10), (pairs_in_common, 50)] {
        let (small, large) = (cost(routine, size), cost(routine, 4 * size));
        let [nodes, times, bytes] = [0, 1, 2].map(|k| large[k] as f64 / small[k] as f64);
        println!("{small:?} {large:?}");
        assert!(times < 1.25 * nodes && bytes < 1.25 * nodes, "{small:?} {large:?}");
    }
}

#[test]
fn states_that_cancel_in_normal_form_are_no_constants() {
    let mut pool = Pool::new();
    let [x, y, z] = states(&mut pool);
    let (single_sum, double_sum) = (pool.sub(x, y), pool.linear(0.0, &[(x, 2.0), (y, -2.0)]));
    let products = [pool.mul(single_sum, z), pool.mul(double_sum, z)];
    let zero = pool.linear(0.0, &[(products[0], 2.0), (products[1], -1.0)]);
    assert!(!pool.is_zero(zero));
    let (opposite, product) = (pool.neg(zero), pool.mul(zero, z));
    let sine = pool.call(Function::Sin, &[zero]);
    let program = single(&mut pool, &[zero, opposite, product, sine]);
    let operands = program.constants.assignments.iter().flat_map(|assignment| assignment.operation.operands());
    let found: Vec<Operand> = operands.chain(program.constants.results.iter().copied()).collect();
    let is_known = |operand: &Operand| {
        matches!(operand, Operand::Number(_) | Operand::Temporary(_) | Operand::Symbol(Symbol::Parameter(_)))
    };
    assert!(found.iter().all(is_known), "{found:?}");
    assert_eq!(program.routines[0].results[..2], [Operand::Number(0.0); 2]);
}

#[test]
fn the_order_of_the_results_changes_nothing_in_how_they_are_calculated() {
    let mut pool = Pool::new();
    let mut roots = Source(Random::new(3)).expressions(&mut pool, 90).split_off(60);
    let [forwards] = single(&mut pool, &roots).routines;
    roots.reverse();
    let [mut backwards] = single(&mut pool, &roots).routines;
    backwards.results.reverse();
    assert_eq!(forwards, backwards);
}
