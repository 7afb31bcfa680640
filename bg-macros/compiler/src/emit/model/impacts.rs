//! What impacts on stops are calculated from.
//!
//! In: the program of impacts, where there are stops with a restitution. Out: `Impacts` for the model.

use proc_macro2::TokenStream;
use quote::quote;

use super::tabled::{Asked, IMPACTS};
use super::{Emission, Shape, shared};
use crate::program::Program;
use crate::tables::{Stop, Stops};

impl Emission<'_> {
    /// What impacts are calculated from.
    pub(super) fn impacts(&self) -> Option<TokenStream> {
        let Program { routines: [routine], .. } = self.model.programs.impacts.as_ref()?;
        let Shape { n, g, .. } = &self.shape;
        let Stops { rigid, closing, stops, moved, integrals } =
            self.tables.stops.as_ref().expect("tables of what the program gives");
        let stops = stops.iter().map(|Stop { name, unit, switch }| {
            quote!(::bg_model::holding::Stop { name: #name, unit: #unit, switch: #switch })
        });
        let closing = shared::closing(closing);
        let kept = self.kept();
        let values = self.values(Asked::rarely(routine, IMPACTS));
        Some(quote! {
            impl<S: Scalar> ::bg_model::capability::Impacts<S, #n, #g> for Model<S> {
                fn stops(&self) -> ::bg_model::holding::Stops {
                    ::bg_model::holding::Stops {
                        rigid: #rigid, closing: #closing, stops: &[#(#stops),*], moved: &[#(#moved),*],
                        integrals: &[#(#integrals),*],
                    }
                }
                #kept
                #[inline(never)]
                fn impact(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S]) {
                    entries.copy_from_slice(&#values);
                }
            }
        })
    }
}
