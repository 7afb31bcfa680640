//! Straight-line code with pairs as tokens.
//!
//! In: a [`Paired`] routine and the tokens of what it refers to. Out: one `let` for each step, generic over a scalar `S`
//! with its pairs `S::Pair`; numbers are `v0`, `v1`, .., pairs `w0`, `w1`, ..

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::items::number;
use super::routine::{self, Names, operand};
use crate::program::pairs::{Half, Paired, Step, Value};

/// The steps of the routine.
pub(super) fn statements(paired: &Paired, names: &Names) -> TokenStream {
    let steps = paired.steps.iter().map(|step| match step {
        Step::Single(assignment) => routine::assignments(std::slice::from_ref(assignment), names),
        Step::Half { target, pair, half: at } => routine::definition(*target, &half(&Half::In(*pair, *at), names)),
        Step::Pair(index, value) => {
            let (name, value) = (pair(*index), self::value(value, names));
            quote!(let #name = #value;)
        }
    });
    steps.collect()
}

/// The pairs of constants, from the table `c`.
pub(super) fn constants(paired: &Paired, names: &Names) -> TokenStream {
    let entries = paired.constants.iter().map(|entry| {
        let [first, second] = entry.map(|(constant, is_negative)| {
            let value = operand(&constant, names);
            if is_negative { quote!(-#value) } else { value }
        });
        quote!(S::Pair::new(#first, #second))
    });
    quote!([#(#entries),*])
}

/// The tokens of a number.
pub(super) fn half(half: &Half, names: &Names) -> TokenStream {
    match half {
        Half::Of(value) => operand(value, names),
        Half::In(index, at) => {
            let (pair, half) = (pair(*index), format_ident!("{}", ["first", "second"][*at]));
            quote!(#pair.#half())
        }
    }
}

fn pair(index: u32) -> Ident {
    format_ident!("w{index}")
}

fn value(value: &Value, names: &Names) -> TokenStream {
    let binary = |a: &u32, operator: TokenStream, b: &u32| {
        let (a, b) = (pair(*a), pair(*b));
        quote!(#a #operator #b)
    };
    match value {
        Value::States(index) => {
            let [first, second] = [*index, index + 1].map(Literal::u32_unsuffixed);
            quote!(S::Pair::new(x[#first], x[#second]))
        }
        Value::Numbers(numbers) => {
            let [first, second] = numbers.map(number);
            quote!(S::Pair::new(S::from_f64(#first), S::from_f64(#second)))
        }
        Value::Constants(index) => {
            let index = Literal::u32_unsuffixed(*index);
            quote!(q[#index])
        }
        Value::Gather(halves) => {
            let [first, second] = halves.map(|of| half(&of, names));
            quote!(S::Pair::new(#first, #second))
        }
        Value::Add(a, b) => binary(a, quote!(+), b),
        Value::Subtract(a, b) => binary(a, quote!(-), b),
        Value::Multiply(a, b) => binary(a, quote!(*), b),
        Value::Divide(a, b) => binary(a, quote!(/), b),
        Value::Turn(of, [first, second]) => {
            let of = pair(*of);
            quote!(#of.turned(#first, #second))
        }
    }
}
