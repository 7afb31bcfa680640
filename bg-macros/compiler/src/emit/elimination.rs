//! Factorisation and solution of I - c J as tokens.
//!
//! In: an [`Elimination`]. Out: the bodies of functions that do it, generic over a scalar `S` and a field `F`: one
//! `let` for each step over arrays of fixed size, or tables of the steps.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::routine::parsed;
use crate::program::elimination::{Elimination, Row, Step, Substep};
use crate::tables::{self, EliminationTable};

/// The value in a slot.
fn value(slot: usize) -> Ident {
    format_ident!("a{slot}")
}

/// Longer factorisations are tables alone. rustc's time for unrolled complex ones grows faster than their length: 0.5 s
/// for 600 steps, 80 s for 9400.
const UNROLLED: usize = 2000;

pub(super) fn is_unrolled(elimination: &Elimination) -> bool {
    elimination.factorisation.len() <= UNROLLED
}

/// The unrolled body of `eliminate(c, entries, factors)`; `entries` and `factors` are arrays.
pub(super) fn factorisation(elimination: &Elimination) -> TokenStream {
    let steps = elimination.factorisation.iter().map(step);
    let values = (0..elimination.slots).map(value);
    quote! {
        use ::bg_model::__private::Pivot;
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
        Step::Enter { slot, entry, of, is_pivot } => {
            let (value, entry) = (value(slot), Literal::usize_unsuffixed(entry));
            match (of, is_pivot) {
                (Row::State, true) => quote!(let #value = Pivot::new(one + minus.scaled(entries[#entry]));),
                (Row::State, false) => quote!(let #value = minus.scaled(entries[#entry]);),
                (Row::Unknown, true) => quote!(let #value = Pivot::of_unknown(F::real(entries[#entry]));),
                (Row::Unknown, false) => quote!(let #value = F::real(entries[#entry]);),
            }
        }
        Step::Fill { slot, product: factors, of, is_pivot } => {
            let (value, product) = (value(slot), product(factors));
            match (of, is_pivot) {
                (Row::State, true) => quote!(let #value = Pivot::new(one - #product);),
                (Row::Unknown, true) => quote!(let #value = Pivot::of_unknown(-(#product));),
                (_, false) => quote!(let #value = -(#product);),
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

/// The unrolled body of `substitute(factors, b)`; `factors` and `b`, of `n` states, are arrays.
pub(super) fn substitution(elimination: &Elimination, n: usize) -> TokenStream {
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
    let (components, unknowns) = components.split_at(n);
    quote! {
        let [#(#components),*] = *b;
        #(let #unknowns = F::real(S::from_f64(0.0));)*
        #(#steps)*
        *b = [#(#components),*];
    }
}

/// The same as [`factorisation`] by tables.
pub(super) fn factorisation_table(elimination: &Elimination) -> TokenStream {
    let EliminationTable { slots, products, .. } = tables::elimination(elimination);
    let slots = slots.iter().map(|slot| format!("{slot:?}")).collect::<Vec<_>>().join(", ");
    let products = products.iter().map(|product| format!("{product:?}")).collect::<Vec<_>>().join(", ");
    let [slots, products] = [slots, products].map(|rows| parsed(&rows));
    quote! {
        use ::bg_model::__private::table::{self, Slot};
        static SLOTS: &[Slot] = &[#slots];
        static PRODUCTS: &[(u32, u32)] = &[#products];
        table::eliminate(SLOTS, PRODUCTS, c, entries, factors)
    }
}

/// The same as [`substitution`] by tables.
pub(super) fn substitution_table(elimination: &Elimination, n: usize) -> TokenStream {
    let EliminationTable { steps, rows, .. } = tables::elimination(elimination);
    let steps = parsed(&steps.iter().map(|step| format!("{step:?}")).collect::<Vec<_>>().join(", "));
    let whole = (rows > n).then(|| {
        quote! {
            let mut whole = [F::real(S::from_f64(0.0)); #rows];
            whole[..#n].copy_from_slice(b);
        }
    });
    let (right, back) = match &whole {
        Some(_) => (quote!(&mut whole), quote!(b.copy_from_slice(&whole[..#n]);)),
        None => (quote!(b), TokenStream::new()),
    };
    quote! {
        static STEPS: &[(u32, u32, u32)] = &[#steps];
        #whole
        ::bg_model::__private::table::substitute::<S, F>(STEPS, factors, #right);
        #back
    }
}
