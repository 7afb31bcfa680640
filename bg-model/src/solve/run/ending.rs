//! What ends a run before its end: a condition of its outputs.
//!
//! In: a model, a function of its outputs. Out: the same as a function of time, state and branches.

use std::ops::Index;

use crate::model::description::OutputInfo;
use crate::model::dynamics::Machine;

/// A model at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    outputs: &'a [f64],
    infos: &'static [OutputInfo],
}

impl Index<&str> for Sample<'_> {
    type Output = f64;

    /// The output called `name`, in its unit.
    ///
    /// # Panics
    /// There is no such output.
    fn index(&self, name: &str) -> &f64 {
        let names = || self.infos.iter().map(|info| info.name).collect::<Vec<_>>().join(", ");
        let index = self.infos.iter().position(|info| info.name == name);
        &self.outputs[index.unwrap_or_else(|| panic!("the model has no output `{name}`; it has {}", names()))]
    }
}

/// A function of the outputs, which ends a run where it passes through zero.
pub(super) type Ending<'a> = Box<dyn FnMut(&Sample<'_>) -> f64 + 'a>;

/// The same of time (s), state and branches.
pub(super) fn of_state<'a>(
    model: &'a dyn Machine,
    mut ending: Ending<'a>,
) -> impl FnMut(f64, &[f64], &[bool]) -> f64 + 'a {
    let infos = model.description().outputs;
    let mut outputs = vec![0.0; infos.len()];
    move |t, x, negative| {
        model.outputs(t, x, negative, &mut outputs);
        ending(&Sample { t, outputs: &outputs, infos })
    }
}
