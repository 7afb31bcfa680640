//! Straight-line code as tokens.
//!
//! In: a [`Routine`] and the tokens of what it refers to. Out: one `let` for each assignment, generic over a scalar `S`.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};

use crate::expr::{Function, Symbol};
use crate::program::{Operand, Operation, Routine};

/// The tokens of what a routine refers to.
#[derive(Clone, Copy)]
#[expect(missing_debug_implementations, reason = "closures have none")]
pub struct Names<'a> {
    /// A symbol.
    pub symbol: &'a dyn Fn(Symbol) -> TokenStream,
    /// An entry of the constant table.
    pub constant: &'a dyn Fn(u32) -> TokenStream,
    /// The `bool` that says whether a switch's guard is negative.
    pub switch: &'a dyn Fn(u32) -> TokenStream,
}

/// One `let` for each assignment of the routine.
pub fn statements(routine: &Routine, names: &Names) -> TokenStream {
    let mut tokens = TokenStream::new();
    for assignment in &routine.assignments {
        let target = temporary(assignment.target);
        let value = operation(&assignment.operation, names);
        tokens.extend(quote! { let #target = #value; });
    }
    tokens
}

/// The tokens of an operand.
pub fn operand(operand: &Operand, names: &Names) -> TokenStream {
    match *operand {
        Operand::Number(value) => quote! { S::from_f64(#value) },
        Operand::Symbol(symbol) => (names.symbol)(symbol),
        Operand::Constant(index) => (names.constant)(index),
        Operand::Temporary(index) => {
            let temporary = temporary(index);
            quote! { #temporary }
        }
    }
}

fn operation(operation: &Operation, names: &Names) -> TokenStream {
    let token = |value: &Operand| operand(value, names);
    match operation {
        Operation::Add(left, right) => binary(token(left), quote! { + }, token(right)),
        Operation::Subtract(left, right) => binary(token(left), quote! { - }, token(right)),
        Operation::Multiply(left, right) => binary(token(left), quote! { * }, token(right)),
        Operation::Divide(left, right) => binary(token(left), quote! { / }, token(right)),
        Operation::Negate(only) => {
            let only = token(only);
            quote! { -#only }
        }
        Operation::Call(function, arguments) => {
            let method = method(*function);
            let receiver = token(&arguments[0]);
            let others = arguments[1..].iter().map(token);
            quote! { #receiver.#method(#(#others),*) }
        }
        Operation::Select { switch, negative, positive } => {
            let (switch, negative, positive) = ((names.switch)(*switch), token(negative), token(positive));
            quote! { if #switch { #negative } else { #positive } }
        }
    }
}

fn binary(left: TokenStream, operator: TokenStream, right: TokenStream) -> TokenStream {
    quote! { #left #operator #right }
}

fn temporary(index: u32) -> Ident {
    format_ident!("v{index}")
}

/// The scalar's method for a function.
fn method(function: Function) -> Ident {
    let name = match function {
        Function::Pow => "powf",
        other => other.name(),
    };
    Ident::new(name, Span::call_site())
}
