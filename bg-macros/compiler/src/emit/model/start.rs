//! The start of a model: the pose that closes its joints, the velocities that fit them, what they hold.
//!
//! In: gaps, unknowns, held motions. Out: the functions that make the start, `start` and `impulse_energy` of the model,
//! and `Joints` for the model.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::items::identifier;
use super::inlined::InlinedAlways;
use super::required::requirement;
use super::tabled::{Asked, HOLDING};
use super::{Emission, Shape, shared};
use crate::program::{Program, Programs, Starting};
use crate::tables::{Gap, Held, Slip, Start};

impl Emission<'_> {
    /// Guesses, gaps, start state and what is asked of values, each with its constants inside.
    pub(super) fn starting(&self) -> TokenStream {
        let parameters = &self.shape.p;
        let Programs { starting, required, .. } = &self.model.programs;
        let functions = starting.programs().chain(required.iter().flatten()).map(|program| {
            let [routine] = &program.routines;
            let function = identifier(&routine.name);
            let constants = self.own_constants(program);
            let written = self.tabled_once(routine).unwrap_or_else(|| {
                let (parameters, (statements, results)) = (self.parameter_bindings(&[routine]), self.body(routine));
                quote!(#parameters #statements to.copy_from_slice(&[#(#results),*]);)
            });
            quote! {
                fn #function(parameters: &[S; #parameters], u: &[S], to: &mut [S]) {
                    #constants
                    #written
                }
            }
        });
        quote! { #(#functions)* }
    }

    /// The functions of the trait that give the start, and before them what they are calculated from.
    pub(super) fn start(&self) -> (TokenStream, TokenStream) {
        let Shape { n, g, .. } = &self.shape;
        let over = quote!(&::bg_model::__private::Over::<_, #n, #g, 0>(self));
        let system = quote!(system: &dyn ::bg_model::dynamics::Dynamics<S>);
        let error = quote!(::bg_model::assembly::AssemblyError);
        let impulse_energy = self.model.programs.holding.as_ref().map(|_| {
            quote! {
                fn impulse_energy(&self) -> Result<S, #error> {
                    ::bg_model::system::Model::impulse_energy_over(self, #over)
                }
                fn impulse_energy_over(&self, #system) -> Result<S, #error> {
                    ::bg_model::__private::start(self, system, &mut [S::from_f64(0.0); #n])
                }
            }
        });
        let start = quote! {
            fn start(&self) -> Result<SVector<S, #n>, #error> {
                let mut x = SVector::from([S::from_f64(0.0); #n]);
                ::bg_model::system::Model::start_over(self, #over, x.as_mut_slice())?;
                Ok(x)
            }
            fn start_over(&self, #system, x: &mut [S]) -> Result<(), #error> {
                ::bg_model::__private::start(self, system, x).map(|_| ())
            }
            #impulse_energy
        };
        (start, self.routines_of_start())
    }

    /// The routines of the start with their tables, as `Starting` asks for them.
    fn routines_of_start(&self) -> TokenStream {
        let Programs { starting, required: [_, required], .. } = &self.model.programs;
        let p = &self.shape.p;
        let Start { unknowns, gaps, speeds, required: requirements, sides, impulse } = &self.tables.start;
        let gaps = gaps.iter().map(|Gap { joint, component, unit }| {
            quote!(::bg_model::assembly::Gap { joint: #joint, component: #component, unit: #unit })
        });
        let requirements = requirements.iter().map(requirement);
        let Starting { guesses, gaps: of_gaps, gap_sizes, start_state, sides: of_sides, clocks: _ } = starting;
        // Each with whether it is asked in doubles alone.
        let routines = [
            ("Guesses", Some(guesses), false),
            ("Gaps", Some(of_gaps), false),
            ("GapSizes", Some(gap_sizes), true),
            ("State", Some(start_state), false),
            ("Sides", of_sides.as_ref(), true),
            ("Required", required.as_ref(), true),
        ];
        let calls = routines.into_iter().map(|(word, program, in_doubles)| {
            let word = format_ident!("{word}");
            let call = program.map(|Program { routines: [routine], .. }| {
                let function = identifier(&routine.name);
                let call = quote!(Self::#function(values, unknowns, to));
                if in_doubles { quote!(if const { ::bg_model::__private::are_doubles::<S>() } { #call }) } else { call }
            });
            quote!(::bg_model::__private::StartRoutine::#word => { #call })
        });
        quote! {
            impl<S: Scalar> Model<S> {
                fn of_start(
                    values: &[S; #p], routine: ::bg_model::__private::StartRoutine, unknowns: &[S], to: &mut [S],
                ) {
                    match routine { #(#calls)* }
                }
            }
            impl<S: Scalar> ::bg_model::__private::Starting<S> for Model<S> {
                fn table(&self) -> ::bg_model::__private::StartTable {
                    ::bg_model::__private::StartTable {
                        unknowns: #unknowns, gaps: &[#(#gaps),*], speeds: &[#(#speeds),*],
                        required: &[#(#requirements),*], sides: #sides, impulse: #impulse,
                    }
                }
                fn in_numbers(
                    &self, routine: ::bg_model::__private::StartRoutine, unknowns: &[f64], to: &mut [f64],
                ) {
                    Model::<f64>::of_start(&self.parameters.numbers(), routine, unknowns, to);
                }
                fn in_scalars(
                    &self, routine: ::bg_model::__private::StartRoutine, unknowns: &[S], to: &mut [S],
                ) {
                    Self::of_start(&self.values, routine, unknowns, to);
                }
            }
        }
    }

    /// What the joints hold.
    pub(super) fn joints(&self) -> TokenStream {
        let Some(Program { routines: [routine], .. }) = &self.model.programs.holding else { return TokenStream::new() };
        let Shape { n, g, .. } = &self.shape;
        let Held { rigid, compliant, moved, pose, turning, closing, is_driven } =
            self.tables.held.as_ref().expect("tables of what the program gives");
        let (rigid, compliant) = (rigid.iter().map(slip), compliant.iter().map(slip));
        let (kept, closing) = (self.kept(), shared::closing(closing));
        let values = self.values(Asked::often(routine, HOLDING));
        let arguments = quote!(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S]);
        let written = quote!(entries.copy_from_slice(&#values););
        let hold = if routine.is_long() {
            quote! {
                #[inline(never)]
                fn hold(#arguments) { #written }
            }
        } else {
            let inline = InlinedAlways;
            quote! {
                #[inline(never)]
                fn hold(#arguments) {
                    ::bg_model::capability::Joints::inlined_hold(self, t, x, negative, entries);
                }
                fn is_hold_inlined(&self) -> bool {
                    true
                }
                #inline
                fn inlined_hold(#arguments) { #written }
            }
        };
        quote! {
            impl<S: Scalar> ::bg_model::capability::Joints<S, #n, #g> for Model<S> {
                fn held(&self) -> ::bg_model::holding::Held {
                    ::bg_model::holding::Held {
                        rigid: &[#(#rigid,)*], compliant: &[#(#compliant,)*], moved: &[#(#moved),*],
                            pose: &[#(#pose),*],
                        turning: &[#(#turning),*], closing: #closing, is_driven: #is_driven,
                    }
                }
                #kept
                #hold
            }
        }
    }
}

fn slip(Slip { joint, direction, unit }: &Slip) -> TokenStream {
    quote!(::bg_model::holding::Slip { joint: #joint, direction: #direction, unit: #unit })
}
