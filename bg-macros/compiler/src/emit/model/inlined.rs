//! Rates and projections as they are inlined where they are compiled for the vectors of a machine.
//!
//! In: the programs of the running model. Out: `Inlined` for the model.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::super::items::identifier;
use super::tabled::{Asked, CONSTANTS};
use super::{Emission, Shape};
use crate::program::Routine;

/// The attribute of functions that are inlined where they are called, in release builds.
#[derive(Clone, Copy)]
pub(super) struct InlinedAlways;

impl ToTokens for InlinedAlways {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(quote!(#[cfg_attr(not(debug_assertions), inline(always))]));
    }
}

impl Emission<'_> {
    /// The rate without pairs, and in pairs where that pays; the projection.
    pub(super) fn inlined(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (running, tables) = (&self.model.programs.running, &self.tables);
        let is_short = running.is_inlined();
        let rate = self.inlined_rate("rate", self.function(&running.rate));
        let pairs = self.model.programs.pairs();
        let paired_rate = pairs
            .rate
            .as_ref()
            .map(|paired| self.inlined_rate("paired_rate", self.with_pairs(&running.rate, Some(paired), "constant")));
        let pose = self.projection(&running.project, &tables.projected);
        let momenta = self.projection(&running.settle, &tables.settled);
        let (inline, runs_in_lanes) = (InlinedAlways, self.runs_in_lanes());
        quote! {
            impl<S: Scalar> ::bg_model::capability::Inlined<S, #n, #g> for Model<S> {
                const IS_SHORT: bool = #is_short;
                #rate
                #paired_rate
                #inline
                fn project(&self, t: S, negative: &[S::Switch; #g], state: &mut SVector<S, #n>) {
                    #pose
                    #momenta
                }
                #runs_in_lanes
            }
        }
    }

    /// A function of this name that gives the rates. The unknowns of iterations come after them.
    fn inlined_rate(&self, name: &str, (body, rates): (TokenStream, Vec<TokenStream>)) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let rates = &rates[..self.model.equations.states.len()];
        let (inline, name) = (InlinedAlways, format_ident!("{name}"));
        quote! {
            #inline
            fn #name(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], dx: &mut SVector<S, #n>) {
                #body
                dx.data.0 = [[#(#rates),*]];
            }
        }
    }

    /// The attribute of rates, and of forces, that are inlined where they are compiled for the machine's vectors.
    pub(super) fn inline(&self) -> Option<InlinedAlways> {
        self.model.programs.running.is_inlined().then_some(InlinedAlways)
    }

    /// Gives the states of `moved` what the routine makes of them.
    pub(super) fn projection(&self, routine: &Routine, moved: &[usize]) -> Option<TokenStream> {
        let values = self.values(Asked::often(routine, CONSTANTS));
        let places = (0..moved.len()).map(Literal::usize_unsuffixed);
        let indices = moved.iter().copied().map(Literal::usize_unsuffixed);
        (!moved.is_empty()).then(|| {
            quote! {
                {
                    let x = &*state;
                    let values = #values;
                    let [projected] = &mut state.data.0;
                    #(projected[#indices] = values[#places];)*
                }
            }
        })
    }

    /// Whether several runs side by side are those that each is by itself, and gain by it; nothing where they always
    /// are.
    fn runs_in_lanes(&self) -> Option<TokenStream> {
        let inputs = self.model.equations.inputs.iter().map(|input| identifier(&input.name.text)).collect::<Vec<_>>();
        let constant = quote!(#(self.inputs.#inputs.is_constant())&&*);
        let answer = if self.may_run_in_lanes() { constant } else { quote!(false) };
        (!answer.is_empty()).then(|| {
            quote! {
                fn runs_in_lanes(&self) -> bool {
                    #answer
                }
            }
        })
    }

    /// Whether there are inputs with which it runs in lanes.
    pub(super) fn may_run_in_lanes(&self) -> bool {
        self.model.equations.found() == 0 && self.inline().is_some() && self.tables.turning.is_empty()
    }
}
