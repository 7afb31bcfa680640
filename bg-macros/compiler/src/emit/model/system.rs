//! What an integrator asks of every system: rates, guards, projection, kinks of inputs, names for messages.
//!
//! In: the programs of the running model. Out: `System` for the model.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::super::items::identifier;
use super::tabled::{Asked, CONSTANTS};
use super::{Emission, Shape};
use crate::program::Routine;
use crate::tables::Delay;

/// The attribute of functions that are inlined where they are called, in release builds.
#[derive(Clone, Copy)]
pub(super) struct Inlined;

impl ToTokens for Inlined {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(quote!(#[cfg_attr(not(debug_assertions), inline(always))]));
    }
}

impl Emission<'_> {
    pub(super) fn system(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (rate, guards, project) = (self.rate(), self.guards(), self.project());
        let (switch_name, not_finite, accessors) = (self.switch_name(), self.not_finite(), self.accessors());
        let (next_break, first_branches, iterations) = (self.next_break(), self.first_branches(), self.iterations());
        let (memories, clocks, delays) = (self.memories(), self.clocks(), self.delays());
        let (runs_in_lanes, pivots) = (self.runs_in_lanes(), self.pivots());
        quote! {
            #iterations
            impl<S: Scalar> ::bg_model::system::System<S, #n, #g> for Model<S> {
                #rate
                #guards
                #project
                #next_break
                #first_branches
                #memories
                #clocks
                #delays
                #runs_in_lanes
                fn state_name(&self, index: usize) -> &'static str {
                    DESCRIPTION.states.get(index).map_or("state", |state| state.name)
                }
                #switch_name
                #not_finite
                #pivots
                #accessors
            }
        }
    }

    /// The rate, in pairs where that pays; without them where it is inlined for other numbers than `f64`.
    fn rate(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let running = &self.model.programs.running;
        let arguments = quote!(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], dx: &mut SVector<S, #n>);
        let function = |name: TokenStream, inline: Option<Inlined>, (body, rates): (TokenStream, Vec<TokenStream>)| {
            // The unknowns of iterations come after the rates.
            let rates = &rates[..self.model.equations.states.len()];
            quote! {
                #inline
                fn #name(#arguments) {
                    #body
                    dx.data.0 = [[#(#rates),*]];
                }
            }
        };
        let calling = |name: TokenStream, inline: Option<Inlined>, called: TokenStream| {
            quote! {
                #inline
                fn #name(#arguments) {
                    ::bg_model::system::System::#called(self, t, x, negative, dx);
                }
            }
        };
        // By the table where numbers are interpreted, else by this.
        let tabled = self.tabled(&running.rate, &format_ident!("constants"));
        let chosen = |straight: TokenStream| {
            let Some(tabled) = &tabled else { return quote!(fn rate(#arguments) { #straight }) };
            quote! {
                fn rate(#arguments) {
                    if const { ::bg_model::__private::is_tabled::<S>() } {
                        let to = dx.as_mut_slice();
                        #tabled
                    } else {
                        #straight
                    }
                }
            }
        };
        let always = function(quote!(always_inlined_rate), Some(Inlined), self.function(&running.rate));
        let Some(paired) = &self.model.programs.pairs().rate else {
            let rate = chosen(quote!(::bg_model::system::System::always_inlined_rate(self, t, x, negative, dx);));
            let inlined =
                self.inline().map(|inline| calling(quote!(inlined_rate), Some(inline), quote!(always_inlined_rate)));
            return quote!(#rate #inlined #always);
        };
        let body = self.with_pairs(&running.rate, Some(paired), "constant");
        if !running.is_inlined() {
            let paired = function(quote!(paired_rate), Some(Inlined), body);
            let rate = chosen(quote!(::bg_model::__private::vectorised_rate(self, t, x, negative, dx);));
            return quote!(#rate #paired #always);
        }
        let rate = chosen(quote!(::bg_model::system::System::inlined_rate(self, t, x, negative, dx);));
        let inlined = function(quote!(inlined_rate), Some(Inlined), body);
        quote!(#rate #inlined #always)
    }

    /// The attribute of rates, and of forces, that are inlined where they are compiled for the machine's vectors.
    pub(super) fn inline(&self) -> Option<Inlined> {
        self.model.programs.running.is_inlined().then_some(Inlined)
    }

    fn guards(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let values = self.values(Asked::often(&self.model.programs.running.guards, CONSTANTS));
        quote! {
            #[inline(always)]
            fn guards(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], guards: &mut SVector<S, #g>) {
                guards.data.0 = [#values];
            }
        }
    }

    fn project(&self) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (running, tables) = (&self.model.programs.running, &self.tables);
        let pose = self.projection(&running.project, &tables.projected);
        let momenta = self.projection(&running.settle, &tables.settled);
        let inline = Inlined;
        quote! {
            fn project(&self, t: S, negative: &[S::Switch; #g], state: &mut SVector<S, #n>) {
                ::bg_model::system::System::inlined_project(self, t, negative, state);
            }
            #inline
            fn inlined_project(&self, t: S, negative: &[S::Switch; #g], state: &mut SVector<S, #n>) {
                #pose
                #momenta
            }
        }
    }

    /// Gives the states of `moved` what the routine makes of them.
    pub(super) fn projection(&self, routine: &Routine, moved: &[usize]) -> Option<TokenStream> {
        let values = self.values(Asked::often(routine, CONSTANTS));
        let places = (0..moved.len()).map(Literal::usize_unsuffixed);
        let indices = moved.iter().copied().map(Literal::usize_unsuffixed);
        (!moved.is_empty()).then(|| {
            quote! {
                {
                    let x = &*state;
                    let values = #values;
                    let [projected] = &mut state.data.0;
                    #(projected[#indices] = values[#places];)*
                }
            }
        })
    }

    /// Where inputs have a step end; nothing where there are none.
    fn next_break(&self) -> Option<TokenStream> {
        let inputs = &self.model.equations.inputs;
        let inputs = inputs.iter().map(|input| identifier(&input.name.text)).collect::<Vec<_>>();
        (!inputs.is_empty()).then(|| {
            quote! {
                fn next_break(&self, t: f64) -> f64 {
                    ::bg_model::input::next_break([#(&self.inputs.#inputs),*], t)
                }
            }
        })
    }

    /// The states that keep what memories have followed; nothing where there are none.
    fn memories(&self) -> Option<TokenStream> {
        let memories = &self.tables.memories;
        (!memories.is_empty()).then(|| {
            quote! {
                fn memories(&self) -> &'static [usize] {
                    &[#(#memories),*]
                }
            }
        })
    }

    /// The switches of clocks and their instants; nothing where there are none.
    fn clocks(&self) -> Option<TokenStream> {
        let clocks = &self.tables.clocks;
        (!clocks.is_empty()).then(|| {
            quote! {
                fn clocks(&self) -> &'static [usize] {
                    &[#(#clocks),*]
                }
                fn instants(&self, instants: &mut [S]) {
                    Self::clocks(&self.values, &[], instants);
                }
            }
        })
    }

    /// The delays of signals; nothing where there are none.
    fn delays(&self) -> Option<TokenStream> {
        let delays = self.tables.delays.iter().map(|Delay { clock, window: [from, until], signals }| {
            let signals = signals.iter().map(|(coefficients, is_given)| {
                quote! { ::bg_model::delay::Signal { coefficients: &[#(#coefficients),*], is_given: #is_given } }
            });
            quote! { ::bg_model::delay::States { clock: #clock, window: [#from, #until], signals: &[#(#signals),*] } }
        });
        (delays.len() > 0).then(|| {
            quote! {
                fn delays(&self) -> &'static [::bg_model::delay::States] {
                    &[#(#delays),*]
                }
            }
        })
    }

    /// The branches from which the search for those at the start begins; nothing where no switch remembers.
    fn first_branches(&self) -> Option<TokenStream> {
        let g = &self.shape.g;
        let branches = &self.tables.first_branches;
        branches.contains(&true).then(|| {
            quote! {
                fn first_branches(&self) -> [bool; #g] {
                    [#(#branches),*]
                }
            }
        })
    }

    /// Whether several runs side by side are those that each is by itself, and gain by it; nothing where they always
    /// are.
    fn runs_in_lanes(&self) -> Option<TokenStream> {
        let inputs = self.model.equations.inputs.iter().map(|input| identifier(&input.name.text)).collect::<Vec<_>>();
        let constant = quote!(#(self.inputs.#inputs.is_constant())&&*);
        let answer = if self.may_run_in_lanes() { constant } else { quote!(false) };
        (!answer.is_empty()).then(|| {
            quote! {
                fn runs_in_lanes(&self) -> bool {
                    #answer
                }
            }
        })
    }

    /// Whether there are inputs with which it runs in lanes.
    pub(super) fn may_run_in_lanes(&self) -> bool {
        self.model.equations.found() == 0 && self.inline().is_some() && self.tables.turning.is_empty()
    }

    /// What switches are called.
    fn switch_name(&self) -> Option<TokenStream> {
        (!self.model.equations.switches.is_empty()).then(|| {
            quote! {
                fn switch_name(&self, index: usize) -> Option<&'static str> {
                    DESCRIPTION.switches.get(index).map(|switch| switch.name)
                }
            }
        })
    }

    /// The loops that may come to their ends, and their pivots; nothing where there are none.
    fn pivots(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (body, values) = self.by_itself(self.model.programs.pivots.as_ref()?);
        let joints = &self.tables.turning;
        Some(quote! {
            fn turning(&self) -> &'static [&'static str] {
                &[#(#joints),*]
            }
            fn pivots(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], pivots: &mut [S]) {
                #body
                pivots.copy_from_slice(&[#(#values),*]);
            }
        })
    }

    /// Which input or law is the first whose value is not finite; nothing where none can be.
    fn not_finite(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (fallible, inputs) = (&self.tables.fallible, &self.model.equations.inputs);
        if fallible.is_empty() && inputs.is_empty() {
            return None;
        }
        let inputs = inputs.iter().map(|input| {
            let (field, name) = (identifier(&input.name.text), &input.name.text);
            quote!(("input", #name, self.inputs.#field.value(t)))
        });
        let (body, values) = self.by_itself(&self.model.programs.not_finite);
        let laws = fallible.iter().zip(values).map(|((kind, element), value)| quote!((#kind, #element, #value)));
        Some(quote! {
            #[cold]
            fn not_finite(
                &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g],
            ) -> Option<::bg_model::failure::Origin> {
                #body
                ::bg_model::failure::Origin::first(&[#(#inputs,)* #(#laws,)*])
            }
        })
    }
}
