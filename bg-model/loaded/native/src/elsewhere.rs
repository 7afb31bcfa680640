//! Machines without a back end: nothing is translated.

use crate::function::Entry;
use crate::steps::Steps;

/// The machine at hand: there is none.
pub enum Machine {}

/// What it compiles: nothing.
pub enum Compiled {}

impl Machine {
    pub fn at_hand() -> Option<Self> {
        None
    }

    pub fn compiled(&self, _steps: &Steps) -> Option<Compiled> {
        match *self {}
    }
}

impl Compiled {
    pub fn entry(&self) -> Entry {
        match *self {}
    }
}
