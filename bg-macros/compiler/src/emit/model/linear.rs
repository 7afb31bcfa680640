//! The Jacobian of the rates and the elimination along its pattern.
//!
//! In: the program of the derivatives, the planned elimination. Out: `Linearised` and `Elimination` for the model.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};

use super::super::elimination;
use super::super::items::identifier;
use super::super::routine::parsed;
use super::capabilities::accessor;
use super::inlined::InlinedAlways;
use super::{Emission, Shape};
use crate::tables::{self, Tables};

/// Rows and columns.
fn listed(places: &[(usize, usize)]) -> TokenStream {
    let places = places.iter().map(|(row, column)| format!("({row}, {column})"));
    parsed(&places.collect::<Vec<_>>().join(", "))
}

impl Emission<'_> {
    pub(super) fn linear(&self) -> TokenStream {
        let (linearised, elimination) = (self.linearised(), self.elimination());
        quote! { #linearised #elimination }
    }

    /// The Jacobian with its sparsity, and what dampers do.
    fn linearised(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let Tables { jacobian, unknowns, .. } = &self.tables;
        let (places, count) = (listed(jacobian), jacobian.len());
        let [routine] = &self.model.programs.derivatives.jacobian.routines;
        let (body, results) = self.running(routine, &format_ident!("slope_constants"));
        let (entries, slopes) = results.split_at(count);
        let sparsity = if *unknowns == 0 {
            quote!(::bg_model::linear::Sparsity::Places(&ENTRIES))
        } else {
            quote!(::bg_model::linear::Sparsity::Bordered { places: &ENTRIES, unknowns: #unknowns })
        };
        let elimination = accessor("elimination", &quote!(Elimination<S, #n>), &quote!(Some(self)));
        let damping = self.damping();
        quote! {
            impl<S: Scalar> ::bg_model::capability::Linearised<S, #n, #g> for Model<S> {
                fn sparsity(&self) -> ::bg_model::linear::Sparsity {
                    static ENTRIES: [(u16, u16); #count] = [#places];
                    #sparsity
                }
                #[inline(never)]
                fn jacobian(
                    &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S],
                    slope: &mut SVector<S, #n>,
                ) {
                    let entries: &mut [S; #count] = entries.try_into().expect("one entry for each place");
                    #body
                    *entries = [#(#entries),*];
                    slope.data.0 = [[#(#slopes),*]];
                }
                #damping
                #elimination
            }
        }
    }

    /// The derivatives among states that are not of second order, where they have a routine of their own.
    fn damping(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let [routine] = &self.model.programs.derivatives.damping.as_ref()?.routines;
        let (body, results) = self.running(routine, &format_ident!("damping_constants"));
        let places = listed(&tables::damping(self.model));
        let count = results.len();
        Some(quote! {
            fn damping_sparsity(&self) -> ::bg_model::linear::Sparsity {
                static ENTRIES: [(u16, u16); #count] = [#places];
                ::bg_model::linear::Sparsity::Places(&ENTRIES)
            }
            #[inline(never)]
            fn damping(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S]) {
                let entries: &mut [S; #count] = entries.try_into().expect("one entry for each place");
                #body
                *entries = [#(#results),*];
            }
        })
    }

    /// Unrolled, for the vectors that a step may take; by tables where that is too long, and for machines without AVX2
    /// where nearly all have it: this takes much less to compile.
    fn elimination(&self) -> TokenStream {
        let n = &self.shape.n;
        let plan = &self.model.elimination;
        let (count, slots) = (self.model.jacobian.entries.len(), plan.slots);
        let states = self.model.equations.states.len();
        // The names of both functions, their attribute and their bodies.
        let functions = |names: [&str; 2], inline: TokenStream, bodies: [TokenStream; 2]| {
            let ([eliminate, substitute], [factorisation, substitution]) = (names.map(identifier), bodies);
            quote! {
                #inline
                fn #eliminate<F: ::bg_model::linear::Field<S>>(&self, c: F, entries: &[S], factors: &mut [F]) -> bool {
                    let entries: &[S; #count] = entries.try_into().expect("one entry for each place");
                    let factors: &mut [F; #slots] = factors.try_into().expect("as many factors as are eliminated");
                    #factorisation
                }
                #inline
                fn #substitute<F: ::bg_model::linear::Field<S>>(&self, factors: &[F], b: &mut [F; #n]) {
                    let factors: &[F; #slots] = factors.try_into().expect("as many factors as are eliminated");
                    #substitution
                }
            }
        };
        let names = ["eliminate", "substitute"];
        let tables = [elimination::factorisation_table(plan), elimination::substitution_table(plan, states)];
        let called = quote!(#[inline(never)]);
        let functions = if elimination::is_unrolled(plan) {
            let unrolled = [elimination::factorisation(plan), elimination::substitution(plan, states)];
            let unrolled = functions(names, InlinedAlways.to_token_stream(), unrolled);
            let compact = functions(["eliminate_compactly", "substitute_compactly"], called, tables);
            quote!(#unrolled #compact)
        } else {
            functions(names, called, tables)
        };
        quote! {
            impl<S: Scalar> ::bg_model::capability::Elimination<S, #n> for Model<S> {
                fn factors(&self) -> usize {
                    #slots
                }
                #functions
            }
        }
    }
}
