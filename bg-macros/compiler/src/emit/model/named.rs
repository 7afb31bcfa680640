//! What messages call states, switches and what is not finite.
//!
//! In: the model's description, inputs and fallible laws. Out: `Named` for the model.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::items::identifier;
use super::{Emission, Shape};

impl Emission<'_> {
    /// The names, as the description has them.
    pub(super) fn named(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (switch_name, not_finite) = (self.switch_name(), self.not_finite());
        quote! {
            impl<S: Scalar> ::bg_model::capability::Named<S, #n, #g> for Model<S> {
                fn state_name(&self, index: usize) -> &'static str {
                    DESCRIPTION.states.get(index).map_or("state", |state| state.name)
                }
                #switch_name
                #not_finite
            }
        }
    }

    /// What switches are called.
    fn switch_name(&self) -> Option<TokenStream> {
        (!self.model.equations.switches.is_empty()).then(|| {
            quote! {
                fn switch_name(&self, index: usize) -> Option<&'static str> {
                    DESCRIPTION.switches.get(index).map(|switch| switch.name)
                }
            }
        })
    }

    /// Which input or law is the first whose value is not finite; nothing where none can be.
    fn not_finite(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (fallible, inputs) = (&self.tables.fallible, &self.model.equations.inputs);
        if fallible.is_empty() && inputs.is_empty() {
            return None;
        }
        let inputs = inputs.iter().map(|input| {
            let (field, name) = (identifier(&input.name.text), &input.name.text);
            quote!(("input", #name, self.inputs.#field.value(t)))
        });
        let (body, values) = self.by_itself(&self.model.programs.not_finite);
        let laws = fallible.iter().zip(values).map(|((kind, element), value)| quote!((#kind, #element, #value)));
        Some(quote! {
            #[cold]
            fn not_finite(
                &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g],
            ) -> Option<::bg_model::failure::Origin> {
                #body
                ::bg_model::failure::Origin::first(&[#(#inputs,)* #(#laws,)*])
            }
        })
    }
}
