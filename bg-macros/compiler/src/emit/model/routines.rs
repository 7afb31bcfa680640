//! How a routine becomes the body of a function.
//!
//! In: a routine and the table of constants that it reads. Out: its statements, and the tokens of its results.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::pairs;
use super::super::routine::{assignments, operand, statements};
use super::{Emission, Shape};
use crate::program::pairs::Paired;
use crate::program::{Assignment, Operand, Program, Routine};

/// Assignments of a function of its own, where there are more.
const PART: usize = 1000;

/// A long routine in parts: functions, the body that calls them, and the results.
pub(super) struct Parts {
    pub(super) functions: TokenStream,
    pub(super) body: TokenStream,
    pub(super) results: Vec<TokenStream>,
}

impl Emission<'_> {
    /// The bare statements of a routine, and its results.
    pub(super) fn body(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.with_names(routine.is_long(), |names| {
            let results = routine.results.iter().map(|result| operand(result, names)).collect();
            (statements(routine, names), results)
        })
    }

    /// `let c`: the constants of a program that is evaluated by itself, from `parameters`; before it the parameters it reads.
    pub(super) fn own_constants(&self, program: &Program<1>) -> TokenStream {
        let [routine] = &program.routines;
        let parameters = self.parameter_bindings(&[&program.constants, routine]);
        let (constants, table) = self.body(&program.constants);
        let entries = table.len();
        quote! {
            #parameters
            let c: [S; #entries] = { #constants [#(#table),*] };
        }
    }

    /// The statements of a function of the running model, and its results.
    pub(super) fn function(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.running(routine, &format_ident!("constants"))
    }

    /// The statements of a routine that reads states and this table of constants, and its results.
    pub(super) fn running(&self, routine: &Routine, constants: &Ident) -> (TokenStream, Vec<TokenStream>) {
        let bindings = self.dynamic_bindings(routine);
        let (statements, results) = self.body(routine);
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
            #bindings
            #statements
        };
        (body, results)
    }

    /// The statements of a routine that may have pairs, and its results.
    pub(super) fn with_pairs(
        &self,
        routine: &Routine,
        paired: Option<&Paired>,
        prefix: &str,
    ) -> (TokenStream, Vec<TokenStream>) {
        let (constants, constant_pairs) = (format_ident!("{prefix}s"), format_ident!("{prefix}_pairs"));
        let Some(paired) = paired else { return self.running(routine, &constants) };
        let bindings = self.dynamic_bindings(routine);
        self.with_names(false, |names| {
            let statements = pairs::statements(paired, names);
            let body = quote! {
                let (c, q) = (&self.#constants, &self.#constant_pairs);
                let [x] = &x.data.0;
                #bindings
                #statements
            };
            (body, paired.results.iter().map(|result| pairs::half(result, names)).collect())
        })
    }

    /// A long routine of the running model in parts, each a function of its own. What a part gives to later ones or as a result
    /// is in the array `v`; all else are `let`s of the part: rustc checks these twice as fast as places of an array.
    pub(super) fn in_parts(&self, routine: &Routine, constants: &Ident) -> Parts {
        let kept = kept(routine);
        let count = kept.len();
        let (mut functions, mut calls) = (TokenStream::new(), TokenStream::new());
        for (index, part) in routine.assignments.chunks(PART).enumerate() {
            let name = format_ident!("{}_part_{index}", routine.name);
            functions.extend(self.part(&name, &alone(routine, part, &[]), &kept, constants));
            calls.extend(quote!(self.#name(t, x, negative, &mut v);));
        }
        let bindings = self.dynamic_bindings(&alone(routine, &[], &routine.results));
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
            let mut v = [S::from_f64(0.0); #count];
            #calls
            #bindings
        };
        let result = |result: &Operand| match result {
            Operand::Temporary(temporary) => place(kept[temporary]),
            other => self.with_names(false, |names| operand(other, names)),
        };
        Parts { functions, body, results: routine.results.iter().map(result).collect() }
    }

    /// The function of a part of a long routine; `kept` are the places of what more than one part needs.
    fn part(&self, name: &Ident, part: &Routine, kept: &BTreeMap<u32, usize>, constants: &Ident) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let count = kept.len();
        let bindings = self.dynamic_bindings(part);
        let own = |temporary: &u32| part.assignments.iter().any(|assignment| assignment.target == *temporary);
        let read: BTreeSet<u32> = part.assignments.iter().flat_map(temporaries).filter(|read| !own(read)).collect();
        let written: Vec<u32> =
            part.assignments.iter().map(|a| a.target).filter(|target| kept.contains_key(target)).collect();
        self.with_names(false, |names| {
            let statements = assignments(&part.assignments, names);
            let reads = read.iter().map(|&temporary| {
                let (name, place) = (operand(&Operand::Temporary(temporary), names), place(kept[&temporary]));
                quote!(let #name = #place;)
            });
            let writes = written.iter().map(|&temporary| {
                let (name, place) = (operand(&Operand::Temporary(temporary), names), place(kept[&temporary]));
                quote!(#place = #name;)
            });
            quote! {
                #[inline(never)]
                fn #name(&self, t: S, x: &[S; #n], negative: &[bool; #g], v: &mut [S; #count]) {
                    let c = &self.#constants;
                    #bindings
                    #(#reads)*
                    #statements
                    #(#writes)*
                }
            }
        })
    }
}

/// The temporaries that more than one part of a long routine or its results need, each with its place.
fn kept(routine: &Routine) -> BTreeMap<u32, usize> {
    let part = |temporary: u32| temporary as usize / PART;
    let results = routine.results.iter().filter_map(temporary);
    let read = routine
        .assignments
        .iter()
        .flat_map(|assignment| temporaries(assignment).filter(move |&read| part(read) != part(assignment.target)));
    let kept: BTreeSet<u32> = results.chain(read).collect();
    kept.into_iter().zip(0..).collect()
}

fn temporary(operand: &Operand) -> Option<u32> {
    if let Operand::Temporary(temporary) = operand { Some(*temporary) } else { None }
}

/// The temporaries that an assignment reads.
fn temporaries(assignment: &Assignment) -> impl Iterator<Item = u32> + use<> {
    assignment.operation.operands().into_iter().filter_map(|operand| temporary(&operand))
}

/// A place of the array of what is kept.
fn place(place: usize) -> TokenStream {
    let place = Literal::usize_unsuffixed(place);
    quote!(v[#place])
}

/// The routine with these assignments and results only.
fn alone(routine: &Routine, assignments: &[Assignment], results: &[Operand]) -> Routine {
    Routine { assignments: assignments.to_vec(), results: results.to_vec(), ..routine.clone() }
}
