//! Reference solutions: a system integrated in any [`Scalar`], such as [`crate::scalar::DoubleDouble`], far beyond the
//! accuracy of the integrators for runs.
//!
//! In: a system, its start, a span, an accuracy, instants. Out: the state at the instants, told to an observer, and at
//! the end. Method: Gragg's midpoint rule extrapolated after Bulirsch and Stoer ([`Accuracy::columns`] columns, order
//! twice that) with steps by the estimated error. Steps end at the instants, at kinks of inputs and at the switchings,
//! so nothing is interpolated; a switching is located by steps of other sizes until the guard vanishes to rounding.
//! Explicit: a stiff system costs as many steps as its stability takes.

mod branch;
mod extrapolation;
mod monitor;
mod sizes;
#[cfg(test)]
mod tests;

use thiserror::Error;

use crate::model::clock::{self, Clock};
use crate::model::dynamics::{Dynamics, Machine};
use crate::model::sampled;
use crate::model::scalar::{DoubleDouble, Scalar};
use crate::solve::failure::switch_text;
use crate::solve::simulation::Span;
use extrapolation::Extrapolation;
use monitor::{Course, GuardMonitor};

/// How exactly to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The columns of the extrapolation, 2 to 20; the order is twice as high. Rate evaluations of a step: their square
    /// + 1.
    pub columns: usize,
    /// The error estimated for a step, at most this part of the size of each state: of its largest value, or of a
    /// small part of the size at which it counts beside the others ([`crate::simulation::sizes`]).
    pub tolerance: f64,
}

/// A change of branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event<S> {
    /// When, s.
    pub t: S,
    /// The switch that changed its branch.
    pub switch: usize,
}

/// Where a run has come to, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Finish<S> {
    /// State at the end.
    pub x: Vec<S>,
    /// The branches of the switches at the end.
    pub negative: Vec<bool>,
    /// The changes of branches, in the order of time.
    pub events: Vec<Event<S>>,
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps, and those tried to locate events.
    pub rejected: u64,
    /// Evaluations of the rate function.
    pub rate_evaluations: u64,
}

/// Why a run stopped.
#[derive(Clone, PartialEq, Error)]
pub enum Fault {
    /// The instants, the span or the accuracy cannot be.
    #[error("{0}")]
    BadInput(&'static str),
    /// The tolerance calls for a smaller step than rounding allows, or a number is not finite.
    #[error("the step fell to {h:e} s at t = {t} s")]
    StepTooSmall {
        /// Time, s.
        t: f64,
        /// The step, s.
        h: f64,
    },
    /// A switch changes its branch again and again at one instant.
    #[error("{} changes its branch without end at t = {t} s", switch_text(.name, *.switch))]
    EventsAccumulate {
        /// The switch.
        switch: usize,
        /// Its name, such as ``if v < 0` of `valve``; empty where it has none.
        name: &'static str,
        /// Time, s.
        t: f64,
    },
}

debug_is_display!(Fault);

/// Parts of the span: the first step, the step from which on nothing is looked at more closely, the smallest step.
const FIRST: f64 = 1e-6;
const CLOSEST: f64 = 1e-12;
const SMALLEST: f64 = 1e-24;
/// Events in a row, each nearer to the last one than [`CLOSEST`], that end a run.
const CROWD: usize = 100;

/// Is given time (s), state and branches at an instant.
pub type Observe<'a, S> = dyn FnMut(S, &[S], &[bool]) + 'a;

/// Integrates `system` from `start` at `span.t0` to `span.t_end`; gives time, state and branches at each of the
/// `instants` (s, ascending, in the span) to `observe`. The start is projected onto the system's invariants first.
/// Branches at the start follow from the guards' signs; a guard that is exactly zero is decided by its sign a little
/// later.
///
/// # Errors
/// [`Fault`].
///
/// # Panics
/// The start has another number of states.
pub fn integrate<S: Scalar<Switch = bool>>(
    system: &dyn Dynamics<S>,
    start: &[S],
    span: Span,
    accuracy: Accuracy,
    instants: &[f64],
    observe: &mut Observe<'_, S>,
) -> Result<Finish<S>, Fault> {
    assert_eq!(start.len(), system.states(), "a number for each state");
    check(span, accuracy, instants)?;
    if system.stops().is_some() {
        return Err(Fault::BadInput("stops with a restitution make the state jump, which only runs in `f64` follow"));
    }
    if !system.delays().is_empty() {
        return Err(Fault::BadInput("a delay of a signal at any time has a past, which only runs in `f64` keep"));
    }
    let mut run = Run::new(system, start, span, accuracy);
    run.begin();
    for &instant in instants {
        run.advance_over_breaks(instant)?;
        observe(run.t, &run.x, &run.negative);
    }
    run.advance_over_breaks(span.t_end)?;
    let Run { x, negative, events, steps, rejected, rate_evaluations, .. } = run;
    Ok(Finish { x, negative, events, steps, rejected, rate_evaluations })
}

/// The outputs of `model` with these places in its description at each of the `instants` (s, ascending, from 0 on), in
/// double-double arithmetic from this start, rounded once: `told` is told the instant and their values. As
/// [`integrate`], compiled here.
///
/// # Errors
/// [`Fault`].
///
/// # Panics
/// The start has another number of states; there is no such output.
pub fn outputs(
    model: &dyn Machine<DoubleDouble>,
    start: &[f64],
    accuracy: Accuracy,
    instants: &[f64],
    places: &[usize],
    told: &mut dyn FnMut(f64, &[f64]),
) -> Result<Finish<DoubleDouble>, Fault> {
    let start: Vec<DoubleDouble> = start.iter().copied().map(DoubleDouble::from).collect();
    let span = Span { t0: 0.0, t_end: instants.last().copied().unwrap_or(0.0) };
    let mut y = vec![DoubleDouble::default(); model.description().outputs.len()];
    integrate(model, &start, span, accuracy, instants, &mut |t, x, negative| {
        model.outputs(t, x, negative, &mut y);
        told(t.to_f64(), &places.iter().map(|&place| y[place].to_f64()).collect::<Vec<_>>());
    })
}

fn check(span: Span, accuracy: Accuracy, instants: &[f64]) -> Result<(), Fault> {
    let is_ordered = instants.is_sorted()
        && instants.first().is_none_or(|first| *first >= span.t0)
        && instants.last().is_none_or(|last| *last <= span.t_end);
    if !(span.t0.is_finite() && span.t_end.is_finite() && span.t0 <= span.t_end) {
        Err(Fault::BadInput("the span must be finite and must not end before its start"))
    } else if !is_ordered {
        Err(Fault::BadInput("the instants must ascend and be in the span"))
    } else if !(2..=20).contains(&accuracy.columns) || accuracy.tolerance <= 0.0 || accuracy.tolerance.is_nan() {
        Err(Fault::BadInput("2 to 20 columns and a tolerance above 0 are possible"))
    } else {
        Ok(())
    }
}

/// A run under way.
struct Run<'a, S: Scalar> {
    system: &'a dyn Dynamics<S>,
    accuracy: Accuracy,
    /// The length of the span, s.
    length: f64,
    t: S,
    x: Vec<S>,
    negative: Vec<bool>,
    /// How large each state is, in its unit.
    sizes: Vec<f64>,
    /// The size of the next step, s.
    step: f64,
    method: Extrapolation<S>,
    monitor: GuardMonitor<S>,
    events: Vec<Event<S>>,
    steps: u64,
    rejected: u64,
    rate_evaluations: u64,
    clocks: Vec<Clock<S>>,
    /// The last instant of a clock, s, up to which samples are computed.
    computed: f64,
}

impl<'a, S: Scalar<Switch = bool>> Run<'a, S> {
    fn new(system: &'a dyn Dynamics<S>, start: &[S], span: Span, accuracy: Accuracy) -> Self {
        let length = span.t_end - span.t0;
        Self {
            system,
            accuracy,
            length,
            t: S::from_f64(span.t0),
            x: start.to_vec(),
            negative: vec![false; system.switches()],
            sizes: vec![0.0; start.len()],
            step: FIRST * length,
            method: Extrapolation::new(accuracy.columns, start.len()),
            monitor: GuardMonitor::new(accuracy.tolerance, system.switches()),
            events: Vec::new(),
            steps: 0,
            rejected: 0,
            rate_evaluations: 0,
            clocks: system.clocks(),
            computed: span.t0,
        }
    }

    /// Steps until `target` (s) is reached, with a step's end at each instant from which on the system follows another
    /// law.
    fn advance_over_breaks(&mut self, target: f64) -> Result<(), Fault> {
        loop {
            let now = self.t.to_f64();
            let next = self.system.next_break(now).min(clock::next(&self.clocks, now));
            if !(next > now && next < target) {
                self.advance(target)?;
                return self.compute_samples();
            }
            self.advance(next)?;
            self.compute_samples()?;
        }
    }

    /// Computes the samples of the model where an instant of a clock is reached for the first time.
    fn compute_samples(&mut self) -> Result<(), Fault> {
        let t = self.t.to_f64();
        if !(clock::is_due(&self.clocks, t) && t > self.computed) {
            return Ok(());
        }
        self.computed = t;
        sampled::compute_due(self.system, &self.clocks, t, &self.negative, &mut self.x);
        // Guards that this moves to the wrong side change their branches at once.
        self.switch(vec![false; self.negative.len()])
    }

    /// Steps until `target` (s) is reached exactly.
    fn advance(&mut self, target: f64) -> Result<(), Fault> {
        let target = S::from_f64(target);
        while self.t < target {
            let rest = target - self.t;
            // Equal parts: no step is much shorter than the others.
            let parts = (rest.to_f64() / self.step).ceil().max(1.0);
            let h = rest / S::from_f64(parts);
            self.check_step(h)?;
            let error = self.attempt(h);
            if error > 1.0 || error.is_nan() {
                self.shorten(h, self.factor(error));
                continue;
            }
            match self.monitor.course(&self.negative) {
                Course::Unclear if h.to_f64() > CLOSEST * self.length => self.shorten(h, 0.5),
                Course::WrongFromStart => {
                    let before = self.negative.clone();
                    self.switch(self.monitor.wrong(&before))?;
                    if self.negative == before {
                        // The branch is right, so the step is too long for the guard's course.
                        self.shorten(h, 0.1);
                    }
                }
                Course::Crosses(crossing) => {
                    let (h, switches) = self.locate(h, crossing);
                    self.accept(self.t + h);
                    self.switch(switches)?;
                }
                Course::Clear | Course::Unclear => {
                    self.accept(if parts == 1.0 { target } else { self.t + h });
                    self.step = h.to_f64() * self.factor(error);
                }
            }
        }
        Ok(())
    }

    /// Tries a step of size `h` (s) and looks at the guards on its way and at its projected end; gives the estimated
    /// error over the tolerance.
    fn attempt(&mut self, h: S) -> f64 {
        let Self { system, negative, monitor, rate_evaluations, .. } = self;
        let (system, negative) = (*system, &negative[..]);
        let mut rate = |t: S, x: &[S], dx: &mut [S]| {
            *rate_evaluations += 1;
            system.rate(t, x, negative, dx);
        };
        let guards = |t: S, x: &[S]| guards(system, t, x, negative);
        monitor.begin_step(guards(self.t, &self.x), h);
        self.method.attempt(self.t, &self.x, h, &mut rate, &mut |t, x| monitor.pass(guards(t, x)));
        let error = self.method.error(&self.sizes, self.accuracy.tolerance);
        system.project(self.t + h, negative, &mut self.method.end);
        self.monitor.end_step(guards(self.t + h, &self.method.end));
        error
    }

    /// By how much the step may grow, or has to shrink, for an error over the tolerance.
    fn factor(&self, error: f64) -> f64 {
        // The estimate is that of the last but one column.
        let order = 2 * self.accuracy.columns - 1;
        let factor = 0.9 * libm::pow(error, -1.0 / order as f64);
        if factor.is_nan() { 0.1 } else { factor.clamp(0.1, 4.0) }
    }

    /// Rejects a step of size `h` (s): the next one has this part of it.
    fn shorten(&mut self, h: S, part: f64) {
        self.rejected += 1;
        self.step = h.to_f64() * part;
    }

    /// Takes the last attempt over, which has come to the time `t` (s).
    fn accept(&mut self, t: S) {
        self.steps += 1;
        self.t = t;
        self.x.copy_from_slice(&self.method.end);
        if sizes::are_outgrown(&self.sizes, &self.x) {
            self.raise_sizes();
        }
    }

    fn raise_sizes(&mut self) {
        sizes::raise(&mut self.sizes, self.system, (self.t, &self.x), self.length, self.accuracy.tolerance);
    }

    fn check_step(&self, h: S) -> Result<(), Fault> {
        let is_seen = h.to_f64() > SMALLEST * self.length && self.t + h > self.t;
        if is_seen { Ok(()) } else { Err(Fault::StepTooSmall { t: self.t.to_f64(), h: h.to_f64() }) }
    }
}

/// The guards at time `t` (s) and state `x` in the branches `negative`.
fn guards<S: Scalar>(system: &dyn Dynamics<S>, t: S, x: &[S], negative: &[S::Switch]) -> Vec<S> {
    let mut value = vec![S::from_f64(0.0); negative.len()];
    system.guards(t, x, negative, &mut value);
    value
}
