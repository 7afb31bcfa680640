//! Straight-line code with pairs as tokens.
//!
//! In: a [`Paired`] routine and the text of what it refers to. Out: one `let` for each step, generic over a scalar `S`
//! with its pairs `S::Pair`; numbers are `v0`, `v1`, .., pairs `w0`, `w1`, ..

use proc_macro2::TokenStream;
use quote::quote;

use super::items::number_text;
use super::routine::{self, Names, operand, parsed, parsed_each};
use crate::program::pairs::{Half, Paired, Step, Value};

/// The steps of the routine.
pub(super) fn statements(paired: &Paired, names: &Names) -> TokenStream {
    parsed(&text(&paired.steps, names))
}

/// Steps as text.
pub(super) fn text(steps: &[Step], names: &Names) -> String {
    steps.iter().map(|of| step(of, names)).collect()
}

/// The definition of what a step gives.
pub(super) fn step(step: &Step, names: &Names) -> String {
    match step {
        Step::Single(assignment) => routine::assignments(std::slice::from_ref(assignment), names),
        Step::Half { target, pair, half: at } => routine::definition(*target, &half(&Half::In(*pair, *at), names)),
        Step::Pair(index, value) => definition(*index, &self::value(value, names)),
    }
}

/// The definition of a pair.
pub(super) fn definition(index: u32, value: &str) -> String {
    format!("let {} = {value};\n", name(index))
}

/// The results of the routine.
pub(super) fn results(paired: &Paired, names: &Names) -> Vec<TokenStream> {
    parsed_each(paired.results.iter().map(|result| half(result, names)))
}

/// The pairs of constants, from the table `c`.
pub(super) fn constants(paired: &Paired, names: &Names) -> TokenStream {
    let entries = paired.constants.iter().map(|entry| {
        let [first, second] = entry.map(|(constant, is_negative)| {
            let value = operand(&constant, names);
            if is_negative { format!("-{value}") } else { value }
        });
        new(&first, &second)
    });
    let entries = parsed_each(entries);
    quote!([#(#entries),*])
}

/// The text of a number.
pub(super) fn half(half: &Half, names: &Names) -> String {
    match half {
        Half::Of(value) => operand(value, names),
        Half::In(index, at) => format!("{}.{}()", name(*index), ["first", "second"][*at]),
    }
}

/// A pair of two numbers.
pub(super) fn new(first: &str, second: &str) -> String {
    format!("S::Pair::new({first}, {second})")
}

/// The name of a pair.
pub(super) fn name(index: u32) -> String {
    format!("w{index}")
}

/// The value of a pair.
pub(super) fn value(value: &Value, names: &Names) -> String {
    let binary = |a: &u32, operator: &str, b: &u32| format!("{} {operator} {}", name(*a), name(*b));
    match value {
        Value::States(index) => new(&format!("x[{index}]"), &format!("x[{}]", index + 1)),
        Value::Numbers(numbers) => {
            let [first, second] = numbers.map(|number| format!("S::from_f64({})", number_text(number)));
            new(&first, &second)
        }
        Value::Constants(index) => format!("q[{index}]"),
        Value::Gather(halves) => {
            let [first, second] = halves.map(|of| half(&of, names));
            new(&first, &second)
        }
        Value::Add(a, b) => binary(a, "+", b),
        Value::Subtract(a, b) => binary(a, "-", b),
        Value::Multiply(a, b) => binary(a, "*", b),
        Value::Divide(a, b) => binary(a, "/", b),
        Value::Turn(of, [first, second]) => format!("{}.turned({first}, {second})", name(*of)),
    }
}
