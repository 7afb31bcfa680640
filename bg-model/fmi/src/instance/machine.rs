//! A model where it stands, whatever the number of its states.
//!
//! In: a model with its parameters. Out: rates, outputs, guards at a time and state; what an event makes of branches
//! and state; the state a piece of time later, by a run that goes on from piece to piece.

use std::rc::Rc;

use bg_model::dynamics::Machine;
use bg_model::failure::Origin;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::run::Request;
use bg_model::simulation::{Ongoing, Settings, raise, sizes_of};
use bg_model::standing::{CLOSE, Misplaced, Standing};
use bg_model::statistics::Statistics;
use bg_model::{clock, sampled};

use super::Fault;
use super::saved::ModelState;

/// The part of the machine's size by which a host's steps may have left joints, orientations and stops: it may have
/// located an event no better.
const DRIFT: f64 = 1e-3;

/// A model at a time, in a state, its switches in branches.
#[derive(Clone)]
pub(crate) struct Stood {
    model: Rc<dyn Machine>,
    /// Time, s.
    t: f64,
    /// The model's own start.
    start: Vec<f64>,
    x: Vec<f64>,
    /// How large each state is to be taken for at the start, in its unit.
    size: Vec<f64>,
    /// How large each state has been.
    largest: Vec<f64>,
    /// The branches of the switches, once an event or a step has found them.
    negative: Option<Vec<bool>>,
    /// All positive, before they are found.
    none: Vec<bool>,
    /// Up to when samples are computed, s.
    computed: f64,
    /// Up to when clocks have ticked, s.
    ticked: f64,
    /// The run from here on, once there is one.
    run: Option<Run>,
}

#[derive(Clone)]
struct Run {
    method: AnyMethod,
    ongoing: Ongoing,
}

impl Run {
    fn at(t: f64, x: &[f64], largest: &[f64], negative: Option<&[bool]>) -> Self {
        let ongoing = match negative {
            Some(negative) => Ongoing::standing(t, x, negative),
            None => Ongoing::at(t, x),
        };
        let method = Integrator::default().method(Request::default().fixed_step);
        Self { method, ongoing: ongoing.grown(largest) }
    }
}

fn settings(rtol: f64) -> Settings {
    Settings { tolerances: Tolerances::relative(rtol), ..Settings::default() }
}

/// Nominal values of these sizes: 1 SI unit, as the standard has it, where nothing is known.
fn above_zero(sizes: impl Iterator<Item = f64>) -> Vec<f64> {
    sizes.map(|size| if size > 0.0 && size.is_finite() { size } else { 1.0 }).collect()
}

/// How large each state of a model is to be taken for in state `x` at time `t` (s), in its unit.
fn nominals(model: &dyn Machine, t: f64, x: &[f64]) -> Vec<f64> {
    above_zero(sizes_of(model, t, x).iter().copied())
}

/// The nominal values of a model's states at its start, where it has one.
pub(crate) fn nominals_at_start(model: &dyn Machine) -> Option<Vec<f64>> {
    Some(nominals(model, 0.0, &model.start().ok()?))
}

fn misplaced(fault: Misplaced) -> Fault {
    Fault::Misplaced(fault.to_string())
}

impl Stood {
    /// A model at its start, whose time is `t` (s).
    ///
    /// # Errors
    /// It cannot be assembled.
    pub fn at_start(model: Rc<dyn Machine>, t: f64) -> Result<Self, Fault> {
        let x = model.start().map_err(|fault| Fault::Start(fault.to_string()))?;
        let (size, largest) = (nominals(&*model, t, &x), x.iter().map(|x| x.abs()).collect());
        let none = vec![false; model.switches()];
        Ok(Self {
            model,
            t,
            start: x.clone(),
            x,
            size,
            largest,
            negative: None,
            none,
            computed: t,
            ticked: f64::NEG_INFINITY,
            run: None,
        })
    }

    /// Whether it delays signals, whose past the steps of its run keep.
    pub fn delays(&self) -> bool {
        !self.model.delays().is_empty()
    }

    /// Time, s.
    pub fn time(&self) -> f64 {
        self.t
    }

    pub fn set_time(&mut self, t: f64) {
        self.t = t;
    }

    pub fn states(&self) -> &[f64] {
        &self.x
    }

    /// Stands in another state; none of it but that its numbers are finite is checked before the next event, since a
    /// host's steps drift.
    pub fn set_states(&mut self, x: &[f64]) {
        self.x.copy_from_slice(x);
        raise(&mut self.largest, x);
    }

    /// How large each state has been.
    pub fn largest(&self) -> &[f64] {
        &self.largest
    }

    /// Whether each switch is in the branch of its negative guard; none before an event or a step has found the
    /// branches.
    pub fn branches(&self) -> &[bool] {
        self.negative.as_deref().unwrap_or(&self.none)
    }

    /// Whether the branches are found.
    pub fn knows_branches(&self) -> bool {
        self.negative.is_some()
    }

    /// How large each state is to be taken for, in its unit, above zero: what a host measures its errors by.
    pub fn nominals(&self) -> Vec<f64> {
        let sizes = sizes_of(&*self.model, self.t, &self.x);
        above_zero(sizes.iter().zip(&self.largest).map(|(size, largest)| size.max(*largest)))
    }

    /// Writes dx/dt.
    pub fn rates(&self, rates: &mut [f64]) {
        self.model.rate(self.t, &self.x, self.branches(), rates);
    }

    pub fn outputs(&self, outputs: &mut [f64]) {
        self.model.outputs(self.t, &self.x, self.branches(), outputs);
    }

    pub fn guards(&self, guards: &mut [f64]) {
        self.model.guards(self.t, &self.x, self.branches(), guards);
    }

    /// The input or law that something which is not finite comes from, as far as that is known.
    pub fn origin(&self) -> Option<Origin> {
        self.model.not_finite(self.t, &self.x, self.branches())
    }

    /// Closes what rounding or a host's steps have left of what the model holds: up to `part` of its size.
    fn stand(&mut self, part: f64) -> Result<(), Fault> {
        let standing = self.standing(part);
        let negative = self.negative.clone().map(|negative| standing.possible(&self.x, negative));
        let x = standing.closed(&self.x, negative.as_deref()).map_err(misplaced)?;
        (self.x, self.negative) = (x, negative);
        Ok(())
    }

    fn standing(&self, part: f64) -> Standing<'_> {
        Standing::with_start(&*self.model, self.t, Some(self.start.clone()), &self.largest, part)
    }

    /// Whether the state has drifted off the invariants: whether the projection changes a state by more than the part
    /// `rtol` of what is larger, the state or its size ([`Stood::nominals`]) at the start.
    ///
    /// # Errors
    /// It is so far off that no step leads there.
    pub fn drifts(&self, rtol: f64) -> Result<bool, Fault> {
        let mut x = self.x.clone();
        self.model.project(self.t, self.branches(), &mut x);
        let mut parts =
            x.iter().zip(&self.x).zip(&self.size).map(|((after, x), size)| (after - x) / x.abs().max(*size));
        let is_off = parts.any(|part| part.is_nan() || part.abs() > rtol);
        // What no projection moves, such as an orientation of zeros, is off as well.
        self.standing(DRIFT).rotated(&self.x).map_err(misplaced)?;
        if is_off {
            self.standing(DRIFT).closed(&self.x, self.negative.as_deref()).map_err(misplaced)?;
        }
        Ok(is_off)
    }

    /// An event: projects the state, computes samples at an instant of their clock, lets the state jump where something
    /// hits a stop, finds the branches that hold from here on. Gives whether the state has changed.
    pub fn settle(&mut self, rtol: f64) -> Result<bool, Fault> {
        let before = self.x.clone();
        self.stand(DRIFT)?;
        if self.t > self.computed {
            self.computed = self.t;
            self.x = sampled::computed(&*self.model, self.t, &self.x, self.negative.as_deref());
        }
        if self.model.switches() > 0 {
            // A run of no length finds branches and impacts.
            let Run { mut method, mut ongoing } = self.run_from_here();
            let settled = ongoing.drive(&*self.model, &mut method, self.t, &settings(rtol), &mut ());
            settled.map_err(|failure| Fault::Stopped(failure.to_string()))?;
            (self.x, self.negative) = (ongoing.state().to_vec(), Some(ongoing.negative().to_vec()));
        }
        Ok(self.x != before)
    }

    /// Whether each clock has an instant at the time, which no update has come after; none where there are not so many.
    pub fn ticks(&self) -> Vec<bool> {
        let clocks = self.model.clocks();
        clocks.iter().map(|clock| self.t > self.ticked && clock.at(self.t).is_some()).collect()
    }

    /// An update: clocks that have ticked do no more.
    pub fn ends_ticks(&mut self) {
        self.ticked = self.t;
    }

    fn run_from_here(&self) -> Run {
        Run::at(self.t, &self.x, &self.largest, self.negative.as_deref())
    }

    /// The first instant after the time at which a step must end, s; infinity where there is none.
    pub fn next_break(&self) -> f64 {
        self.model.next_break(self.t).min(clock::next(&self.model.clocks(), self.t))
    }

    /// Goes on to time `to` (s), over all events. On failure it stands where the run has come to.
    pub fn advance(&mut self, to: f64, rtol: f64) -> Result<(), Fault> {
        let mut run = self.run.take().unwrap_or_else(|| self.run_from_here());
        let outcome = run.ongoing.drive(&*self.model, &mut run.method, to, &settings(rtol), &mut ());
        (self.t, self.x) = (run.ongoing.time(), run.ongoing.state().to_vec());
        self.computed = self.t;
        self.negative = Some(run.ongoing.negative().to_vec());
        raise(&mut self.largest, &self.x);
        self.run = Some(run);
        outcome.map(|_| ()).map_err(|failure| Fault::Stopped(failure.to_string()))
    }

    /// What the rate reads from outside has changed.
    pub fn disturb(&mut self) {
        if let Some(run) = &mut self.run {
            run.ongoing.renew(None);
        }
    }

    /// The size that the next step of the run is to have, s, where that is known.
    pub fn next_step(&self) -> Option<f64> {
        self.run.as_ref().and_then(|run| run.ongoing.next_step())
    }

    /// What the run has cost, where there is one.
    pub fn statistics(&self) -> Option<Statistics> {
        self.run.as_ref().map(|run| *run.ongoing.statistics())
    }

    /// Stands at another place, where the switches are in these branches; the next step of the run is tried with `step`
    /// (s).
    ///
    /// # Errors
    /// The model cannot stand there.
    pub fn place(&mut self, ModelState { t, x, largest, negative, step }: &ModelState) -> Result<(), Fault> {
        (self.t, self.computed, self.ticked) = (*t, *t, *t);
        self.set_states(x);
        raise(&mut self.largest, largest);
        self.negative.clone_from(negative);
        self.stand(CLOSE)?;
        self.run = step.map(|step| {
            let mut run = self.run_from_here();
            run.ongoing.renew(Some(step));
            run
        });
        Ok(())
    }
}
