//! The reverse sweeps of the model's functions.
//!
//! In: the sweeps of the running model's routines. Out: `Reversed` for the model, and a function for each sweep.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Emission, Shape};
use crate::expr::Symbol;
use crate::program::{Operand, Reverse};

impl Emission<'_> {
    pub(super) fn reversed(&self) -> Option<TokenStream> {
        let Shape { n, g, m, .. } = &self.shape;
        let reversed = self.model.programs.reversed()?;
        let (equations, constants) = (&self.model.equations, self.constant_count());
        let (rate, project) = (self.sweep(&reversed.rate, equations.states.len()), self.reverse_project());
        let outputs = reversed.outputs.as_ref().map(|sweep| self.sweep(sweep, equations.outputs.len()));
        let reverse_outputs = outputs.as_ref().map(|_| {
            quote! {
                fn reverse_outputs(
                    &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], weights: &SVector<S, #m>,
                    by_state: &mut SVector<S, #n>, by_constants: &mut [S],
                ) -> bool {
                    let by_constants: &mut [S; #constants] =
                        by_constants.try_into().expect("a number for each constant");
                    self.sweep_outputs(t, x, negative, &weights.data.0[0], by_state, by_constants);
                    true
                }
            }
        });
        let functions = [(&reversed.project, &equations.projections), (&reversed.settle, &equations.settled)];
        let functions = functions.into_iter().filter(|(_, moved)| !moved.is_empty());
        let functions = functions.map(|(sweep, moved)| self.sweep(sweep, moved.len()));
        Some(quote! {
            impl<S: Scalar> Model<S> {
                #rate
                #outputs
                #(#functions)*
            }
            impl<S: Scalar> ::bg_model::capability::Reversed<S, #n, #g, #m> for Model<S> {
                fn constants(&self) -> &[S] {
                    &self.constants
                }
                fn reverse_rate(
                    &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], weights: &SVector<S, #n>,
                    by_state: &mut SVector<S, #n>, by_constants: &mut [S],
                ) {
                    let by_constants: &mut [S; #constants] =
                        by_constants.try_into().expect("a number for each constant");
                    self.sweep_rate(t, x, negative, &weights.data.0[0], by_state, by_constants);
                }
                #project
                #reverse_outputs
            }
        })
    }

    fn constant_count(&self) -> Literal {
        Literal::usize_unsuffixed(self.model.programs.running.constants.results.len())
    }

    /// The function of a sweep with so many weights: it replaces the derivatives by states and adds to those by
    /// constants.
    fn sweep(&self, sweep: &Reverse, weights: usize) -> TokenStream {
        let (Shape { n, g, .. }, constants) = (&self.shape, self.constant_count());
        let name = format_ident!("{}", sweep.routine.name.replace("reverse", "sweep"));
        let (body, results) = self.running(&sweep.routine, &format_ident!("constants"));
        let (mut by_state, mut by_constants) = (vec![quote!(S::from_f64(0.0)); self.states.len()], TokenStream::new());
        for (leaf, result) in sweep.leaves.iter().zip(results) {
            match *leaf {
                Operand::Symbol(Symbol::State(index)) => by_state[index as usize] = result,
                Operand::Constant(index) => {
                    let index = Literal::u32_unsuffixed(index);
                    by_constants.extend(quote!(by_constants[#index] = by_constants[#index] + #result;));
                }
                _ => unreachable!("functions of a running model read states and constants"),
            }
        }
        quote! {
            #[inline(always)]
            fn #name(
                &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], weights: &[S; #weights],
                by_state: &mut SVector<S, #n>, by_constants: &mut [S; #constants],
            ) {
                #body
                by_state.data.0 = [[#(#by_state),*]];
                #by_constants
            }
        }
    }

    /// The function that follows a projection backwards; nothing where there is none.
    fn reverse_project(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let (running, constants) = (&self.model.programs.running, self.constant_count());
        let (posed, settled) = (&self.tables.projected, &self.tables.settled);
        let back = |name: &str, moved: &[usize]| {
            let name = format_ident!("sweep_{name}");
            let moved: Vec<_> = moved.iter().copied().map(Literal::usize_unsuffixed).collect();
            quote! {
                self.#name(t, state, negative, &[#(weights[#moved]),*], &mut by_state, by_constants);
                #(weights[#moved] = S::from_f64(0.0);)*
                for (weight, by) in weights.iter_mut().zip(by_state.iter()) {
                    *weight = *weight + *by;
                }
            }
        };
        if posed.is_empty() && settled.is_empty() {
            return None;
        }
        let settle = (!settled.is_empty()).then(|| {
            let (pose, back) = (self.projection(&running.project, posed), back("settle", settled));
            quote! {
                {
                    let state = &mut x.clone();
                    #pose
                    #back
                }
            }
        });
        let pose = (!posed.is_empty()).then(|| {
            let back = back("project", posed);
            quote! {
                {
                    let state = x;
                    #back
                }
            }
        });
        Some(quote! {
            fn reverse_project(
                &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], weights: &mut SVector<S, #n>,
                by_constants: &mut [S],
            ) {
                let by_constants: &mut [S; #constants] = by_constants.try_into().expect("a number for each constant");
                let mut by_state = SVector::repeat(S::from_f64(0.0));
                #settle
                #pose
            }
        })
    }
}
