//! The model type and its constructors.
//!
//! In: a [`Compiled`]. Out: a type that implements `bg_model::System`, its capabilities and `bg_model::Model`, generic
//! over the scalar; flat single assignments over fixed-size vectors. Each trait has a file of its own in this folder.

mod capabilities;
mod constants;
mod impacts;
mod inlined;
mod iterations;
mod linear;
pub(super) mod mechanism;
mod memories;
mod named;
mod names;
mod outputs;
mod parts;
mod required;
mod reversed;
mod routines;
mod shared;
mod start;
mod system;
mod tabled;
mod turning;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::items::{Given, declared};
use super::{description, documentation, picture};
use crate::pipeline::Compiled;
use crate::tables::{self, Counted, Tables};
use constants::Constants;

/// The items of one model: parameters, inputs, the type, its functions, its description.
#[must_use]
pub fn model(model: &Compiled) -> TokenStream {
    let states = names::of_states(&model.equations);
    Emission { model, states, shape: Shape::of(model), tables: tables::tables(model, Counted::All) }.items()
}

struct Emission<'a> {
    model: &'a Compiled,
    /// The identifier of each state.
    states: Vec<Ident>,
    shape: Shape,
    tables: Tables,
}

/// The numbers of states, switches, outputs and parameters, as they stand in types: a name there shows in documentation
/// as the whole text of the macro's call.
struct Shape {
    n: Literal,
    g: Literal,
    m: Literal,
    /// The number of parameters.
    p: Literal,
}

impl Shape {
    fn of(model: &Compiled) -> Self {
        let equations = &model.equations;
        let counts =
            [equations.states.len(), equations.switches.len(), equations.outputs.len(), equations.parameters.len()];
        let [n, g, m, p] = counts.map(Literal::usize_unsuffixed);
        Self { n, g, m, p }
    }
}

impl Emission<'_> {
    fn items(&self) -> TokenStream {
        let graph = &self.model.derived.causal.graph;
        let given = Given {
            name: &graph.name,
            stands_for_graph: self.model.stands_for_graph,
            visibility: &graph.visibility,
            parameters: &self.model.equations.parameters,
            inputs: &graph.inputs,
        };
        let constants = self.constants(&given.scalar());
        let definition = self.definition(&given, &constants);
        let items = given.items(&definition, &self.code(&given, &constants));
        let scenes =
            given.scenes(!self.model.is_scene, &self.model.scenes.iter().map(String::as_str).collect::<Vec<_>>());
        quote!(#items #scenes)
    }

    /// The model's struct.
    fn definition(&self, given: &Given, constants: &Constants) -> TokenStream {
        let (name, scalar, fields) = (declared(given.name), given.scalar(), given.fields());
        let doc = &self.model.derived.causal.graph.docs;
        let picture = picture::text(self.model);
        let tables = documentation::tables(self.model, &self.model.costs());
        let (table_fields, decided, p) = (&constants.fields, self.decided().fields(), &self.shape.p);
        // The empty lines end a paragraph and HTML; rustdoc drops those inside a text at its ends.
        quote! {
            #[doc = #doc]
            #[doc = ""]
            #[cfg_attr(doc, doc = ::bg_model::__private::picture!(#picture))]
            #[doc = ""]
            #[doc = #tables]
            #[derive(Clone, Debug)]
            pub struct #name<#scalar: ::bg_model::scalar::Scalar = ::core::primitive::f64> {
                #fields
                values: [#scalar; #p],
                #decided
                #table_fields
            }
        }
    }

    /// What the model's struct implements.
    fn code(&self, given: &Given, constants: &Constants) -> TokenStream {
        let description = description::description(&self.tables.description);
        let constructors = self.constructors(given, constants);
        let (system, capabilities, model, reversed) =
            (self.system(), self.capabilities(), self.model(), self.reversed());
        let (mechanism, parts, straight) = (self.mechanism(), self.parts(), self.straight());
        let import_pair = constants.has_pairs.then(|| {
            quote!(
                use ::bg_model::scalar::Pair as _;
            )
        });
        quote! {
            use ::bg_model::scalar::Scalar;
            #import_pair
            use ::bg_model::nalgebra::SVector;

            static DESCRIPTION: ::bg_model::description::Description = #description;

            #constructors
            #parts
            #straight
            #system
            #capabilities
            #model
            #reversed
            #mechanism
        }
    }

    /// The model's own functions, and those that its traits call.
    fn constructors(&self, given: &Given, constants: &Constants) -> TokenStream {
        let inputs_mut = given.inputs_mut();
        let has_inputs = !self.model.derived.causal.graph.inputs.is_empty();
        let input_argument = has_inputs.then(|| quote!(, inputs: Inputs));
        let input_value = has_inputs.then(|| quote!(inputs,));
        let input_pass = has_inputs.then(|| quote!(, inputs));
        let (starting, required) = (self.starting(), self.required());
        let decided = self.decided();
        let (decided_arguments, decided_values) = (decided.owned(), decided.values());
        let construction = self.construction(has_inputs);
        let reactions = self.reactions();
        let input_copied = has_inputs.then(|| quote!(inputs: first.inputs.clone(),));
        let decided_copied = decided.copied();
        let Constants { values, functions, lets, moved, joined, tables, .. } = constants;
        let Shape { n, g, m, p } = &self.shape;
        quote! {
            impl Model {
                /// Number of states.
                pub const STATES: usize = #n;
                /// Number of switches.
                pub const SWITCHES: usize = #g;
                /// Number of scalar outputs.
                pub const OUTPUTS: usize = #m;

                /// The model with these parameters, in `f64`.
                ///
                /// # Errors
                /// A parameter outside its range, a value that parameters give and that cannot be.
                pub fn new(parameters: Parameters #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    Self::in_scalar(parameters #input_pass)
                }
            }

            impl<S: Scalar> Model<S> {
                /// The model with these parameters, calculating in `S`.
                ///
                /// # Errors
                /// A parameter outside its range, a value that parameters give and that cannot be.
                pub fn in_scalar(parameters: Parameters #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    let values = parameters.numbers().map(S::from_f64);
                    Self::constructed(parameters, values #input_pass)
                }

                /// The model with parameters of `S` in the order of their table, such as dual numbers.
                ///
                /// # Errors
                /// As [`Self::in_scalar`].
                pub fn lifted(values: [S; #p] #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    let parameters = Parameters::of_numbers(values.map(S::to_f64));
                    Self::constructed(parameters, values #input_pass)
                }

                fn constructed(parameters: Parameters, values: [S; #p] #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    ::bg_model::parameters::Parameters::validate(&parameters)?;
                    #required
                    #construction
                }

                fn made(parameters: Parameters, values: [S; #p] #input_argument #decided_arguments) -> Self {
                    #lets
                    Self { parameters, values, #input_value #decided_values #values }
                }

                /// The model each of whose numbers `of` makes of those of several.
                fn joined<T: Scalar>(models: &[&Self], of: fn(&[S]) -> T) -> Model<T> {
                    use ::bg_model::__private::{joined, taken};
                    let first = models[0];
                    let numbers = joined(models.len(), #tables, &|model, table| models[model].tables()[table], of);
                    let mut rest = &numbers[..];
                    let values = taken(&mut rest);
                    #moved
                    Model {
                        parameters: first.parameters.clone(),
                        values,
                        #input_copied
                        #decided_copied
                        #values
                    }
                }

                /// All tables of numbers.
                fn tables(&self) -> [&[S]; #tables] {
                    [&self.values, #joined]
                }

                /// The parameters.
                pub fn parameters(&self) -> &Parameters {
                    &self.parameters
                }

                #inputs_mut

                #functions

                #starting

                #reactions
            }
        }
    }
}
