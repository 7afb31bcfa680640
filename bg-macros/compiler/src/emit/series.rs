//! The Taylor series of the rates as tokens.
//!
//! In: the routine of the rates. Out: the body of `expand` of `Series`: its assignments once for the values at the
//! start, and once, in a loop over the orders, for the coefficients. Products, quotients and functions need the
//! coefficients of lower orders as well, which rows of a work table keep; see `bg_model::series`. What does not change
//! has no coefficients after the start: nothing is left of it in the loop.
//!
//! What iterations find is a number at the start only. A step of Newton's iteration on series gives the coefficient of
//! an order where all lower ones are right and that one is 0 (Brent and Kung 1978, Fast algorithms for manipulating
//! formal power series), so each order is gone through twice: for that coefficient, then with it.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::blocks::{Blocks, Chunk, Group};
use super::coefficients::Writer;
use super::pairs;
use super::routine::{Names, assignments, parsed, parsed_each};
use crate::program::pairs::{Half, Paired, Step};
use crate::program::{Assignment, Changes, Routine, SeriesSize, series_size};

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
    /// Whether it is compiled for the machine's vectors as a whole; else its inner products alone are.
    pub in_vectors: bool,
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

/// The code of a series, from the routine of the rates, in pairs where it has them.
pub(super) fn expansion(routine: &Routine, paired: Option<&Paired>, names: &Names, reads: &Reads) -> Expansion {
    let steps = paired.map_or_else(|| alone(routine), |paired| paired.steps.clone());
    let results = paired.map_or_else(|| halves(routine), |paired| paired.results.clone());
    let changes = Changes::of(&steps);
    let (moving, fixed): (Vec<_>, Vec<_>) = steps.into_iter().partition(|step| changes.includes(step));
    let [moving_singles, fixed_singles] = [&moving, &fixed].map(|steps| singles(steps));
    let long = routine.is_long().then(|| {
        let [fixed, moving] =
            [&fixed_singles, &moving_singles].map(|of| Group::of(of, &|operand| changes.operand(operand)));
        let blocks = Blocks::of(&[&fixed[..], &moving[..]].concat(), &routine.results);
        Long { fixed, moving, blocks }
    });
    let written = |is_start| {
        let mut writer = Writer::new(names, &changes, is_start, moving.iter());
        let code = match &long {
            Some(long) => long.parts(&long.moving, |part| writer.part(part)),
            None => Code::Whole(writer.group(&moving)),
        };
        let rates = results.iter().map(|result| match (&long, result) {
            (Some(Long { blocks, .. }), Half::Of(result)) if is_start || changes.operand(result) => {
                blocks.result(result, names)
            }
            _ => writer.half(result),
        });
        let rates = parsed_each(rates);
        (code, rates, writer)
    };
    let ((start, start_rates, counted), (order, order_rates, _)) = (written(true), written(false));
    let (products, places) = (counted.products, counted.places().max(1));
    let (array, array_type) =
        (long.as_ref().map(|long| long.blocks.array()), long.as_ref().map(|long| long.blocks.array_type()));
    let mut parts = TokenStream::new();
    let mut statements = |pass: Pass, code: Code| match code {
        Code::Parts(written) => {
            let (functions, calls) = pass.parts(written, &array_type, reads);
            parts.extend(functions);
            calls
        }
        Code::Whole(definitions) => parsed(&definitions),
    };
    // What does not change with time, and yet is no constant of the model: it depends on inputs.
    let fixed = match &long {
        Some(long) => long.parts(&long.fixed, |part| assignments(&part.assignments, names)),
        None => Code::Whole(pairs::text(&fixed, names)),
    };
    let fixed = statements(Pass::Fixed, fixed);
    let start = statements(Pass::Start { places }, start);
    let order = statements(Pass::Order { places, products }, order);
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
    let pair_products = paired.map(|_| quote!(, first_products, next_products));
    let tables = match paired {
        Some(_) => quote!(let (c, q) = (&self.constants, &self.constant_pairs);),
        None => quote!(let c = &self.constants;),
    };
    let next_order = format_ident!("{}", if reads.in_vectors { "at_next_order" } else { "called_at_next_order" });
    let at = long.as_ref().map(|_| quote!(let at = t;));
    let body = quote! {
        use ::bg_model::series::{first_product, next_product #pair_products};
        #tables
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
        let mut inner = ::bg_model::series::InnerProducts::<S, #products>::first();
        for k in 1..series.len() - 1 {
            let t = if k == 1 { h } else { S::from_f64(0.0) };
            let inner = inner.#next_order(&table[..k]);
            let rows = &mut table[..=k];
            let [x] = &series[k].data.0;
            #states
            #order
            let part = h / S::from_f64((k + 1) as f64);
            series[k + 1].data.0 = [[#(#order_rates * part),*]];
        }
    };
    let operations = operations(series_size(routine, *found > 0));
    Expansion { width: places, operations, body, parts }
}

/// A long routine in groups.
struct Long<'a> {
    /// Of what does not change.
    fixed: Vec<Group<'a>>,
    /// Of what does.
    moving: Vec<Group<'a>>,
    blocks: Blocks,
}

impl<'a> Long<'a> {
    /// Groups as they are written, each with its definitions.
    fn parts(&self, groups: &[Group<'a>], mut definitions: impl FnMut(&mut Chunk) -> String) -> Code<'a> {
        let written = groups.iter().map(|group| {
            let mut part = self.blocks.part(group);
            let definitions = definitions(&mut part);
            (part, definitions)
        });
        Code::Parts(written.collect())
    }
}

/// What is gone through once or for each order, as text.
enum Code<'a> {
    Whole(String),
    Parts(Vec<(Chunk<'a>, String)>),
}

/// The assignments of a routine as steps.
fn alone(routine: &Routine) -> Vec<Step> {
    routine.assignments.iter().cloned().map(Step::Single).collect()
}

/// The results of a routine.
fn halves(routine: &Routine) -> Vec<Half> {
    routine.results.iter().copied().map(Half::Of).collect()
}

/// The assignments among the steps: of a long routine, which has no pairs, all of them.
fn singles(steps: &[Step]) -> Vec<Assignment> {
    let single = |step: &Step| if let Step::Single(assignment) = step { Some(assignment.clone()) } else { None };
    steps.iter().filter_map(single).collect()
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
    /// The functions of these parts, each with its definitions, and their calls in the body of `expand`.
    fn parts(
        self,
        parts: Vec<(Chunk, String)>,
        array: &Option<TokenStream>,
        reads: &Reads,
    ) -> (TokenStream, TokenStream) {
        let (pass, arguments) = self.arguments(reads);
        let (declared, handed): (Vec<_>, Vec<_>) =
            arguments.into_iter().map(|[declared, handed]| (declared, handed)).unzip();
        let function = |(index, (part, definitions)): (usize, (Chunk, String))| {
            let name = format_ident!("series_{pass}_part_{index}");
            let (read, block) = ((reads.by)(&part.assignments), parsed(&part.code(&definitions)));
            let function = quote! {
                #[inline(never)]
                fn #name(&self, #(#declared,)* v: &mut #array) {
                    use ::bg_model::series::{first_product, next_product};
                    let c = &self.constants;
                    #read
                    #block
                }
            };
            (function, quote!(self.#name(#(#handed,)* v);))
        };
        parts.into_iter().enumerate().map(function).unzip()
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

/// What it costs, as the fields of `Operations`.
fn operations(size: SeriesSize) -> TokenStream {
    let SeriesSize { rate, order, product_count, sums, .. } = size;
    let [rate, order, products, sums] = [rate, order, product_count, sums].map(Literal::usize_unsuffixed);
    quote!(rate: #rate, order: #order, products: #products, sums: #sums)
}
