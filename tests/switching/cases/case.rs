//! A case with known events: what is run, when its events are, and what a run gives.
//!
//! In: a case, an integrator and a tolerance or step. Out: the events found, and the largest error of their times.

use bg_model::failure::Cause;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Observer, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::System;

/// What a run is asked for.
#[derive(Clone, Debug)]
pub struct Request {
    /// Start and end, s.
    pub span: [f64; 2],
    /// The relative and the absolute tolerance of all states.
    pub tolerance: f64,
    /// The step of a fixed-step method, s.
    pub fixed_step: f64,
    /// The first step of a method with error control, s.
    pub first_step: Option<f64>,
    /// The largest step, s.
    pub largest_step: f64,
    /// The instants at which samples are wanted, s.
    pub samples: Vec<f64>,
    /// The most attempted steps.
    pub limit: u64,
}

impl Default for Request {
    /// From 0 to 1 s at a tolerance of 1e-8, in 100 fixed steps.
    fn default() -> Self {
        Self {
            span: [0.0, 1.0],
            tolerance: 1e-8,
            fixed_step: 0.01,
            first_step: None,
            largest_step: f64::INFINITY,
            samples: Vec::new(),
            limit: 100_000,
        }
    }
}

/// A change of branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// When, s.
    pub t: f64,
    /// The index of the switch.
    pub switch: usize,
    /// Whether it is in the branch of its negative guard from then on.
    pub negative: bool,
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// The changes of branch in the order of time.
    pub events: Vec<Event>,
    /// The samples: time, s, and branches.
    pub samples: Vec<(f64, Vec<bool>)>,
    /// Where the run has come to: time, s, state and branches.
    pub t: f64,
    /// See `t`.
    pub x: Vec<f64>,
    /// See `t`.
    pub negative: Vec<bool>,
    /// What it cost.
    pub statistics: Statistics,
    /// Why it stopped before its end.
    pub failure: Option<Cause>,
}

impl Run {
    /// The times of the events, s.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        self.events.iter().map(|event| event.t).collect()
    }
}

/// Something with switches to run; its numbers of states and switches are forgotten.
pub trait Switched {
    /// Runs it with `integrator`.
    fn run(&self, integrator: Integrator, request: &Request) -> Run;
}

/// A system and its start.
pub struct Started<Sys, const N: usize, const G: usize> {
    system: Sys,
    start: SVector<f64, N>,
}

/// The `system` from `start`.
pub fn started<Sys, const N: usize, const G: usize>(system: Sys, start: impl Into<SVector<f64, N>>) -> Box<dyn Switched>
where
    Sys: System<f64, N, G> + 'static,
{
    Box::new(Started::<Sys, N, G> { system, start: start.into() })
}

/// Writes events and samples down.
#[derive(Default)]
struct Recorder {
    events: Vec<Event>,
    samples: Vec<(f64, Vec<bool>)>,
}

impl Observer for Recorder {
    fn sample(&mut self, t: f64, _: &[f64], negative: &[bool]) {
        self.samples.push((t, negative.to_vec()));
    }

    fn event(&mut self, t: f64, _: &[f64], switch: usize, negative: &[bool]) {
        self.events.push(Event { t, switch, negative: negative[switch] });
    }
}

impl<Sys, const N: usize, const G: usize> Switched for Started<Sys, N, G>
where
    Sys: System<f64, N, G>,
{
    fn run(&self, integrator: Integrator, request: &Request) -> Run {
        let mut method: AnyMethod = integrator.method(request.fixed_step);
        let settings = Settings {
            tolerances: Tolerances::new(request.tolerance, request.tolerance),
            first_step: request.first_step,
            largest_step: request.largest_step,
            step_limit: request.limit,
            samples: Samples::At(request.samples.clone()),
        };
        let span = Span { t0: request.span[0], t_end: request.span[1] };
        let mut recorder = Recorder::default();
        let outcome = integrate(&self.system, &mut method, &self.start, span, &settings, &mut recorder);
        let (last, failure) = match outcome {
            Ok(finish) => (finish, None),
            Err(failure) => (*failure.last, Some(failure.cause)),
        };
        let Recorder { events, samples } = recorder;
        let (x, negative) = (last.x.as_slice().to_vec(), last.negative);
        Run { events, samples, t: last.t, x, negative, statistics: last.statistics, failure }
    }
}

/// A problem whose events are known.
pub struct Case {
    /// The name, one word.
    pub name: &'static str,
    /// Why its events are known.
    pub source: &'static str,
    /// The end of the run, s; it starts at 0.
    pub end: f64,
    /// The exact times of its events, s, all of them before the end.
    pub events: Vec<f64>,
    /// How much a relative disturbance of the state on the way moves an event, in units of 1 s, a power of ten; 0 where
    /// the methods make no error but rounding.
    pub amplification: f64,
    /// The largest step of a fixed-step method that resolves it, s.
    pub step: f64,
    /// What is run.
    pub problem: Box<dyn Switched>,
}

impl Case {
    /// The largest error of an event time, s, by `integrator` at `tolerance` or with steps of `step` (s); infinite
    /// where not all events were found, or others.
    #[must_use]
    pub fn error(&self, integrator: Integrator, tolerance: f64, step: f64) -> f64 {
        let request = Request { span: [0.0, self.end], tolerance, fixed_step: step, ..Request::default() };
        let run = self.problem.run(integrator, &request);
        let times = run.times();
        if run.failure.is_some() || times.len() != self.events.len() {
            return f64::INFINITY;
        }
        times.iter().zip(&self.events).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max)
    }
}
