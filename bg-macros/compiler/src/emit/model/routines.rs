//! How a routine becomes the body of a function.
//!
//! In: a routine and the table of constants that it reads. Out: its statements, and the tokens of its results.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::super::pairs;
use super::super::routine::statements;
use super::Emission;
use crate::program::pairs::Paired;
use crate::program::{Program, Routine};

impl Emission<'_> {
    /// The bare statements of a routine, and its results.
    pub(super) fn body(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.with_names(|names| statements(routine, names))
    }

    /// `let c`: the constants of a program that is evaluated by itself, from `parameters`.
    pub(super) fn own_constants(&self, program: &Program<1>) -> TokenStream {
        let (entries, constants) = (program.constants.results.len(), self.constant_table(&program.constants));
        quote!(let c: [S; #entries] = { #constants };)
    }

    /// The statements of a function that evaluates a program by itself at a state, with constants of its own, and its
    /// results.
    pub(super) fn by_itself(&self, program: &Program<1>) -> (TokenStream, Vec<TokenStream>) {
        let [routine] = &program.routines;
        let (decided, constants) = (self.decided().read(), self.own_constants(program));
        let (parameters, bindings) = (self.parameter_bindings(&[routine]), self.dynamic_bindings(routine));
        let (statements, results) = self.body(routine);
        let body = quote! {
            let parameters = &self.values;
            #decided
            #constants
            #parameters
            let [x] = &x.data.0;
            #bindings
            #statements
        };
        (body, results)
    }

    /// The statements of a function of the running model, and its results.
    pub(super) fn function(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.running(routine, &format_ident!("constants"))
    }

    /// The statements of a routine that reads states and this table of constants, and its results; of a long one the
    /// calls of its [parts](Self::parts).
    pub(super) fn running(&self, routine: &Routine, constants: &Ident) -> (TokenStream, Vec<TokenStream>) {
        let (statements, results) = if routine.is_long() {
            self.in_parts(routine)
        } else {
            let bindings = self.dynamic_bindings(routine);
            let (statements, results) = self.body(routine);
            (quote!(#bindings #statements), results)
        };
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
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
            (body, pairs::results(paired, names))
        })
    }
}
