//! Slopes that follow a run: from step to step, over events, into the outputs at the samples.
//!
//! In: what an observer of the run is told. Out: the derivatives of the outputs at each sample, and those of the states at the end.

use nalgebra::SVector;

use super::jump::jumped;
use super::step::{Frozen, Sloped, Stepper};
use super::{Direction, SensitivityError};
use crate::model::scalar::Scalar;
use crate::model::scalar::gradient::GradientIn;
use crate::model::scalar::slopes::{Slopes, WIDTH};
use crate::model::system::Model;
use crate::solve::integrator::{Point, Scale};
use crate::solve::simulation::{Observer, Switching};

/// Some of the directions with the system in numbers that have slopes along them.
pub(super) struct Follower<V, Li, const N: usize, const G: usize, const M: usize> {
    system: Li,
    /// The same with slopes of nothing.
    plain: Li,
    directions: Vec<Direction>,
    stepper: Stepper<V, N>,
    /// The last step: its start, its branches, the state there.
    start: f64,
    negative: [bool; G],
    from: Sloped<V, N>,
    /// The state at a sample in it.
    between: Sloped<V, N>,
    /// Where the run has come to.
    t: f64,
    now: Sloped<V, N>,
    has_begun: bool,
    error: Option<SensitivityError>,
    /// For each direction and output the derivatives at the samples.
    pub outputs: Vec<Vec<Vec<f64>>>,
}

impl<V, Li, const N: usize, const G: usize, const M: usize> Follower<V, Li, N, G, M>
where
    V: Slopes,
    Li: Model<GradientIn<V>, N, G, M>,
{
    /// From the start of a run at `t0` (s) and the state `x`; `sizes` are those of the directions.
    pub fn new(
        [system, plain]: [Li; 2],
        directions: &[Direction],
        sizes: [f64; WIDTH],
        scale: Scale<N>,
        t0: f64,
        x: Sloped<V, N>,
    ) -> Self {
        let mut now = x;
        for (l, direction) in directions.iter().enumerate() {
            if let Direction::Start(state) = direction {
                let mut slopes = now[*state].slopes();
                slopes[l] += 1.0;
                now[*state] = GradientIn::new(now[*state].value, slopes);
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
            between: now,
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
}

/// The state `x` gets these values.
fn set<V, const N: usize>(x: &mut Sloped<V, N>, values: &SVector<f64, N>) {
    x.data.0[0].iter_mut().zip(&values.data.0[0]).for_each(|(x, &value)| x.value = value);
}

impl<V, Li, const N: usize, const G: usize, const M: usize> Observer<N, G> for Follower<V, Li, N, G, M>
where
    V: Slopes,
    Li: Model<GradientIn<V>, N, G, M>,
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
            self.system.project(GradientIn::from_f64(t), negative, &mut self.now);
            set(&mut self.now, x);
        }
        let Self { system, stepper, from, now, between, .. } = self;
        let reached = if t == self.t {
            now
        } else if stepper.cross(&Frozen { system, negative: &self.negative }, self.start, t, from, between) {
            between
        } else {
            self.error = Some(SensitivityError::Inexact { t });
            return;
        };
        set(reached, x);
        let mut outputs = SVector::repeat(GradientIn::from_f64(0.0));
        system.outputs(GradientIn::from_f64(t), reached, negative, &mut outputs);
        for (l, columns) in self.outputs.iter_mut().enumerate() {
            columns.iter_mut().zip(&outputs).for_each(|(column, output)| column.push(output.slopes()[l]));
        }
    }

    fn passed(&mut self, start: &Point<N>, end: &Point<N>, negative: &[bool; G]) {
        if self.error.is_some() {
            return;
        }
        (self.start, self.negative) = (start.t, *negative);
        std::mem::swap(&mut self.from, &mut self.now);
        let Self { system, stepper, from, now, .. } = self;
        set(from, &start.x);
        if stepper.cross(&Frozen { system, negative }, start.t, end.t, from, now) {
            self.t = end.t;
            set(now, &end.x);
        } else {
            self.error = Some(SensitivityError::Inexact { t: start.t });
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
