//! Tests of the schedule: values against the interpreter of expressions, and operation counts of hand-written examples.

mod counts;
mod reverse;
mod values;

use super::{Counts, Operand, Operation, Program, Request, Routine, schedule};
use crate::expr::{Environment, Id, Pool, Symbol, apply};

fn parameter(pool: &mut Pool, index: u32) -> Id {
    pool.symbol(Symbol::Parameter(index))
}

fn states<const N: usize>(pool: &mut Pool) -> [Id; N] {
    std::array::from_fn(|index| pool.symbol(Symbol::State(u32::try_from(index).unwrap())))
}

/// The program of one routine, checked for form.
fn single(pool: &mut Pool, roots: &[Id]) -> Program<1> {
    let program = schedule(pool, [Request { name: "rate", roots }]);
    check(&program);
    program
}

/// The values of a routine's results.
pub(crate) fn run(routine: &Routine, constants: &[f64], environment: &Environment) -> Vec<f64> {
    let mut temporaries: Vec<f64> = Vec::new();
    for assignment in &routine.assignments {
        temporaries.push(apply_operation(&assignment.operation, &temporaries, constants, environment));
    }
    routine.results.iter().map(|result| value(result, &temporaries, constants, environment)).collect()
}

/// The value of an operation.
pub(crate) fn apply_operation(
    operation: &Operation,
    temporaries: &[f64],
    constants: &[f64],
    environment: &Environment,
) -> f64 {
    let value = |operand: &Operand| value(operand, temporaries, constants, environment);
    match operation {
        Operation::Add(left, right) => value(left) + value(right),
        Operation::Subtract(left, right) => value(left) - value(right),
        Operation::Multiply(left, right) => value(left) * value(right),
        Operation::Divide(left, right) => value(left) / value(right),
        Operation::Negate(only) => -value(only),
        Operation::Call(function, all) => apply(*function, &all.iter().map(value).collect::<Vec<_>>()),
        Operation::Select { switch, negative, positive } => {
            value(if environment.negative[*switch as usize] { negative } else { positive })
        }
    }
}

/// The value of an operand.
pub(crate) fn value(operand: &Operand, temporaries: &[f64], constants: &[f64], environment: &Environment) -> f64 {
    match *operand {
        Operand::Number(number) => number,
        Operand::Temporary(index) => temporaries[index as usize],
        Operand::Constant(index) => constants[index as usize],
        Operand::Symbol(symbol) => {
            let mut pool = Pool::new();
            let symbol = pool.symbol(symbol);
            crate::expr::evaluate(&pool, &[symbol], environment)[0]
        }
    }
}

/// Targets count from 0, operands are known, nothing is dead or repeated, parameters only stand in the constants.
fn check<const R: usize>(program: &Program<R>) {
    let constants = program.constants.results.len();
    let mut used = vec![false; constants];
    for routine in std::iter::once(&program.constants).chain(&program.routines) {
        let dynamic = !std::ptr::eq(routine, &program.constants);
        let mut live = vec![false; routine.assignments.len()];
        let mut visit = |operand: Operand, before: usize| match operand {
            Operand::Temporary(index) => {
                assert!((index as usize) < before, "{}: v{index} is used before it is defined", routine.name);
                live[index as usize] = true;
            }
            Operand::Constant(index) => used[index as usize] = true,
            Operand::Symbol(Symbol::Parameter(_)) => assert!(!dynamic, "{}: a parameter", routine.name),
            Operand::Symbol(_) => assert!(dynamic, "constants: a dynamic symbol"),
            Operand::Number(_) => {}
        };
        for (at, assignment) in routine.assignments.iter().enumerate() {
            assert_eq!(assignment.target as usize, at);
            assignment.operation.operands().into_iter().for_each(|operand| visit(operand, at));
            let earlier = &routine.assignments[at.saturating_sub(200)..at];
            assert!(earlier.iter().all(|other| other.operation != assignment.operation), "a repeated operation");
        }
        routine.results.iter().for_each(|&result| visit(result, usize::MAX));
        assert!(live.into_iter().all(|live| live), "{}: a dead assignment", routine.name);
        assert_eq!(routine.counts, Counts::of(&routine.assignments));
    }
    assert!(used.into_iter().all(|used| used), "a constant that nobody uses");
}
