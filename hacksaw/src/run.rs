//! The run: a hacksaw integrated over its time, its outputs sampled.
//!
//! In: a model and what is asked of the run. Out: the trajectory and the statistics; of a run that fails, those up to the
//! failure and its cause. Method: the one asked for, with switchings located as events.

use std::time::{Duration, Instant};

use bg_model::assembly::AssemblyError;
use bg_model::integrator::{AnyMethod, Change, Integrator, Method, Tolerances};
use bg_model::simulation::{EachStep, Part, Recorder, Recording, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::Model;

use crate::trajectory::{Column, Trajectory, sample_times};

/// What is asked of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// The integrator.
    pub method: Integrator,
    /// The step of a fixed-step method, s; without effect on others.
    pub fixed_step: f64,
    /// The end of the run, s; it starts at 0.
    pub t_end: f64,
    /// Relative tolerance of each step.
    pub rtol: f64,
    /// Absolute tolerance of each step, in each state's SI unit.
    pub atol: f64,
    /// The output interval of the CSV file, s.
    pub step: f64,
}

/// The rtol over the atol that goes with it. A smaller atol costs steps and gives no smaller an error for the same time.
pub const RTOL_OVER_ATOL: f64 = 10.0;

impl Default for RunSettings {
    /// The paper's 5 s at a relative tolerance of 1e-8, a row each 0.01 s.
    fn default() -> Self {
        Self {
            method: Integrator::default(),
            fixed_step: 1e-4,
            t_end: 5.0,
            rtol: 1e-8,
            atol: 1e-8 / RTOL_OVER_ATOL,
            step: 0.01,
        }
    }
}

/// The interval of the samples that figures, checks and summary are made from, s: more than forty in each turn of the
/// paper's crank, whatever the output interval.
const FINE: f64 = 0.002;
/// The most of these samples: a long run has them farther apart.
const MOST_FINE: f64 = 20_000.0;

/// The most steps tried for each second of simulated time, and in all for a shorter run. The paper's case takes 5000 each
/// second; parameters that need a thousand times as many are too stiff for an explicit method.
const STEPS_PER_SECOND: f64 = 5e6;

impl RunSettings {
    /// The times of the CSV file's rows, s.
    #[must_use]
    pub fn output_times(&self) -> Vec<f64> {
        sample_times(self.step, self.t_end)
    }

    /// The times of all samples, s: those of the CSV file and those that the figures need.
    fn sample_times(&self) -> Vec<f64> {
        let mut times = self.output_times();
        times.extend(sample_times(FINE.max(self.t_end / MOST_FINE), self.t_end));
        times.sort_unstable_by(f64::total_cmp);
        times.dedup();
        times
    }
}

/// What a run gives.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The outputs at the sample times that were reached.
    pub trajectory: Trajectory,
    /// What the run took.
    pub effort: Effort,
    /// Why the run stopped before its end, if it did: when, and which state.
    pub failure: Option<String>,
}

/// What a run took.
#[derive(Clone, Debug, Default)]
pub struct Effort {
    /// The states that are integrated.
    pub states: usize,
    /// Steps, evaluations, factorisations, events.
    pub statistics: Statistics,
    /// The methods that made the steps, from when (s) on; the first from the start.
    pub methods: Vec<Change>,
    /// The times of the switchings, s.
    pub event_times: Vec<f64>,
    /// Time on the wall clock.
    pub wall: Duration,
}

/// Integrates `model` from its start. `progress` is told the time reached, s, after each step.
///
/// # Errors
/// The start pose cannot be assembled. A run that fails later is no error here: see [`Simulation::failure`].
pub fn run<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    settings: &RunSettings,
    mut progress: impl FnMut(f64),
) -> Result<Simulation, AssemblyError>
where
    Mo: Model<f64, N, G, M>,
{
    let integration = Settings {
        tolerances: Tolerances::new(settings.rtol, settings.atol),
        samples: Samples::At(settings.sample_times()),
        step_limit: (STEPS_PER_SECOND * settings.t_end.max(1.0)) as u64,
        ..Settings::default()
    };
    record(model, settings.method, settings.fixed_step, settings.t_end, &integration, &mut progress)
}

/// Integrates `model` from its start until `t_end` (s) with `method` as `integration` asks; `step` (s) is that of a method
/// with a fixed step. `progress` is told the time reached, s, after each step. All runs pass here, so that each
/// scene is compiled once.
///
/// # Errors
/// As [`run`].
pub fn record<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    method: Integrator,
    step: f64,
    t_end: f64,
    integration: &Settings<N>,
    progress: &mut dyn FnMut(f64),
) -> Result<Simulation, AssemblyError>
where
    Mo: Model<f64, N, G, M>,
{
    let mut method: AnyMethod<N> = method.method(step);
    let clock = Instant::now();
    let first = Change { t: 0.0, method: method.name() };
    let start = model.start()?;
    let mut observer = (Recorder::new(model, &[Part::Outputs]), EachStep(progress));
    let span = Span { t0: 0.0, t_end };
    let result = integrate(model, &mut method, &start, span, integration, &mut observer);
    let (statistics, failure) = match result {
        Ok(finish) => (finish.statistics, None),
        Err(failure) => (failure.last.statistics, Some(failure.to_string())),
    };
    let Recording { columns, times, rows, events } = observer.0.recording;
    let columns = columns.into_iter().map(Column::from).collect();
    let trajectory = Trajectory { columns, times, rows };
    let effort = Effort {
        states: N,
        statistics,
        methods: std::iter::once(first).chain(method.changes().iter().copied()).collect(),
        event_times: events,
        wall: clock.elapsed(),
    };
    Ok(Simulation { trajectory, effort, failure })
}
