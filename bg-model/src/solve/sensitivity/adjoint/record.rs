//! What a run leaves to be followed backwards: its steps, events and samples, in the order of time.
//!
//! In: what an observer of the run is told, the most states that are kept. Out: a [`Record`]. Of each step its instants
//! stay and the number of its branches, 24 bytes, and its start state; where there are more of these than are kept,
//! every second one is forgotten, again and again, and the states between two that are left are made again. So a run of
//! n steps takes 24 n bytes and a fixed number of states, beside its events and the samples that count.

use super::super::SensitivityError;
use crate::solve::integrator::{Point, Scale};
use crate::solve::simulation::{Observer, Switching};

/// Is handed a sample: its time, s, its state and branches. Gives what counts of it: the derivatives of the objective
/// by the outputs there. None where nothing counts.
type Samples<'a> = Box<dyn FnMut(f64, &[f64], &[bool]) -> Option<Vec<f64>> + 'a>;

/// A sample that counts.
pub(super) struct Sample {
    /// The number of steps before its time, the one that it is in among them.
    pub steps: usize,
    /// The number of events before it.
    pub events: usize,
    pub t: f64,
    pub x: Vec<f64>,
    /// The branches, by their number.
    pub branches: u32,
    /// The derivatives of the objective by the outputs.
    pub weights: Vec<f64>,
}

/// What has happened after a step.
pub(super) struct Happened {
    /// The number of steps before it.
    pub steps: usize,
    pub switching: Box<Switching>,
}

/// A step.
#[derive(Clone, Copy)]
pub(super) struct Step {
    /// Where it begins, s.
    pub from: f64,
    /// Where it ends, s, but for the state there: that the next one begins with.
    pub to: f64,
    /// The branches, by their number.
    pub branches: u32,
}

/// A run as it was told.
pub(super) struct Record<'a> {
    samples_of: Samples<'a>,
    /// The model's own start.
    start: Vec<f64>,
    pub steps: Vec<Step>,
    /// The start states of the steps of these numbers: multiples of `stride`.
    pub states: Vec<Vec<f64>>,
    pub stride: usize,
    most: usize,
    pub branches: Vec<Vec<bool>>,
    pub events: Vec<Happened>,
    pub samples: Vec<Sample>,
    /// What errors are measured by, at the end of the run.
    pub scale: Option<Scale>,
    pub error: Option<SensitivityError>,
}

impl<'a> Record<'a> {
    /// Of a run from `start` that keeps `most` states at most.
    pub fn new(samples_of: Samples<'a>, start: Vec<f64>, most: usize) -> Self {
        Self {
            samples_of,
            start,
            steps: Vec::new(),
            states: Vec::new(),
            stride: 1,
            most: most.max(2),
            branches: Vec::new(),
            events: Vec::new(),
            samples: Vec::new(),
            scale: None,
            error: None,
        }
    }

    /// The number of these branches, which are those of the last step as a rule.
    fn number(&mut self, negative: &[bool]) -> u32 {
        if self.branches.last().is_none_or(|last| last != negative) {
            self.branches.push(negative.to_vec());
        }
        u32::try_from(self.branches.len() - 1).expect("fewer than 2^32 events")
    }
}

impl Observer for Record<'_> {
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        if let Some(weights) = (self.samples_of)(t, x, negative) {
            let branches = self.number(negative);
            let (steps, events) = (self.steps.len(), self.events.len());
            self.samples.push(Sample { steps, events, t, x: x.to_vec(), branches, weights });
        }
    }

    fn measured(&mut self, scale: &Scale) {
        self.scale = Some(scale.clone());
    }

    fn passed(&mut self, start: &Point, end: &Point, negative: &[bool]) {
        let x = start.x.as_slice();
        if self.steps.is_empty() && x != self.start {
            self.error = Some(SensitivityError::ImpactAtStart);
        }
        if self.steps.len().is_multiple_of(self.stride) {
            if self.states.len() == self.most {
                let mut number = 0_usize;
                self.states.retain(|_| {
                    number += 1;
                    !number.is_multiple_of(2)
                });
                self.stride *= 2;
            }
            if self.steps.len().is_multiple_of(self.stride) {
                self.states.push(x.to_vec());
            }
        }
        let branches = self.number(negative);
        self.steps.push(Step { from: start.t, to: end.t, branches });
    }

    fn switched(&mut self, switching: &Switching) {
        self.events.push(Happened { steps: self.steps.len(), switching: Box::new(switching.clone()) });
    }

    fn is_done(&self) -> bool {
        self.error.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn of_a_long_run_every_so_many_states_are_kept() {
        let mut record = Record::new(Box::new(|_, _, _| None), vec![0.0], 6);
        for step in 0..1000_u32 {
            let point = |at: u32| Point::at(f64::from(at), DVector::from_element(1, f64::from(at)));
            record.passed(&point(step), &point(step + 1), &[]);
            assert!(record.states.len() <= 6, "{}", record.states.len());
        }
        assert_eq!((record.steps.len(), record.stride), (1000, 256));
        let kept: Vec<f64> = record.states.iter().map(|state| state[0]).collect();
        assert_eq!(kept, [0.0, 256.0, 512.0, 768.0]);
    }
}
