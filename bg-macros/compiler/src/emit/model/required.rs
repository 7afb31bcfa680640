//! What is asked of values: checked in `new` where parameters decide, in `start` where the assembly does.
//!
//! In: the requirements that are left. Out: a table of them, and the call that holds their values against it.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::items::identifier;
use super::Emission;
use crate::tables::Requirement;

impl Emission<'_> {
    /// The check in `new`, where there is anything to check.
    pub(super) fn required(&self) -> Option<TokenStream> {
        let program = self.model.programs.required[0].as_ref()?;
        let function = identifier(&program.routines[0].name);
        let (count, table) = (self.tables.required.len(), self.tables.required.iter().map(requirement));
        Some(quote! {
            static REQUIREMENTS: &[::bg_model::__private::Requirement] = &[#(#table),*];
            let mut required = [0.0; #count];
            Model::<f64>::#function(&parameters.numbers(), &[], &mut required);
            ::bg_model::__private::require(REQUIREMENTS, &required)?;
        })
    }
}

/// What is asked of a value as a literal.
pub(super) fn requirement(of: &Requirement) -> TokenStream {
    let Requirement { subject, wanted, unit, is_strict, parameters } = of;
    let unit = match unit {
        Some(unit) => quote!(::core::option::Option::Some(#unit)),
        None => quote!(::core::option::Option::None),
    };
    quote! {
        ::bg_model::__private::Requirement {
            subject: #subject, wanted: #wanted, unit: #unit, is_strict: #is_strict, parameters: &[#(#parameters),*],
        }
    }
}
