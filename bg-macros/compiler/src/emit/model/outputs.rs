//! What a run asks of a model: its description, its start, outputs, energies and powers.
//!
//! In: the programs of the running model and of the start. Out: `bg_model::Model` for the model.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::items::identifier;
use super::capabilities::accessor;
use super::tabled::{Asked, CONSTANTS};
use super::{Emission, Shape, names};

impl Emission<'_> {
    pub(super) fn model(&self) -> TokenStream {
        let Shape { n, g, m, .. } = &self.shape;
        let (start, started) = self.start();
        let (outputs, stored_energy, powers) = (self.outputs(), self.stored_energy(), self.powers());
        let (shown, redundant, decided) = (self.shown(), self.redundant(), self.decided().handed_over());
        let reversed = self.model.programs.reversed();
        let reversed = reversed.map(|_| accessor("reversed", &quote!(Reversed<S, #n, #g, #m>), &quote!(Some(self))));
        quote! {
            #started
            impl<S: Scalar> ::bg_model::system::Model<S, #n, #g, #m> for Model<S> {
                fn description(&self) -> &'static ::bg_model::description::Description {
                    &DESCRIPTION
                }
                #start
                #redundant
                #decided
                #outputs
                #stored_energy
                #powers
                #shown
                #reversed
            }
        }
    }

    fn outputs(&self) -> TokenStream {
        let Shape { n, g, m, .. } = &self.shape;
        let values = self.values(Asked::often(&self.model.programs.running.outputs, CONSTANTS));
        let reactions = names::reads_reactions(&self.model.programs.running.outputs).then(|| self.with_reactions());
        quote! {
            fn outputs(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], y: &mut SVector<S, #m>) {
                #reactions
                y.data.0 = [#values];
            }
        }
    }

    /// What pictures show, from the tape.
    fn shown(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (reactions, values) = self.shown_reactions();
        let (iterated, found) = self.shown_found();
        let sides = if self.model.equations.assembly.sides.is_empty() { quote!(&[]) } else { quote!(&self.sides) };
        let inputs: Vec<_> = self.model.equations.inputs.iter().map(|input| identifier(&input.name.text)).collect();
        quote! {
            fn shown(
                &self, t: f64, x: &SVector<f64, #n>, negative: &[bool; #g],
                values: &mut ::bg_model::__private::vec::Vec<f64>,
            ) {
                #reactions
                #iterated
                let parameters: ::bg_model::__private::vec::Vec<f64> = (0..DESCRIPTION.parameters.len())
                    .map(|index| ::bg_model::parameters::Parameters::value(&self.parameters, index))
                    .collect();
                DESCRIPTION.drawing.tape.evaluate(
                    &::bg_model::drawing::Moment {
                        t,
                        states: x.as_slice(),
                        parameters: &parameters,
                        inputs: &[#([self.inputs.#inputs.value(t), self.inputs.#inputs.slope(t)]),*],
                        negative,
                        reactions: #values,
                        found: #found,
                        sides: #sides,
                    },
                    values,
                );
            }
        }
    }

    fn stored_energy(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let values = self.values(Asked::often(&self.model.programs.running.stored_energy, CONSTANTS));
        quote! {
            fn stored_energy(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g]) -> S {
                let [stored] = #values;
                stored
            }
        }
    }

    fn powers(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let values = self.values(Asked::often(&self.model.programs.running.powers, CONSTANTS));
        quote! {
            fn powers(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g]) -> ::bg_model::system::Powers<S> {
                let [supplied, dissipated] = #values;
                ::bg_model::system::Powers { supplied, dissipated }
            }
        }
    }
}
