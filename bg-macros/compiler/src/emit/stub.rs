//! The items that a faulty graph promised, so that rustc adds no follow-up errors to the compiler's own.
//!
//! In: what could be read of the source. Out: types of the same names; they can be built, not run.

use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::quote;

use super::items::{Given, identifier};
use crate::graph::units::Dimension;
use crate::graph::{Input, Parameter};
use crate::source::ast::{Graph, Item, Source};

/// Stubs of all graphs.
#[must_use]
pub fn stub(source: &Source) -> TokenStream {
    source.graphs.iter().map(of_graph).collect()
}

/// The stubs of a graph and of its scenes, each name once.
fn of_graph(graph: &Graph) -> TokenStream {
    let mut names = BTreeSet::from([graph.name.text.as_str()]);
    let scenes = graph.items.iter().filter_map(|item| if let Item::Scene(scene) = item { Some(scene) } else { None });
    let mut tokens = of_model(graph, &graph.name.text, &|_| true);
    for scene in scenes.filter(|scene| names.insert(&scene.name.text)) {
        let keeps =
            |parameter: &str| scene.tune.as_ref().is_none_or(|tuned| tuned.iter().any(|name| name.text == parameter));
        tokens.extend(of_model(graph, &scene.name.text, &keeps));
    }
    tokens
}

/// The stub of one model of a graph, with the parameters that it keeps.
fn of_model(graph: &Graph, model: &str, keeps: &dyn Fn(&str) -> bool) -> TokenStream {
    let mut parameters: Vec<Parameter> = Vec::new();
    let mut inputs: Vec<Input> = Vec::new();
    for item in &graph.items {
        match item {
            Item::Parameter(found)
                if keeps(&found.name.text) && parameters.iter().all(|known| known.name.text != found.name.text) =>
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
            Item::Input(found) if inputs.iter().all(|known| known.name.text != found.name.text) => {
                let (name, docs, unit) = (found.name.clone(), String::new(), String::new());
                inputs.push(Input { name, docs, unit, dimension: Dimension::NONE });
            }
            _ => {}
        }
    }
    let given = Given { name: model, visibility: &graph.visibility, parameters: &parameters, inputs: &inputs };
    let structs = given.structs();
    let (name, visibility) = (identifier(model), &graph.visibility);
    let (parameters, inputs_name) = (given.parameters_name(), given.inputs_name());
    let argument = (!inputs.is_empty()).then(|| quote!(, _: #inputs_name));
    quote! {
        #structs
        #[derive(Clone, Debug)]
        #[allow(missing_docs)]
        #visibility struct #name<S = f64>(::core::marker::PhantomData<S>, #parameters);

        #[allow(missing_docs, unused_variables, clippy::all, clippy::pedantic)]
        const _: () = {
            use ::bg_model::scalar::Scalar;
            use ::bg_model::nalgebra::SVector;
            const WHY: &str = "the graph has faults";

            impl #name {
                pub const STATES: usize = 1;
                pub const SWITCHES: usize = 0;
                pub const OUTPUTS: usize = 1;
                pub fn new(parameters: #parameters #argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    Ok(Self(::core::marker::PhantomData, parameters))
                }
            }
            impl<S: Scalar> #name<S> {
                pub fn in_scalar(parameters: #parameters #argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    Ok(Self(::core::marker::PhantomData, parameters))
                }
                pub fn parameters(&self) -> &#parameters {
                    &self.1
                }
            }
            impl<S: Scalar> ::bg_model::system::System<S, 1, 0> for #name<S> {
                fn rate(&self, t: S, x: &SVector<S, 1>, negative: &[bool; 0], dx: &mut SVector<S, 1>) {
                    ::core::unreachable!("{WHY}")
                }
            }
            impl<S: Scalar> ::bg_model::system::Model<S, 1, 0, 1> for #name<S> {
                fn description(&self) -> &'static ::bg_model::description::Description {
                    ::core::unreachable!("{WHY}")
                }
                fn start(&self) -> Result<SVector<S, 1>, ::bg_model::assembly::AssemblyError> {
                    ::core::unreachable!("{WHY}")
                }
                fn outputs(&self, t: S, x: &SVector<S, 1>, negative: &[bool; 0], y: &mut SVector<S, 1>) {
                    ::core::unreachable!("{WHY}")
                }
                fn stored_energy(&self, t: S, x: &SVector<S, 1>, negative: &[bool; 0]) -> S {
                    ::core::unreachable!("{WHY}")
                }
                fn powers(&self, t: S, x: &SVector<S, 1>, negative: &[bool; 0]) -> ::bg_model::system::Powers<S> {
                    ::core::unreachable!("{WHY}")
                }
            }
        };
    }
}
