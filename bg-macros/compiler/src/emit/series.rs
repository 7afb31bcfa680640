//! The Taylor series of the rates as tokens.
//!
//! In: the routine of the rates. Out: the body of `series`: its assignments once for the values at the start, and once, in
//! a loop over the orders, for the coefficients. Products, quotients and functions need the coefficients of lower orders as
//! well, which rows of a work table keep; see `bg_model::series`. What does not change has no coefficients behind the
//! start: nothing is left of it in the loop.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{self, Names, temporary};
use crate::expr::{Function, Symbol};
use crate::program::{Assignment, Operand, Operation, Routine};

/// The statements of a series.
pub(super) struct Statements {
    /// What does not change with time, and yet is no constant of the model: it depends on inputs.
    pub fixed: TokenStream,
    /// At the start, order 0.
    pub start: TokenStream,
    /// The rates there.
    pub start_rates: Vec<TokenStream>,
    /// At order `k` > 0.
    pub order: TokenStream,
    /// The rates' coefficients.
    pub order_rates: Vec<TokenStream>,
    /// The number of products of two factors that change.
    pub products: usize,
    /// The number of places in a row of the table.
    pub places: usize,
}

/// The statements of the series of a routine's results.
pub(super) fn statements(routine: &Routine, names: &Names) -> Statements {
    let changes = changing(&routine.assignments);
    let mut writer = Writer::new(names, &changes, true);
    writer.products = routine.assignments.iter().filter(|assignment| writer.is_product(assignment)).count();
    let mut at_order = Writer::new(names, &changes, false);
    at_order.products = writer.products;
    let (moving, fixed): (Vec<_>, Vec<_>) =
        routine.assignments.iter().cloned().partition(|assignment| changes[assignment.target as usize]);
    for assignment in &moving {
        writer.assignment(assignment);
        at_order.assignment(assignment);
    }
    let rates = |writer: &Writer| routine.results.iter().map(|result| writer.value(result)).collect();
    Statements {
        fixed: routine::assignments(&fixed, names),
        start_rates: rates(&writer),
        order_rates: rates(&at_order),
        products: writer.products,
        places: (2 * writer.products + writer.others).max(1),
        start: writer.tokens,
        order: at_order.tokens,
    }
}

/// Which assignments change with time.
fn changing(assignments: &[Assignment]) -> Vec<bool> {
    let mut changes: Vec<bool> = Vec::with_capacity(assignments.len());
    for assignment in assignments {
        let operands = assignment.operation.operands();
        changes.push(operands.iter().any(|operand| is_changing(operand, &changes)));
    }
    changes
}

fn is_changing(operand: &Operand, changes: &[bool]) -> bool {
    match *operand {
        Operand::Temporary(index) => changes[index as usize],
        Operand::Symbol(Symbol::Input(_)) | Operand::Number(_) | Operand::Constant(_) => false,
        Operand::Symbol(_) => true,
    }
}

struct Writer<'w, 'n> {
    names: &'w Names<'n>,
    changes: &'w [bool],
    /// Whether the order is 0.
    is_start: bool,
    /// The number of products.
    products: usize,
    /// The products written so far.
    product: usize,
    /// The places behind those of the products.
    others: usize,
    tokens: TokenStream,
}

impl<'w, 'n> Writer<'w, 'n> {
    fn new(names: &'w Names<'n>, changes: &'w [bool], is_start: bool) -> Self {
        Self { names, changes, is_start, products: 0, product: 0, others: 0, tokens: TokenStream::new() }
    }

    fn is_changing(&self, operand: &Operand) -> bool {
        is_changing(operand, self.changes)
    }

    /// Whether both factors of a product change.
    fn is_product(&self, assignment: &Assignment) -> bool {
        matches!(&assignment.operation, Operation::Multiply(a, b) if self.is_changing(a) && self.is_changing(b))
    }

    /// The coefficient of an operand.
    fn value(&self, operand: &Operand) -> TokenStream {
        if self.is_start || self.is_changing(operand) {
            routine::operand(operand, self.names)
        } else {
            quote!(S::from_f64(0.0))
        }
    }

    /// The value of an operand at the start, which is its value at all times if it does not change.
    fn fixed(&self, operand: &Operand) -> TokenStream {
        routine::operand(operand, self.names)
    }

    fn assignment(&mut self, assignment: &Assignment) {
        let value = self.operation(&assignment.operation);
        let target = temporary(assignment.target, self.names);
        self.tokens.extend(if self.names.is_long { quote!(#target = #value;) } else { quote!(let #target = #value;) });
    }

    fn operation(&mut self, operation: &Operation) -> TokenStream {
        match operation {
            Operation::Multiply(a, b) if self.is_changing(a) && self.is_changing(b) => self.product(a, b),
            Operation::Divide(a, b) if self.is_changing(b) => {
                let at = self.reserve(2);
                let (a, b) = (self.value(a), self.value(b));
                quote!(::bg_model::series::quotient(rows, k, #at, #a, #b))
            }
            Operation::Call(function, arguments) => self.call(*function, arguments),
            // In the loop only what changes is left of a sum.
            Operation::Add(a, b) if !self.is_start && !self.is_changing(a) => self.value(b),
            Operation::Add(a, b) | Operation::Subtract(a, b) if !self.is_start && !self.is_changing(b) => self.value(a),
            Operation::Subtract(a, b) if !self.is_start && !self.is_changing(a) => {
                let b = self.value(b);
                quote!(-#b)
            }
            Operation::Multiply(..) | Operation::Divide(..) => {
                routine::operation(operation, self.names, &|operand| self.fixed(operand))
            }
            _ => routine::operation(operation, self.names, &|operand| self.value(operand)),
        }
    }

    fn product(&mut self, a: &Operand, b: &Operand) -> TokenStream {
        let index = Literal::usize_unsuffixed(self.product);
        let (left, right) =
            (Literal::usize_unsuffixed(self.product), Literal::usize_unsuffixed(self.products + self.product));
        self.product += 1;
        let (a, b) = (self.value(a), self.value(b));
        let value = if self.is_start {
            quote!(a * b)
        } else {
            quote!(inner[#index] + (a * rows[0][#right] + rows[0][#left] * b))
        };
        quote! {{
            let (a, b) = (#a, #b);
            (rows[k][#left], rows[k][#right]) = (a, b);
            #value
        }}
    }

    /// The first of `count` places.
    fn reserve(&mut self, count: usize) -> Literal {
        let at = 2 * self.products + self.others;
        self.others += count;
        Literal::usize_unsuffixed(at)
    }

    fn call(&mut self, function: Function, arguments: &[Operand]) -> TokenStream {
        let is_fixed_power = function == Function::Pow && !self.is_changing(&arguments[1]);
        let (name, places) = match function {
            Function::Sqrt => (quote!(sqrt), 1),
            Function::Abs => (quote!(abs), 1),
            Function::Exp => (quote!(exp), 2),
            Function::Ln => (quote!(ln), 2),
            Function::Sin => (quote!(sin), 3),
            Function::Cos => (quote!(cos), 3),
            Function::Tan => (quote!(tan), 3),
            Function::Tanh => (quote!(tanh), 3),
            Function::Asin => (quote!(asin), 3),
            Function::Acos => (quote!(acos), 3),
            Function::Atan2 => (quote!(atan2), 4),
            Function::Pow if is_fixed_power => (quote!(powf), 2),
            Function::Pow => (quote!(power), 6),
        };
        let at = self.reserve(places);
        let first = self.value(&arguments[0]);
        let second = arguments.get(1).map(|second| {
            let second = if is_fixed_power { self.fixed(second) } else { self.value(second) };
            quote!(, #second)
        });
        quote!(::bg_model::series::#name(rows, k, #at, #first #second))
    }
}
