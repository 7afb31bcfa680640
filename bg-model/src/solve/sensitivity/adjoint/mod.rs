//! The gradient of one number that a run gives by many parameters at once.
//!
//! In: a model, what is asked of a run, an [`Objective`], directions. Out: the run, the number and its
//! derivative along each direction. Method: the run is made as without derivatives, and recorded; then it is followed
//! backwards, step by step, event by event, with how the objective depends on the state there. Each piece is the
//! transposed one of what slopes do that follow a run ([`sensitivities`](super::sensitivities)), so that both agree to
//! rounding. The cost hardly depends on the number of directions: one run, and per step its stages once again and a
//! reverse sweep for each. Source: D. Cao, S. Li, L. Petzold, R. Serban, SIAM J. Sci. Comput. 24 (2003).

mod back;
mod event;
mod lifted;
mod objective;
mod record;

use super::{Direction, SensitivityError};
use crate::model::description::Description;
use crate::model::dynamics::Machine;
use crate::model::mechanism::Reversible;
use crate::solve::integrator::Scale;
use crate::solve::run::{Interrupt, Progress, Request, Trajectory, observed};
use crate::solve::simulation;
use back::{Back, Crossing, add, dot};
use event::back_over;
use lifted::{Lifted, weighted};
pub use objective::{Measured, Objective};
use record::{Happened, Record, Sample, Step};

/// The states of a run that are kept unless another number is asked for.
const MOST_STATES: usize = 1 << 16;

/// About the part of the time that the run takes; the rest is that of following it backwards.
const RUN: f64 = 0.25;

/// A number that a run gives, with its derivatives.
#[derive(Clone, Debug)]
pub struct Gradients {
    /// The run; its samples are at the instants of the objective.
    pub trajectory: Trajectory,
    /// The objective.
    pub value: f64,
    /// The directions, as they were asked for.
    pub directions: Vec<Direction>,
    /// The derivative of the objective along each direction, in the objective's unit per the direction's.
    pub by: Vec<f64>,
}

/// Makes a run of `model` from its own start, as it is asked for but with samples where `objective` needs them, and
/// gives the objective with its derivatives along `directions`. Of a run by DOP853 these are the derivatives of what
/// the run calculates, an integral over it that of its steps' quadrature. Keeps 65536 states of the run at most; of a
/// longer run it makes steps once more.
///
/// ```
/// use bg_model::bond_graph;
/// use bg_model::integrator::Integrator;
/// use bg_model::run::Request;
/// use bg_model::sensitivity::{Direction, Objective, gradient};
///
/// bond_graph! {
///     pub graph Oscillator {
///         param mass: kg = 2, above 0;
///         param stiffness: N/m = 50, at least 0;
///         1 slide: translation;
///         I body = mass; C spring = stiffness start 0.1;
///         slide -> body; slide -> spring;
///         observe { x: m = spring.q }
///     }
/// }
///
/// let model = Oscillator::new(OscillatorParameters::default())?;
/// let request = Request { method: Integrator::Dop853, t_end: 1.0, rtol: 1e-10, ..Request::default() };
/// let found = gradient(&model, &request, &Objective::last(0), &Direction::parameters::<Oscillator>())?;
/// // x = 0.1 cos(w t) with w = sqrt(k / m): dx/dk = -0.1 sin(w t) t / (2 m w).
/// let expected = -0.1 * 5.0_f64.sin() / (2.0 * 2.0 * 5.0);
/// assert!((found.by[1] - expected).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SensitivityError`].
///
/// # Panics
/// The objective names an output that there is none of.
pub fn gradient(
    model: &dyn Reversible,
    request: &Request,
    objective: &Objective<'_>,
    directions: &[Direction],
) -> Result<Gradients, SensitivityError> {
    gradient_within(model, request, objective, directions, MOST_STATES)
}

/// As [`gradient`], keeping at most `states` states of the run, at least two.
///
/// # Errors
/// As there.
///
/// # Panics
/// As there.
pub fn gradient_within(
    model: &dyn Reversible,
    request: &Request,
    objective: &Objective<'_>,
    directions: &[Direction],
    states: usize,
) -> Result<Gradients, SensitivityError> {
    let instants = objective.instants(request.t_end);
    if let Some(&(t, ..)) = instants.iter().find(|(t, ..)| !(0.0..=request.t_end).contains(t)) {
        return Err(SensitivityError::OutsideOfRun { t, t_end: request.t_end });
    }
    let Description { name, .. } = model.description();
    if !model.machine().delays().is_empty() {
        return Err(SensitivityError::Delays { model: name });
    }
    let Some(sweeps) = model.swept() else { return Err(SensitivityError::NoReverseSweep { model: name }) };
    let mut times: Vec<f64> = instants.iter().map(|&(t, ..)| t).collect();
    times.dedup();
    let progress = &request.progress;
    let [forwards, back_again] = [progress.part(0.0, RUN), progress.part(RUN, 1.0)];
    let request = Request { samples: simulation::Samples::At(times), progress: forwards, ..request.clone() };
    let (machine, values) = (model.machine(), model.values());
    let mut at_samples = AtSamples { objective, instants: &instants, given: 0, value: 0.0 };
    let add = |t: f64, x: &[f64], negative: &[bool]| at_samples.add(t, &outputs(&*machine, t, x, negative));
    let mut record = Record::new(Box::new(add), machine.start()?, states);
    let outcome = observed(&*machine, &request, &mut record);
    if let Some(error) = record.error.take() {
        return Err(error);
    }
    let trajectory = outcome?;
    let of = |chunk: &[Direction]| Ok(model.lifted(&super::sloped(&values, chunk))?);
    let lifted = Lifted::new(directions, of)?;
    let scale = record.scale.clone().unwrap_or_else(|| Scale::new(&request.tolerances(), machine.states()));
    let back = Back::new((&*machine, &*sweeps, lifted), (scale, super::is_own(&request)), &objective.integrals);
    let weights = vec![0.0; machine.states()];
    let told = (&request.interrupt, back_again);
    let mut backwards = Backwards { back, record: &record, model: &*machine, weights, told };
    backwards.back_to_start()?;
    backwards.by_parameters(directions)?;
    let (integral, by) = (backwards.back.integral, backwards.back.lifted.by);
    drop(record);
    let value = at_samples.value + integral;
    Ok(Gradients { trajectory, value, directions: directions.to_vec(), by })
}

/// The outputs at time `t` (s) and state `x`.
fn outputs(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<f64> {
    let mut outputs = vec![0.0; model.description().outputs.len()];
    model.outputs(t, x, negative, &mut outputs);
    outputs
}

/// The terms of an objective while the run is made.
struct AtSamples<'a> {
    objective: &'a Objective<'a>,
    instants: &'a [(f64, usize, usize)],
    /// How many of the instants have been.
    given: usize,
    /// The sum of the terms there.
    value: f64,
}

impl AtSamples<'_> {
    /// Adds the terms at the sample at `t` (s); gives their derivatives by the outputs, none where all are zero.
    fn add(&mut self, t: f64, outputs: &[f64]) -> Option<Vec<f64>> {
        let mut weights = vec![0.0; outputs.len()];
        let now = self.instants[self.given..].iter().take_while(|(instant, ..)| *instant <= t);
        for &(_, term, k) in now {
            let term = &self.objective.terms[term];
            let mut by = vec![0.0; outputs.len()];
            self.value += term.factor * (term.value)(k, outputs, &mut by);
            weights.iter_mut().zip(by).for_each(|(weight, by)| *weight += term.factor * by);
            self.given += 1;
        }
        weights.iter().any(|weight| *weight != 0.0).then_some(weights)
    }
}

/// A recorded run that is followed backwards.
struct Backwards<'a> {
    model: &'a dyn Machine,
    record: &'a Record<'a>,
    back: Back<'a>,
    /// How the objective depends on the state where this has come to.
    weights: Vec<f64>,
    /// What ends it, and what it tells how far it is.
    told: (&'a Interrupt, Progress),
}

impl Backwards<'_> {
    /// Follows the run from its end to its start.
    fn back_to_start(&mut self) -> Result<(), SensitivityError> {
        let Record { states, stride, steps, events, samples, .. } = self.record;
        let (mut events, mut samples) = (events.as_slice(), samples.as_slice());
        for (kept, state) in states.iter().enumerate().rev() {
            let first = kept * stride;
            let starts = self.again(first..steps.len().min(first + stride), state)?;
            for (number, x) in starts.iter().enumerate().rev().map(|(k, x)| (first + k, x)) {
                let (interrupt, progress) = &self.told;
                progress.tell(1.0 - number as f64 / steps.len() as f64);
                if interrupt.is_set() {
                    return Err(SensitivityError::Interrupted { t: self.record.steps[number].to });
                }
                let mut inside = vec![0.0; x.len()];
                loop {
                    let sample = last_after(samples, number, |sample| sample.steps);
                    let happened = last_after(events, number, |happened| happened.steps);
                    // At the instants of clocks samples come after the event.
                    if let Some((happened, before)) =
                        happened.filter(|_| sample.is_none_or(|(of, _)| of.events < events.len()))
                    {
                        self.over(happened)?;
                        events = before;
                    } else if let Some((sample, before)) = sample {
                        self.sampled(sample, number, x, &mut inside)?;
                        samples = before;
                    } else {
                        break;
                    }
                }
                self.back_along(number, x)?;
                add(&mut self.weights, &inside);
            }
        }
        for sample in samples {
            let weights = self.by_outputs(sample);
            add(&mut self.weights, &weights);
        }
        Ok(())
    }

    /// The start states of some steps, from that of the first: made again where there are several.
    fn again(&mut self, numbers: std::ops::Range<usize>, state: &[f64]) -> Result<Vec<Vec<f64>>, SensitivityError> {
        let mut starts = vec![state.to_vec()];
        for number in numbers.start..numbers.end - 1 {
            let events = &self.record.events;
            let happened = events[..events.partition_point(|happened| happened.steps <= number + 1)].last();
            let next = match happened.filter(|happened| happened.steps == number + 1) {
                Some(Happened { switching, .. }) => switching.after.x.as_slice().to_vec(),
                None => {
                    let (Step { from, to, branches }, x) = (self.record.steps[number], &starts[starts.len() - 1]);
                    let negative = &self.record.branches[branches as usize];
                    let end = self.back.cross(Crossing { from, to, negative, x });
                    end.ok_or(SensitivityError::Inexact { t: from })?.projected
                }
            };
            starts.push(next);
        }
        Ok(starts)
    }

    /// Follows a step from its end to its start `x`.
    fn back_along(&mut self, number: usize, x: &[f64]) -> Result<(), SensitivityError> {
        let record = self.record;
        let Step { from, to, branches } = record.steps[number];
        let crossing = Crossing { from, to, negative: &record.branches[branches as usize], x };
        let followed = self.back.follow(crossing, true, &mut self.weights);
        followed.then_some(()).ok_or(SensitivityError::Inexact { t: from })
    }

    /// Adds what the objective takes of a sample in or at the end of a step from `x`: to `inside`, how it depends on
    /// that state, or to the weights at the end.
    fn sampled(
        &mut self,
        sample: &Sample,
        number: usize,
        x: &[f64],
        inside: &mut [f64],
    ) -> Result<(), SensitivityError> {
        let record = self.record;
        let Step { from, to, branches } = record.steps[number];
        let mut weights = self.by_outputs(sample);
        if sample.t == to {
            add(&mut self.weights, &weights);
            return Ok(());
        }
        let crossing = Crossing { from, to: sample.t, negative: &record.branches[branches as usize], x };
        if !self.back.follow(crossing, false, &mut weights) {
            return Err(SensitivityError::Inexact { t: from });
        }
        add(inside, &weights);
        Ok(())
    }

    /// How the objective depends on the state at a sample.
    fn by_outputs(&mut self, sample: &Sample) -> Vec<f64> {
        let Sample { t, x, branches, weights, .. } = sample;
        let negative = &self.record.branches[*branches as usize];
        self.back.by_outputs(*t, x, negative, weights)
    }

    /// Follows an event backwards.
    fn over(&mut self, happened: &Happened) -> Result<(), SensitivityError> {
        let event = &*happened.switching;
        let gained = self.back.integrand.as_ref().map_or(0.0, |factors| {
            let ends = [(&event.before, &event.negative_before), (&event.after, &event.negative_after)];
            let [before, after] =
                ends.map(|(point, negative)| dot(factors, &outputs(self.model, point.t, point.x.as_slice(), negative)));
            before - after
        });
        back_over(&mut self.back.lifted, event, gained, &mut self.weights).ok_or_else(|| {
            let switch = event.reached.iter().position(|&reached| reached).unwrap_or_default();
            let switch = self.model.switch_name(switch).unwrap_or("a switch");
            SensitivityError::Grazes { switch, t: event.before.t }
        })
    }

    /// From the weights of the start state and of the constants to the directions.
    fn by_parameters(&mut self, directions: &[Direction]) -> Result<(), SensitivityError> {
        let Self { record, back, weights, .. } = self;
        if let (Some(step), Some(x)) = (record.steps.first(), record.states.first()) {
            let negative = &record.branches[step.branches as usize];
            back.sweeps.reverse_project(step.from, x, negative, weights, &mut back.by_constants);
        }
        back.lifted.try_add_by_parameters(|system| {
            let start = system.start()?;
            Ok::<_, SensitivityError>(weighted(&start, weights))
        })?;
        let by_constants = &back.by_constants;
        back.lifted.add_by_parameters(1.0, |system| weighted(system.constants(), by_constants));
        for (by, direction) in back.lifted.by.iter_mut().zip(directions) {
            if let Direction::Start(state) = direction {
                *by += weights[*state];
            }
        }
        Ok(())
    }
}

/// The last of some things in order, if it comes after the step of this number, and those before it.
fn last_after<T>(of: &[T], number: usize, steps: impl Fn(&T) -> usize) -> Option<(&T, &[T])> {
    let (last, before) = of.split_last()?;
    (steps(last) > number).then_some((last, before))
}
