//! The programs of a model: what each generated function evaluates, in order.
//!
//! In: equations and their derivatives. Out: [`Programs`], straight-line code for each function, and a [`Tape`] for
//! pictures. Method: `bg_expressions::schedule`.

mod changes;
mod deferred;
mod programs;
mod reversed;
pub mod series;
mod tape;

pub use bg_expressions::elimination;
pub use bg_expressions::schedule::{
    Assignment, Counts, Operand, Operation, Program, Request, Reverse, Routine, batches, pairs, repetition, reverse,
    schedule,
};
pub use changes::Changes;
pub use deferred::{Deferred, deferred};
pub use programs::{Derivatives, Pairs, Programs, Running, SecondOrderPrograms, Starting, programs, rate_operations};
pub use reversed::{Reversed, reversed};
pub use series::{SeriesSize, series_size};
pub use tape::Tape;
