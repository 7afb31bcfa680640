//! The stages of a step followed backwards.
//!
//! In: how a number depends on the state at the end of a step. Out: how it depends on the rate of each stage, once that
//! of the later ones has been handed on. With x_i = x + h sum a_ij k_j, y = x + h sum b_j k_j and a weight l of y, that
//! of k_j is h (b_j l + sum a_ij m_i), where m_i is that of x_i.

use core::marker::PhantomData;

use super::stages::STAGES;
use super::{Row, Tableau};
use crate::solve::integrator::side_by_side::{Padded, SIDE_BY_SIDE, Stack};

/// How a number depends on the rates of all stages of tableau `T`.
#[derive(Clone, Debug)]
pub(crate) struct Transposed<T> {
    by_rates: Stack<f64, SIDE_BY_SIDE, STAGES>,
    /// Those of one stage, and what is handed on.
    room: Padded<f64, SIDE_BY_SIDE>,
    tableau: PhantomData<T>,
}

impl<T: Tableau> Transposed<T> {
    /// Room for so many states.
    pub fn new(states: usize) -> Self {
        Self { by_rates: Stack::new(states, 0, 0.0), room: Padded::new(states, 0.0), tableau: PhantomData }
    }

    /// Begins at the end of a step of size `h` (s), on whose state the number depends by `by_end`.
    #[inline(always)]
    pub fn begin(&mut self, h: f64, by_end: &[f64]) {
        let Self { by_rates, room, .. } = self;
        room.copy_from_slice(by_end);
        for (first, rows) in by_rates.groups_mut() {
            let by_end = room.group(*first);
            for (stage, row) in rows.iter_mut().enumerate() {
                let part = h * weight(T::B, stage);
                *row = by_end.map(|by| by * part);
            }
        }
    }

    /// How it depends on the rate of a stage.
    #[inline(always)]
    pub fn by_rate(&mut self, stage: usize) -> &[f64] {
        for (first, rows) in self.by_rates.groups() {
            self.room.set_group(*first, rows[stage]);
        }
        &self.room
    }

    /// Hands on to the rates that the state of a stage is made of how the number depends on it.
    #[inline(always)]
    pub fn hand_on(&mut self, stage: usize, h: f64, by_state: &[f64]) {
        let Self { by_rates, room, .. } = self;
        room.copy_from_slice(by_state);
        for (first, rows) in by_rates.groups_mut() {
            let by_state = room.group(*first);
            for (earlier, a) in T::A[stage] {
                let (row, part) = (&mut rows[*earlier], h * a);
                for i in 0..SIDE_BY_SIDE {
                    row[i] += part * by_state[i];
                }
            }
        }
    }

    /// The weight of a stage in the state at the end of the step.
    pub fn quadrature(stage: usize) -> f64 {
        weight(T::B, stage)
    }
}

/// The weight of a stage in a row.
fn weight(row: Row, stage: usize) -> f64 {
    row.iter().find(|(of, _)| *of == stage).map_or(0.0, |(_, weight)| *weight)
}
