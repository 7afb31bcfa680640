//! Slopes that follow a run: from step to step, over events, into the outputs at the samples.
//!
//! In: what an observer of the run is told. Out: the derivatives of the outputs at each sample, and those of the states at the end.

use nalgebra::SVector;

use super::jump::jumped;
use super::step::{Sloped, Stepper, WIDTH};
use super::{Direction, SensitivityError};
use crate::model::scalar::{Gradient, Scalar};
use crate::model::system::Model;
use crate::solve::integrator::{Point, Scale};
use crate::solve::simulation::{Observer, Switching};

/// Some of the directions with the system in numbers that have slopes along them.
pub(super) struct Follower<Li, const N: usize, const G: usize, const M: usize> {
    system: Li,
    /// The same with slopes of nothing.
    plain: Li,
    directions: Vec<Direction>,
    stepper: Stepper<N>,
    /// The last step: its start, its branches, the state there.
    start: f64,
    negative: [bool; G],
    from: Sloped<N>,
    /// Where the run has come to.
    t: f64,
    now: Sloped<N>,
    has_begun: bool,
    error: Option<SensitivityError>,
    /// For each direction and output the derivatives at the samples.
    pub outputs: Vec<Vec<Vec<f64>>>,
}

impl<Li, const N: usize, const G: usize, const M: usize> Follower<Li, N, G, M>
where
    Li: Model<Gradient, N, G, M>,
{
    /// From the start of a run at `t0` (s) and the state `x`; `sizes` are those of the directions.
    pub fn new(
        [system, plain]: [Li; 2],
        directions: &[Direction],
        sizes: [f64; WIDTH],
        scale: Scale<N>,
        t0: f64,
        x: Sloped<N>,
    ) -> Self {
        let mut now = x;
        for (l, direction) in directions.iter().enumerate() {
            if let Direction::Start(state) = direction {
                let mut slopes = now[*state].slopes();
                slopes[l] += 1.0;
                now[*state] = Gradient::new(now[*state].value, slopes);
            }
        }
        Self {
            system,
            plain,
            directions: directions.to_vec(),
            stepper: Stepper::new(scale, sizes),
            start: t0,
            negative: [false; G],
            from: now,
            t: t0,
            now,
            has_begun: false,
            error: None,
            outputs: vec![vec![Vec::new(); M]; directions.len()],
        }
    }

    /// The derivatives of the states where the run has come to, for each direction.
    pub fn states(&self) -> Vec<Vec<f64>> {
        let of = |l: usize| self.now.iter().map(|state| state.slopes()[l]).collect();
        (0..self.directions.len()).map(of).collect()
    }

    /// What the outputs at the samples and the states have come to.
    ///
    /// # Errors
    /// What has gone wrong first.
    pub fn check(&mut self) -> Result<(), SensitivityError> {
        self.error.take().map_or(Ok(()), Err)
    }

    /// The state at the time `t` (s) in the last step, projected.
    fn cross(&mut self, t: f64) -> Option<Sloped<N>> {
        let Self { system, stepper, start, negative, from, .. } = self;
        let mut x = stepper.cross(system, negative, *start, t, from)?;
        system.project(Gradient::from_f64(t), negative, &mut x);
        Some(x)
    }
}

/// The slopes of `of` at the values `x`.
fn at<const N: usize>(x: &SVector<f64, N>, of: &Sloped<N>) -> Sloped<N> {
    SVector::from_fn(|i, _| Gradient::new(x[i], of[i].slopes()))
}

impl<Li, const N: usize, const G: usize, const M: usize> Observer<N, G> for Follower<Li, N, G, M>
where
    Li: Model<Gradient, N, G, M>,
{
    fn sample(&mut self, t: f64, x: &SVector<f64, N>, negative: &[bool; G]) {
        if self.error.is_some() {
            return;
        }
        if !std::mem::replace(&mut self.has_begun, true) {
            if self.now.iter().zip(x).any(|(now, x)| now.value != *x) {
                self.error = Some(SensitivityError::ImpactAtStart);
                return;
            }
            self.system.project(Gradient::from_f64(t), negative, &mut self.now);
            self.now = at(x, &self.now);
        }
        let reached = if t == self.t { Some(self.now) } else { self.cross(t) };
        let Some(reached) = reached else {
            self.error = Some(SensitivityError::Inexact { t });
            return;
        };
        let mut outputs = SVector::repeat(Gradient::from_f64(0.0));
        self.system.outputs(Gradient::from_f64(t), &at(x, &reached), negative, &mut outputs);
        for (l, columns) in self.outputs.iter_mut().enumerate() {
            columns.iter_mut().zip(&outputs).for_each(|(column, output)| column.push(output.slopes()[l]));
        }
    }

    fn passed(&mut self, start: &Point<N>, end: &Point<N>, negative: &[bool; G]) {
        if self.error.is_some() {
            return;
        }
        (self.start, self.negative, self.from) = (start.t, *negative, at(&start.x, &self.now));
        match self.cross(end.t) {
            Some(reached) => (self.t, self.now) = (end.t, at(&end.x, &reached)),
            None => self.error = Some(SensitivityError::Inexact { t: start.t }),
        }
    }

    fn switched(&mut self, switching: &Switching<N, G>) {
        if self.error.is_some() {
            return;
        }
        let Self { system, plain, now, .. } = self;
        match jumped(system, plain, now, switching) {
            Some(after) => self.now = after,
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
