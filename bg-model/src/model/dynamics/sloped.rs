//! A system with slopes in vectors, over slices.
//!
//! In: a [`System`] in a scalar whose slopes are vectors of the machine. Out: [`InVectors`], each of whose functions is
//! compiled for these vectors.

use nalgebra::{ArrayStorage, SVector};
use pulp::NullaryFnOnce;

use super::inlined;
use crate::model::scalar::slopes::Slopes;
use crate::model::scalar::{GradientIn, Scalar};
use crate::model::system::{System, switches};

/// A system as a step of a state with slopes in the vectors `V` asks for it, over slices: each of its functions is
/// compiled for these vectors.
///
/// # Panics
/// As [`Dynamics`](super::Dynamics).
pub trait Rates<V> {
    /// [`System::rate`] at time `t` (s).
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]);

    /// [`System::project`] at time `t` (s).
    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]);
}

/// A system whose numbers are in its type, as steps with slopes ask for it.
#[derive(Clone, Copy, Debug)]
pub struct InVectors<Sys, const N: usize, const G: usize>(pub Sys);

impl<V: Slopes, Sys: System<GradientIn<V>, N, G>, const N: usize, const G: usize> Rates<V> for InVectors<Sys, N, G> {
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]) {
        V::vectorized(SlopedRate::<V, Sys, N, G> { system: &self.0, t, x, negative: switches(negative), dx });
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]) {
        V::vectorized(SlopedProjection::<V, Sys, N, G> { system: &self.0, t, negative: switches(negative), x });
    }
}

// Closures are not inlined into what is compiled for vectors.

struct SlopedRate<'a, V, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: f64,
    x: &'a [GradientIn<V>],
    negative: &'a [bool; G],
    dx: &'a mut [GradientIn<V>],
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for SlopedRate<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (t, x) = (GradientIn::from_f64(self.t), state(self.x));
        let mut rates = x;
        if V::MUST_BE_INLINED {
            inlined::rate(self.system, t, &x, self.negative, &mut rates);
        } else {
            self.system.rate(t, &x, self.negative, &mut rates);
        }
        self.dx.copy_from_slice(&rates.data.0[0]);
    }
}

struct SlopedProjection<'a, V, Sys, const N: usize, const G: usize> {
    system: &'a Sys,
    t: f64,
    negative: &'a [bool; G],
    x: &'a mut [GradientIn<V>],
}

impl<V, Sys, const N: usize, const G: usize> NullaryFnOnce for SlopedProjection<'_, V, Sys, N, G>
where
    V: Slopes,
    Sys: System<GradientIn<V>, N, G>,
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (t, mut x) = (GradientIn::from_f64(self.t), state(self.x));
        if V::MUST_BE_INLINED {
            inlined::project(self.system, t, self.negative, &mut x);
        } else {
            self.system.project(t, self.negative, &mut x);
        }
        self.x.copy_from_slice(&x.data.0[0]);
    }
}

/// The numbers of all states as a system takes them; a copy, which is none where it is inlined.
#[inline(always)]
fn state<S: Copy, const N: usize>(of: &[S]) -> SVector<S, N> {
    SVector::from_array_storage(ArrayStorage([*of.first_chunk().expect("there is a number for each state")]))
}
