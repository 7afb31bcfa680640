//! A system whose numbers are those of several runs side by side, over slices.
//!
//! In: a [`System`] in such numbers. Out: [`InLanes`], each of whose functions is compiled for their vectors.

use core::ops::Range;

use nalgebra::SVector;
use pulp::NullaryFnOnce;

use super::inlined;
use crate::model::capability::{Joints, SecondOrder};
use crate::model::holding::Held;
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::model::system::System;

/// A system as runs side by side in the vectors `V` ask for it, over slices: each of its functions is compiled for
/// these vectors.
///
/// # Panics
/// As [`Dynamics`](super::Dynamics).
pub trait Abreast<V: Vector> {
    /// The number of states.
    fn states(&self) -> usize;

    /// The number of switches.
    fn switches(&self) -> usize;

    /// [`System::rate`].
    fn rate(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]);

    /// [`System::guards`].
    fn guards(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], guards: &mut [Lanes<V>]);

    /// [`System::project`].
    fn project(&self, t: Lanes<V>, negative: &[V::Mask], x: &mut [Lanes<V>]);

    /// [`SecondOrder::states`]; an empty range where none are known.
    fn second(&self) -> Range<usize>;

    /// [`SecondOrder::second_derivatives`].
    fn second_derivatives(&self, x: &[Lanes<V>], dx: &mut [Lanes<V>]);

    /// [`SecondOrder::forces`]; the rate where no states of second order are known.
    fn forces(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]);

    /// [`Joints::held`]; none where joints hold nothing.
    fn held(&self) -> Option<Held>;

    /// [`Joints::kept`].
    fn kept(&self) -> &[f64];

    /// [`Joints::is_hold_inlined`].
    fn is_hold_inlined(&self) -> bool;

    /// [`Joints::hold`], if it is inlined.
    fn hold(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], entries: &mut [Lanes<V>]);
}

/// A system whose numbers are in its type, as runs side by side ask for it.
#[derive(Clone, Copy, Debug)]
pub struct InLanes<Sys, const N: usize, const G: usize>(pub Sys);

impl<V: Vector, Sys: System<Lanes<V>, N, G>, const N: usize, const G: usize> Abreast<V> for InLanes<Sys, N, G> {
    fn states(&self) -> usize {
        N
    }

    fn switches(&self) -> usize {
        G
    }

    fn rate(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]) {
        V::vectorized(Rate::<_, V, N, G>(Asked { of: &self.0, t, x, negative, to: dx }));
    }

    fn guards(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], guards: &mut [Lanes<V>]) {
        V::vectorized(Guards::<_, V, N, G>(Asked { of: &self.0, t, x, negative, to: guards }));
    }

    fn project(&self, t: Lanes<V>, negative: &[V::Mask], x: &mut [Lanes<V>]) {
        V::vectorized(Projection::<_, V, N, G>(Asked { of: &self.0, t, x: &[], negative, to: x }));
    }

    fn second(&self) -> Range<usize> {
        self.0.second_order().map_or(0..0, |second| second.states())
    }

    fn second_derivatives(&self, x: &[Lanes<V>], dx: &mut [Lanes<V>]) {
        if let Some(second) = self.0.second_order() {
            let asked = Asked { of: second, t: Lanes::from_f64(0.0), x, negative: &[], to: dx };
            V::vectorized(SecondDerivatives::<_, V, N, G>(asked));
        }
    }

    fn forces(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], dx: &mut [Lanes<V>]) {
        match self.0.second_order() {
            Some(second) => V::vectorized(Forces::<_, V, N, G>(Asked { of: second, t, x, negative, to: dx })),
            None => self.rate(t, x, negative, dx),
        }
    }

    fn held(&self) -> Option<Held> {
        self.0.joints().map(Joints::held)
    }

    fn kept(&self) -> &[f64] {
        self.0.joints().map_or(&[], Joints::kept)
    }

    fn is_hold_inlined(&self) -> bool {
        self.0.joints().is_some_and(Joints::is_hold_inlined)
    }

    fn hold(&self, t: Lanes<V>, x: &[Lanes<V>], negative: &[V::Mask], entries: &mut [Lanes<V>]) {
        if let Some(joints) = self.0.joints() {
            V::vectorized(Hold::<_, V, N, G>(Asked { of: joints, t, x, negative, to: entries }));
        }
    }
}

/// The numbers of all states as a system takes them; a copy, which is none where it is inlined.
#[inline(always)]
fn whole<V: Vector, const N: usize>(of: &[Lanes<V>]) -> SVector<Lanes<V>, N> {
    SVector::from(*of.first_chunk().expect("there is a number for each state"))
}

/// The branches in an array.
#[inline(always)]
fn each<T, const G: usize>(negative: &[T]) -> &[T; G] {
    negative.try_into().expect("there is a branch for each switch")
}

// Closures are not inlined into what is compiled for vectors.

/// What is asked of a system, or of what it knows of itself, at a time and state in branches; where it is written.
struct Asked<'a, C, V: Vector> {
    of: &'a C,
    t: Lanes<V>,
    x: &'a [Lanes<V>],
    negative: &'a [V::Mask],
    to: &'a mut [Lanes<V>],
}

/// Functions that are compiled for vectors: closures are not inlined into what is.
macro_rules! compiled_for_vectors {
    ($($name:ident: $capability:ident<$($number:ident),*>, |$asked:ident| $call:expr;)*) => { $(
        struct $name<'a, C, V: Vector, const N: usize, const G: usize>(Asked<'a, C, V>);

        impl<C, V, const N: usize, const G: usize> NullaryFnOnce for $name<'_, C, V, N, G>
        where
            C: $capability<Lanes<V>, $($number),*>,
            V: Vector,
        {
            type Output = ();

            #[inline(always)]
            fn call(self) {
                let $asked = self.0;
                $call
            }
        }
    )* };
}

compiled_for_vectors! {
    Rate: System<N, G>, |asked| {
        let mut rate = SVector::from([asked.t; N]);
        inlined::rate(asked.of, asked.t, &whole(asked.x), each(asked.negative), &mut rate);
        asked.to.copy_from_slice(&rate.data.0[0]);
    };
    Guards: System<N, G>, |asked| {
        let mut guards = SVector::from([asked.t; G]);
        asked.of.guards(asked.t, &whole(asked.x), each(asked.negative), &mut guards);
        asked.to.copy_from_slice(&guards.data.0[0]);
    };
    Projection: System<N, G>, |asked| {
        let mut state = whole::<V, N>(asked.to);
        inlined::project(asked.of, asked.t, each(asked.negative), &mut state);
        asked.to.copy_from_slice(&state.data.0[0]);
    };
    SecondDerivatives: SecondOrder<N, G>, |asked| {
        let mut rate = whole(asked.to);
        asked.of.second_derivatives(&whole(asked.x), &mut rate);
        asked.to.copy_from_slice(&rate.data.0[0]);
    };
    Forces: SecondOrder<N, G>, |asked| {
        let mut rate = SVector::from([asked.t; N]);
        asked.of.forces(asked.t, &whole(asked.x), each(asked.negative), &mut rate);
        asked.to.copy_from_slice(&rate.data.0[0]);
    };
    Hold: Joints<N, G>, |asked| asked.of.inlined_hold(asked.t, &whole(asked.x), each(asked.negative), asked.to);
}
