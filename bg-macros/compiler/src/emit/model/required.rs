//! What is asked of values: checked in `new` where parameters decide, in `start` where the assembly does.
//!
//! In: the requirements that are left. Out: a table of them, and the call that holds their values against it.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::items::identifier;
use super::Emission;
use crate::expr::Symbol;
use crate::system::requirements::Requirement;

impl Emission<'_> {
    /// The check in `new`, where there is anything to check.
    pub(super) fn required(&self) -> Option<TokenStream> {
        let unknowns = self.model.equations.guesses.len();
        self.check(false, &quote!(&parameters.numbers()), &quote!(&[0.0; #unknowns]))
    }

    /// The check in `start`, after the assembly.
    pub(super) fn required_at_start(&self) -> Option<TokenStream> {
        self.check(true, &quote!(&numbers), &quote!(&unknowns))
    }

    fn check(&self, is_of_start: bool, parameters: &TokenStream, unknowns: &TokenStream) -> Option<TokenStream> {
        let program = self.model.programs.required[usize::from(is_of_start)].as_ref()?;
        let function = identifier(&program.routines[0].name);
        let requirements = self.model.equations.requirements.of(is_of_start);
        let table = requirements.map(|requirement| self.requirement(requirement));
        Some(quote! {
            static REQUIREMENTS: &[::bg_model::__private::Requirement] = &[#(#table),*];
            ::bg_model::__private::require(REQUIREMENTS, &Model::<f64>::#function(#parameters, #unknowns))?;
        })
    }

    fn requirement(&self, requirement: &Requirement) -> TokenStream {
        let Requirement { subject, wanted, unit, is_strict, value, .. } = requirement;
        let equations = &self.model.equations;
        let unit = match unit {
            Some(unit) => quote!(::core::option::Option::Some(#unit)),
            None => quote!(::core::option::Option::None),
        };
        let symbols = equations.requirements.pool.symbols(&[*value]);
        let parameters = symbols.into_iter().filter_map(|symbol| match symbol {
            Symbol::Parameter(index) => Some(&equations.parameters[index as usize].name.text),
            _ => None,
        });
        quote! {
            ::bg_model::__private::Requirement {
                subject: #subject, wanted: #wanted, unit: #unit, is_strict: #is_strict, parameters: &[#(#parameters),*],
            }
        }
    }
}
