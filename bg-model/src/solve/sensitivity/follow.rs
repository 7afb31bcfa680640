//! Slopes that follow a run: from step to step, over events, into the outputs at the samples.
//!
//! In: what an observer of the run is told. Out: the derivatives of the outputs at each sample, and those of the states at the end.

use nalgebra::SVector;

use super::jump::jumped;
use super::step::{Sloped, Steps, set_values};
use super::{Direction, SensitivityError};
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::Model;
use crate::solve::integrator::Point;
use crate::solve::simulation::{Observer, Switching};

/// Some of the directions with the system in numbers that have slopes along them.
pub(super) struct Follower<Li, const N: usize, const G: usize, const M: usize> {
    system: Box<Li>,
    /// The same with slopes of nothing.
    plain: Box<Li>,
    directions: Vec<Direction>,
    /// The slopes where the run has come to: some of the directions each.
    steps: Vec<Box<dyn Steps<N, G>>>,
    /// The last step: its start, its branches.
    start: f64,
    negative: [bool; G],
    /// Where the run has come to.
    t: f64,
    /// The state at the start, until the run has begun.
    begin: Option<Sloped<N>>,
    error: Option<SensitivityError>,
    /// The outputs that are asked for.
    outputs: Vec<usize>,
    /// For each direction and output the derivatives at the samples.
    pub slopes: Vec<Vec<Vec<f64>>>,
}

impl<Li, const N: usize, const G: usize, const M: usize> Follower<Li, N, G, M>
where
    Li: Model<Gradient, N, G, M>,
{
    /// From the start of a run at `t0` (s) and the state `x`; `steps` are those of the same system.
    pub fn new(
        [system, plain]: [Box<Li>; 2],
        steps: Vec<Box<dyn Steps<N, G>>>,
        (directions, outputs): (&[Direction], &[usize]),
        t0: f64,
        x: Sloped<N>,
    ) -> Self {
        let mut begin = x;
        for (l, direction) in directions.iter().enumerate() {
            if let Direction::Start(state) = direction {
                let mut slopes = begin[*state].slopes();
                slopes[l] += 1.0;
                begin[*state] = Gradient::new(begin[*state].value, slopes);
            }
        }
        Self {
            system,
            plain,
            directions: directions.to_vec(),
            steps,
            start: t0,
            negative: [false; G],
            t: t0,
            begin: Some(begin),
            error: None,
            outputs: outputs.to_vec(),
            slopes: vec![vec![Vec::new(); M]; directions.len()],
        }
    }

    /// Begins at the first state of the run, which is to be that of the start. Gives whether it has begun.
    fn has_begun(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) -> bool {
        let Some(mut start) = self.begin.take() else { return true };
        if start.iter().zip(x).any(|(start, x)| start.value != *x) {
            self.error = Some(SensitivityError::ImpactAtStart);
            return false;
        }
        self.system.project(Gradient::from_f64(t), negative, &mut start);
        set_values(&mut start, x);
        self.steps.iter_mut().for_each(|steps| steps.set(&start));
        true
    }

    /// The derivatives of the states where the run has come to, for each direction.
    pub fn states(&self) -> Vec<Vec<f64>> {
        let now = self.now(&SVector::zeros());
        let of = |l: usize| now.iter().map(|state| state.slopes()[l]).collect();
        (0..self.directions.len()).map(of).collect()
    }

    /// The state where the run has come to, of these values.
    fn now(&self, values: &SVector<f64, N>) -> Sloped<N> {
        let mut now = values.map(Gradient::from_f64);
        self.steps.iter().for_each(|steps| steps.write(&mut now));
        now
    }

    /// What the outputs at the samples and the states have come to.
    ///
    /// # Errors
    /// What has gone wrong first.
    pub fn check(&mut self) -> Result<(), SensitivityError> {
        self.error.take().map_or(Ok(()), Err)
    }
}

impl<Li, const N: usize, const G: usize, const M: usize> Observer<N, G> for Follower<Li, N, G, M>
where
    Li: Model<Gradient, N, G, M>,
{
    fn sample(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) {
        if self.error.is_some() {
            return;
        }
        if !self.has_begun(t, x, negative) {
            return;
        }
        let mut reached = self.now(x);
        if t != self.t {
            let (start, branches) = (self.start, &self.negative);
            if !self.steps.iter_mut().all(|steps| steps.look(branches, start, t, &mut reached)) {
                self.error = Some(SensitivityError::Inexact { t });
                return;
            }
        }
        let mut outputs = SVector::repeat(Gradient::from_f64(0.0));
        self.system.outputs(Gradient::from_f64(t), &reached, negative, &mut outputs);
        for &output in &self.outputs {
            let slopes = outputs[output].slopes();
            self.slopes.iter_mut().zip(slopes).for_each(|(columns, slope)| columns[output].push(slope));
        }
    }

    fn passed(&mut self, start: &Point<N>, end: &Point<N>, negative: &[bool; G]) {
        if self.error.is_some() {
            return;
        }
        if !self.has_begun(start.t, &start.x, negative) {
            return;
        }
        (self.start, self.negative, self.t) = (start.t, *negative, end.t);
        if !self.steps.iter_mut().all(|steps| steps.pass(negative, start, end)) {
            self.error = Some(SensitivityError::Inexact { t: start.t });
        }
    }

    fn switched(&mut self, switching: &Switching<N, G>) {
        if self.error.is_some() {
            return;
        }
        match jumped(&*self.system, &*self.plain, &self.now(&switching.before.x), switching) {
            Some(after) => self.steps.iter_mut().for_each(|steps| steps.set(&after)),
            None => {
                let switch = switching.reached.iter().position(|&reached| reached).unwrap_or_default();
                let name = self.system.switch_name(switch).unwrap_or("a switch");
                self.error = Some(SensitivityError::Grazes { switch: name, t: switching.before.t });
            }
        }
    }

    fn is_done(&self) -> bool {
        self.error.is_some()
    }
}
