//! Factorisation and solution of I - c J as tokens.
//!
//! In: an [`Elimination`]. Out: the bodies of `eliminate` and `substitute`, generic over a scalar `S` and a field `F`: one
//! `let` for each step over arrays of fixed size, or, for long ones, tables of the steps.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::program::elimination::{Elimination, Step, Substep};

/// The value in a slot.
fn value(slot: usize) -> Ident {
    format_ident!("a{slot}")
}

/// Longer factorisations are tables. rustc's time for unrolled complex ones grows faster than their length: 0.5 s for 600
/// steps, 80 s for 9400.
const UNROLLED: usize = 2000;

fn is_unrolled(elimination: &Elimination) -> bool {
    elimination.factorisation.len() <= UNROLLED
}

/// The body of `eliminate(c, entries, factors)`; `entries` and `factors` are arrays.
pub(super) fn factorisation(elimination: &Elimination) -> TokenStream {
    if !is_unrolled(elimination) {
        return factorisation_table(elimination);
    }
    let steps = elimination.factorisation.iter().map(step);
    let values = (0..elimination.slots).map(value);
    quote! {
        let minus = -c;
        let one = F::real(S::from_f64(1.0));
        let mut is_regular = true;
        #(#steps)*
        *factors = [#(#values),*];
        is_regular
    }
}

fn step(step: &Step) -> TokenStream {
    let product = |(left, right): (usize, usize)| {
        let (left, right) = (value(left), value(right));
        quote!(#left * #right)
    };
    match *step {
        Step::Enter { slot, entry, is_pivot } => {
            let (value, entry) = (value(slot), Literal::usize_unsuffixed(entry));
            if is_pivot {
                quote!(let #value = ::bg_model::__private::Pivot::new(one + minus.scaled(entries[#entry]));)
            } else {
                quote!(let #value = minus.scaled(entries[#entry]);)
            }
        }
        Step::Fill { slot, product: factors, is_pivot } => {
            let (value, product) = (value(slot), product(factors));
            if is_pivot {
                quote!(let #value = ::bg_model::__private::Pivot::new(one - #product);)
            } else {
                quote!(let #value = -(#product);)
            }
        }
        Step::Update { slot, product: factors, is_pivot } => {
            let (value, product) = (value(slot), product(factors));
            if is_pivot {
                quote!(let #value = #value.minus(#product);)
            } else {
                quote!(let #value = #value - #product;)
            }
        }
        Step::Invert { slot } => {
            let value = value(slot);
            quote!(let #value = #value.reciprocal(&mut is_regular);)
        }
        Step::Scale { slot, by } => {
            let (value, by) = (value(slot), value(by));
            quote!(let #value = #value * #by;)
        }
    }
}

/// The body of `substitute(factors, b)`; `factors` is an array.
pub(super) fn substitution(elimination: &Elimination) -> TokenStream {
    if !is_unrolled(elimination) {
        return substitution_table(elimination);
    }
    let component = |row: usize| format_ident!("b{row}");
    let components: Vec<Ident> = (0..elimination.order.len()).map(component).collect();
    let steps = elimination.substitution.iter().map(|step| match *step {
        Substep::Subtract { row, slot, column } => {
            let (row, slot, column) = (component(row), Literal::usize_unsuffixed(slot), component(column));
            quote!(let #row = #row - factors[#slot] * #column;)
        }
        Substep::Scale { row, slot } => {
            let (row, slot) = (component(row), Literal::usize_unsuffixed(slot));
            quote!(let #row = #row * factors[#slot];)
        }
    });
    quote! {
        let [#(#components),*] = *b;
        #(#steps)*
        *b = [#(#components),*];
    }
}

/// A number without suffix.
fn index(of: usize) -> Literal {
    Literal::usize_unsuffixed(of)
}

fn factorisation_table(elimination: &Elimination) -> TokenStream {
    let mut products = Vec::new();
    let slots: Vec<TokenStream> = elimination
        .factorisation
        .chunk_by(|left, right| left.slot() == right.slot())
        .map(|steps| {
            let (mut entry, mut scale, mut is_pivot) = (quote!(None), quote!(None), false);
            for step in steps {
                match *step {
                    Step::Enter { entry: number, .. } => {
                        let number = index(number);
                        entry = quote!(Some(#number));
                    }
                    Step::Fill { product: (left, right), .. } | Step::Update { product: (left, right), .. } => {
                        let (left, right) = (index(left), index(right));
                        products.push(quote!((#left, #right)));
                    }
                    Step::Invert { .. } => is_pivot = true,
                    Step::Scale { by, .. } => {
                        let by = index(by);
                        scale = quote!(Some(#by));
                    }
                }
            }
            let end = index(products.len());
            quote!(Slot { entry: #entry, end: #end, is_pivot: #is_pivot, scale: #scale })
        })
        .collect();
    quote! {
        use ::bg_model::__private::table::{self, Slot};
        static SLOTS: &[Slot] = &[#(#slots),*];
        static PRODUCTS: &[(u32, u32)] = &[#(#products),*];
        table::eliminate(SLOTS, PRODUCTS, c, entries, factors)
    }
}

fn substitution_table(elimination: &Elimination) -> TokenStream {
    let steps = elimination.substitution.iter().map(|step| {
        let (row, slot, column) = match *step {
            Substep::Subtract { row, slot, column } => (row, slot, column),
            Substep::Scale { row, slot } => (row, slot, row),
        };
        let (row, slot, column) = (index(row), index(slot), index(column));
        quote!((#row, #slot, #column))
    });
    quote! {
        static STEPS: &[(u32, u32, u32)] = &[#(#steps),*];
        ::bg_model::__private::table::substitute::<S, F>(STEPS, factors, b)
    }
}
