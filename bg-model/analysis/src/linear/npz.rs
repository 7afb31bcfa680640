//! A linear model as arrays of numpy.
//!
//! In: a linear model. Out: the bytes of an `.npz` file: `numpy.load(..)` gives A, B, C, D, eigenvalues, names, the
//! state.

use std::io::Error;

use super::state_space::{Named, StateSpace};
use crate::npz::{Array, archive};

impl StateSpace {
    /// The bytes of an `.npz` file with the arrays `A`, `B`, `C`, `D`, `eigenvalues` (complex, both of a pair),
    /// `states`, `inputs`, `outputs` and their units `state_units`, `input_units`, `output_units`; of the operating
    /// point `t`, `point` (all states), `point_names`, `point_rates`.
    ///
    /// # Errors
    /// None in practice: writing to memory does not fail.
    pub fn npz(&self) -> Result<Vec<u8>, Error> {
        let mut eigenvalues = Vec::new();
        for mode in &self.modes {
            eigenvalues.push([mode.real, mode.imaginary]);
            if mode.imaginary > 0.0 {
                eigenvalues.push([mode.real, -mode.imaginary]);
            }
        }
        let column = |value: fn(&super::state_space::PointState) -> f64| {
            let values: Vec<f64> = self.point.iter().map(value).collect();
            Array::numbers(&[values.len()], &values)
        };
        let mut arrays = vec![
            ("A", Array::matrix(&self.a)),
            ("B", Array::matrix(&self.b)),
            ("C", Array::matrix(&self.c)),
            ("D", Array::matrix(&self.d)),
            ("eigenvalues", Array::complex(&eigenvalues)),
            ("t", Array::numbers(&[], &[self.t])),
            ("point", column(|state| state.value)),
            ("point_rates", column(|state| state.rate)),
            ("point_names", Array::texts(self.point.iter().map(|state| state.name.as_str()))),
        ];
        let named = [
            ("states", "state_units", &self.states),
            ("inputs", "input_units", &self.inputs),
            ("outputs", "output_units", &self.outputs),
        ];
        for (names, units, of) in named {
            arrays.push((names, Array::texts(of.iter().map(|Named { name, .. }| name.as_str()))));
            arrays.push((units, Array::texts(of.iter().map(|Named { unit, .. }| unit.as_str()))));
        }
        archive(&arrays)
    }
}
