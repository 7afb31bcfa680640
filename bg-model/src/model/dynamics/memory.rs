//! What a system remembers, over slices.
//!
//! In: its [`Memories`], if it has any. Out: the states, clocks and delays as [`Dynamics`](super::Dynamics) lists them.

use alloc::vec::Vec;

use crate::model::capability::Memories;
use crate::model::clock::{self, Clock};
use crate::model::delay::{self, Delay};
use crate::model::scalar::Scalar;

/// The states that projection sets.
pub(super) fn states<S: Scalar>(of: Option<&impl Memories<S>>) -> Vec<usize> {
    of.map_or_else(Vec::new, |memories| memories.states().to_vec())
}

/// The clocks but for those of delays.
pub(super) fn clocks<S: Scalar>(of: Option<&impl Memories<S>>) -> Vec<Clock<S>> {
    of.map_or_else(Vec::new, |memories| delay::without(all_clocks(memories), memories.delays()))
}

/// The delays of signals.
pub(super) fn delays<S: Scalar>(of: Option<&impl Memories<S>>) -> Vec<Delay<S>> {
    of.map_or_else(Vec::new, |memories| delay::listed(&all_clocks(memories), memories.delays()))
}

fn all_clocks<S: Scalar>(memories: &impl Memories<S>) -> Vec<Clock<S>> {
    clock::listed(memories.clocks(), &|instants| memories.instants(instants))
}
