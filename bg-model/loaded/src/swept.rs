//! An interpreted model whose runs are followed backwards.
//!
//! In: the sweeps of its programs, weights of what these give. Out: [`Swept`], with the bits of generated code.

use std::cell::RefCell;

use bg_compiler::expr::Symbol;
use bg_compiler::program::Operand;
use bg_model::dynamics::Swept;

use crate::blueprint::Sweep;
use crate::interpreted::{Interpreted, Moment, Own};

impl Interpreted {
    /// Writes the derivatives by the states of a weighted sum of what a program gives, and adds those by the constants.
    fn sweep(
        &self,
        sweep: &Sweep,
        row: &Own<f64>,
        moment: Moment<'_, f64>,
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) {
        let row = row.get_or_init(|| RefCell::new(sweep.code.row(&self.constants, self.back_end)));
        by_state.fill(0.0);
        for (leaf, value) in sweep.leaves.iter().zip(self.listed(&sweep.code, row, moment)) {
            match *leaf {
                Operand::Symbol(Symbol::State(index)) => by_state[index as usize] = value,
                Operand::Constant(index) => by_constants[index as usize] += value,
                _ => unreachable!("programs of a running model read states and constants"),
            }
        }
    }

    /// Follows one part of a projection backwards, which moves these states and begins at those of `moment`.
    fn back(
        &self,
        (sweep, row, moved): (&Sweep, &Own<f64>, &[usize]),
        moment: Moment<'_, f64>,
        weights: &mut [f64],
        by_constants: &mut [f64],
    ) {
        if moved.is_empty() {
            return;
        }
        let of_moved: Vec<f64> = moved.iter().map(|&state| weights[state]).collect();
        let mut by_state = vec![0.0; weights.len()];
        self.sweep(sweep, row, Moment { weights: &of_moved, ..moment }, &mut by_state, by_constants);
        moved.iter().for_each(|&state| weights[state] = 0.0);
        weights.iter_mut().zip(by_state).for_each(|(weight, by)| *weight += by);
    }
}

impl Swept for Interpreted {
    fn reverse_rate(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) {
        let moment = Moment { weights, ..Moment::at(t, x, negative) };
        self.sweep(&self.programs().sweeps.rate, &self.rows.reverse_rate, moment, by_state, by_constants);
    }

    fn reverse_project(&self, t: f64, x: &[f64], negative: &[bool], weights: &mut [f64], by_constants: &mut [f64]) {
        let (blueprint, rows, sweeps) = (&self.blueprint, &self.rows, &self.programs().sweeps);
        let mut posed = x.to_vec();
        self.pose(t, negative, &mut posed);
        let settle = (&sweeps.settle, &rows.reverse_settle, &blueprint.settled[..]);
        self.back(settle, Moment::at(t, &posed, negative), weights, by_constants);
        let pose = (&sweeps.project, &rows.reverse_project, &blueprint.projected[..]);
        self.back(pose, Moment::at(t, x, negative), weights, by_constants);
    }

    fn reverse_outputs(
        &self,
        t: f64,
        x: &[f64],
        negative: &[bool],
        weights: &[f64],
        by_state: &mut [f64],
        by_constants: &mut [f64],
    ) -> bool {
        let Some(sweep) = &self.programs().sweeps.outputs else { return false };
        let moment = Moment { weights, ..Moment::at(t, x, negative) };
        self.sweep(sweep, &self.rows.reverse_outputs, moment, by_state, by_constants);
        true
    }
}
