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

use std::slice::Chunks;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::blocks::{BLOCK, Blocks};
use super::routine::{self, Names, parsed, parsed_each};
use crate::expr::{Function, Symbol};
use crate::program::{Assignment, Operand, Operation, Routine};

/// What a series reads, beside constants.
pub(super) struct Reads<'a> {
    /// `let`s of the inputs that the rates read, from the time `t`.
    pub values: TokenStream,
    /// `let`s of the states' coefficients, from `x`.
    pub states: Option<TokenStream>,
    /// How many unknowns iterations find; they are the last results of the routine.
    pub found: usize,
    /// The numbers of states and of switches.
    pub shape: [&'a Literal; 2],
    /// `let`s of what some assignments read: inputs from the time `at`, the states' coefficients from `x`.
    pub by: &'a dyn Fn(&[Assignment]) -> TokenStream,
}

/// The code of a series.
pub(super) struct Expansion {
    /// How many numbers each order takes.
    pub width: usize,
    /// What it costs, as the fields of `Operations`.
    pub operations: TokenStream,
    /// The body of `expand`.
    pub body: TokenStream,
    /// The functions of the model that the body of a long one calls.
    pub parts: TokenStream,
}

/// The code of a series, from the routine of the rates.
pub(super) fn expansion(routine: &Routine, names: &Names, reads: &Reads) -> Expansion {
    let changes = changing(&routine.assignments);
    let (moving, fixed): (Vec<_>, Vec<_>) =
        routine.assignments.iter().cloned().partition(|assignment| changes[assignment.target as usize]);
    let length = if routine.is_long() { BLOCK } else { usize::MAX };
    let (fixed, moving) = (fixed.chunks(length), moving.chunks(length));
    let blocks = routine.is_long().then(|| Blocks::of(fixed.clone().chain(moving.clone()), &routine.results));
    let written = |is_start| {
        let mut writer = Writer::new(names, &changes, is_start, moving.clone().flatten());
        let groups: Vec<_> = moving.clone().map(|group| writer.group(group)).collect();
        let rates = routine.results.iter().map(|result| match &blocks {
            Some(blocks) if is_start || writer.is_changing(result) => blocks.result(result, names),
            _ => writer.value(result),
        });
        let rates = parsed_each(rates);
        (groups, rates, writer)
    };
    let ((start, start_rates, counted), (order, order_rates, _)) = (written(true), written(false));
    let (products, places) = (counted.products, (2 * counted.products + counted.others).max(1));
    let mut parts = TokenStream::new();
    let mut statements = |pass: Pass, groups: Chunks<Assignment>, definitions: Vec<String>| match &blocks {
        Some(blocks) => {
            let (functions, calls) = pass.parts(groups, &definitions, blocks, names, reads);
            parts.extend(functions);
            calls
        }
        None => parsed(&definitions.concat()),
    };
    // What does not change with time, and yet is no constant of the model: it depends on inputs.
    let definitions = fixed.clone().map(|group| routine::assignments(group, names)).collect();
    let fixed = statements(Pass::Fixed, fixed, definitions);
    let start = statements(Pass::Start { places }, moving.clone(), start);
    let order = statements(Pass::Order { places, products }, moving, order);
    let Reads { values, states, found, .. } = reads;
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
    let (array, at) = (blocks.as_ref().map(Blocks::array), blocks.as_ref().map(|_| quote!(let at = t;)));
    let body = quote! {
        use ::bg_model::series::{first_product, next_product};
        let c = &self.constants;
        let table = rows.as_chunks_mut::<#places>().0;
        #values
        #array
        #at
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
            let inner = &::bg_model::series::inner_products::<S, #products, #places>(&table[..k]);
            let rows = &mut table[..=k];
            let [x] = &series[k].data.0;
            #states
            #order
            let part = h / S::from_f64((k + 1) as f64);
            series[k + 1].data.0 = [[#(#order_rates * part),*]];
        }
    };
    let operations = operations(routine, &counted, *found > 0);
    Expansion { width: places, operations, body, parts }
}

/// What is gone through once or for each order.
#[derive(Clone, Copy)]
enum Pass {
    /// What does not change.
    Fixed,
    /// The values at the start.
    Start { places: usize },
    /// The coefficients of an order.
    Order { places: usize, products: usize },
}

impl Pass {
    /// The functions of these groups, and their calls in the body of `expand`.
    fn parts(
        self,
        groups: Chunks<Assignment>,
        definitions: &[String],
        blocks: &Blocks,
        names: &Names,
        reads: &Reads,
    ) -> (TokenStream, TokenStream) {
        let (pass, arguments) = self.arguments(reads);
        let (declared, handed): (Vec<_>, Vec<_>) =
            arguments.into_iter().map(|[declared, handed]| (declared, handed)).unzip();
        let array = blocks.array_type();
        let part = |(index, (group, definitions)): (usize, (_, &String))| {
            let (name, read, block) = (
                format_ident!("series_{pass}_part_{index}"),
                (reads.by)(group),
                parsed(&blocks.block(group, definitions, names)),
            );
            let function = quote! {
                #[cfg_attr(not(debug_assertions), inline(always))]
                fn #name(&self, #(#declared,)* v: &mut #array) {
                    use ::bg_model::series::{first_product, next_product};
                    let c = &self.constants;
                    #read
                    #block
                }
            };
            (function, quote!(self.#name(#(#handed,)* v);))
        };
        groups.zip(definitions).enumerate().map(part).unzip()
    }

    /// The name in those of its parts, and what these are handed: declared, and in the body of `expand`.
    fn arguments(self, reads: &Reads) -> (&'static str, Vec<[TokenStream; 2]>) {
        let [n, g] = reads.shape;
        let mut arguments = vec![[quote!(at: S), quote!(at)], [quote!(negative: &[S::Switch; #g]), quote!(negative)]];
        if let Self::Start { places } | Self::Order { places, .. } = self {
            arguments.extend([
                [quote!(t: S), quote!(t)],
                [quote!(x: &[S; #n]), quote!(x)],
                [quote!(k: usize), quote!(k)],
                [quote!(rows: &mut [[S; #places]]), quote!(rows)],
            ]);
            arguments.extend((reads.found > 0).then(|| [quote!(found: &[S]), quote!(&found)]));
        }
        match self {
            Self::Fixed => ("fixed", arguments),
            Self::Start { .. } => ("start", arguments),
            Self::Order { products, .. } => {
                arguments.push([quote!(inner: &[S; #products]), quote!(inner)]);
                ("order", arguments)
            }
        }
    }
}

/// What an order costs beside a rate; where iterations find something, it is gone through twice.
fn operations(routine: &Routine, counted: &Writer, is_twice: bool) -> TokenStream {
    let (mut order, mut sums) = (routine.results.len(), 0);
    let is_changing = |operand: &Operand| counted.is_changing(operand);
    for Assignment { target, operation } in &routine.assignments {
        if !counted.changes[*target as usize] {
            continue;
        }
        order += match operation {
            // Two products with the values at the start, and what is known already.
            Operation::Multiply(..) if counted.is_product(operation) => 4,
            Operation::Divide(_, divisor) if is_changing(divisor) => {
                sums += 1;
                2
            }
            Operation::Call(function, _) => {
                sums += if matches!(function, Function::Abs | Function::Sqrt) { 1 } else { 2 };
                4
            }
            Operation::Add(a, b) | Operation::Subtract(a, b) => usize::from(is_changing(a) && is_changing(b)),
            _ => 1,
        };
    }
    let passes = if is_twice { 2 } else { 1 };
    let [rate, order, products, sums] =
        [routine.counts.total(), passes * order, counted.products, passes * sums].map(Literal::usize_unsuffixed);
    quote!(rate: #rate, order: #order, products: #products, sums: #sums)
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
}

impl<'w, 'n> Writer<'w, 'n> {
    fn new<'a>(
        names: &'w Names<'n>,
        changes: &'w [bool],
        is_start: bool,
        assignments: impl Iterator<Item = &'a Assignment>,
    ) -> Self {
        let mut writer = Self { names, changes, is_start, products: 0, product: 0, others: 0 };
        writer.products = assignments.filter(|assignment| writer.is_product(&assignment.operation)).count();
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
    fn value(&self, operand: &Operand) -> String {
        if self.is_start || self.is_changing(operand) {
            routine::operand(operand, self.names)
        } else {
            "S::from_f64(0.0)".to_owned()
        }
    }

    /// The value of an operand at the start, which is its value at all times if it does not change.
    fn fixed(&self, operand: &Operand) -> String {
        routine::operand(operand, self.names)
    }

    /// The definitions of a group.
    fn group(&mut self, group: &[Assignment]) -> String {
        let definition = |of: &Assignment| routine::definition(of.target, &self.operation(&of.operation));
        group.iter().map(definition).collect()
    }

    fn operation(&mut self, operation: &Operation) -> String {
        match operation {
            Operation::Multiply(a, b) if self.is_product(operation) => self.product(a, b),
            Operation::Divide(a, b) if self.is_changing(b) => {
                let at = self.reserve(2);
                let (a, b) = (self.value(a), self.value(b));
                format!("::bg_model::series::quotient(rows, k, {at}, {a}, {b})")
            }
            Operation::Call(function, arguments) => self.call(*function, arguments),
            // In the loop only what changes is left of a sum.
            Operation::Add(a, b) if !self.is_start && !self.is_changing(a) => self.value(b),
            Operation::Add(a, b) | Operation::Subtract(a, b) if !self.is_start && !self.is_changing(b) => self.value(a),
            Operation::Subtract(a, b) if !self.is_start && !self.is_changing(a) => {
                let b = self.value(b);
                format!("-{b}")
            }
            Operation::Multiply(..) | Operation::Divide(..) => {
                routine::operation(operation, self.names, &|operand| self.fixed(operand))
            }
            _ => routine::operation(operation, self.names, &|operand| self.value(operand)),
        }
    }

    fn product(&mut self, a: &Operand, b: &Operand) -> String {
        let (a, b) = (self.value(a), self.value(b));
        let (left, right) = (self.product, self.products + self.product);
        self.product += 1;
        if self.is_start {
            format!("first_product(rows, {left}, {right}, {a}, {b})")
        } else {
            format!("next_product(inner, rows, k, {left}, {a}, {b})")
        }
    }

    /// The first of `count` places.
    fn reserve(&mut self, count: usize) -> usize {
        let at = 2 * self.products + self.others;
        self.others += count;
        at
    }

    fn call(&mut self, function: Function, arguments: &[Operand]) -> String {
        let is_fixed_power = function == Function::Pow && !self.is_changing(&arguments[1]);
        let (name, places) = match function {
            Function::Sqrt => ("sqrt", 1),
            Function::Abs => ("abs", 1),
            Function::Exp => ("exp", 2),
            Function::Ln => ("ln", 2),
            Function::Sin => ("sin", 3),
            Function::Cos => ("cos", 3),
            Function::Tan => ("tan", 3),
            Function::Tanh => ("tanh", 3),
            Function::Asin => ("asin", 3),
            Function::Acos => ("acos", 3),
            Function::Atan2 => ("atan2", 4),
            Function::Pow if is_fixed_power => ("powf", 2),
            Function::Pow => ("power", 6),
        };
        let at = self.reserve(places);
        let first = self.value(&arguments[0]);
        let second = arguments.get(1).map(|second| {
            let second = if is_fixed_power { self.fixed(second) } else { self.value(second) };
            format!(", {second}")
        });
        format!("::bg_model::series::{name}(rows, k, {at}, {first}{})", second.unwrap_or_default())
    }
}
