//! The model seen by name: made from parameters and inputs in their order, handed on with its numbers.
//!
//! In: the graph's inputs, the names of its scenes. Out: `bg_model::Mechanism` for the model, beside its other code;
//! `bg_model::Scenes`, which names the scenes' types, where these are.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::super::items::{Given, identifier};
use super::Emission;

impl Emission<'_> {
    pub(super) fn mechanism(&self) -> TokenStream {
        let inputs = &self.model.derived.causal.graph.inputs;
        let inputs: Vec<_> = inputs.iter().map(|input| identifier(&input.name.text)).collect();
        let lanes = self.may_run_in_lanes().then(|| quote!(lanes));
        // What is long takes too long to compile in the vectors of two kinds of machines.
        let is_inlined = self.model.programs.running.is_inlined();
        let in_vectors = is_inlined.then(|| quote!(::bg_model::__private::in_vectors! { #lanes }));
        of(&inputs, &quote!(&DESCRIPTION), &in_vectors.unwrap_or_default())
    }
}

/// The implementation for a model with these inputs, this description and functions in the vectors of machines.
pub(in super::super) fn of(inputs: &[Ident], description: &TokenStream, in_vectors: &TokenStream) -> TokenStream {
    let places = (0..inputs.len()).map(Literal::usize_unsuffixed);
    let has_inputs = !inputs.is_empty();
    let made = has_inputs.then(|| quote!(, Inputs { #(#inputs: inputs.get(#places).cloned().unwrap_or_default(),)* }));
    let own = has_inputs.then(|| quote!(, self.inputs.clone()));
    quote! {
        impl ::bg_model::mechanism::Mechanism for Model {
            type Parameters = Parameters;

            fn describe() -> &'static ::bg_model::description::Description {
                #description
            }
            fn make(parameters: Parameters, inputs: &[::bg_model::input::Input])
                -> Result<Self, ::bg_model::parameters::ParameterError>
            {
                Self::new(parameters #made)
            }
            fn parameters(&self) -> &Parameters {
                &self.parameters
            }
            fn inputs(&self) -> ::bg_model::__private::vec::Vec<::bg_model::input::Input> {
                ::bg_model::__private::vec![#(self.inputs.#inputs.clone()),*]
            }
            fn visit<S: Scalar, V: ::bg_model::mechanism::ModelVisitor<S>>(&self, visitor: V) -> V::Output {
                let model = Model::<S>::in_scalar(self.parameters.clone() #own);
                visitor.visit(&model.expect("a model was made with these parameters before"))
            }
            fn visit_lifted<S: Scalar, T: Scalar, V: ::bg_model::mechanism::LiftedVisitor<S, T>>(
                &self, visitor: V,
            ) -> V::Output {
                visitor.visit(
                    self,
                    |values: &[f64]| Model::<f64>::lifted(values.try_into().expect("a value for each parameter") #own),
                    |values: &[S]| Model::<S>::lifted(values.try_into().expect("a value for each parameter") #own),
                    Model::<S>::joined,
                )
            }
            #in_vectors
        }
    }
}

impl Given<'_> {
    /// The types of the graph's other models. Stands where these are: no module inside sees items of a function's body.
    pub(in super::super) fn scenes(&self, is_literal: bool, names: &[&str]) -> TokenStream {
        let name = identifier(&self.name.text);
        let count = Literal::usize_unsuffixed(names.len() + 1);
        let places = (1..=names.len()).map(Literal::usize_unsuffixed);
        let scenes = names.iter().map(|name| identifier(name));
        let models = quote! {
            0 => visitor.visit::<Self>(),
            #(#places => visitor.visit::<#scenes>(),)*
            _ => ::core::panic!("there is no model of this number"),
        };
        quote! {
            #[allow(clippy::all, clippy::pedantic)]
            impl ::bg_model::mechanism::Scenes for #name {
                const MODELS: ::core::primitive::usize = #count;
                const LITERAL: ::core::primitive::bool = #is_literal;
                fn model<__Visitor: ::bg_model::mechanism::MechanismVisitor>(
                    index: ::core::primitive::usize, visitor: __Visitor,
                ) -> __Visitor::Output {
                    match index { #models }
                }
                fn only<const INDEX: ::core::primitive::usize, __Visitor: ::bg_model::mechanism::MechanismVisitor>(
                    visitor: __Visitor,
                ) -> __Visitor::Output {
                    match INDEX { #models }
                }
            }
        }
    }
}
