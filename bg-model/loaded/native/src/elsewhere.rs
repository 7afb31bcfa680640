//! Machines without a back end: nothing is translated.

use crate::program::{Inputs, Program};

/// A program in machine code: there is none on this machine.
#[derive(Debug)]
pub enum Function {}

impl Function {
    /// None.
    #[must_use]
    pub fn of(_program: &Program) -> Option<Self> {
        None
    }

    /// Never called.
    #[must_use]
    pub fn appended(&self) -> &[(u32, bool)] {
        match *self {}
    }

    /// Never called.
    #[must_use]
    pub fn operations(&self) -> usize {
        match *self {}
    }

    /// Never called.
    pub fn call(&self, _inputs: Inputs<'_>, _results: &mut [f64]) {
        match *self {}
    }
}
