//! Straight-line code as tokens.
//!
//! In: a [`Routine`] and the tokens of what it refers to. Out: one `let` for each assignment, generic over a scalar `S`;
//! in a long routine one array of all temporaries. In debug information each `let` is a scope inside the one before, and
//! LLVM's stack overflows over some thousands of them; the array's places become registers like the `let`s.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::items::number;
use crate::expr::{Function, Symbol};
use crate::program::{Assignment, Operand, Operation, Routine};

/// The tokens of what a routine refers to.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    /// A symbol.
    pub symbol: &'a dyn Fn(Symbol) -> TokenStream,
    /// An entry of the constant table.
    pub constant: &'a dyn Fn(u32) -> TokenStream,
    /// The `bool` that says whether a switch's guard is negative.
    pub switch: &'a dyn Fn(u32) -> TokenStream,
    /// Whether the temporaries are places of one array.
    pub is_long: bool,
}

/// The assignments of the routine.
pub fn statements(routine: &Routine, names: &Names) -> TokenStream {
    let array = array(routine);
    let assignments = assignments(&routine.assignments, names);
    quote! { #array #assignments }
}

/// The array of the temporaries of a long routine.
pub fn array(routine: &Routine) -> Option<TokenStream> {
    let count = routine.assignments.len();
    routine.is_long().then(|| quote! { let mut v = [S::from_f64(0.0); #count]; })
}

/// These assignments; in a long routine `v` is there already.
pub fn assignments(of: &[Assignment], names: &Names) -> TokenStream {
    let value = |of: &Assignment| operation(&of.operation, names, &|value| operand(value, names));
    of.iter().map(|assignment| definition(assignment.target, &value(assignment), names)).collect()
}

/// The definition of a temporary.
pub fn definition(target: u32, value: &TokenStream, names: &Names) -> TokenStream {
    let target = temporary(target, names);
    if names.is_long { quote!(#target = #value;) } else { quote!(let #target = #value;) }
}

/// The tokens of an operand.
pub fn operand(operand: &Operand, names: &Names) -> TokenStream {
    match *operand {
        Operand::Number(value) => {
            let value = number(value);
            quote! { S::from_f64(#value) }
        }
        Operand::Symbol(symbol) => (names.symbol)(symbol),
        Operand::Constant(index) => (names.constant)(index),
        Operand::Temporary(index) => temporary(index, names),
    }
}

/// The tokens of an operation; `token` gives those of its operands.
pub fn operation(operation: &Operation, names: &Names, token: &dyn Fn(&Operand) -> TokenStream) -> TokenStream {
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

fn temporary(index: u32, names: &Names) -> TokenStream {
    if names.is_long {
        let index = Literal::u32_unsuffixed(index);
        return quote!(v[#index]);
    }
    let name = format_ident!("v{index}");
    quote!(#name)
}

/// The scalar's method for a function.
fn method(function: Function) -> Ident {
    let name = match function {
        Function::Pow => "powf",
        other => other.name(),
    };
    Ident::new(name, Span::call_site())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Pool;
    use crate::program::{Request, schedule};

    fn rendered(routine: &Routine) -> (String, Vec<String>) {
        let names = Names {
            symbol: &|symbol| match symbol {
                Symbol::State(index) => {
                    let name = format_ident!("x{index}");
                    quote! { #name }
                }
                _ => quote! { p },
            },
            constant: &|index| {
                let index = proc_macro2::Literal::u32_unsuffixed(index);
                quote! { c[#index] }
            },
            switch: &|_| quote! { below },
            is_long: routine.is_long(),
        };
        let results = routine.results.iter().map(|result| operand(result, &names).to_string()).collect();
        (statements(routine, &names).to_string(), results)
    }

    #[test]
    fn text_of_a_routine() {
        let mut pool = Pool::new();
        let [x, y] = [0, 1].map(|index| pool.symbol(Symbol::State(index)));
        let mass = pool.symbol(Symbol::Parameter(0));
        let quotient = pool.div(x, mass);
        let angle = pool.call(Function::Atan2, &[x, y]);
        let power = pool.call(Function::Pow, &[y, angle]);
        let half = pool.scale(0.5, power);
        let choice = pool.select(0, quotient, half);
        let opposite = pool.neg(x);
        let program = schedule(&mut pool, [Request { name: "rate", roots: &[choice, opposite, x] }]);
        let (text, results) = rendered(&program.routines[0]);
        assert_eq!(
            text,
            "let v0 = x0 * c [0] ; let v1 = x0 . atan2 (x1) ; let v2 = x1 . powf (v1) ; \
             let v3 = S :: from_f64 (0.5f64) * v2 ; let v4 = if below { v0 } else { v3 } ; let v5 = - x0 ;"
        );
        assert_eq!(results, ["v4", "v5", "x0"]);
        assert_eq!(rendered(&program.constants).0, "let v0 = S :: from_f64 (1f64) / p ;");
    }

    #[test]
    fn a_long_routine_has_one_array() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let last = (0..2001).fold(x, |value, _| pool.call(crate::expr::Function::Sin, &[value]));
        let program = schedule(&mut pool, [Request { name: "rate", roots: &[last] }]);
        let (text, results) = rendered(&program.routines[0]);
        assert!(text.starts_with(
            "let mut v = [S :: from_f64 (0.0) ; 2001usize] ; v [0] = x0 . sin () ; v [1] = v [0] . sin () ;"
        ));
        assert_eq!(results, ["v [2000]"]);
    }

    #[test]
    fn negative_numbers_are_literals() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let root = pool.scale(-2.5, x);
        let program = schedule(&mut pool, [Request { name: "rate", roots: &[root] }]);
        assert_eq!(rendered(&program.routines[0]).0, "let v0 = x0 * S :: from_f64 (- 2.5f64) ;");
    }
}
