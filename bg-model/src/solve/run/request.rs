//! What is asked of a run.

use super::{Interrupt, Progress, sample_times};
use crate::solve::integrator::{AnyMethod, Auto, Integrator, Tolerances};
use crate::solve::simulation::{Part, Samples, Settings};

/// What is asked of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The integrator.
    pub method: Integrator,
    /// The method that `auto` begins with, without trials: what made most of the steps of a run like this
    /// ([`Trajectory::hint`](super::Trajectory::hint)). Others take over where they are ahead later on. Without effect
    /// on other integrators.
    pub hint: Option<Integrator>,
    /// The step of a fixed-step method, s; without effect on others.
    pub fixed_step: f64,
    /// The end of the run, s.
    pub t_end: f64,
    /// Relative tolerance of each step.
    pub rtol: f64,
    /// Absolute tolerance of each step, in each state's SI unit; without one, by the sizes of the states
    /// ([`Absolute::OfSizes`](crate::integrator::Absolute::OfSizes)).
    pub atol: Option<f64>,
    /// The instants of the samples.
    pub samples: Samples,
    /// What is recorded at each.
    pub parts: Vec<Part>,
    /// Whether the peaks of the outputs are looked for between the samples ([`Column::peaks`]): some evaluations of the
    /// outputs in each step more.
    ///
    /// [`Column::peaks`]: crate::simulation::Column::peaks
    pub peaks: bool,
    /// The instant, s, from which on they are looked for once more, where a start does not count
    /// ([`Column::settled`](crate::simulation::Column::settled)).
    pub settled: Option<f64>,
    /// The number of attempted steps, rejected ones included, after which the run gives up.
    pub step_limit: u64,
    /// What ends it from another thread: it then fails as [`Cause::Interrupted`](crate::failure::Cause::Interrupted).
    pub interrupt: Interrupt,
    /// What tells another thread how far it is.
    pub progress: Progress,
}

impl Default for Request {
    /// `auto` over 1 s at a relative tolerance of 1e-8; the outputs at the end of each step.
    fn default() -> Self {
        Self {
            method: Integrator::default(),
            hint: None,
            fixed_step: 1e-4,
            t_end: 1.0,
            rtol: 1e-8,
            atol: None,
            samples: Samples::Steps,
            parts: vec![Part::Outputs],
            peaks: false,
            settled: None,
            step_limit: Settings::default().step_limit,
            interrupt: Interrupt::default(),
            progress: Progress::default(),
        }
    }
}

impl Request {
    /// The method.
    pub(crate) fn method(&self) -> AnyMethod {
        match (self.method, self.hint) {
            (Integrator::Auto, Some(hint)) => Auto::beginning_with(hint).into(),
            (method, _) => method.method(self.fixed_step),
        }
    }

    /// The tolerances of each step.
    #[must_use]
    pub fn tolerances(&self) -> Tolerances {
        self.atol.map_or(Tolerances::relative(self.rtol), |atol| Tolerances::new(self.rtol, atol))
    }

    /// The same for the driver, of a run from `t0` (s) on.
    pub(crate) fn settings(&self, t0: f64) -> Settings {
        let samples = match &self.samples {
            // The driver says what is wrong with an interval that cannot be.
            Samples::Every(interval) if interval.is_finite() && self.is_countable(t0, *interval) => {
                Samples::At(sample_times(t0, *interval, self.t_end))
            }
            samples => samples.clone(),
        };
        Settings { tolerances: self.tolerances(), samples, step_limit: self.step_limit, ..Settings::default() }
    }

    /// Whether the samples can be listed before the run: their instants take 80 MB at most.
    fn is_countable(&self, t0: f64, interval: f64) -> bool {
        const MOST: f64 = 1e7;
        interval > 0.0 && self.t_end >= t0 && (self.t_end - t0) / interval < MOST
    }
}
