//! Loops in closed form that may come to a pose where links turn either way.
//!
//! In: the program of their pivots. Out: `Turning` for a model that has such loops.

use proc_macro2::TokenStream;
use quote::quote;

use super::{Emission, Shape};

impl Emission<'_> {
    /// The joints that close these loops, and their pivots.
    pub(super) fn turning(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (body, values) = self.by_itself(self.model.programs.pivots.as_ref()?);
        let joints = &self.tables.turning;
        Some(quote! {
            impl<S: Scalar> ::bg_model::capability::Turning<S, #n, #g> for Model<S> {
                fn joints(&self) -> &'static [&'static str] {
                    &[#(#joints),*]
                }
                fn pivots(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], pivots: &mut [S]) {
                    #body
                    pivots.copy_from_slice(&[#(#values),*]);
                }
            }
        })
    }
}
