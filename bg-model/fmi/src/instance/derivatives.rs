//! Partial derivatives of derivatives, outputs and event indicators by states and inputs, along a direction and against
//! it.
//!
//! In: unknowns, knowns, seeds. Out: sensitivities: J s, or J^T s. The latter takes a column of J for each known.

use super::{Fault, Instance, same_length};
use crate::variables::VariableKind;

impl Instance {
    /// Writes J `seed` into `sensitivity`, where J has a row for each of `unknowns` and a column for each of `knowns`.
    ///
    /// # Errors
    /// [`Fault::Length`], [`Fault::Reference`], [`Fault::Derivative`].
    pub fn directional(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        same_length("the seed", seed.len(), knowns.len())?;
        same_length("the sensitivities", sensitivity.len(), unknowns.len())?;
        let (mut states, mut inputs) = (vec![0.0; self.counts.states], vec![0.0; self.counts.inputs]);
        for (&known, seed) in knowns.iter().zip(seed) {
            match self.counts.kind(known).ok_or(Fault::Reference(known))? {
                VariableKind::State(index) => states[index] += seed,
                VariableKind::Input(index) => inputs[index] += seed,
                _ => return Err(self.no_derivative(unknowns, known)),
            }
        }
        let (counts, signals) = (self.counts, self.signals.clone());
        let made = self.made()?;
        let along = made.slopes.along(&made.machine, &signals, &states, &inputs);
        for (&unknown, sensitivity) in unknowns.iter().zip(sensitivity) {
            *sensitivity = match counts.kind(unknown).ok_or(Fault::Reference(unknown))? {
                VariableKind::Derivative(index) => along.rates[index],
                VariableKind::Output(index) => along.outputs[index],
                VariableKind::Guard(index) => along.guards[index],
                _ => return Err(self.no_derivative(&[unknown], knowns.first().copied().unwrap_or(0))),
            };
        }
        Ok(())
    }

    /// Writes J^T `seed` into `sensitivity`, J as above.
    ///
    /// # Errors
    /// As [`Instance::directional`].
    pub fn adjoint(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        sensitivity: &mut [f64],
    ) -> Result<(), Fault> {
        same_length("the seed", seed.len(), unknowns.len())?;
        same_length("the sensitivities", sensitivity.len(), knowns.len())?;
        let mut column = vec![0.0; unknowns.len()];
        for (known, sensitivity) in knowns.iter().zip(sensitivity) {
            self.directional(unknowns, std::slice::from_ref(known), &[1.0], &mut column)?;
            *sensitivity = column.iter().zip(seed).map(|(entry, seed)| entry * seed).sum();
        }
        Ok(())
    }

    fn no_derivative(&self, unknowns: &[u32], known: u32) -> Fault {
        let unknown = unknowns.first().map_or_else(String::new, |&unknown| self.name(unknown));
        Fault::Derivative { unknown, known: self.name(known) }
    }
}
