//! The start of a model: the pose that closes its joints, the velocities that fit them, what they hold.
//!
//! In: gaps, unknowns, held motions. Out: the functions that make the start, `start` and `impulse_energy` of the model,
//! and `Joints` for the model.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::items::identifier;
use super::shared::closing;
use super::system::Inlined;
use super::{Emission, Shape};
use crate::expr::{Symbol, substitute};
use crate::program::{Program, Programs};
use crate::system::equations::{Kind, Slip};

impl Emission<'_> {
    /// Guesses, gaps, start state and what is asked of values, each with its constants inside.
    pub(super) fn starting(&self) -> TokenStream {
        let (unknowns, parameters) = (self.model.equations.guesses.len(), &self.shape.p);
        let Programs { starting, required, .. } = &self.model.programs;
        let functions = starting.programs().chain(required.iter().flatten()).map(|program| {
            let [routine] = &program.routines;
            let function = identifier(&routine.name);
            let constants = self.own_constants(program);
            let (statements, results) = self.body(routine);
            let length = results.len();
            quote! {
                fn #function(parameters: &[S; #parameters], u: &[S; #unknowns]) -> [S; #length] {
                    #constants
                    #statements
                    [#(#results),*]
                }
            }
        });
        quote! { #(#functions)* }
    }

    /// The functions of the trait that give the start, and before them what they share.
    pub(super) fn start(&self) -> (TokenStream, TokenStream) {
        let n = &self.shape.n;
        let (closed, lifted) = (self.closed_pose(), lifted());
        if self.model.programs.holding.is_none() {
            let start = quote! {
                fn start(&self) -> Result<SVector<S, #n>, ::bg_model::assembly::AssemblyError> {
                    #closed
                    #lifted
                    Ok(SVector::from(Self::start_state(&self.values, &unknowns)))
                }
            };
            return (start, TokenStream::new());
        }
        let speeds = self.model.equations.speeds.iter().map(|&index| Literal::usize_unsuffixed(index));
        let (count, impulse) = (self.model.equations.guesses.len(), self.model.equations.impulse);
        let started = quote! {
            impl<S: Scalar> Model<S> {
                /// The start state, and what it took to make it fit.
                fn started(&self)
                    -> Result<::bg_model::__private::Started<S, #n>, ::bg_model::assembly::AssemblyError>
                {
                    #closed
                    #lifted
                    let state = |unknowns: &[S; #count]| SVector::from(Self::start_state(&self.values, unknowns));
                    ::bg_model::__private::fit(self, unknowns, [#(#speeds),*], state, #impulse)
                }
            }
        };
        let start = quote! {
            fn start(&self) -> Result<SVector<S, #n>, ::bg_model::assembly::AssemblyError> {
                Ok(self.started()?.x)
            }
            fn impulse_energy(&self) -> Result<S, ::bg_model::assembly::AssemblyError> {
                Ok(self.started()?.lost)
            }
        };
        (start, started)
    }

    /// `let unknowns`: the guesses, those of the pose moved until the joints are closed.
    pub(super) fn closed_pose(&self) -> TokenStream {
        let gaps = self.model.equations.gaps.iter().map(|gap| {
            let (joint, component, unit) = (&gap.joint, gap.component, &gap.unit);
            quote!(::bg_model::assembly::Gap { joint: #joint, component: #component, unit: #unit })
        });
        let guess = quote! {
            static GAPS: &[::bg_model::assembly::Gap] = &[#(#gaps),*];
            let numbers = self.parameters.numbers();
            let guess = Model::<f64>::guesses(&numbers, &::core::array::from_fn(|_| 0.0));
        };
        let (speeds, required) = (&self.model.equations.speeds, self.required_at_start());
        if speeds.is_empty() {
            return quote! {
                #guess
                let unknowns = ::bg_model::assembly::close(guess, GAPS, |unknowns, gaps| {
                    gaps.copy_from_slice(&Model::<f64>::gaps(&numbers, unknowns));
                }, |unknowns, sizes| sizes.copy_from_slice(&Model::<f64>::gap_sizes(&numbers, unknowns)))?;
                #required
            };
        }
        let poses = (0..self.model.equations.guesses.len()).filter(|index| !speeds.contains(index));
        let poses: Vec<Literal> = poses.map(Literal::usize_unsuffixed).collect();
        let (count, places) = (poses.len(), (0..poses.len()).map(Literal::usize_unsuffixed));
        quote! {
            #guess
            let whole = |poses: &[f64; #count]| {
                let mut unknowns = guess;
                #(unknowns[#poses] = poses[#places];)*
                unknowns
            };
            let poses = ::bg_model::assembly::close([#(guess[#poses]),*], GAPS, |poses, gaps| {
                gaps.copy_from_slice(&Model::<f64>::gaps(&numbers, &whole(poses)));
            }, |poses, sizes| sizes.copy_from_slice(&Model::<f64>::gap_sizes(&numbers, &whole(poses))))?;
            let unknowns = whole(&poses);
            #required
        }
    }

    /// The indices of the states of these kinds.
    fn states_of(&self, kinds: &[Kind]) -> TokenStream {
        let states = self.model.equations.states.iter().enumerate();
        let indices = states.filter(|(_, state)| kinds.contains(&state.origin.kind())).map(|(index, _)| index);
        let indices = indices.map(Literal::usize_unsuffixed);
        quote!(&[#(#indices),*])
    }

    /// Whether sources give flows: whether something moves, or is to move, where the momenta that joints change are
    /// zero.
    fn is_driven(&self) -> bool {
        let equations = &self.model.equations;
        let is_of_pose = |kind| matches!(kind, Kind::Position | Kind::Orientation | Kind::Angle);
        let pose = equations.states.iter().filter(|state| is_of_pose(state.origin.kind())).map(|state| state.rate);
        let flows = equations.holding.rigid.iter().map(|slip| slip.flow);
        let mut pool = equations.pool.clone();
        let zero = pool.zero();
        let is_moved = |state: usize| equations.holding.moves.iter().any(|(moved, _)| *moved == state);
        let at_rest = |symbol: Symbol| symbol.as_state().filter(|&state| is_moved(state)).map(|_| zero);
        let given = substitute(&mut pool, &pose.chain(flows).collect::<Vec<_>>(), &at_rest);
        given.into_iter().any(|flow| !pool.is_zero(flow))
    }

    /// What the joints hold.
    pub(super) fn joints(&self) -> TokenStream {
        let Some(Program { routines: [routine], .. }) = &self.model.programs.holding else { return TokenStream::new() };
        let Shape { n, g, .. } = &self.shape;
        let holding = &self.model.equations.holding;
        let (rigid, compliant) = (slips(&holding.rigid), slips(&holding.compliant));
        let moved = holding.moves.iter().map(|(state, _)| Literal::usize_unsuffixed(*state));
        let closing = closing(&holding.rigid);
        let pose = self.states_of(&[Kind::Position, Kind::Orientation, Kind::Angle, Kind::Displacement, Kind::Way]);
        let turning = self.states_of(&[Kind::Orientation, Kind::Angle]);
        let (kept, is_driven) = (self.kept(), self.is_driven());
        let (body, entries) = self.running(routine, &format_ident!("holding_constants"));
        let arguments = quote!(&self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], entries: &mut [S]);
        let written = quote! {
            #body
            entries.copy_from_slice(&[#(#entries),*]);
        };
        let hold = if routine.is_long() {
            quote! {
                #[inline(never)]
                fn hold(#arguments) { #written }
            }
        } else {
            let inline = Inlined;
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
                    ::bg_model::holding::Held { rigid: &[#rigid], compliant: &[#compliant], moved: &[#(#moved),*], pose: #pose, turning: #turning, closing: #closing, is_driven: #is_driven }
                }
                #kept
                #hold
            }
        }
    }
}

/// `let unknowns` in the scalar: with what they are more than numbers, as derivatives.
pub(super) fn lifted() -> TokenStream {
    quote! {
        let guess = Self::guesses(&self.values, &::core::array::from_fn(|_| S::from_f64(0.0)));
        let unknowns = ::bg_model::__private::lifted(guess, unknowns, |unknowns| {
            ::bg_model::__private::vec::Vec::from(Self::gaps(&self.values, unknowns))
        });
    }
}

fn slips(of: &[Slip]) -> TokenStream {
    let each = of.iter().map(|Slip { joint, direction, unit, .. }| {
        quote!(::bg_model::holding::Slip { joint: #joint, direction: #direction, unit: #unit },)
    });
    each.collect()
}
