//! What a model remembers: memories, samples of clocks, delays.
//!
//! In: the tables of what projection sets. Out: `Memories` for a model that has any.

use proc_macro2::TokenStream;
use quote::quote;

use super::Emission;
use crate::tables::Delay;

impl Emission<'_> {
    /// Whether projection sets states that follow something.
    pub(super) fn remembers(&self) -> bool {
        let tables = &self.tables;
        !(tables.memories.is_empty() && tables.clocks.is_empty() && tables.delays.is_empty())
    }

    /// The states that keep what they have followed, clocks with their instants, delays.
    pub(super) fn memories(&self) -> Option<TokenStream> {
        let (memories, clocks, delays) = (&self.tables.memories, self.clocks(), self.delays());
        self.remembers().then(|| {
            quote! {
                impl<S: Scalar> ::bg_model::capability::Memories<S> for Model<S> {
                    fn states(&self) -> &'static [usize] {
                        &[#(#memories),*]
                    }
                    #clocks
                    #delays
                }
            }
        })
    }

    /// The switches of clocks and their instants; nothing where there are none.
    fn clocks(&self) -> Option<TokenStream> {
        let clocks = &self.tables.clocks;
        (!clocks.is_empty()).then(|| {
            quote! {
                fn clocks(&self) -> &'static [usize] {
                    &[#(#clocks),*]
                }
                fn instants(&self, instants: &mut [S]) {
                    Self::clocks(&self.values, &[], instants);
                }
            }
        })
    }

    /// The delays of signals; nothing where there are none.
    fn delays(&self) -> Option<TokenStream> {
        let delays = self.tables.delays.iter().map(|Delay { clock, window: [from, until], signals }| {
            let signals = signals.iter().map(|(coefficients, is_given)| {
                quote! { ::bg_model::delay::Signal { coefficients: &[#(#coefficients),*], is_given: #is_given } }
            });
            quote! { ::bg_model::delay::States { clock: #clock, window: [#from, #until], signals: &[#(#signals),*] } }
        });
        (delays.len() > 0).then(|| {
            quote! {
                fn delays(&self) -> &'static [::bg_model::delay::States] {
                    &[#(#delays),*]
                }
            }
        })
    }
}
