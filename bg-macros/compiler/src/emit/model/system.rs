//! What an integrator asks of every system: rates, guards, projection, kinks of inputs.
//!
//! In: the programs of the running model. Out: `System` for the model.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::items::identifier;
use super::tabled::{Asked, CONSTANTS};
use super::{Emission, Shape};
use crate::program::Programs;

impl Emission<'_> {
    pub(super) fn system(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (rate, guards, accessors) = (self.rate(), self.guards(), self.accessors());
        let (next_break, first_branches, iterations) = (self.next_break(), self.first_branches(), self.iterations());
        quote! {
            #iterations
            impl<S: Scalar> ::bg_model::system::System<S, #n, #g> for Model<S> {
                #rate
                #guards
                fn project(&self, t: S, negative: &[S::Switch; #g], state: &mut SVector<S, #n>) {
                    ::bg_model::capability::Inlined::project(self, t, negative, state);
                }
                #next_break
                #first_branches
                #accessors
            }
        }
    }

    /// The rate: by its table where numbers are interpreted, else inlined if it is short, or in the vectors of the
    /// machine if it is in pairs.
    fn rate(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let Programs { running, .. } = &self.model.programs;
        let straight = if running.is_inlined() {
            quote!(::bg_model::capability::Inlined::paired_rate(self, t, x, negative, dx);)
        } else if self.model.programs.pairs().rate.is_some() {
            quote!(::bg_model::__private::vectorised_rate(self, t, x, negative, dx);)
        } else {
            quote!(::bg_model::capability::Inlined::rate(self, t, x, negative, dx);)
        };
        let body = match self.tabled(&running.rate, &format_ident!("constants")) {
            None => straight,
            Some(tabled) => quote! {
                if const { ::bg_model::__private::is_tabled::<S>() } {
                    let to = dx.as_mut_slice();
                    #tabled
                } else {
                    #straight
                }
            },
        };
        quote! {
            fn rate(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], dx: &mut SVector<S, #n>) {
                #body
            }
        }
    }

    fn guards(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let values = self.values(Asked::often(&self.model.programs.running.guards, CONSTANTS));
        quote! {
            #[inline(always)]
            fn guards(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], guards: &mut SVector<S, #g>) {
                guards.data.0 = [#values];
            }
        }
    }

    /// Where inputs have a step end; nothing where there are none.
    fn next_break(&self) -> Option<TokenStream> {
        let inputs = &self.model.equations.inputs;
        let inputs = inputs.iter().map(|input| identifier(&input.name.text)).collect::<Vec<_>>();
        (!inputs.is_empty()).then(|| {
            quote! {
                fn next_break(&self, t: f64) -> f64 {
                    ::bg_model::input::next_break([#(&self.inputs.#inputs),*], t)
                }
            }
        })
    }

    /// The branches from which the search for those at the start begins; nothing where no switch remembers.
    fn first_branches(&self) -> Option<TokenStream> {
        let g = &self.shape.g;
        let branches = &self.tables.first_branches;
        branches.contains(&true).then(|| {
            quote! {
                fn first_branches(&self) -> [bool; #g] {
                    [#(#branches),*]
                }
            }
        })
    }
}
