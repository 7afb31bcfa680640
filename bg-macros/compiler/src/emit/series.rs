//! The Taylor series of the rates as tokens.
//!
//! In: the routine of the rates. Out: the body of `expand` of `Series`: its assignments once for the values at the start, and once, in
//! a loop over the orders, for the coefficients. Products, quotients and functions need the coefficients of lower orders as
//! well, which rows of a work table keep; see `bg_model::series`. What does not change has no coefficients behind the
//! start: nothing is left of it in the loop.
//!
//! What iterations find is a number at the start only. A step of Newton's iteration on series gives the coefficient of an order
//! where all lower ones are right and that one is 0 (Brent and Kung 1978, Fast algorithms for manipulating formal power series),
//! so each order is gone through twice: for that coefficient, then with it.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::routine::{self, Names};
use crate::expr::{Function, Symbol};
use crate::program::{Assignment, Operand, Operation, Routine};

/// What a series reads, beside constants.
pub(super) struct Reads {
    /// `let`s of the inputs that the rates read, from the time `t`.
    pub values: TokenStream,
    /// `let`s of the states' coefficients, from `x`.
    pub states: TokenStream,
    /// How many unknowns iterations find; they are the last results of the routine.
    pub found: usize,
}

/// How many numbers each order takes, and the body of `expand`, from the routine of the rates.
pub(super) fn expansion(routine: &Routine, names: &Names, reads: &Reads) -> (usize, TokenStream) {
    let changes = changing(&routine.assignments);
    let (moving, fixed): (Vec<_>, Vec<_>) =
        routine.assignments.iter().cloned().partition(|assignment| changes[assignment.target as usize]);
    let written = |is_start| {
        let mut writer = Writer::new(names, &changes, is_start, &moving);
        moving.iter().for_each(|assignment| writer.assignment(assignment));
        let rates: Vec<_> = routine.results.iter().map(|result| writer.value(result)).collect();
        (writer, rates)
    };
    let ((start, start_rates), (order, order_rates)) = (written(true), written(false));
    let (products, places) = (start.products, (2 * start.products + start.others).max(1));
    let (start, order) = (start.tokens, order.tokens);
    let Reads { values, states, found } = reads;
    let (start_rates, _) = start_rates.split_at(start_rates.len() - found);
    let (order_rates, coefficients) = order_rates.split_at(order_rates.len() - found);
    let order = if *found == 0 {
        order
    } else {
        quote! {
            found = [S::from_f64(0.0); #found];
            #order
            found = [#(#coefficients),*];
            #order
        }
    };
    let array = routine::array(routine);
    // What does not change with time, and yet is no constant of the model: it depends on inputs.
    let fixed = routine::assignments(&fixed, names);
    let body = quote! {
        let c = &self.constants;
        let table = rows.as_chunks_mut::<#places>().0;
        #values
        #array
        #fixed
        {
            let k = 0;
            let rows = &mut table[..1];
            let [x] = &series[0].data.0;
            #states
            #start
            series[1].data.0 = [[#(#start_rates * h),*]];
        }
        for k in 1..series.len() - 1 {
            let t = if k == 1 { h } else { S::from_f64(0.0) };
            let inner = ::bg_model::series::inner_products::<S, #products, #places>(&table[..k]);
            let rows = &mut table[..=k];
            let [x] = &series[k].data.0;
            #states
            #order
            let part = h / S::from_f64((k + 1) as f64);
            series[k + 1].data.0 = [[#(#order_rates * part),*]];
        }
    };
    (places, body)
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
    fn new(names: &'w Names<'n>, changes: &'w [bool], is_start: bool, assignments: &[Assignment]) -> Self {
        let tokens = TokenStream::new();
        let mut writer = Self { names, changes, is_start, products: 0, product: 0, others: 0, tokens };
        writer.products = assignments.iter().filter(|assignment| writer.is_product(&assignment.operation)).count();
        writer
    }

    fn is_changing(&self, operand: &Operand) -> bool {
        is_changing(operand, self.changes)
    }

    /// Whether both factors of a product change.
    fn is_product(&self, operation: &Operation) -> bool {
        matches!(operation, Operation::Multiply(a, b) if self.is_changing(a) && self.is_changing(b))
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
        self.tokens.extend(routine::definition(assignment.target, &value, self.names));
    }

    fn operation(&mut self, operation: &Operation) -> TokenStream {
        match operation {
            Operation::Multiply(a, b) if self.is_product(operation) => self.product(a, b),
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
