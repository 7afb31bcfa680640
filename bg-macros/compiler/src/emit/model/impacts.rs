//! What impacts on stops are calculated from.
//!
//! In: the program of impacts, where there are stops with a restitution. Out: `Impacts` for the model.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::shared::closing;
use super::{Emission, Shape};
use crate::expr::Id;
use crate::program::Program;

impl Emission<'_> {
    /// What impacts are calculated from.
    pub(super) fn impacts(&self) -> Option<TokenStream> {
        let Program { routines: [routine], .. } = self.model.programs.impacts.as_ref()?;
        let Shape { n, g, .. } = &self.shape;
        let impacts = &self.model.equations.impacts;
        let stops = impacts.stops.iter().map(|stop| {
            let (name, unit, switch) =
                (&stop.slip.joint, &stop.slip.unit, Literal::u32_unsuffixed(stop.rebound.switch));
            quote!(::bg_model::holding::Stop { name: #name, unit: #unit, switch: #switch })
        });
        let states = |of: &[(usize, Vec<Id>)]| -> Vec<Literal> {
            of.iter().map(|(state, _)| Literal::usize_unsuffixed(*state)).collect()
        };
        let (moved, integrals) = (states(&impacts.moves), states(&impacts.integrals));
        let rigid = Literal::usize_unsuffixed(impacts.rigid.len());
        let closing = closing(&impacts.rigid);
        let kept = self.kept();
        let (body, entries) = self.running(routine, &format_ident!("impact_constants"));
        Some(quote! {
            impl<S: Scalar> ::bg_model::capability::Impacts<S, #n, #g> for Model<S> {
                fn stops(&self) -> ::bg_model::holding::Stops {
                    ::bg_model::holding::Stops {
                        rigid: #rigid, closing: #closing, stops: &[#(#stops),*], moved: &[#(#moved),*], integrals: &[#(#integrals),*],
                    }
                }
                #kept
                #[inline(never)]
                fn impact(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S]) {
                    #body
                    entries.copy_from_slice(&[#(#entries),*]);
                }
            }
        })
    }
}
