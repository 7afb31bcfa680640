//! The tables of constants: what depends on parameters only, calculated once in `new`.
//!
//! In: the constants of each program that runs. Out: fields of the model's struct, and the functions that fill them.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::super::pairs;
use super::Emission;
use crate::program::pairs::Paired;
use crate::program::{Derivatives, Programs, Routine};

/// A table of what depends on parameters only.
struct Table<'a> {
    /// What the names of the table, of its pairs and of their functions begin with.
    prefix: &'static str,
    doc: &'static str,
    constants: &'a Routine,
    /// The routine that reads pairs of the table.
    paired: Option<&'a Paired>,
}

/// What a model has of its tables: fields of its type, their values, the functions that calculate them and the `let`s
/// that call these.
#[derive(Default)]
pub(super) struct Constants {
    pub(super) fields: TokenStream,
    pub(super) values: TokenStream,
    pub(super) functions: TokenStream,
    pub(super) lets: TokenStream,
    /// The tables of a model, in an array after its parameters, and how many these are together.
    pub(super) joined: TokenStream,
    pub(super) tables: usize,
    /// The `let`s that take the same tables of several models, joined, from the numbers of all.
    pub(super) moved: TokenStream,
    pub(super) has_pairs: bool,
}

impl Emission<'_> {
    /// The tables of the running model, and of their pairs; `scalar` is what the model's struct calls it.
    pub(super) fn constants(&self, scalar: &Ident) -> Constants {
        let mut made = Constants { tables: 1, ..Constants::default() };
        for table in self.constant_tables() {
            self.add_table(&mut made, &table, scalar);
        }
        made
    }

    fn constant_tables(&self) -> Vec<Table<'_>> {
        let Programs { running, derivatives, second_order, holding, impacts, sizes, .. } = &self.model.programs;
        let Derivatives { jacobian, damping } = &**derivatives;
        let table = |prefix, doc, constants, paired| Table { prefix, doc, constants, paired };
        let of_rates = " What depends on parameters only.";
        let of_jacobian = " What depends on parameters only, of the Jacobian.";
        let of_forces = " What depends on parameters only, of forces.";
        let of_holding = " What depends on parameters only, of held motions.";
        let mut tables = vec![
            table("constant", of_rates, &running.constants, self.model.programs.pairs().rate.as_ref()),
            table("slope_constant", of_jacobian, &jacobian.constants, None),
        ];
        let of_damping = " What depends on parameters only, of damping.";
        tables.extend(damping.as_ref().map(|program| table("damping_constant", of_damping, &program.constants, None)));
        tables.extend(holding.as_ref().map(|program| table("holding_constant", of_holding, &program.constants, None)));
        let of_impacts = " What depends on parameters only, of impacts.";
        tables.extend(impacts.as_ref().map(|program| table("impact_constant", of_impacts, &program.constants, None)));
        tables.push(table("size_constant", " What depends on parameters only, of sizes.", &sizes.constants, None));
        tables.extend(second_order.as_ref().map(|second| {
            table("second_constant", of_forces, &second.constants, self.model.programs.pairs().forces.as_ref())
        }));
        tables
    }

    fn add_table(&self, made: &mut Constants, table: &Table, scalar: &Ident) {
        let &Table { prefix, doc, constants, paired } = table;
        let (field, function) = (format_ident!("{prefix}s"), format_ident!("{prefix}_table"));
        let (count, body) = (constants.results.len(), self.constant_table(constants));
        let parameters = &self.shape.p;
        made.fields.extend(quote!(#field: [#scalar; #count],));
        let decided = self.decided();
        let (pass, argument) = (decided.pass(), decided.arguments());
        made.lets.extend(quote!(let #field = Self::#function(&values #pass);));
        made.joined.extend(quote!(&self.#field,));
        made.tables += 1;
        made.moved.extend(quote!(let #field = taken(&mut rest);));
        made.functions.extend(quote! {
            #[doc = #doc]
            fn #function(parameters: &[S; #parameters] #argument) -> [S; #count] {
                #body
            }
        });
        if let Some(paired) = paired {
            self.add_pairs(made, table, paired, scalar);
        }
        made.values.extend(quote!(#field,));
    }

    /// The pairs of a table's constants.
    fn add_pairs(&self, made: &mut Constants, table: &Table, paired: &Paired, scalar: &Ident) {
        let Table { prefix, constants, .. } = table;
        let (field, pair_field) = (format_ident!("{prefix}s"), format_ident!("{prefix}_pairs"));
        let (count, pairs) = (constants.results.len(), paired.constants.len());
        let body = self.with_names(|names| pairs::constants(paired, names));
        made.has_pairs = true;
        made.fields.extend(quote!(#pair_field: [#scalar::Pair; #pairs],));
        made.values.extend(quote!(#pair_field: Model::#pair_field(&#field),));
        made.functions.extend(quote! {
            /// Pairs of them.
            fn #pair_field(c: &[S; #count]) -> [S::Pair; #pairs] {
                #body
            }
        });
    }

    /// The body of a function that gives constants, from `parameters` and what the start pose decides.
    pub(super) fn constant_table(&self, routine: &Routine) -> TokenStream {
        if let Some(tabled) = self.tabled_once(routine) {
            let count = routine.results.len();
            return quote! {
                let mut values = [S::from_f64(0.0); #count];
                let to = &mut values;
                #tabled
                values
            };
        }
        let parameters = self.parameter_bindings(&[routine]);
        let (statements, results) = self.body(routine);
        quote! { #parameters #statements [#(#results),*] }
    }
}
