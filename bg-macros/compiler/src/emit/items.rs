//! The parameter and input structs.
//!
//! In: parameters and inputs. Out: structs with units and docs, and their access by name.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

use crate::graph::{Input, Parameter};

/// What the generated structs are made from.
pub(super) struct Given<'a> {
    pub(super) name: &'a str,
    pub(super) visibility: &'a syn::Visibility,
    pub(super) parameters: &'a [Parameter],
    pub(super) inputs: &'a [Input],
}

/// An identifier of the user's.
pub(super) fn identifier(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// A literal `f64`; infinities and not-a-number by their names.
pub(super) fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        quote!(f64::NAN)
    } else if value == f64::INFINITY {
        quote!(f64::INFINITY)
    } else if value == f64::NEG_INFINITY {
        quote!(f64::NEG_INFINITY)
    } else {
        let literal = Literal::f64_suffixed(value.abs());
        if value.is_sign_negative() { quote!(-#literal) } else { quote!(#literal) }
    }
}

impl Given<'_> {
    /// The name of the parameter struct.
    pub(super) fn parameters_name(&self) -> Ident {
        format_ident!("{}Parameters", self.name)
    }

    /// The name of the input struct.
    pub(super) fn inputs_name(&self) -> Ident {
        format_ident!("{}Inputs", self.name)
    }

    /// Both structs; the inputs' only where there are inputs.
    pub(super) fn structs(&self) -> TokenStream {
        let parameters = self.parameter_struct();
        if self.inputs.is_empty() {
            return parameters;
        }
        let (visibility, name) = (self.visibility, self.inputs_name());
        let doc = format!("Inputs of [`{}`]: functions of time in s.", self.name);
        let fields = self.inputs.iter().map(|input| {
            let (field, doc) = (identifier(&input.name.text), field_doc(&input.docs, &input.unit, None));
            quote! { #[doc = #doc] pub #field: ::bg_model::input::Input, }
        });
        quote! {
            #parameters
            #[doc = #doc]
            #[derive(Clone, Debug, Default)]
            #visibility struct #name { #(#fields)* }
        }
    }

    fn parameter_struct(&self) -> TokenStream {
        let (visibility, name) = (self.visibility, self.parameters_name());
        let doc = format!("Parameters of [`{}`], SI units.", self.name);
        let names: Vec<Ident> = self.parameters.iter().map(|parameter| identifier(&parameter.name.text)).collect();
        let docs = self
            .parameters
            .iter()
            .map(|parameter| field_doc(&parameter.docs, &parameter.unit, Some(parameter.default)));
        let defaults = self.parameters.iter().map(|parameter| number(parameter.default));
        let table = self.parameters.iter().map(parameter_info);
        let index: Vec<Literal> = (0..names.len()).map(Literal::usize_unsuffixed).collect();
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug, PartialEq, ::bg_model::serde::Serialize, ::bg_model::serde::Deserialize)]
            #[serde(crate = "::bg_model::serde", default, deny_unknown_fields)]
            #visibility struct #name { #(#[doc = #docs] pub #names: f64,)* }

            impl ::core::default::Default for #name {
                fn default() -> Self {
                    Self { #(#names: #defaults,)* }
                }
            }

            impl ::bg_model::parameters::Parameters for #name {
                fn table() -> &'static [::bg_model::description::ParameterInfo] {
                    const TABLE: &[::bg_model::description::ParameterInfo] = &[#(#table,)*];
                    TABLE
                }
                fn value(&self, index: usize) -> f64 {
                    match index { #(#index => self.#names,)* _ => f64::NAN }
                }
                fn set_value(&mut self, index: usize, value: f64) {
                    match index { #(#index => self.#names = value,)* _ => {} }
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

fn parameter_info(parameter: &Parameter) -> TokenStream {
    let (name, unit, doc) = (&parameter.name.text, &parameter.unit, &parameter.docs);
    let default = number(parameter.default);
    let (lower, lower_included) = parameter.lower.unwrap_or((f64::NEG_INFINITY, false));
    let (upper, upper_included) = parameter.upper.unwrap_or((f64::INFINITY, false));
    let (lower, upper) = (number(lower), number(upper));
    quote! {
        ::bg_model::description::ParameterInfo {
            name: #name, unit: #unit, default: #default, doc: #doc,
            range: ::bg_model::description::Range {
                lower: #lower, lower_included: #lower_included, upper: #upper, upper_included: #upper_included,
            },
        }
    }
}
