//! Algebraic loops that are solved at run time.
//!
//! In: iterations with the program of their equations. Out: functions of the model that find their unknowns. Nothing
//! for models without.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::{Emission, Shape};

impl Emission<'_> {
    /// What iterations find for pictures, as `f64`, and what is handed over of it.
    pub(super) fn shown_found(&self) -> (Option<TokenStream>, TokenStream) {
        if self.model.equations.found() == 0 {
            return (None, quote!(&[]));
        }
        let found = quote! {
            let switches = negative.map(S::Switch::from);
            let found = self.found(S::from_f64(t), &x.map(S::from_f64).data.0[0], &switches);
            let found = found.map(|found| found.to_f64());
        };
        (Some(found), quote!(&found))
    }

    /// `found`, and the equations that it solves, one group of unknowns after the other.
    pub(super) fn iterations(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let equations = &self.model.equations;
        let (count, routine) = (equations.found(), &self.model.programs.running.loops);
        let groups = self.tables.loops.iter().map(|of| {
            let (first, length, equation) = (of.first, of.unknowns, of.equation);
            let places = [first, first + length, equation, equation + of.equations()];
            let [begin, end, from, to] = places.map(Literal::usize_unsuffixed);
            quote! {
                let unknowns = ::bg_model::nalgebra::Const::<#length>;
                let solved = ::bg_model::__private::newton(unknowns, |u| {
                    ::bg_model::__private::lift(u, &mut found[#begin..#end]);
                    ::bg_model::__private::Equations::of(unknowns, &self.loops(t, x, negative, &found)[#from..#to])
                });
                ::bg_model::__private::lift(solved.as_slice(), &mut found[#begin..#end]);
            }
        });
        let groups: TokenStream = groups.collect();
        let (inputs, states) = (self.input_bindings(routine, "t"), self.state_bindings(routine));
        let (statements, results) = self.body(routine);
        let length = results.len();
        (count > 0).then(|| {
            quote! {
                impl<S: Scalar> Model<S> {
                    fn loops(
                        &self, t: S, x: &[S; #n], negative: &[S::Switch; #g], found: &[S; #count],
                    ) -> [S; #length] {
                        let c = &self.constants;
                        #inputs
                        #states
                        #statements
                        [#(#results),*]
                    }
                    /// What the unknowns of algebraic loops are, nearly; not numbers where that is not found.
                    #[inline(never)]
                    fn found(&self, t: S, x: &[S; #n], negative: &[S::Switch; #g]) -> [S; #count] {
                        let mut found = [S::from_f64(0.0); #count];
                        #groups
                        found
                    }
                }
            }
        })
    }
}
