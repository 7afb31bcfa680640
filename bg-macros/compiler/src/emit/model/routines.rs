//! How a routine becomes the body of a function.
//!
//! In: a routine and the table of constants that it reads. Out: its statements, and the tokens of its results.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::super::blocks::{BLOCK, Blocks};
use super::super::pairs;
use super::super::routine::{assignments, statements};
use super::{Emission, Shape};
use crate::program::pairs::Paired;
use crate::program::{Assignment, Operand, Program, Routine};

/// A long routine in parts: functions, the body that calls them, and the results.
pub(super) struct Parts {
    pub(super) functions: TokenStream,
    pub(super) body: TokenStream,
    pub(super) results: Vec<TokenStream>,
}

impl Emission<'_> {
    /// The bare statements of a routine, and its results.
    pub(super) fn body(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.with_names(|names| statements(routine, names))
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
        self.with_names(|names| {
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

    /// A long routine of the running model in parts: its blocks, each a function of its own.
    pub(super) fn in_parts(&self, routine: &Routine, constants: &Ident) -> Parts {
        let Shape { n, g, .. } = &self.shape;
        let groups = routine.assignments.chunks(BLOCK);
        let blocks = Blocks::of(groups.clone(), &routine.results);
        let (array, array_type) = (blocks.array(), blocks.array_type());
        let (mut functions, mut calls) = (TokenStream::new(), TokenStream::new());
        for (index, group) in groups.enumerate() {
            let name = format_ident!("{}_part_{index}", routine.name);
            let bindings = self.dynamic_bindings(&alone(routine, group, &[]));
            let block = self.with_names(|names| blocks.block(group, &assignments(group, names), names));
            functions.extend(quote! {
                #[inline(never)]
                fn #name(&self, t: S, x: &[S; #n], negative: &[S::Switch; #g], v: &mut #array_type) {
                    let c = &self.#constants;
                    #bindings
                    #block
                }
            });
            calls.extend(quote!(self.#name(t, x, negative, v);));
        }
        let bindings = self.dynamic_bindings(&alone(routine, &[], &routine.results));
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
            #array
            #calls
            #bindings
        };
        let results =
            self.with_names(|names| routine.results.iter().map(|result| blocks.result(result, names)).collect());
        Parts { functions, body, results }
    }
}

/// The routine with these assignments and results only.
fn alone(routine: &Routine, assignments: &[Assignment], results: &[Operand]) -> Routine {
    Routine { assignments: assignments.to_vec(), results: results.to_vec(), ..routine.clone() }
}
