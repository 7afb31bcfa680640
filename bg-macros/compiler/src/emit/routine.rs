//! Straight-line code as text and as tokens.
//!
//! In: a [`Routine`] and the text of what it refers to. Out: one `let` for each assignment, generic over a scalar `S`;
//! a long routine is cut into `blocks`. Statements are written as text, which becomes tokens at once: inside of rustc
//! each piece that is quoted is handed over and copied several times, which takes three times as long.

extern crate proc_macro;

use proc_macro2::{TokenStream, TokenTree};
use quote::quote;

use super::blocks::{Blocks, Group};
use super::items::number_text;
use crate::expr::{Function, Symbol};
use crate::program::{Assignment, Operand, Operation, Routine};

/// The text of what a routine refers to.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    /// A symbol.
    pub symbol: &'a dyn Fn(Symbol) -> String,
    /// An entry of the constant table.
    pub constant: &'a dyn Fn(u32) -> String,
    /// What says whether a switch's guard is negative.
    pub switch: &'a dyn Fn(u32) -> String,
}

/// The tokens of generated text. Inside of rustc its own lexer reads them; that of `proc_macro2` would read them first,
/// to be sure.
pub(super) fn parsed(text: &str) -> TokenStream {
    const FAILED: &str = "generated text is made of tokens";
    if proc_macro::is_available() {
        return text.parse::<proc_macro::TokenStream>().expect(FAILED).into();
    }
    text.parse().expect(FAILED)
}

/// The tokens of each of these values.
pub(super) fn parsed_each(values: impl IntoIterator<Item = String>) -> Vec<TokenStream> {
    let ended = values.into_iter().map(|value| value + ";").collect::<String>();
    let tokens: Vec<TokenTree> = parsed(&ended).into_iter().collect();
    let is_end = |token: &TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ';');
    let values = tokens.split_inclusive(is_end);
    values.map(|value| value[..value.len() - 1].iter().cloned().collect()).collect()
}

/// The assignments of the routine, and after them its results.
pub fn statements(routine: &Routine, names: &Names) -> (TokenStream, Vec<TokenStream>) {
    if !routine.is_long() {
        let results = routine.results.iter().map(|result| operand(result, names));
        return (parsed(&assignments(&routine.assignments, names)), parsed_each(results));
    }
    let groups: Vec<_> = Group::straight(&routine.assignments).collect();
    let blocks = Blocks::of(&groups, &routine.results);
    let array = blocks.array();
    let statements = groups.iter().map(|group| {
        let part = blocks.part(group);
        parsed(&part.code(&assignments(&part.assignments, names)))
    });
    let results = routine.results.iter().map(|result| blocks.result(result, names));
    (quote! { #array #({ #statements })* }, parsed_each(results))
}

/// These assignments, one `let` for each.
pub fn assignments(of: &[Assignment], names: &Names) -> String {
    let value = |of: &Assignment| operation(&of.operation, names, &|value| operand(value, names));
    of.iter().map(|assignment| definition(assignment.target, &value(assignment))).collect()
}

/// The definition of a temporary.
pub fn definition(target: u32, value: &str) -> String {
    format!("let {} = {value};\n", temporary(target))
}

/// The text of an operand.
pub fn operand(operand: &Operand, names: &Names) -> String {
    match *operand {
        Operand::Number(value) => format!("S::from_f64({})", number_text(value)),
        Operand::Symbol(symbol) => (names.symbol)(symbol),
        Operand::Constant(index) => (names.constant)(index),
        Operand::Temporary(index) => temporary(index),
    }
}

/// The text of an operation; `text` gives that of its operands.
pub fn operation(operation: &Operation, names: &Names, text: &dyn Fn(&Operand) -> String) -> String {
    match operation {
        Operation::Add(left, right) => format!("{} + {}", text(left), text(right)),
        Operation::Subtract(left, right) => format!("{} - {}", text(left), text(right)),
        Operation::Multiply(Operand::Number(factor), other) | Operation::Multiply(other, Operand::Number(factor)) => {
            format!("{}.times({})", text(other), number_text(*factor))
        }
        Operation::Multiply(left, right) => format!("{} * {}", text(left), text(right)),
        Operation::Divide(left, right) => format!("{} / {}", text(left), text(right)),
        Operation::Negate(only) => format!("-{}", text(only)),
        Operation::Call(function, arguments) => {
            let others: Vec<String> = arguments[1..].iter().map(text).collect();
            format!("{}.{}({})", text(&arguments[0]), method(*function), others.join(", "))
        }
        Operation::Select { switch, negative, positive } => {
            format!("S::select({}, {}, {})", (names.switch)(*switch), text(negative), text(positive))
        }
    }
}

/// The name of a temporary.
pub(super) fn temporary(index: u32) -> String {
    format!("v{index}")
}

/// The scalar's method for a function.
fn method(function: Function) -> &'static str {
    match function {
        Function::Pow => "powf",
        other => other.name(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Pool;
    use crate::program::{Request, schedule};

    fn rendered(routine: &Routine) -> (String, Vec<String>) {
        let names = Names {
            symbol: &|symbol| match symbol {
                Symbol::State(index) => format!("x{index}"),
                _ => "p".to_owned(),
            },
            constant: &|index| format!("c[{index}]"),
            switch: &|_| "below".to_owned(),
        };
        let (text, results) = statements(routine, &names);
        (text.to_string(), results.iter().map(ToString::to_string).collect())
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
             let v3 = v2 . times (0.5f64) ; let v4 = S :: select (below , v0 , v3) ; let v5 = - x0 ;"
        );
        assert_eq!(results, ["v4", "v5", "x0"]);
        assert_eq!(rendered(&program.constants).0, "let v0 = S :: from_f64 (1f64) / p ;");
    }

    #[test]
    fn a_long_routine_has_blocks_that_hand_on_what_later_ones_need() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let last = (0..2001).fold(x, |value, _| pool.call(crate::expr::Function::Sin, &[value]));
        let program = schedule(&mut pool, [Request { name: "rate", roots: &[last] }]);
        let (text, results) = rendered(&program.routines[0]);
        assert!(text.starts_with(
            "let v = & mut [S :: from_f64 (0.0) ; 3usize] ; { let v0 = x0 . sin () ; let v1 = v0 . sin () ;"
        ));
        let handed = "let v999 = v998 . sin () ; :: bg_model :: __private :: store (v , 0 , [v999]) ; } \
                      { let v999 = v [0] ; let v1000 = v999 . sin () ;";
        assert!(text.contains(handed), "{text}");
        let last = "{ let v1999 = v [1] ; let v2000 = v1999 . sin () ; :: bg_model :: __private :: store (v , 2 , \
            [v2000]) ; }";
        assert!(text.ends_with(last));
        assert_eq!(results, ["v [2]"]);
    }

    #[test]
    fn negative_numbers_are_literals() {
        let mut pool = Pool::new();
        let x = pool.symbol(Symbol::State(0));
        let root = pool.scale(-2.5, x);
        let program = schedule(&mut pool, [Request { name: "rate", roots: &[root] }]);
        assert_eq!(rendered(&program.routines[0]).0, "let v0 = x0 . times (- 2.5f64) ;");
    }
}
