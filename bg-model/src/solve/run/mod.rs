//! A run of a mechanism, asked for in words and given as columns by name: the face without const generics.
//!
//! In: a [`Mechanism`] and what is asked of the run. Out: a [`Trajectory`], from which the run can go on. Underneath is
//! [`simulation::integrate`](crate::simulation::integrate), which allocates nothing in a step. This face records the
//! samples and asks after each step whether to go on: 0.4 % more instructions than a `Recorder` by itself, counted on 5
//! s of the paper's hacksaw with 501 samples.

mod ending;
mod instants;
mod interrupt;
mod lanes;
mod progress;
mod request;
mod state;
mod stopwatch;
mod trajectory;

use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::Duration;

use nalgebra::DVector;
use stopwatch::Stopwatch;

use ending::{Ending, of_state};

pub use ending::Sample;
pub use instants::sample_times;
pub use interrupt::Interrupt;
pub use lanes::{LaneError, in_lanes};
pub use progress::Progress;
pub use request::Request;
pub use state::{State, StateError};
pub use trajectory::{Stopped, Trajectory};

use thiserror::Error;

use crate::model::assembly::AssemblyError;
use crate::model::dynamics::Machine;
use crate::model::mechanism::Mechanism;
use crate::model::standing::{CLOSE, Standing};
use crate::solve::event::Condition;
use crate::solve::failure::Cause;
use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{AnyMethod, Change, Integrator, Method, Reason};
use crate::solve::simulation::{Beginning, Observer, Part, PeakMonitor, Recorder, Samples, Span, make, raise};
use crate::solve::statistics::Statistics;

/// A run to be made.
///
/// ```
/// use bg_model::bond_graph;
/// use bg_model::run::Simulation;
///
/// bond_graph! {
///     pub graph Oscillator {
///         param mass: kg = 2, above 0;
///         param stiffness: N/m = 50, at least 0;
///         param damping: N*s/m = 0.5, at least 0;
///         1 slide: translation;
///         I body = mass; C spring = stiffness start 0.1; R damper = damping;
///         slide -> body; slide -> spring; slide -> damper;
///         observe { x: m = spring.q; v: m/s = slide.flow }
///     }
/// }
///
/// let model = Oscillator::new(OscillatorParameters::default())?;
/// let mut run = Simulation::new(&model).rtol(1e-8).every(0.01).until(5.0).run()?;
/// assert_eq!((run.times.len(), run["x"][0]), (501, 0.1));
/// run.continue_until(&model, 6.0)?;
/// assert_eq!(run.times.last(), Some(&6.0));
///
/// // Until the mass passes the place at which the spring is unloaded.
/// let swing = Simulation::new(&model).every(0.1).until(5.0).stop_when(|now| now["x"]).run()?;
/// assert!(swing["x"].last().is_some_and(|x| x.abs() < 1e-12));
/// run.write_csv(std::io::sink())?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use = "a run is made by `run`"]
pub struct Simulation<'a> {
    model: Rc<dyn Machine>,
    request: Request,
    start: Option<State>,
    each_step: EachStep<'a>,
    ending: Option<Ending<'a>>,
}

/// Is told the time reached, s, after each step, and says whether the run goes on.
type EachStep<'a> = Box<dyn FnMut(f64) -> ControlFlow<()> + 'a>;

impl<'a> Simulation<'a> {
    /// A run of `model` from its start, as [`Request::default`] says, unless another setting is given.
    pub fn new(model: &impl Mechanism) -> Self {
        Self::of(model, Request::default())
    }

    /// A run of `model` from its start as it is asked for.
    pub fn of(model: &impl Mechanism, request: Request) -> Self {
        Self::over(model.machine(), request)
    }

    /// The same of a model over slices.
    pub fn over(model: Rc<dyn Machine>, request: Request) -> Self {
        let each_step = Box::new(|_| ControlFlow::Continue(()));
        Self { model, request, start: None, each_step, ending: None }
    }

    /// Ends the run where `condition` passes through zero, in either direction; located like an event, by steps to its
    /// zero. A condition that is zero at the start ends the run the next time.
    pub fn stop_when(mut self, condition: impl FnMut(&Sample<'_>) -> f64 + 'a) -> Self {
        self.ending = Some(Box::new(condition));
        self
    }

    /// The integrator.
    pub fn method(mut self, method: Integrator) -> Self {
        self.request.method = method;
        self
    }

    /// The method that `auto` begins with, such as [`Trajectory::hint`] of a run before.
    pub fn hint(mut self, method: Integrator) -> Self {
        self.request.hint = Some(method);
        self
    }

    /// The relative tolerance of each step; the absolute ones follow the sizes of the states unless one is set.
    pub fn rtol(mut self, relative: f64) -> Self {
        self.request.rtol = relative;
        self
    }

    /// The absolute tolerance of each step, in each state's SI unit.
    pub fn atol(mut self, absolute: f64) -> Self {
        self.request.atol = Some(absolute);
        self
    }

    /// A sample at the start, every `interval` (s) and at the end. Without it every step gives one.
    pub fn every(mut self, interval: f64) -> Self {
        self.request.samples = Samples::Every(interval);
        self
    }

    /// Samples at these instants only, s, ascending, not before the start nor after the end.
    pub fn at(mut self, instants: &[f64]) -> Self {
        self.request.samples = Samples::At(instants.to_vec());
        self
    }

    /// What is recorded of each sample; the outputs unless it is said.
    pub fn recording(mut self, parts: &[Part]) -> Self {
        self.request.parts = parts.to_vec();
        self
    }

    /// Looks for the least and the largest value of each output between the samples as well
    /// ([`Recording::peaks`](crate::simulation::Recording::peaks)).
    pub fn with_peaks(mut self) -> Self {
        self.request.peaks = true;
        self
    }

    /// The end of the run, s.
    pub fn until(mut self, t_end: f64) -> Self {
        self.request.t_end = t_end;
        self
    }

    /// Starts from `state` at its time, not from the model's own start. The parameters may be others than those that
    /// led to it: what stays are the states (momenta, not velocities), and what sticks or rests as far as it can. The
    /// state is checked as a start is: joints closed, orientations rotations, no stop passed; what rounding leaves of
    /// that is closed.
    pub fn from(mut self, state: &State) -> Self {
        self.start = Some(state.clone());
        self
    }

    /// Tells `each_step` the time reached, s, after each step; where it breaks, the run ends there.
    pub fn each_step(mut self, each_step: impl FnMut(f64) -> ControlFlow<()> + 'a) -> Self {
        self.each_step = Box::new(each_step);
        self
    }

    /// The state that it starts from.
    ///
    /// # Errors
    /// The start cannot be assembled, the state is not one of this mechanism, or the mechanism cannot stand in it.
    pub fn start(&self) -> Result<State, RunError> {
        let model = &*self.model;
        let (t, Beginning { x, largest, negative }) = beginning(model, self.start.as_ref())?;
        Ok(State::new(model.description(), t, x.as_slice(), largest.as_slice(), negative.as_deref()))
    }

    /// Makes the run.
    ///
    /// # Errors
    /// The start cannot be assembled, the state is not one of this mechanism, or the run stops before its end: then the
    /// error has what was reached.
    pub fn run(self) -> Result<Trajectory, RunError> {
        let Self { model, request, start, each_step, ending } = self;
        Integration { request, start, each_step, ending }.recorded(&*model, None)
    }
}

/// A run that was not made, or not to its end.
#[derive(Debug, Error)]
pub enum RunError {
    /// The mechanism cannot be assembled.
    #[error(transparent)]
    Start(#[from] AssemblyError),
    /// A state that it cannot start from.
    #[error(transparent)]
    State(#[from] StateError),
    /// It stopped before its end.
    #[error(transparent)]
    Stopped(Box<Stopped>),
}

/// The time (s) and the states that a run starts from: of `start`, else the model's own.
fn beginning(model: &dyn Machine, start: Option<&State>) -> Result<(f64, Beginning), RunError> {
    let Some(state) = start else {
        let x = model.start()?;
        return Ok((0.0, Beginning::at(DVector::from_vec(x))));
    };
    if !model.delays().is_empty() {
        return Err(StateError::Delays(model.description().name.to_owned()).into());
    }
    let Beginning { x, largest, negative } = state.beginning(model.description())?;
    let standing = Standing::new(model, state.t, largest.as_slice(), CLOSE);
    let negative = negative.map(|negative| standing.possible(x.as_slice(), negative));
    let x = standing.closed(x.as_slice(), negative.as_deref()).map_err(StateError::from)?;
    Ok((state.t, Beginning { x: DVector::from_vec(x), largest, negative }))
}

/// What is integrated.
struct Integration<'a> {
    request: Request,
    start: Option<State>,
    each_step: EachStep<'a>,
    ending: Option<Ending<'a>>,
}

/// Makes a run of `model` from its start as it is asked for, with another observer.
///
/// # Errors
/// The start cannot be assembled, or the run stops before its end.
pub fn observed(model: &dyn Machine, request: &Request, observer: &mut dyn Observer) -> Result<Trajectory, RunError> {
    let each_step = Box::new(|_| ControlFlow::Continue(()));
    let request = request.clone();
    Integration { request, start: None, each_step, ending: None }.recorded(model, Some(observer))
}

impl Integration<'_> {
    fn recorded(self, model: &dyn Machine, another: Option<&mut dyn Observer>) -> Result<Trajectory, RunError> {
        let Self { request, start, each_step, ending } = self;
        let stopwatch = Stopwatch::started();
        let (t0, beginning) = beginning(model, start.as_ref())?;
        let mut method: AnyMethod = request.method();
        let first = Change { t: t0, method: method.name(), reason: Reason::First };
        let settings = request.settings(t0);
        let mut observer = observer(model, (t0, &request), each_step, another);
        observer.0.largest.copy_from_slice(beginning.largest.as_slice());
        let span = Span { t0, t_end: request.t_end };
        let mut ending = ending.map(|ending| of_state(model, ending));
        let ending = ending.as_mut().map(|ending| ending as &mut Condition<'_>);
        let outcome = make(model, &mut method, &beginning, span, &settings, ending, &mut observer);
        let (finish, cause) = match outcome {
            Ok(finish) => (finish, None),
            Err(failure) => (*failure.last, Some(failure.cause)),
        };
        let changes = method.changes();
        // What begins may depend on the tolerances.
        let begins = changes.first().is_some_and(|change| change.reason == Reason::First);
        let methods = Some(first).filter(|_| !begins).into_iter().chain(changes.iter().copied()).collect();
        Made { finish, cause, methods, wall: stopwatch.elapsed() }.concluded(model, recorded(observer), request)
    }
}

/// The observers of a run: what records it, what hands its steps on, another one, what finds its peaks where these are
/// asked for.
type Observers<'a, 'b, 'c> = (Recorder<'a>, (Told<'b>, (Option<&'c mut dyn Observer>, Option<PeakMonitor<'a>>)));

fn observer<'a, 'b, 'c>(
    model: &'a dyn Machine,
    (t0, request): (f64, &Request),
    each_step: EachStep<'b>,
    another: Option<&'c mut dyn Observer>,
) -> Observers<'a, 'b, 'c> {
    let peaks = request.peaks.then(|| PeakMonitor::new(model, request.settled));
    let Request { interrupt, progress, .. } = request.clone();
    let told = Told { each_step, t0, interrupt, progress, is_done: false };
    (Recorder::new(model, &request.parts), (told, (another, peaks)))
}

/// What was recorded, with the peaks that were found.
fn recorded<'a>((mut recorder, (_, (_, peaks))): Observers<'a, '_, '_>) -> Recorder<'a> {
    if let Some(peaks) = peaks {
        recorder.keep(&peaks);
    }
    recorder
}

/// A run that has been made.
struct Made {
    finish: Finish,
    /// Why it failed.
    cause: Option<Cause>,
    /// The methods that made its steps, the first from its start.
    methods: Vec<Change>,
    wall: Duration,
}

impl Made {
    /// What it gives.
    fn concluded(
        self,
        model: &dyn Machine,
        mut recorder: Recorder<'_>,
        request: Request,
    ) -> Result<Trajectory, RunError> {
        let Self { finish, cause, methods, wall } = self;
        let starts_at_zero = methods.first().is_some_and(|first| first.t == 0.0);
        // The end of a run that was stopped is none of the instants that were listed before it.
        let is_sampled = recorder.recording.times.last().is_some_and(|&t| t >= finish.t);
        if matches!(request.samples, Samples::Every(_)) && cause.is_none() && !is_sampled {
            recorder.sample(finish.t, finish.x.as_slice(), &finish.negative);
        }
        let is_interrupted = finish.ended == Ended::ByObserver && request.interrupt.is_set();
        let cause = cause.or(is_interrupted.then_some(Cause::Interrupted { t: finish.t }));
        // What could not be calculated was so before anything else failed.
        let fault = recorder.fault.map(Cause::from);
        let (cause, ended) = match fault.or(cause) {
            None => (None, finish.ended),
            cause => (cause, Ended::ByFailure),
        };
        let states = model.description().states.iter().zip(&finish.uncontrolled);
        let uncontrolled = states.filter(|(_, is)| **is).map(|(of, _)| of.name).collect();
        let trajectory = Trajectory {
            recording: recorder.recording,
            ended,
            statistics: finish.statistics,
            uncontrolled,
            methods,
            wall,
            redundant: model.redundant(),
            impulse_energy: if starts_at_zero { model.impulse_energy().unwrap_or(0.0) } else { 0.0 },
            last: last(model, &finish, recorder.largest),
            request,
        };
        match cause {
            None => Ok(trajectory),
            Some(cause) => Err(RunError::Stopped(Box::new(Stopped { cause, trajectory }))),
        }
    }
}

/// Where a run has come to, by name; its states have been as large as `largest` before. What coarse steps have left of
/// gaps is closed: another run could not start there.
fn last(model: &dyn Machine, Finish { t, x, negative, .. }: &Finish, mut largest: Vec<f64>) -> State {
    /// The part of a state that a projection may move it by, to be left as it is.
    const EXACT: f64 = 1e-12;
    const ROUNDS: usize = 4;
    raise(&mut largest, x.as_slice());
    let mut x = x.as_slice().to_vec();
    for _ in 0..ROUNDS {
        let mut closer = x.clone();
        model.project(*t, negative, &mut closer);
        let moves = |index: usize| (closer[index] - x[index]).abs() > EXACT * largest[index];
        if !(0..x.len()).any(moves) || closer.iter().any(|value| !value.is_finite()) {
            break;
        }
        x = closer;
    }
    State::new(model.description(), *t, &x, &largest, Some(negative))
}

/// Hands each step on.
struct Told<'a> {
    each_step: EachStep<'a>,
    /// Where the run begins, s.
    t0: f64,
    interrupt: Interrupt,
    progress: Progress,
    is_done: bool,
}

impl Observer for Told<'_> {
    fn step(&mut self, t: f64, t_end: f64, _statistics: &Statistics) {
        self.progress.tell((t - self.t0) / (t_end - self.t0));
        self.is_done = (self.each_step)(t).is_break() || self.interrupt.is_set();
    }

    fn is_done(&self) -> bool {
        self.is_done
    }
}
