//! A run under way: which steps are made, shortened, accepted, and when it ends.
//!
//! In: a system, a method, a condition that may end the run. Out: the point where the run ends and why it does, with
//! samples and events told to the observer on the way; or why it cannot go on (`cause`).

use alloc::vec;
use alloc::vec::Vec;

use super::history::History;
use super::observer::{Inside, Observer, Switching};
use super::rounding::RoundingMonitor;
use super::sampling::Sampling;
use super::settings::{Settings, Span};
use super::sizes::SizeMonitor;
use super::step_size::{self, StepSizeController};
use crate::model::clock::{self, Clock};
use crate::model::dynamics::Dynamics;
#[cfg(feature = "std")]
use crate::model::reactions::LoopsInLanes;
use crate::model::reactions::{After, Broken, Collision, EndMonitor, LoopMonitor};
use crate::model::sampled;
#[cfg(feature = "std")]
use crate::model::scalar::lanes::Vector;
use crate::solve::event::{Crossing, EventMonitor, Located, Stop, Struck};
use crate::solve::failure::Cause;
use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{Point, StepControl, is_finite};
use crate::solve::stepper::{MOVED, Stepper};

/// How often a sample is projected at most.
const PROJECTIONS: usize = 6;
/// How much less another projection moves, at most, where the first one has led to the motion's own branch: about the
/// error beside the distance of the branches.
const AGAIN: f64 = 0.05;

/// A run under way.
pub(crate) struct Run<'a> {
    pub stepper: Stepper<'a>,
    pub controller: StepSizeController,
    /// Whether the next step is the first of the run, its size an estimate.
    pub is_first: bool,
    /// What was not finite at the end of a longer step from the present start.
    pub faulty: Option<Faulty>,
    pub monitor: EventMonitor,
    /// What ends the run beside its span.
    condition: Option<Located<'a>>,
    pub sampling: Sampling<'a>,
    pub span: Span,
    pub attempts: u64,
    pub limit: u64,
    /// Of joints that close loops, where there are any.
    loops: Option<LoopMonitor>,
    /// Of loops in closed form that may come to their ends, where there are any.
    ends: Option<EndMonitor>,
    /// Of impacts on stops, where there are any.
    collision: Option<Collision<f64>>,
    /// Of the sizes of the states, by which errors are measured.
    pub sizes: SizeMonitor,
    /// Of the error estimates, where the tolerances may be below it.
    pub rounding: Option<RoundingMonitor>,
    /// What computes samples of the model.
    clocks: Vec<Clock>,
    /// The past of signals that the model delays, where it does.
    pub history: Option<History>,
    /// Room for the state at a sample.
    sample: Vec<f64>,
}

/// What is monitored in a step and is not finite at its end.
#[derive(Clone, Copy, Debug)]
pub(super) enum Faulty {
    /// The guard of this index, and its value.
    Guard((usize, f64)),
    /// The condition that ends the run.
    Condition(f64),
}

impl<'a> Run<'a> {
    pub fn new(
        stepper: Stepper<'a>,
        condition: Option<Located<'a>>,
        control: StepControl,
        span: Span,
        settings: &'a Settings,
    ) -> Self {
        let (system, states) = (stepper.system, stepper.system.states());
        let clocks = system.clocks();
        let history = History::of(system.delays(), settings.tolerances.relative);
        let has_breaks = system.next_break(span.t0) < f64::INFINITY || !clocks.is_empty() || history.is_some();
        let (loops, ends) = (LoopMonitor::new(system), EndMonitor::new(system));
        let collision = system.stops().map(|stops| Collision::new(stops, system.kept_of_stops()));
        Self {
            stepper,
            controller: StepSizeController::new(control, span, settings, has_breaks),
            is_first: false,
            faulty: None,
            monitor: EventMonitor::new(system.switches()),
            condition,
            sampling: Sampling::new(&settings.samples, span),
            span,
            attempts: 0,
            limit: settings.step_limit,
            loops,
            ends,
            collision,
            sizes: SizeMonitor::new(&settings.tolerances, states, span.t0),
            rounding: RoundingMonitor::new(settings.tolerances.relative),
            clocks,
            history,
            sample: vec![0.0; states],
        }
    }

    /// Finds the first step, the branches at the start, from those that are `known` on, and the condition's side.
    pub fn begin(&mut self, control: StepControl, settings: &Settings, known: Option<&[bool]>) -> Result<(), Cause> {
        if let Some(history) = &mut self.history {
            history.begin(self.stepper.start.t, self.stepper.start.x.as_slice());
        }
        self.sizes.start(&mut self.stepper);
        let clear = self.monitor.begin_by_sign(&mut self.stepper, self.collision.as_mut(), known);
        self.stepper.evaluate_start();
        self.check_start()?;
        let longest = self.span.length().min(settings.largest_step);
        self.sizes.begin(&mut self.stepper);
        self.sizes.look_ahead(&mut self.stepper, longest);
        if let (Some(order), None) = (control.order(), settings.first_step) {
            let (_, flow, start, _, scale) = self.stepper.split();
            let first = step_size::first_step(&flow, start, scale, order, longest);
            self.controller.begin(first);
            self.is_first = true;
        }
        self.monitor.begin_by_probe(&mut self.stepper, &clear, self.controller.reach());
        self.stepper.end.become_that(self.stepper.start.borrowed());
        self.check_start()?;
        self.check_ends()?;
        let reach = self.controller.reach();
        let outcome = self.condition.as_mut().map_or(Ok(()), |condition| condition.begin(&mut self.stepper, reach));
        self.stepper.end.become_that(self.stepper.start.borrowed());
        outcome.map_err(|value| self.not_finite_monitored(Faulty::Condition(value), 0.0))
    }

    /// Whether joints close loops.
    #[cfg(feature = "std")]
    pub fn has_loops(&self) -> bool {
        self.loops.is_some()
    }

    /// Whether joints close no loops, or ones that are looked at as `lanes` does, the last pose not near a singular
    /// one.
    #[cfg(feature = "std")]
    pub fn has_loops_of<V: Vector>(&self, lanes: Option<&LoopsInLanes<V>>) -> bool {
        self.loops.as_ref().is_none_or(|loops| lanes.is_some_and(|lanes| loops.is_that_of(lanes)))
    }

    /// Sees to it that the joints which close loops say where the mechanism goes at the end of the step.
    pub fn check_joints(&mut self) -> Result<(), Cause> {
        self.check_ends()?;
        let Stepper { system, end, negative, .. } = &self.stepper;
        let Some(loops) = &mut self.loops else { return Ok(()) };
        match loops.check(*system, (end.t, end.x.as_slice()), negative, self.sizes.moved(*system)) {
            Some(Broken::Torn(slipping)) => Err(Cause::Torn { slipping, t: end.t }),
            Some(Broken::Singular(redundancy)) => Err(Cause::Singular { redundancy, t: end.t }),
            None => Ok(()),
        }
    }

    /// Sees to it that no loop has come to its end at the end of the step.
    fn check_ends(&mut self) -> Result<(), Cause> {
        let Stepper { system, end, negative, .. } = &self.stepper;
        let Some(ends) = &mut self.ends else { return Ok(()) };
        let reached = ends.reached(*system, (end.t, end.x.as_slice()), negative);
        reached.map_or(Ok(()), |joint| Err(Cause::LoopEnds { joint, t: end.t }))
    }

    /// Makes steps until the run ends; gives why it does.
    pub fn advance_to_end(&mut self, observer: &mut dyn Observer) -> Result<Ended, Cause> {
        observer.measured(&self.stepper.scale);
        self.sample(observer, self.span.t0);
        loop {
            if let Some(ended) = self.advance(observer)? {
                return Ok(ended);
            }
        }
    }

    /// Makes a step, or finds another branch at its start; gives why the run ends, if it does.
    #[inline]
    pub fn advance(&mut self, observer: &mut dyn Observer) -> Result<Option<Ended>, Cause> {
        if self.stepper.start.t >= self.span.t_end {
            return Ok(Some(Ended::AtEnd));
        }
        if self.open_window(observer)? {
            return Ok(Some(self.end_at_start(observer)));
        }
        if self.sizes.is_at_rest(self.stepper.system) {
            let t = self.stepper.start.t;
            let longest = self.next_break(t).min(self.span.t_end) - t;
            self.sizes.look_ahead(&mut self.stepper, longest);
            observer.measured(&self.stepper.scale);
        }
        self.try_steps()?;
        match self.monitor.inspect(&mut self.stepper) {
            Ok(crossing) => self.conclude(crossing, observer),
            Err(guard) => self.reject_not_finite(Faulty::Guard(guard)).map(|()| None),
        }
    }

    /// Takes over the step that was made, which ends at `crossing` or has none; gives why the run ends, if it does.
    pub fn conclude(
        &mut self,
        crossing: Option<Crossing>,
        observer: &mut dyn Observer,
    ) -> Result<Option<Ended>, Cause> {
        if crossing.as_ref().is_some_and(|crossing| crossing.is_at_start) {
            let jumps = self.change_branches(crossing, observer)?;
            return Ok(jumps.then(|| self.end_at_start(observer)));
        }
        let h = self.stepper.h;
        let is_at_event = crossing.is_some();
        let condition = self.condition.as_mut();
        match condition.map_or(Ok(None), |condition| condition.inspect(&mut self.stepper, is_at_event)) {
            Err(value) => self.reject_not_finite(Faulty::Condition(value)).map(|()| None),
            Ok(Some(Stop::AtStart)) => Ok(Some(self.end_at_start(observer))),
            Ok(Some(Stop::AtEnd)) => {
                let crossing = if self.stepper.h == h { crossing } else { self.still_crossing(crossing) };
                self.end_span(self.stepper.end.t);
                self.accept(observer)?;
                self.change_branches(crossing, observer)?;
                self.compute_samples(observer)?;
                Ok(Some(Ended::ByCondition))
            }
            Ok(None) => {
                let is_done = self.accept(observer)?;
                let jumps = self.change_branches(crossing, observer)?;
                if self.compute_samples(observer)? || jumps {
                    return Ok(Some(self.end_at_start(observer)));
                }
                Ok(is_done.then_some(Ended::ByObserver))
            }
        }
    }

    /// Tries steps until one satisfies the tolerances; its end is projected and the rate there is known.
    fn try_steps(&mut self) -> Result<(), Cause> {
        let t = self.stepper.start.t;
        let next_break = self.next_break(t);
        let mut error = 0.0_f64;
        loop {
            if self.controller.is_lost(t) {
                return Err(self.lost(error));
            }
            if self.attempts >= self.limit {
                return Err(Cause::TooManySteps { limit: self.limit, t, h: self.stepper.h });
            }
            self.attempts += 1;
            let t_new = self.controller.next_end(t, next_break);
            let h = t_new - t;
            error = self.stepper.attempt(h);
            if self.is_first && error <= 1.0 {
                let alone = self.stepper.method.error_alone();
                error = if alone > 1.0 { alone } else { error };
            }
            self.controller.follow(self.stepper.method.control());
            self.stepper.end.t = t_new;
            if error > 1.0 && self.is_around_singular() {
                error = self.stepper.error_after_projection().unwrap_or(error);
            }
            if error <= 1.0 && is_finite(self.stepper.end.x.as_slice()) {
                let is_near = self.project() || !self.controller.is_adaptive();
                // Ahead of the rate, for neither to wait for the other.
                let mut next = self.controller.clone();
                next.accept(t_new, h, error);
                self.stepper.evaluate_end();
                if is_near && is_finite(self.stepper.end.x.as_slice()) && is_finite(self.stepper.end.rate.as_slice()) {
                    match self.end_ahead() {
                        None => {
                            self.controller = next;
                            return Ok(());
                        }
                        Some(joint) if !self.controller.is_adaptive() => return Err(Cause::LoopEnds { joint, t }),
                        // A shorter step shows whether it is one.
                        Some(_) => {}
                    }
                }
            }
            if error <= 1.0 {
                error = f64::NAN;
            }
            self.sizes.guess(&self.stepper.end.x, &mut self.stepper.scale);
            self.stepper.statistics.rejected += 1;
            self.controller.reject(h, error);
            if !self.controller.is_adaptive() {
                return Err(self.lost(error));
            }
        }
    }

    /// The joint whose loop seems to come to its end in the step.
    fn end_ahead(&mut self) -> Option<&'static str> {
        let Stepper { system, start, h, negative, .. } = &self.stepper;
        self.ends.as_mut()?.ahead(*system, (start.t, start.x.as_slice(), start.rate.as_slice()), *h, negative)
    }

    /// Whether the step begins or ends in the neighbourhood of a singular pose.
    pub fn is_around_singular(&mut self) -> bool {
        let Stepper { system, start, end, negative, .. } = &self.stepper;
        let Some(loops) = &mut self.loops else { return false };
        [start, end].into_iter().any(|point| loops.is_around(*system, (point.t, point.x.as_slice()), negative))
    }

    /// Projects the end of the step; gives whether it is still on the branch of the motion on which the step began.
    ///
    /// Near a singular pose steps err much in what joints hold, which the projection takes away. It is Newton's step,
    /// so where the branches are far apart beside the error, another one moves by the error's square only, or by
    /// rounding.
    fn project(&mut self) -> bool {
        let moved = self.stepper.project();
        if moved <= MOVED || !self.is_around_singular() {
            return moved <= MOVED;
        }
        let rounding = self.stepper.rounding_of_projection(&self.stepper.end.x);
        let again = self.stepper.project();
        again <= AGAIN * moved || again <= MOVED * rounding
    }

    /// The first instant after `t` (s) and before the end, by more than rounding, at which the system has a step end;
    /// infinity where there is none.
    pub fn next_break(&self, t: f64) -> f64 {
        let latest = self.span.t_end - self.controller.least(self.span.t_end);
        let window = self.history.as_ref().map_or(f64::INFINITY, History::until);
        let mut last = t;
        loop {
            let next = self.stepper.system.next_break(last).min(clock::next(&self.clocks, last)).min(window);
            // A system that gives no later one has none.
            if next.is_nan() || next <= last || next >= latest {
                return f64::INFINITY;
            }
            if next - t > self.controller.least(t) {
                return next;
            }
            last = next;
        }
    }

    /// Gives up a step at whose end something is not finite, for a shorter one.
    pub fn reject_not_finite(&mut self, faulty: Faulty) -> Result<(), Cause> {
        let h = self.stepper.h;
        self.stepper.statistics.rejected += 1;
        self.controller.reject(h, f64::NAN);
        self.faulty = Some(faulty);
        let is_last = !self.controller.is_adaptive() || self.controller.is_lost(self.stepper.start.t);
        if is_last { Err(self.not_finite_monitored(faulty, h)) } else { Ok(()) }
    }

    /// Takes the step over: gives its samples and makes its end the start of the next one. Gives whether the observer
    /// ends the run with it.
    fn accept(&mut self, observer: &mut dyn Observer) -> Result<bool, Cause> {
        self.check_joints()?;
        self.faulty = None;
        self.is_first = false;
        if let Some(rounding) = &mut self.rounding {
            rounding.follow(&mut self.stepper, &self.sizes);
        }
        if self.sizes.follow(&mut self.stepper) {
            observer.measured(&self.stepper.scale);
        }
        self.stepper.statistics.record(self.stepper.h);
        self.sampling.next_step();
        let t = self.stepper.end.t;
        observer.passed(&self.stepper.start, &self.stepper.end, &self.stepper.negative);
        if observer.looks_inside() {
            let projections = self.projections();
            observer.inside(&mut Inside::of(&mut self.stepper, projections));
        }
        self.record_history();
        if clock::is_due(&self.clocks, t) {
            while let Some(instant) = self.sampling.next_before(t - clock::rounding(t)) {
                self.sample_inside(observer, instant);
            }
        } else {
            self.sample(observer, t);
        }
        self.stepper.advance();
        observer.step(t, self.span.t_end, &self.stepper.statistics);
        let is_done = observer.is_done();
        if is_done {
            self.end_span(t);
            self.sample(observer, t);
        }
        Ok(is_done)
    }

    /// Gives the samples up to the end of the step at `t`.
    pub fn sample(&mut self, observer: &mut dyn Observer, t: f64) {
        while let Some(instant) = self.sampling.next_up_to(t) {
            if instant >= t {
                observer.sample(t, self.stepper.end.x.as_slice(), &self.stepper.negative);
                continue;
            }
            self.sample_inside(observer, instant);
        }
    }

    /// Gives a sample inside of the step.
    fn sample_inside(&mut self, observer: &mut dyn Observer, instant: f64) {
        let part = (instant - self.stepper.start.t) / self.stepper.h;
        let most = self.projections();
        let Self { stepper, sample, .. } = self;
        stepper.projected_sample(part.min(1.0), instant, most, sample);
        observer.sample(instant, sample, &stepper.negative);
    }

    /// At an instant of a clock, computes the samples of the model at the start of the next step. What the run is to
    /// give at that instant is with them. Gives whether the condition has jumped through zero by that.
    fn compute_samples(&mut self, observer: &mut dyn Observer) -> Result<bool, Cause> {
        let t = self.stepper.start.t;
        if !clock::is_due(&self.clocks, t) {
            return Ok(false);
        }
        let mut reached = vec![false; self.stepper.negative.len()];
        self.clocks.iter().for_each(|clock| reached[clock.switch] = clock.at(t).is_some());
        if let Some(history) = &mut self.history {
            history.jumps();
        }
        let clocks = self.clocks.clone();
        self.rewrite(reached, observer, |system, negative, x| sampled::compute_due(system, &clocks, t, negative, x))?;
        self.sample(observer, t);
        self.condition_jumps()
    }

    /// Keeps the signals that are delayed during the step.
    fn record_history(&mut self) {
        let projections = self.projections();
        let Self { stepper, history: Some(history), .. } = self else { return };
        let is_kink = stepper.system.next_break(stepper.start.t) <= stepper.end.t;
        history.record(stepper, projections);
        if is_kink {
            history.jumps();
        }
    }

    /// Where the window in which delayed signals are known is over, opens another one. Gives whether the condition has
    /// jumped through zero by that.
    fn open_window(&mut self, observer: &mut dyn Observer) -> Result<bool, Cause> {
        let t = self.stepper.start.t;
        let Some(mut history) = self.history.take_if(|history| history.is_over(t)) else { return Ok(false) };
        let none = vec![false; self.stepper.negative.len()];
        let outcome = self.rewrite(none, observer, |_, _, x| history.open(t, x));
        self.history = Some(history);
        outcome?;
        self.condition_jumps()
    }

    /// Lets `write` change what is held at the start of the next step; `reached` are the switches of clocks by which it
    /// does.
    fn rewrite(
        &mut self,
        reached: Vec<bool>,
        observer: &mut dyn Observer,
        write: impl FnOnce(&dyn Dynamics, &[bool], &mut [f64]),
    ) -> Result<(), Cause> {
        let t = self.stepper.start.t;
        let (before, negative_before) = (self.stepper.start.clone(), self.stepper.negative.clone());
        let none = vec![false; negative_before.len()];
        let Stepper { system, start, negative, .. } = &mut self.stepper;
        write(*system, negative, start.x.as_mut_slice());
        // Guards that this moves to the wrong side change their branches at once.
        self.monitor.settle(&mut self.stepper, none.clone(), self.controller.reach());
        self.check_start()?;
        self.stepper.end.become_that(self.stepper.start.borrowed());
        let (after, negative_after) = (self.stepper.start.clone(), self.stepper.negative.clone());
        let changed = (0..none.len()).filter(|&switch| negative_after[switch] != negative_before[switch]);
        let changed: Vec<usize> = changed.collect();
        observer.switched(&Switching {
            before,
            after,
            negative_before,
            negative_after,
            reached,
            left: none,
            jumps: false,
        });
        for switch in changed {
            self.stepper.statistics.events += 1;
            observer.event(t, self.stepper.start.x.as_slice(), switch, &self.stepper.negative);
        }
        Ok(())
    }

    /// Whether the condition has jumped through zero at the start of the next step.
    fn condition_jumps(&mut self) -> Result<bool, Cause> {
        let reach = self.controller.reach();
        let condition = self.condition.as_mut();
        let jumps = condition.map_or(Ok(false), |condition| condition.jumps(&mut self.stepper, reach));
        jumps.map_err(|value| self.not_finite_monitored(Faulty::Condition(value), 0.0))
    }

    /// How often a state inside of a step is projected at most.
    fn projections(&self) -> usize {
        if self.loops.is_some() { PROJECTIONS } else { 1 }
    }

    /// The run is to end at `t` (s).
    fn end_span(&mut self, t: f64) {
        self.span.t_end = t;
        self.sampling.end(t);
    }

    /// The run ends where the last accepted step has led.
    fn end_at_start(&mut self, observer: &mut dyn Observer) -> Ended {
        let t = self.stepper.start.t;
        self.stepper.end.become_that(self.stepper.start.borrowed());
        self.end_span(t);
        self.sample(observer, t);
        Ended::ByCondition
    }

    /// What is left of an event at the end of a step that the condition has shortened: nothing where it is later.
    fn still_crossing(&mut self, crossing: Option<Crossing>) -> Option<Crossing> {
        let switches = self.monitor.still_at_zero(&mut self.stepper, &crossing?.switches);
        switches.contains(&true).then_some(Crossing { switches, is_at_start: false })
    }

    /// Goes on with the branches that hold after the step: the old ones where nothing has crossed. Gives whether the
    /// condition has jumped through zero by that.
    fn change_branches(&mut self, crossing: Option<Crossing>, observer: &mut dyn Observer) -> Result<bool, Cause> {
        let Some(Crossing { switches, is_at_start }) = crossing else {
            self.monitor.advance();
            if let Some(condition) = &mut self.condition {
                condition.advance();
            }
            return Ok(false);
        };
        let before = self.stepper.negative.clone();
        let h = self.stepper.h;
        let jumps = self.switch(&switches, observer)?;
        if is_at_start && self.stepper.negative == before && !jumps {
            // The branch is right, so the step was too long for the guard's course.
            self.stepper.statistics.rejected += 1;
            self.controller.reject(h, f64::NAN);
            if self.controller.is_lost(self.stepper.start.t) {
                return Err(self.accumulate(&switches));
            }
        }
        self.condition_jumps()
    }

    /// Lets the switches whose guards are at zero find their branches at the start of the next step, where the state
    /// jumps if something has hit a stop. Gives whether it does.
    fn switch(&mut self, reached: &[bool], observer: &mut dyn Observer) -> Result<bool, Cause> {
        let t = self.stepper.start.t;
        let (before, point) = (self.stepper.negative.clone(), self.stepper.start.clone());
        let struck = self.monitor.strike(&mut self.stepper, reached.to_vec(), self.collision.as_mut());
        let Struck { switches, rebounds, jumps } = struck;
        self.stepper.remember(&switches);
        self.monitor.settle(&mut self.stepper, switches.clone(), self.controller.reach());
        self.check_start()?;
        if jumps || self.stepper.negative != before {
            if let Some(history) = &mut self.history {
                history.jumps();
            }
            let mut left = vec![false; before.len()];
            let outcomes = self.collision.as_ref().filter(|_| jumps).into_iter().flat_map(Collision::outcomes);
            outcomes.for_each(|(k, after)| left[k] = after == After::Clear);
            observer.switched(&Switching {
                before: point,
                after: self.stepper.start.clone(),
                negative_before: before.clone(),
                negative_after: self.stepper.negative.clone(),
                reached: reached.to_vec(),
                left,
                jumps,
            });
        }
        for (switch, before) in before.into_iter().enumerate() {
            if self.stepper.negative[switch] != before || rebounds[switch] {
                self.stepper.statistics.events += 1;
                observer.event(t, self.stepper.start.x.as_slice(), switch, &self.stepper.negative);
            }
        }
        let is_crowded = self.monitor.is_crowded(t, self.span.t_end - self.span.t0);
        if is_crowded { Err(self.accumulate(&switches)) } else { Ok(jumps) }
    }

    pub fn finish(self, ended: Ended) -> Finish {
        let Stepper { start: Point { t, x, .. }, negative, statistics, scale, .. } = self.stepper;
        let mut uncontrolled = self.sizes.uncontrolled(&scale);
        if !self.controller.is_adaptive() {
            uncontrolled.fill(false);
        }
        Finish { t, x, negative, ended, uncontrolled, statistics }
    }
}
