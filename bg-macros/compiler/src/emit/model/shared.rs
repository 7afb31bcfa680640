//! Loops: which rows of the joints that close them are kept, on which side they are closed, and reactions of least
//! norm.
//!
//! In: held motions with numbers of their own, sides of roots. Out: the fields `kept` and `sides` with their values,
//! what functions of constants take for them, and the reactions that outputs read. Nothing for other models.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Emission, Shape};

/// What the start pose decides for a run, each an array of numbers of this many places: which rows are kept, on which
/// sides roots are.
pub(super) struct Decided {
    arrays: Vec<(Ident, usize)>,
}

impl Decided {
    fn each(&self, tokens: impl Fn(&Ident, usize) -> TokenStream) -> TokenStream {
        self.arrays.iter().map(|(name, count)| tokens(name, *count)).collect()
    }

    /// The fields of the model's struct.
    pub fn fields(&self) -> TokenStream {
        self.each(|name, count| quote!(#name: [::core::primitive::f64; #count],))
    }

    /// Their values in a constructor.
    pub fn values(&self) -> TokenStream {
        self.each(|name, _| quote!(#name,))
    }

    /// Their values in another model of the same parameters.
    pub fn copied(&self) -> TokenStream {
        self.each(|name, _| quote!(#name: first.#name,))
    }

    /// The arguments of a function that calculates constants.
    pub fn arguments(&self) -> TokenStream {
        self.each(|name, count| quote!(, #name: &[f64; #count]))
    }

    /// The arguments of a function that makes the model.
    pub fn owned(&self) -> TokenStream {
        self.each(|name, count| quote!(, #name: [f64; #count]))
    }

    /// What is passed for them where they are variables.
    pub fn pass(&self) -> TokenStream {
        self.each(|name, _| quote!(, &#name))
    }

    /// The same, handed over.
    fn moved(&self) -> TokenStream {
        self.each(|name, _| quote!(, #name))
    }

    /// What stands for them while they are not known.
    fn assumed(&self) -> TokenStream {
        self.each(|_, count| quote!(, [1.0; #count]))
    }

    /// `let`s of them in a function of the model.
    pub fn read(&self) -> TokenStream {
        self.each(|name, _| quote!(let #name = &self.#name;))
    }

    /// The function of `Model` that hands them over.
    pub fn handed_over(&self) -> Option<TokenStream> {
        let names = self.arrays.iter().map(|(name, _)| name);
        (!self.arrays.is_empty()).then(|| {
            quote! {
                fn decided(&self) -> ::bg_model::__private::vec::Vec<f64> {
                    [#(&self.#names[..]),*].concat()
                }
            }
        })
    }
}

impl Emission<'_> {
    /// What the start pose decides.
    pub(super) fn decided(&self) -> Decided {
        let counts = [("kept", self.tables.closing_rows), ("sides", self.tables.start.sides)];
        let arrays = counts.into_iter().filter(|(_, count)| *count > 0);
        Decided { arrays: arrays.map(|(name, count)| (format_ident!("{name}"), count)).collect() }
    }

    fn where_shared(&self, tokens: impl FnOnce(usize) -> TokenStream) -> Option<TokenStream> {
        Some(self.tables.closing_rows).filter(|&rows| rows > 0).map(tokens)
    }

    /// The function of `Joints` that hands over which rows are kept.
    pub(super) fn kept(&self) -> Option<TokenStream> {
        self.where_shared(|_| {
            quote!(
                fn kept(&self) -> &[f64] {
                    &self.kept
                }
            )
        })
    }

    /// The body of a constructor after the checks: the model with what its start pose decides.
    pub(super) fn construction(&self, has_inputs: bool) -> TokenStream {
        let Shape { n, g, .. } = &self.shape;
        let (inputs, cloned) = (has_inputs.then(|| quote!(, inputs)), has_inputs.then(|| quote!(, inputs.clone())));
        let decided = self.decided();
        let (assumed, moved) = (decided.assumed(), decided.moved());
        let made = |arguments: &TokenStream| {
            quote!(Model::<f64>::made(parameters.clone(),
            parameters.numbers() #cloned #arguments))
        };
        let count = self.tables.start.sides;
        let sides = (count > 0).then(|| {
            let made = made(&assumed);
            quote!(let sides: [f64; #count] = ::bg_model::__private::decided(::bg_model::__private::sides(&#made));)
        });
        let kept = self.where_shared(|rows| {
            let made = made(&moved);
            quote! {
                let kept = [1.0; #rows];
                let all = #made;
                let kept: [f64; #rows] = ::bg_model::__private::decided(
                    ::bg_model::__private::kept(&all, &::bg_model::__private::Over::<_, #n, #g, 0>(&all)),
                );
            }
        });
        quote!(#sides #kept Ok(Self::made(parameters, values #inputs #moved)))
    }

    /// `reactions`: those of all rigid joints, of least norm where they are not unique.
    pub(super) fn reactions(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let routine = &self.model.programs.running.reactions;
        let (values, count) = (self.values(self.asked_reactions()), routine.results.len());
        self.where_shared(|_| {
            quote! {
                fn reactions(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g]) -> [S; #count] {
                    let (state, mut reactions) = (x.as_slice(), #values);
                    let over = ::bg_model::__private::Over::<_, #n, #g, 0>(self);
                    ::bg_model::__private::share(&over, t, state, negative, &mut reactions);
                    reactions
                }
            }
        })
    }

    /// The function of `Model` that names the joints.
    pub(super) fn redundant(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        self.where_shared(|_| {
            quote! {
                fn redundant(&self) -> ::bg_model::__private::vec::Vec<::bg_model::holding::Redundancy> {
                    let over = &::bg_model::__private::Over::<_, #n, #g, 0>(self);
                    ::bg_model::system::Model::redundant_over(self, over)
                }
                fn redundant_over(
                    &self, system: &dyn ::bg_model::dynamics::Dynamics<S>,
                ) -> ::bg_model::__private::vec::Vec<::bg_model::holding::Redundancy> {
                    ::bg_model::__private::redundant(self, system)
                }
            }
        })
    }

    /// `let reactions` in a function of the model.
    pub(super) fn with_reactions(&self) -> Option<TokenStream> {
        self.where_shared(|_| quote!(let reactions = self.reactions(t, x, negative);))
    }

    /// The reactions that pictures show, as `f64`, and what is handed over of them.
    pub(super) fn shown_reactions(&self) -> (Option<TokenStream>, TokenStream) {
        let reactions = self.where_shared(|_| {
            quote! {
                let state = x.map(S::from_f64);
                let switches = negative.map(S::Switch::from);
                let reactions = self.reactions(S::from_f64(t), &state, &switches).map(|reaction| reaction.to_f64());
            }
        });
        let values = if reactions.is_some() { quote!(&reactions) } else { quote!(&[]) };
        (reactions, values)
    }
}

/// The rows that may follow from others, each with its number.
pub(super) fn closing(rows: &[(usize, usize)]) -> TokenStream {
    let rows = rows.iter().map(|&(row, number)| {
        let [row, number] = [row, number].map(Literal::usize_unsuffixed);
        quote!((#row, #number))
    });
    quote!(&[#(#rows),*])
}
