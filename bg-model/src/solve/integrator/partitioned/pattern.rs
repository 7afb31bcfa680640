//! Which states are damped stiffly.
//!
//! In: a Jacobian and a step. Out: the states, and where their block of the Jacobian is.

use alloc::vec;
use alloc::vec::Vec;

use super::places::{LANES, Places};
use crate::model::linear::Sparsity;
use crate::model::scalar::double::power;
use crate::solve::integrator::Flow;
use crate::solve::integrator::linear::Jacobian;

/// States are damped stiffly where dampers would take away this part of them in a step. Explicit steps bear about ten
/// times as much.
const STIFF: f64 = 0.25;

/// This part of the square of it keeps states that are chosen already, so that the choice does not swing.
const KEPT: f64 = 0.1;
/// States that such weaker dampers connect to chosen ones are chosen with them.
const WEAK: f64 = 0.025;

/// A row and a column.
type RowColumn = (usize, usize);

/// The places of a Jacobian.
#[derive(Clone, Debug, Default)]
pub(super) struct Pattern {
    /// Row and column of each entry.
    places: Vec<RowColumn>,
    /// The entries in places that mirror each other, with the place of the first one, those of displacements and
    /// orientations left out; one on the diagonal mirrors itself.
    mirrored: Vec<(usize, usize, RowColumn)>,
    /// The dampers that count in a step, as squares of 1/s.
    dampers: Vec<(RowColumn, f64)>,
    /// Of each state whether it is chosen; to be written by each choice.
    damped: Vec<bool>,
}

impl Pattern {
    /// Writes the entries of a Jacobian whose places are known from here on; with unknowns beside the states those of
    /// the states alone.
    pub fn entries(&mut self, flow: &Flow<'_>, jacobian: &Jacobian, entries: &mut Vec<f64>) {
        let n = flow.states();
        let mut sparsity = jacobian.sparsity(flow);
        entries.clear();
        if let Sparsity::Bordered { .. } = sparsity {
            entries.extend(sparsity.matrix(n, &jacobian.entries).as_slice());
            sparsity = Sparsity::Full;
        } else {
            entries.extend(&jacobian.entries);
        }
        if self.places.is_empty() {
            self.places = (0..entries.len()).map(|k| sparsity.place(k, n)).collect();
            let second = flow.second();
            let is_of_pose = |state: &usize| second.contains(state);
            let mut numbers = vec![None; n * n];
            self.places.iter().enumerate().for_each(|(k, (row, column))| numbers[row * n + column] = Some(k));
            let upper = self.places.iter().enumerate().filter(|(_, (row, column))| row <= column);
            let upper = upper.filter(|(_, (row, column))| !is_of_pose(row) && !is_of_pose(column));
            let mirrored = upper.filter_map(|(k, &(row, column))| Some((k, numbers[column * n + row]?, (row, column))));
            self.mirrored = mirrored.collect();
        }
    }

    /// Chooses among `n` states those that are damped stiffly in a step of size `h` (s). Gives whether they are others
    /// than before.
    ///
    /// A damper between two states changes the rate of each with the other in the same sense; a spring, a mass and what
    /// turns do so in opposite senses. The root of the product of both changes, 1/s, does not depend on the units of
    /// the states.
    pub fn choose(&mut self, entries: &[f64], h: f64, n: usize, states: &mut Vec<usize>) -> bool {
        let Self { mirrored, dampers, damped, .. } = self;
        damped.clear();
        damped.resize(n, false);
        let before = |state: usize| states.binary_search(&state).is_ok();
        let (strong, weak) = (power(STIFF / h, 2), power(WEAK / h, 2));
        let products = mirrored.iter().map(|&(one, other, place)| (place, entries[one] * entries[other]));
        dampers.clear();
        dampers.extend(products.filter(|(_, product)| *product > weak));
        for &((row, column), product) in &*dampers {
            if product > strong || (product > KEPT * strong && before(row) && before(column)) {
                (damped[row], damped[column]) = (true, true);
            }
        }
        // On along weaker dampers: a part of what one damper holds together would err more than all of it.
        let is_at_edge = |damped: &[bool], (row, column): RowColumn| damped[row] != damped[column];
        while let Some(&((row, column), _)) = dampers.iter().find(|(place, _)| is_at_edge(damped, *place)) {
            (damped[row], damped[column]) = (true, true);
        }
        let chosen = || (0..n).filter(|&state| damped[state]);
        let has_changed = !chosen().eq(states.iter().copied());
        if has_changed {
            states.clear();
            states.extend(chosen());
        }
        has_changed
    }

    /// The entries between these states, each with its place in their matrix.
    pub fn sources(&self, places: &Places, sources: &mut Vec<(usize, usize)>) {
        let (mut rows, length) = (vec![None; self.damped.len()], LANES * places.groups.len());
        places.states.iter().enumerate().for_each(|(row, &state)| rows[state] = Some(row));
        let within = self.places.iter().enumerate();
        sources.clear();
        sources.extend(within.filter_map(|(k, &(row, column))| Some((k, rows[column]? * length + rows[row]?))));
    }
}
