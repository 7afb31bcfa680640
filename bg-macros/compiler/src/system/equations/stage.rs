//! How far state equations have come, as types: each stage takes what the one before it gives.
//!
//! In: [`StateEquations`] of a graph, or reduced to what a scene needs. Out: [`Solved`], [`Projected`], [`Ordered`],
//! [`Closed`], in this order. All of them can be read as equations.

use std::ops::{Deref, DerefMut};

use super::StateEquations;
use crate::fault::Staged;

/// Equations whose reactions are solved for. They are symbols, each with its value.
#[derive(Clone, Debug)]
pub struct Solved(pub(crate) StateEquations);

/// The same, with what brings a state back onto what rigid joints hold.
#[derive(Clone, Debug)]
pub struct Projected(pub(crate) StateEquations);

/// The same, states of one kind side by side: the equations that a model integrates.
#[derive(Clone, Debug)]
pub struct Ordered(pub(crate) StateEquations);

/// The same, with the values of the reactions in the places of their symbols, as programs evaluate them.
#[derive(Clone, Debug)]
pub struct Closed(StateEquations);

impl Solved {
    /// Decides what is asked of values that are numbers now.
    ///
    /// # Errors
    /// The faults of what does not hold.
    pub fn decide_requirements(&mut self) -> Staged<()> {
        self.0.requirements.decide(&self.0.parameters)
    }
}

impl Ordered {
    /// Puts the reactions' values in the places of their symbols.
    #[must_use]
    pub fn close(mut self) -> Closed {
        self.0.close();
        Closed(self.0)
    }
}

macro_rules! read_as_equations {
    ($($stage:ident)*) => { $(
        impl Deref for $stage {
            type Target = StateEquations;

            fn deref(&self) -> &StateEquations {
                &self.0
            }
        }
    )* };
}

read_as_equations!(Solved Projected Ordered Closed);

/// Pools gain nodes where programs are made.
impl DerefMut for Closed {
    fn deref_mut(&mut self) -> &mut StateEquations {
        &mut self.0
    }
}
