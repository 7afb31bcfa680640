//! Programs in machine code: their bits, what is refused.
#![cfg(all(feature = "machine-code", any(target_arch = "x86_64", target_arch = "aarch64")))]

mod random;

use bg_expressions::schedule::Operation;
use bg_native::{Function, Inputs, Operand, Pairing, Program};

/// Longer programs are not translated.
const LONGEST: usize = 20_000;

#[test]
fn random_programs_have_the_bits_of_one_operation_after_the_other() {
    let random::Compared { numbers, paired } = random::compare();
    assert!(numbers > 1000 && paired > 50, "{numbers} {paired}");
}

fn sum() -> Function {
    let operations = vec![
        Operation::Add(Operand::State(1), Operand::Read(0)),
        Operation::Select { switch: 1, negative: Operand::Value(0), positive: Operand::Fixed(2) },
    ];
    Function::of(&Program { operations, results: vec![Operand::Value(1)], pairing: Pairing::None })
        .expect("this machine has a back end")
}

fn call(fixed: usize, states: usize, read: usize, switches: usize, results: usize) {
    let numbers = [1.0; 8];
    let (fixed, states, read, negative) =
        (&numbers[..fixed], &numbers[..states], &numbers[..read], &[false; 4][..switches]);
    sum().call(Inputs { fixed, states, read, negative }, &mut vec![0.0; results]);
}

#[test]
fn slices_of_the_right_length_are_taken() {
    call(3, 2, 1, 2, 1);
    call(8, 8, 8, 4, 1);
}

macro_rules! refused {
    ($($name:ident: $($length:literal)*;)*) => {
        $(#[test]
        #[should_panic(expected = "a place for")]
        fn $name() {
            call($($length),*);
        })*
    };
}

refused! {
    too_few_that_are_fixed: 2 2 1 2 1;
    too_few_states: 3 1 1 2 1;
    too_few_that_are_read: 3 2 0 2 1;
    too_few_switches: 3 2 1 1 1;
    too_few_results: 3 2 1 2 0;
    too_many_results: 3 2 1 2 2;
}

#[test]
#[should_panic(expected = "values are taken after they are there")]
fn a_value_before_it_is_there_is_refused() {
    let operations = vec![Operation::Negate(Operand::Value(0))];
    let _ = Function::of(&Program { operations, ..Program::default() });
}

#[test]
fn functions_may_be_shared_and_dropped() {
    let function = sum();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let mut results = [0.0];
                function.call(
                    Inputs { fixed: &[1.0; 3], states: &[2.0; 2], read: &[3.0], negative: &[true; 2] },
                    &mut results,
                );
                assert_eq!(results, [5.0]);
            });
        }
    });
    (0..200).for_each(|_| drop(sum()));
}

#[test]
fn the_longest_program_is_translated_and_no_longer_one() {
    let program = |length: usize| {
        let value = |of: usize| Operand::Value(u32::try_from(of).expect("few values"));
        let operand = |of: usize| if of == 0 { Operand::State(0) } else { value(of - 1) };
        let operations = (0..length).map(|of| Operation::Add(operand(of), Operand::Fixed(0))).collect();
        Program { operations, results: vec![value(length - 1)], pairing: Pairing::Sought }
    };
    let function = Function::of(&program(LONGEST)).expect("this machine has a back end");
    let mut results = [0.0];
    function.call(Inputs { fixed: &[0.5], states: &[1.0], read: &[], negative: &[] }, &mut results);
    assert_eq!(results, [1.0 + 0.5 * LONGEST as f64]);
    assert!(Function::of(&program(LONGEST + 1)).is_none());
}
