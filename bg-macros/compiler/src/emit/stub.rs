//! The items that a faulty graph promised, so that rustc adds no follow-up errors to the compiler's own.
//!
//! In: what could be read of the source. Out: types of the same names; they can be built, not run.

use proc_macro2::TokenStream;
use quote::quote;

use super::items::{Given, declared, identifier};
use super::model::mechanism;
use crate::graph::units::Dimension;
use crate::graph::{Input, Parameter};
use crate::source::ast::{Item, Name, Source};
use crate::source::names::{self, Promised};

/// Stubs of all models, each name once.
#[must_use]
pub fn stub(source: &Source) -> TokenStream {
    names::models(source).0.into_iter().map(of_model).collect()
}

/// Whether two names are two fields.
fn is_other(a: &Name, b: &Name) -> bool {
    names::field(&a.text) != names::field(&b.text)
}

/// The stub of one model, with the parameters that it keeps.
fn of_model(Promised { graph, scene }: Promised<'_>) -> TokenStream {
    let model = scene.map_or(&graph.name, |scene| &scene.name);
    let keeps = |parameter: &str| scene.is_none_or(|scene| scene.tune.keeps(parameter));
    let mut parameters: Vec<Parameter> = Vec::new();
    let mut inputs: Vec<Input> = Vec::new();
    for item in &graph.items {
        match item {
            Item::Parameter(found)
                if keeps(&found.name.text) && parameters.iter().all(|known| is_other(&known.name, &found.name)) =>
            {
                parameters.push(Parameter {
                    name: found.name.clone(),
                    docs: String::new(),
                    unit: String::new(),
                    dimension: Dimension::NONE,
                    default: 0.0,
                    lower: None,
                    upper: None,
                });
            }
            Item::Input(found) if inputs.iter().all(|known| is_other(&known.name, &found.name)) => {
                let (name, docs, unit) = (found.name.clone(), String::new(), String::new());
                inputs.push(Input { name, docs, unit, dimension: Dimension::NONE });
            }
            _ => {}
        }
    }
    let (visibility, stands_for_graph) = (&graph.visibility, false);
    let given = Given { name: model, stands_for_graph, visibility, parameters: &parameters, inputs: &inputs };
    let (name, scalar, fields) = (declared(model), given.scalar(), given.fields());
    let has_inputs = !inputs.is_empty();
    let argument = has_inputs.then(|| quote!(, inputs: Inputs));
    let value = has_inputs.then(|| quote!(inputs,));
    let inputs_mut = given.inputs_mut();
    let definition = quote! {
        #[derive(Clone, Debug)]
        #[allow(missing_docs, dead_code)]
        pub struct #name<#scalar = ::core::primitive::f64> { #fields scalar: ::core::marker::PhantomData<#scalar> }
    };
    let fields: Vec<_> = inputs.iter().map(|input| identifier(&input.name.text)).collect();
    let (mechanism, count) =
        (mechanism::of(&fields, &quote!(::core::unreachable!("{WHY}")), &TokenStream::new()), parameters.len());
    let code = quote! {
        use ::bg_model::scalar::Scalar;
        use ::bg_model::nalgebra::SVector;
        const WHY: &str = "the graph has faults";

        impl Model {
            pub const STATES: usize = 1;
            pub const SWITCHES: usize = 0;
            pub const OUTPUTS: usize = 1;
            pub fn new(parameters: Parameters #argument)
                -> Result<Self, ::bg_model::parameters::ParameterError>
            {
                Ok(Self { parameters, #value scalar: ::core::marker::PhantomData })
            }
        }
        impl<S: Scalar> Model<S> {
            pub fn in_scalar(parameters: Parameters #argument)
                -> Result<Self, ::bg_model::parameters::ParameterError>
            {
                Ok(Self { parameters, #value scalar: ::core::marker::PhantomData })
            }
            pub fn lifted(_: [S; #count] #argument)
                -> Result<Self, ::bg_model::parameters::ParameterError>
            {
                ::core::unreachable!("{WHY}")
            }
            fn joined<T: Scalar>(_: &[&Self], _: fn(&[S]) -> T) -> Model<T> {
                ::core::unreachable!("{WHY}")
            }
            pub fn parameters(&self) -> &Parameters {
                &self.parameters
            }
            #inputs_mut
        }
        impl<S: Scalar> ::bg_model::system::System<S, 1, 0> for Model<S> {
            fn rate(&self, t: S, x: &SVector<S, 1>, negative: &[S::Switch; 0], dx: &mut SVector<S, 1>) {
                ::core::unreachable!("{WHY}")
            }
        }
        impl<S: Scalar> ::bg_model::system::Model<S, 1, 0, 1> for Model<S> {
            fn description(&self) -> &'static ::bg_model::description::Description {
                ::core::unreachable!("{WHY}")
            }
            fn start(&self) -> Result<SVector<S, 1>, ::bg_model::assembly::AssemblyError> {
                ::core::unreachable!("{WHY}")
            }
            fn outputs(&self, t: S, x: &SVector<S, 1>, negative: &[S::Switch; 0], y: &mut SVector<S, 1>) {
                ::core::unreachable!("{WHY}")
            }
            fn stored_energy(&self, t: S, x: &SVector<S, 1>, negative: &[S::Switch; 0]) -> S {
                ::core::unreachable!("{WHY}")
            }
            fn powers(&self, t: S, x: &SVector<S, 1>, negative: &[S::Switch; 0]) -> ::bg_model::system::Powers<S> {
                ::core::unreachable!("{WHY}")
            }
        }
        #mechanism
    };
    let (items, scenes) = (given.items(&definition, &code), given.scenes(true, &[]));
    quote!(#items #scenes)
}
