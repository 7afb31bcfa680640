//! The items of a model: its structs and the modules that they are in.
//!
//! In: parameters, inputs, the tokens of the model's own struct. Out: structs with units and docs, and their access by
//! name.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use super::routine::parsed;
use crate::graph::{Input, Parameter};
use crate::source::ast::Name;
use crate::source::names::{self, INPUTS, PARAMETERS};
use crate::source::visibility::Visibility;
use crate::tables;

/// What the generated structs are made from.
pub(super) struct Given<'a> {
    pub(super) name: &'a Name,
    /// Whether an editor finds the fields at the declarations of what they are.
    pub(super) stands_for_graph: bool,
    pub(super) visibility: &'a Visibility,
    pub(super) parameters: &'a [Parameter],
    pub(super) inputs: &'a [Input],
}

/// An identifier of the user's, a path as one word; raw where an edition has made it a keyword that others have not.
pub(super) fn identifier(name: &str) -> Ident {
    let name = &names::field(name);
    let make = if name == "gen" { Ident::new_raw } else { Ident::new };
    make(name, Span::call_site())
}

/// An identifier of the user's at its place in the source, where editors find it and lints complain about it.
pub(super) fn placed(name: &str, place: Span) -> Ident {
    let mut ident = identifier(name);
    ident.set_span(place);
    ident
}

/// A name at its place.
pub(super) fn declared(name: &Name) -> Ident {
    placed(&name.text, name.places()[0])
}

/// A literal `f64`; infinities and not-a-number by their names.
pub(super) fn number(value: f64) -> TokenStream {
    if !value.is_finite() {
        return parsed(&number_text(value));
    }
    let literal = Literal::f64_suffixed(value.abs());
    if value.is_sign_negative() { quote!(-#literal) } else { quote!(#literal) }
}

/// The text of the same.
pub(super) fn number_text(value: f64) -> String {
    if value.is_nan() {
        "f64::NAN".to_owned()
    } else if value.is_infinite() {
        (if value > 0.0 { "f64::INFINITY" } else { "f64::NEG_INFINITY" }).to_owned()
    } else {
        format!("{value}f64")
    }
}

impl Given<'_> {
    /// The items of a model: its structs, `definition` among them, and what is implemented for them, `code`, in modules
    /// of their own.
    ///
    /// Neither module sees names of the user's but those of the structs, and `code` knows these as `Model`,
    /// `Parameters` and `Inputs` only. So what is called `Option`, `f64` or `S` by the user, as a model or beside one,
    /// is no other thing for the generated code; and without a prelude of the user's there is still its own.
    pub(super) fn items(&self, definition: &TokenStream, code: &TokenStream) -> TokenStream {
        // Not at the declaration, which is the struct's.
        let (visibility, name) = (self.visibility, identifier(&self.name.text));
        let (outside, inside) = (self.word("__bond_graph_", ""), self.word("", "_code"));
        let (parameters, parameter_struct) = (self.parameters_name(), self.parameter_struct());
        let (inputs, input_struct) = (self.inputs_name(), self.input_struct());
        let (input, input_alias) = match &input_struct {
            Some(_) => (Some(quote!(#inputs,)), Some(quote!(#inputs as Inputs,))),
            None => (None, None),
        };
        let parameter_code = self.parameter_code();
        quote! {
            #[allow(unused_imports)]
            #visibility use #outside::{#name, #input #parameters};

            #[allow(dead_code, non_snake_case, non_camel_case_types, unreachable_pub)]
            mod #outside {
                use ::core::prelude::rust_2024::*;

                #parameter_struct
                #input_struct
                #definition

                #[allow(missing_docs, unused_imports, unused_variables, clippy::all, clippy::pedantic)]
                mod #inside {
                    use ::core::prelude::rust_2024::*;
                    use super::{#name as Model, #input_alias #parameters as Parameters};

                    #parameter_code
                    #code
                }
            }
        }
    }

    /// The model's name with words around it.
    fn word(&self, before: &str, after: &str) -> Ident {
        format_ident!("{before}{}{after}", self.name.text)
    }

    /// The field of a parameter or input.
    fn field(&self, name: &Name) -> Ident {
        let is_word = names::field(&name.text) == name.text && name.places().len() == 1;
        if self.stands_for_graph && is_word { declared(name) } else { identifier(&name.text) }
    }

    /// The name of the parameter struct.
    fn parameters_name(&self) -> Ident {
        self.word("", PARAMETERS)
    }

    /// The name of the input struct.
    fn inputs_name(&self) -> Ident {
        self.word("", INPUTS)
    }

    /// What the model is generic over in the definition of its struct.
    pub(super) fn scalar(&self) -> Ident {
        format_ident!("{}", if self.name.text == "S" { "T" } else { "S" })
    }

    /// The fields of the structs' values that the model's struct has.
    pub(super) fn fields(&self) -> TokenStream {
        let (parameters, inputs) = (self.parameters_name(), self.inputs_name());
        let inputs = (!self.inputs.is_empty()).then(|| quote!(inputs: #inputs,));
        quote!(parameters: #parameters, #inputs)
    }

    /// The input struct, where there are inputs.
    fn input_struct(&self) -> Option<TokenStream> {
        let name = self.inputs_name();
        let doc = format!("Inputs of [`{}`]: functions of time in s.", self.name.text);
        let fields = self.inputs.iter().map(|input| {
            let (field, doc) = (self.field(&input.name), field_doc(&input.docs, &input.unit, None));
            quote! { #[doc = #doc] pub #field: ::bg_model::input::Input, }
        });
        (!self.inputs.is_empty()).then(|| {
            quote! {
                #[doc = #doc]
                #[derive(Clone, Debug, Default)]
                pub struct #name { #(#fields)* }
            }
        })
    }

    /// The function of the model that hands out the inputs, where there are any.
    pub(super) fn inputs_mut(&self) -> Option<TokenStream> {
        (!self.inputs.is_empty()).then(|| {
            quote! {
                /// The inputs, to be given anew between steps.
                pub fn inputs_mut(&mut self) -> &mut Inputs {
                    &mut self.inputs
                }
            }
        })
    }

    fn parameter_names(&self) -> impl Iterator<Item = Ident> {
        self.parameters.iter().map(|parameter| identifier(&parameter.name.text))
    }

    fn parameter_struct(&self) -> TokenStream {
        let name = self.parameters_name();
        let doc = format!("Parameters of [`{}`], SI units.", self.name.text);
        let docs = self
            .parameters
            .iter()
            .map(|parameter| field_doc(&parameter.docs, &parameter.unit, Some(parameter.default)));
        let names = self.parameters.iter().map(|parameter| self.field(&parameter.name));
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug, PartialEq)]
            pub struct #name { #(#[doc = #docs] pub #names: ::core::primitive::f64,)* }
        }
    }

    /// What the parameter struct implements.
    fn parameter_code(&self) -> TokenStream {
        let name = self.parameters_name().to_string();
        let names: Vec<Ident> = self.parameter_names().collect();
        let texts = self.parameters.iter().map(|parameter| &parameter.name.text);
        let defaults = self.parameters.iter().map(|parameter| number(parameter.default));
        let table = self.parameters.iter().map(|parameter| parameter_info(&tables::parameter(parameter)));
        let index: Vec<Literal> = (0..names.len()).map(Literal::usize_unsuffixed).collect();
        let count = Literal::usize_unsuffixed(names.len());
        quote! {
            const PARAMETERS: &[::bg_model::description::ParameterInfo] = &[#(#table,)*];

            impl Default for Parameters {
                fn default() -> Self {
                    Self { #(#names: #defaults,)* }
                }
            }

            impl Parameters {
                /// Their values in the order of the table.
                fn numbers(&self) -> [f64; #count] {
                    [#(self.#names),*]
                }
                fn of_numbers(numbers: [f64; #count]) -> Self {
                    Self { #(#names: numbers[#index]),* }
                }
            }

            impl ::bg_model::parameters::Parameters for Parameters {
                fn table() -> &'static [::bg_model::description::ParameterInfo] {
                    PARAMETERS
                }
                fn value(&self, index: usize) -> f64 {
                    match index { #(#index => self.#names,)* _ => f64::NAN }
                }
                fn set_value(&mut self, index: usize, value: f64) {
                    match index { #(#index => self.#names = value,)* _ => {} }
                }
            }

            impl ::bg_model::serde::Serialize for Parameters {
                fn serialize<T: ::bg_model::serde::Serializer>(&self, serializer: T) -> Result<T::Ok, T::Error> {
                    ::bg_model::__private::serialize(self, #name, serializer)
                }
            }

            impl<'de> ::bg_model::serde::Deserialize<'de> for Parameters {
                fn deserialize<D: ::bg_model::serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    ::bg_model::__private::deserialize(#name, &[#(#texts),*], deserializer)
                }
            }
        }
    }
}

fn field_doc(docs: &str, unit: &str, default: Option<f64>) -> String {
    let default = default.map(|value| format!(" Default {value}.")).unwrap_or_default();
    let gap = if docs.is_empty() { "" } else { " " };
    format!("{docs}{gap}Unit: {unit}.{default}")
}

fn parameter_info(of: &tables::Parameter) -> TokenStream {
    let tables::Parameter { name, unit, default, doc, range } = of;
    let tables::Bounds { lower: (lower, lower_included), upper: (upper, upper_included) } = *range;
    let [default, lower, upper] = [*default, lower, upper].map(number);
    quote! {
        ::bg_model::description::ParameterInfo {
            name: #name, unit: #unit, default: #default, doc: #doc,
            range: ::bg_model::description::Range {
                lower: #lower, lower_included: #lower_included, upper: #upper, upper_included: #upper_included,
            },
        }
    }
}
