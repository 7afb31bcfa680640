//! A problem with its number of states forgotten, so that problems of different size stand in one list.
//!
//! In: a system, its start and what is observed of it. Out: a run by any integrator, as rows of what was observed.

use bg_model::failure::Cause;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Observer, Samples, Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::{Model, System, switches, values};

/// What a run is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The relative tolerance.
    pub relative: f64,
    /// The absolute tolerance of all states.
    pub absolute: f64,
    /// The step of a fixed-step method.
    pub fixed_step: f64,
    /// First and largest step of a method with error control, which loose tolerances make a fixed-step method.
    pub forced_step: Option<f64>,
    /// The instants at which rows are wanted; the last is the end.
    pub instants: &'a [f64],
    /// The most attempted steps.
    pub limit: u64,
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// What was observed, at each instant that was reached.
    pub rows: Vec<Vec<f64>>,
    /// What it cost.
    pub statistics: Statistics,
    /// Why it stopped before its end.
    pub failure: Option<Cause>,
}

/// What following a run gave beside the rows.
#[derive(Clone, Debug)]
pub struct Followed {
    /// The times of the switchings, s.
    pub events: Vec<f64>,
    /// What it cost.
    pub statistics: Statistics,
    /// Why it stopped before its end.
    pub failure: Option<Cause>,
}

/// Something to run.
pub trait Problem {
    /// The number of states.
    fn states(&self) -> usize;

    /// Runs it from t = 0 with `integrator`.
    fn run(&self, integrator: Integrator, request: &Request) -> Run;
}

/// A problem of one system, which can be followed at any samples.
pub trait Followable: Problem {
    /// Runs it from t = 0 to the last instant of `request` with `integrator`; `each` is given the rows at `samples`,
    /// not at the instants, with their times (s).
    fn follow(
        &self,
        integrator: Integrator,
        request: &Request,
        samples: Samples,
        each: &mut dyn FnMut(f64, Vec<f64>),
    ) -> Followed;
}

/// A system, its start, and what is observed of it at an instant.
pub struct Observed<Sys, F, const N: usize, const G: usize> {
    system: Sys,
    start: SVector<f64, N>,
    observe: F,
}

/// A problem whose states are observed as they are.
#[must_use]
pub fn states<Sys, const N: usize, const G: usize>(system: Sys, start: [f64; N]) -> Box<dyn Problem>
where
    Sys: System<f64, N, G> + 'static,
{
    let observe = |_: &Sys, _: f64, x: &SVector<f64, N>, _: &[bool; G]| x.as_slice().to_vec();
    Box::new(Observed { system, start: SVector::from(start), observe })
}

/// A problem of a generated model of which `observe` makes something of the outputs.
///
/// # Panics
/// The start does not close.
#[must_use]
pub fn outputs<Mo, F, const N: usize, const G: usize, const M: usize>(model: Mo, observe: F) -> Box<dyn Problem>
where
    Mo: Model<f64, N, G, M> + 'static,
    F: Fn(&[f64; M]) -> Vec<f64> + 'static,
{
    let start = model.start().expect("the mechanism closes");
    followable(model, start, observe)
}

/// The same from any start, and to be followed.
#[must_use]
pub fn followable<Mo, F, const N: usize, const G: usize, const M: usize>(
    model: Mo,
    start: SVector<f64, N>,
    observe: F,
) -> Box<dyn Followable>
where
    Mo: Model<f64, N, G, M> + 'static,
    F: Fn(&[f64; M]) -> Vec<f64> + 'static,
{
    let observe = move |model: &Mo, t: f64, x: &SVector<f64, N>, negative: &[bool; G]| {
        let mut y = SVector::<f64, M>::zeros();
        model.outputs(t, x, negative, &mut y);
        observe(&y.data.0[0])
    };
    Box::new(Observed { system: model, start, observe })
}

impl<Sys, F, const N: usize, const G: usize> Problem for Observed<Sys, F, N, G>
where
    Sys: System<f64, N, G>,
    F: Fn(&Sys, f64, &SVector<f64, N>, &[bool; G]) -> Vec<f64>,
{
    fn states(&self) -> usize {
        N
    }

    fn run(&self, integrator: Integrator, request: &Request) -> Run {
        let mut rows = Vec::with_capacity(request.instants.len());
        let samples = Samples::At(request.instants.to_vec());
        let Followed { statistics, failure, .. } =
            self.follow(integrator, request, samples, &mut |_, row| rows.push(row));
        Run { rows, statistics, failure }
    }
}

impl<Sys, F, const N: usize, const G: usize> Followable for Observed<Sys, F, N, G>
where
    Sys: System<f64, N, G>,
    F: Fn(&Sys, f64, &SVector<f64, N>, &[bool; G]) -> Vec<f64>,
{
    fn follow(
        &self,
        integrator: Integrator,
        request: &Request,
        samples: Samples,
        each: &mut dyn FnMut(f64, Vec<f64>),
    ) -> Followed {
        let mut method: AnyMethod = integrator.method(request.fixed_step);
        let settings = Settings {
            tolerances: Tolerances::new(request.relative, request.absolute),
            first_step: request.forced_step,
            largest_step: request.forced_step.unwrap_or(f64::INFINITY),
            step_limit: request.limit,
            samples,
        };
        let span = Span { t0: 0.0, t_end: request.instants.last().copied().unwrap_or(0.0) };
        let mut follower = Follower { observed: self, each, events: Vec::new() };
        let (statistics, failure) =
            match integrate(&self.system, &mut method, &self.start, span, &settings, &mut follower) {
                Ok(finish) => (finish.statistics, None),
                Err(failure) => (failure.last.statistics, Some(failure.cause)),
            };
        Followed { events: follower.events, statistics, failure }
    }
}

/// Hands on what is observed, and notes the switchings.
struct Follower<'a, Sys, F, const N: usize, const G: usize> {
    observed: &'a Observed<Sys, F, N, G>,
    each: &'a mut dyn FnMut(f64, Vec<f64>),
    events: Vec<f64>,
}

impl<Sys, F, const N: usize, const G: usize> Observer for Follower<'_, Sys, F, N, G>
where
    F: Fn(&Sys, f64, &SVector<f64, N>, &[bool; G]) -> Vec<f64>,
{
    fn sample(&mut self, t: f64, x: &[f64], negative: &[bool]) {
        let Observed { system, observe, .. } = self.observed;
        (self.each)(t, observe(system, t, values(x), switches(negative)));
    }

    fn event(&mut self, t: f64, _x: &[f64], _switch: usize, _negative: &[bool]) {
        self.events.push(t);
    }
}
