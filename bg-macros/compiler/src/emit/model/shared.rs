//! Reactions that joints share: of a model whose joints close loops, which of its rows are kept, and reactions of least norm.
//!
//! In: held motions with numbers of their own. Out: the field `kept` with its value, what functions of constants take for
//! it, and the reactions that outputs read. Nothing for other models.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::start::lifted;
use super::{Emission, Shape};
use crate::system::equations::Slip;

/// How many rows may follow from others.
pub(super) struct Shared {
    rows: usize,
}

impl Shared {
    fn where_any(&self, tokens: impl FnOnce(usize) -> TokenStream) -> Option<TokenStream> {
        (self.rows > 0).then(|| tokens(self.rows))
    }

    /// The field of the model's struct.
    pub fn field(&self) -> Option<TokenStream> {
        self.where_any(|rows| quote!(kept: [::core::primitive::f64; #rows],))
    }

    /// Its value in a constructor.
    pub fn value(&self) -> Option<TokenStream> {
        self.where_any(|_| quote!(kept,))
    }

    /// Its value in another model of the same parameters.
    pub fn copied(&self) -> Option<TokenStream> {
        self.where_any(|_| quote!(kept: first.kept,))
    }

    /// The argument of a function that calculates constants.
    pub fn argument(&self) -> Option<TokenStream> {
        self.where_any(|rows| quote!(, kept: &[f64; #rows]))
    }

    /// The argument of a function that makes the model.
    pub fn owned(&self) -> Option<TokenStream> {
        self.where_any(|rows| quote!(, kept: [f64; #rows]))
    }

    /// What is passed for it where `kept` is a variable.
    pub fn pass(&self) -> Option<TokenStream> {
        self.where_any(|_| quote!(, &kept))
    }

    /// The function of `Joints` that hands it over.
    pub fn kept(&self) -> Option<TokenStream> {
        self.where_any(|_| {
            quote!(
                fn kept(&self) -> &[f64] {
                    &self.kept
                }
            )
        })
    }

    /// `let kept` in a function of the model.
    pub fn read(&self) -> Option<TokenStream> {
        self.where_any(|_| quote!(let kept = &self.kept;))
    }
}

impl Emission<'_> {
    /// What the model's joints share.
    pub(super) fn shared(&self) -> Shared {
        let numbers = self.model.equations.holding.rigid.iter().filter_map(|slip| slip.kept);
        Shared { rows: numbers.max().map_or(0, |last| last as usize + 1) }
    }

    /// The body of a constructor after the checks: the model with the rows that are kept.
    pub(super) fn construction(&self, has_inputs: bool) -> TokenStream {
        let (inputs, cloned) = (has_inputs.then(|| quote!(, inputs)), has_inputs.then(|| quote!(, inputs.clone())));
        let kept = self.shared().where_any(|rows| {
            quote! {
                let all = Model::<f64>::made(parameters.clone(), parameters.numbers() #cloned, [1.0; #rows]);
                let kept = ::bg_model::__private::kept(&all, all.pose().ok());
            }
        });
        let pass = self.shared().where_any(|_| quote!(, kept));
        quote!(#kept Ok(Self::made(parameters, values #inputs #pass)))
    }

    /// `pose`: the state at the closed start pose, guessed velocities as they are.
    pub(super) fn pose(&self) -> Option<TokenStream> {
        let (n, closed, lifted) = (&self.shape.n, self.closed_pose(), lifted());
        self.shared().where_any(|_| {
            quote! {
                fn pose(&self) -> Result<SVector<S, #n>, ::bg_model::assembly::AssemblyError> {
                    #closed
                    #lifted
                    Ok(SVector::from(Self::start_state(&self.values, &unknowns)))
                }
            }
        })
    }

    /// `reactions`: those of all rigid joints, of least norm where they are not unique.
    pub(super) fn reactions(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (body, reactions) = self.function(&self.model.programs.running.reactions);
        let count = reactions.len();
        self.shared().where_any(|_| {
            quote! {
                fn reactions(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g]) -> [S; #count] {
                    let (state, mut reactions) = (x, { #body [#(#reactions),*] });
                    ::bg_model::__private::share(self, t, state, negative, &mut reactions);
                    reactions
                }
            }
        })
    }

    /// The function of `Model` that names the joints.
    pub(super) fn redundant(&self) -> Option<TokenStream> {
        self.shared().where_any(|_| {
            quote! {
                fn redundant(&self) -> ::bg_model::__private::vec::Vec<::bg_model::holding::Redundancy> {
                    let Ok(pose) = self.pose() else { return ::bg_model::__private::vec::Vec::new() };
                    ::bg_model::__private::redundant(self, &pose)
                }
            }
        })
    }

    /// `let reactions` in a function of the model.
    pub(super) fn with_reactions(&self) -> Option<TokenStream> {
        self.shared().where_any(|_| quote!(let reactions = self.reactions(t, x, negative);))
    }

    /// The reactions that pictures show, as `f64`, and what is handed over of them.
    pub(super) fn shown_reactions(&self) -> (Option<TokenStream>, TokenStream) {
        let reactions = self.shared().where_any(|_| {
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
pub(super) fn closing(rigid: &[Slip]) -> TokenStream {
    let rows = rigid.iter().enumerate();
    let rows = rows.filter_map(|(row, slip)| Some((row, slip.kept? as usize)));
    let rows = rows.map(|(row, number)| {
        let [row, number] = [row, number].map(Literal::usize_unsuffixed);
        quote!((#row, #number))
    });
    quote!(&[#(#rows),*])
}
