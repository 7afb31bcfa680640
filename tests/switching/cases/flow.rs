//! A system given by closures.
//!
//! In: a rate, guards, the states' names. Out: a [`System`] of states and switches, its Jacobian by differences.
//! The closures are boxed, so that problems of equal size are one type and the driver is compiled once for them.

use bg_model::capability::Named;
use bg_model::nalgebra::SVector;
use bg_model::system::System;

/// A guard of time (s) and state.
pub type Guard = fn(f64, &[f64]) -> f64;
/// A rate of time (s), state and branches.
type Rate<const N: usize, const G: usize> = Box<dyn Fn(f64, &[f64; N], &[bool; G]) -> [f64; N]>;

/// States whose rates are a function of time, state and branches.
pub struct Flow<const N: usize, const G: usize> {
    names: [&'static str; N],
    guards: [Guard; G],
    rate: Rate<N, G>,
}

impl<const N: usize, const G: usize> Flow<N, G> {
    /// The states `names` with their `rate`, and one switch for each guard.
    #[must_use]
    pub fn new(
        names: [&'static str; N],
        guards: [Guard; G],
        rate: impl Fn(f64, &[f64; N], &[bool; G]) -> [f64; N] + 'static,
    ) -> Self {
        Self { names, guards, rate: Box::new(rate) }
    }
}

impl<const N: usize, const G: usize> System<f64, N, G> for Flow<N, G> {
    fn rate(&self, t: f64, x: &SVector<f64, N>, negative: &[bool; G], dx: &mut SVector<f64, N>) {
        *dx = SVector::from((self.rate)(t, &x.data.0[0], negative));
    }

    fn guards(&self, t: f64, x: &SVector<f64, N>, _: &[bool; G], guards: &mut SVector<f64, G>) {
        *guards = SVector::from(self.guards.map(|guard| guard(t, x.as_slice())));
    }

    fn named(&self) -> Option<&impl Named<f64, N, G>> {
        Some(self)
    }
}

impl<const N: usize, const G: usize> Named<f64, N, G> for Flow<N, G> {
    fn state_name(&self, index: usize) -> &'static str {
        self.names[index]
    }
}
