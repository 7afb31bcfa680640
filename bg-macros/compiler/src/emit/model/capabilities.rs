//! What the model knows of itself beyond its rates: the capabilities, and the functions that hand them over.
//!
//! In: the programs that there are. Out: `SecondOrder` and `Series` for the model, beside those of the other files
//! here.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::items::identifier;
use super::super::series;
use super::parts::alone;
use super::tabled::{Asked, SIZES};
use super::{Emission, Shape, names};
use crate::program::Programs;

/// The function that hands over a capability, as `value`.
pub(super) fn accessor(name: &str, capability: &TokenStream, value: &TokenStream) -> TokenStream {
    let name = format_ident!("{name}");
    quote! {
        #[inline(always)]
        fn #name(&self) -> Option<&impl ::bg_model::capability::#capability> {
            #value
        }
    }
}

impl Emission<'_> {
    /// The implementations of all capabilities that the model has.
    pub(super) fn capabilities(&self) -> TokenStream {
        let (linear, second_order, series, joints) = (self.linear(), self.second_order(), self.series(), self.joints());
        let (impacts, storages, memories) = (self.impacts(), self.storages(), self.memories());
        let (inlined, named, turning) = (self.inlined(), self.named(), self.turning());
        quote! { #inlined #named #memories #turning #linear #second_order #series #joints #impacts #storages }
    }

    /// The functions that hand them over.
    pub(super) fn accessors(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let Programs { second_order, holding, impacts, pivots, .. } = &self.model.programs;
        let itself = quote!(Some(self));
        let linearised = accessor("linearised", &quote!(Linearised<S, #n, #g>), &itself);
        let second_order =
            second_order.as_ref().map(|_| accessor("second_order", &quote!(SecondOrder<S, #n, #g>), &itself));
        let series = accessor("series", &quote!(Series<S, #n, #g>), &self.series_where_known());
        let joints = holding.as_ref().map(|_| accessor("joints", &quote!(Joints<S, #n, #g>), &itself));
        let impacts = impacts.as_ref().map(|_| accessor("impacts", &quote!(Impacts<S, #n, #g>), &itself));
        let storages = accessor("storages", &quote!(Storages<S, #n, #g>), &itself);
        let named = accessor("named", &quote!(Named<S, #n, #g>), &itself);
        let inlined = accessor("inlined", &quote!(Inlined<S, #n, #g>), &itself);
        let memories = self.remembers().then(|| accessor("memories", &quote!(Memories<S>), &itself));
        let turning = pivots.as_ref().map(|_| accessor("turning", &quote!(Turning<S, #n, #g>), &itself));
        quote! {
            #named #inlined #memories #turning #linearised #second_order #series #joints #impacts #storages
        }
    }

    /// The model as its series: none is known where an input changes with time.
    fn series_where_known(&self) -> TokenStream {
        let inputs = &self.model.equations.inputs;
        if inputs.is_empty() {
            return quote!(Some(self));
        }
        let inputs = inputs.iter().map(|input| identifier(&input.name.text));
        quote!((#(self.inputs.#inputs.is_constant())&&*).then_some(self))
    }

    /// The stored energy with its second derivatives.
    fn storages(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let [routine] = &self.model.programs.sizes.routines;
        let values = self.values(Asked::often(routine, SIZES));
        quote! {
            impl<S: Scalar> ::bg_model::capability::Storages<S, #n, #g> for Model<S> {
                fn states(&self) -> &'static [::bg_model::description::StateInfo] {
                    DESCRIPTION.states
                }
                #[cold]
                fn energy(
                    &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], curvatures: &mut SVector<S, #n>,
                ) -> S {
                    let [energy, of_states @ ..] = #values;
                    curvatures.data.0 = [of_states];
                    energy
                }
            }
        }
    }

    /// The states of second order and their second derivatives.
    fn second_order(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let programs = self.model.programs.second_order.as_ref()?;
        let (body, derivatives) = self.running(&programs.second_derivatives, &format_ident!("second_constants"));
        let states = &self.model.second_order.states;
        let [first, behind] = [states.start, states.end].map(Literal::usize_unsuffixed);
        let indices = states.clone().map(Literal::usize_unsuffixed);
        let (forces, inline) = (self.forces(), self.inline());
        let operations =
            programs.operations(self.model.programs.running.rate.counts.total()).map(Literal::usize_unsuffixed);
        Some(quote! {
            impl<S: Scalar> ::bg_model::capability::SecondOrder<S, #n, #g> for Model<S> {
                #[inline(always)]
                fn states(&self) -> ::core::ops::Range<usize> {
                    #first..#behind
                }
                #inline
                fn second_derivatives(&self, x: &SVector<S, #n>, dx: &mut SVector<S, #n>) {
                    let [r] = dx.data.0;
                    #body
                    let [dx] = &mut dx.data.0;
                    #(dx[#indices] = #derivatives;)*
                }
                #forces
                fn operations(&self) -> Option<[u32; 2]> {
                    Some([#(#operations),*])
                }
            }
        })
    }

    /// The rates with second derivatives in their places: in one program where that pays, else one after the other.
    fn forces(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let programs = self.model.programs.second_order.as_ref()?;
        let own = programs.forces.as_ref().map(|routine| {
            let (body, forces) =
                self.with_pairs(routine, self.model.programs.pairs().forces.as_ref(), "second_constant");
            quote!(#body dx.data.0 = [[#(#forces),*]];)
        });
        let inline = own.as_ref().and_then(|_| self.inline());
        let body = own.unwrap_or_else(|| {
            quote! {
                ::bg_model::system::System::rate(self, t, x, negative, dx);
                ::bg_model::capability::SecondOrder::second_derivatives(self, x, dx);
            }
        });
        Some(quote! {
            #inline
            fn forces(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], dx: &mut SVector<S, #n>) {
                #body
            }
        })
    }

    /// The Taylor series of the states.
    fn series(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let routine = &self.model.programs.running.rate;
        let found = self.model.equations.found();
        let first = names::reads_found(routine).then(|| {
            quote! {
                let mut found = {
                    let [x] = &series[0].data.0;
                    self.found(t, x, negative)
                };
            }
        });
        let (inputs, states) = (self.input_bindings(routine, "t"), self.state_bindings(routine));
        let reads = series::Reads {
            values: quote!(#inputs #first),
            states,
            found,
            shape: [n, g],
            in_vectors: self.inline().is_some(),
            by: &|group| {
                let part = alone(routine, group, &[]);
                let (inputs, states) = (self.input_bindings(&part, "at"), self.state_bindings(&part));
                quote!(#inputs #states)
            },
        };
        let series::Expansion { width, operations, body, parts } = self
            .with_names(|names| series::expansion(routine, self.model.programs.pairs().rate.as_ref(), names, &reads));
        let inline = self.inline().map_or_else(|| quote!(#[inline(never)]), |inline| quote!(#inline));
        let parts = (!parts.is_empty()).then(|| quote!(impl<S: Scalar> Model<S> { #parts }));
        quote! {
            #parts
            impl<S: Scalar> ::bg_model::capability::Series<S, #n, #g> for Model<S> {
                fn width(&self) -> usize {
                    #width
                }
                fn operations(&self) -> Option<::bg_model::capability::Operations> {
                    Some(::bg_model::capability::Operations { #operations })
                }
                #inline
                fn expand(
                    &self, t: S, h: S, negative: &[S::Switch; #g], rows: &mut [S], series: &mut [SVector<S, #n>],
                ) {
                    #body
                }
            }
        }
    }
}
