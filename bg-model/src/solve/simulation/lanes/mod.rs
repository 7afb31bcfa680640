//! Runs side by side, in the vectors of the machine: each with its own model, time, steps, branches and events.
//!
//! In: runs, one model for as many of them as there are places. Out: what each gives by itself, to the bit. A place
//! whose run is done takes the next one. What is not the same operations for all (a step with an event, with a sample
//! inside, with a number that is not finite) its run makes by itself and then comes back. A run that fails is given
//! back to be made by itself from its start.

mod controllers;
mod group;

use core::ops::Range;

use nalgebra::DVector;

use super::observer::Observer;
use super::run::{Faulty, Run};
use super::settings::{self, Settings, Span};
use super::step_size::{Judgement, Kept};
use crate::model::dynamics::{Abreast, Machine};
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::solve::event::{Crossing, Found, Shortening};
use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{AnyInLanes, AnyMethod, Method, OfOne, Point, Scale};
use crate::solve::simulation::Samples;
use crate::solve::statistics::Statistics;
use crate::solve::stepper::{MOVED, Stepper};
use controllers::{Control, Lead};
use group::{Group, Tried};

/// A run to be made.
pub(crate) struct Job<'a, O> {
    /// Its number, for who asked for it.
    pub number: usize,
    /// Its model.
    pub model: &'a dyn Machine,
    /// The values of its parameters.
    pub values: &'a [f64],
    /// A method of its own.
    pub method: &'a mut AnyMethod,
    /// Its start.
    pub start: &'a [f64],
    /// Its observer.
    pub observer: O,
}

/// Whether runs of `model` over `span` can be made side by side with these settings.
pub(crate) fn fits(model: &dyn Machine, span: Span, settings: &Settings) -> bool {
    let each_step = settings.samples == Samples::Steps;
    let has_breaks =
        model.next_break(span.t0) < f64::INFINITY || !model.clocks().is_empty() || !model.delays().is_empty();
    model.runs_in_lanes() && !has_breaks && !each_step && !super::rounding::may_matter(settings.tolerances.relative)
}

/// A run at its place.
struct Lane<'a, O> {
    number: usize,
    values: &'a [f64],
    run: Run<'a>,
    observer: O,
    /// Its step is being shortened to an event.
    shortening: Option<Shortening>,
    /// The evaluations of the guards in a step that has no event.
    guards: u64,
}

/// What a run does next.
enum Next {
    /// This step.
    Step(Step),
    /// Nothing more in company.
    Fails,
}

/// A step of one run: its size (s), its end (s), and the error norm by which it is stable.
#[derive(Clone, Copy)]
struct Step {
    h: f64,
    t: f64,
    reach: f64,
}

/// An attempt at it: the norm of its error, and what follows from that.
#[derive(Clone, Copy)]
struct Attempted {
    step: Step,
    error: f64,
    judgement: Judgement,
}

/// What an attempt leads to.
enum Outcome {
    /// Its end is the next start.
    Accepted,
    /// Another one from the same start.
    Again,
    /// The run makes it by itself.
    Alone,
    /// The run has gone on by itself.
    Elsewhere,
    /// Nothing more in company.
    Fails,
}

impl<'a, O: Observer> Lane<'a, O> {
    /// The run at its start; none where it fails there.
    fn new(job: Job<'a, O>, span: Span, settings: &'a Settings) -> Result<Self, (usize, O)> {
        let Job { number, model, values, method, start, mut observer } = job;
        let control = method.control();
        let (scale, x) = (Scale::new(&settings.tolerances, start.len()), DVector::from_column_slice(start));
        let stepper = Stepper::new(model, method, scale, Point::at(span.t0, x));
        let mut run = Run::new(stepper, None, control, span, settings);
        let is_fine = settings::check(model, control, start, span, settings).is_ok();
        // What is at rest looks ahead before each step, by itself.
        if !is_fine || run.begin(control, settings, None).is_err() || run.sizes.is_at_rest(model) {
            return Err((number, observer));
        }
        run.sample(&mut observer, span.t0);
        let guards = if model.switches() == 0 { 0 } else { 3 };
        Ok(Self { number, values, run, observer, shortening: None, guards })
    }

    fn method(&mut self) -> &mut dyn OfOne {
        let chosen = self.run.stepper.method.chosen();
        chosen.and_then(AnyMethod::of_one).expect("only runs by such methods are side by side")
    }

    /// Whether the run's method begins anew to look for the fastest oscillation.
    fn begins(&mut self, second: &Range<usize>) -> bool {
        let stepper = &mut self.run.stepper;
        let method = stepper.method.chosen().and_then(AnyMethod::of_one);
        method.is_some_and(|method| method.begins(second, &stepper.scale.weights))
    }

    fn is_at_end(&self) -> bool {
        self.run.stepper.start.t >= self.run.span.t_end
    }

    /// The next step, not longer than is stable.
    fn next(&mut self) -> Next {
        let t = self.run.stepper.start.t;
        if let Some(shortening) = &self.shortening {
            let h = shortening.size();
            return Next::Step(Step { h, t: t + h, reach: 0.0 });
        }
        let next_break = self.run.next_break(t);
        loop {
            if self.run.controller.is_lost(t) || self.run.attempts >= self.run.limit {
                return Next::Fails;
            }
            let end = self.run.controller.next_end(t, next_break);
            let h = end - t;
            let reach = self.method().reach(h);
            if reach <= 1.0 {
                return Next::Step(Step { h, t: end, reach });
            }
            self.rejected();
            self.run.controller.reject(h, reach);
        }
    }

    fn rejected(&mut self) {
        self.run.attempts += 1;
        self.run.stepper.statistics.rejected += 1;
    }

    /// The group's controller goes on from the run's.
    fn lead<V: Vector>(&mut self, group: &mut Group<V>, place: usize) {
        let run = &self.run;
        let lead = Lead {
            controller: run.controller.kept(),
            until: run.sampling.next().min(run.span.t_end),
            left: run.limit.saturating_sub(run.attempts),
        };
        let is_plain =
            !run.is_first && run.monitor.is_plain() && run.has_loops_of(group.loops()) && !self.observer.looks_inside();
        group.lead(place, lead, is_plain, self.method().frequency());
    }

    /// The run's controller goes on from the group's.
    fn follow<V: Vector>(&mut self, group: &mut Group<V>, place: usize) {
        let Some((controller, made, t)) = group.leave(place) else { return };
        let Statistics { steps, rejected, .. } = made;
        let rates = self.method().rates();
        let run = &mut self.run;
        run.controller.keep(controller);
        run.attempts += steps + rejected;
        run.stepper.statistics.add(&Statistics {
            rate_evaluations: steps * (rates + 1) + rejected * rates,
            guard_evaluations: steps * self.guards,
            ..made
        });
        run.stepper.start.t = t;
        if steps > 0 {
            run.faulty = None;
        }
    }

    /// What an attempt leads to that the group has made; `is_fine` says whether it leads to finite numbers, `is_clear`
    /// whether the guards keep to their sides.
    fn attempted<V: Vector>(
        &mut self,
        group: &mut Group<V>,
        place: usize,
        attempted: Attempted,
        [is_fine, is_clear]: [bool; 2],
    ) -> Outcome {
        let Attempted { step: Step { h, t, .. }, error, judgement } = attempted;
        if self.shortening.is_some() {
            return self.shortened(group, place, attempted.step);
        }
        if error > 1.0 && !self.is_around_singular(group, place, t) {
            self.run.stepper.statistics.rate_evaluations += self.method().rates();
            self.rejected();
            if error < f64::INFINITY {
                self.run.controller.reject_by(h, judgement);
            } else {
                self.run.controller.reject(h, error);
            }
            return Outcome::Again;
        }
        // Of a first step the run wants to know more.
        if !(error <= 1.0 && is_fine) || self.run.is_first {
            return Outcome::Alone;
        }
        self.run.attempts += 1;
        self.run.controller.accept_by(t, h, judgement);
        self.run.stepper.statistics.rate_evaluations += self.method().rates() + 1;
        // Of a plain step the group alone keeps what the guards are.
        let looks = self.observer.looks_inside();
        let asks = looks && {
            self.take_end(group, place, t);
            let Run { stepper, .. } = &self.run;
            self.observer.asks(h, t, stepper.end.x.as_slice(), &stepper.negative)
        };
        let is_quiet = !(asks || self.run.sampling.is_due(t))
            && (is_clear && self.run.monitor.is_plain() || {
                let (end, middle) = group.guards(place);
                let Run { monitor, stepper, .. } = &mut self.run;
                monitor.take_start(group.guards_at_start(place).each_ref().map(Vec::as_slice));
                monitor.pass(&stepper.negative, end.each_ref().map(Vec::as_slice), &middle, h, is_clear)
            });
        if !is_quiet {
            return self.inspected(group, place, attempted.step);
        }
        if !self.holds_together(group, place, t) {
            return Outcome::Fails;
        }
        self.run.stepper.statistics.guard_evaluations += self.guards;
        self.run.faulty = None;
        if looks {
            self.observer.skipped(h, t);
        }
        self.take_end(group, place, t);
        self.run.stepper.h = h;
        if self.run.sizes.follow(&mut self.run.stepper) {
            measure(group, place, &self.run);
        }
        self.run.stepper.statistics.record(h);
        self.run.stepper.start.t = t;
        self.run.stepper.method.advance();
        Outcome::Accepted
    }

    /// Whether a state inside of a step to `t` (s) is asked for, which only the run by itself can give.
    fn is_looked_at(&self, t: f64) -> bool {
        self.run.sampling.is_due(t) || self.observer.looks_inside()
    }

    /// Takes an attempt over that satisfies the tolerances, and looks for events in it.
    fn inspected<V: Vector>(&mut self, group: &mut Group<V>, place: usize, Step { h, t, .. }: Step) -> Outcome {
        self.take_start(group, place);
        group.hand_over(place, self.method());
        self.take_end(group, place, t);
        let is_looked_at = self.is_looked_at(t);
        let run = &mut self.run;
        run.stepper.arrived(h);
        let crossing = match run.monitor.look(&mut run.stepper) {
            Ok(None) => None,
            Ok(Some(Found::AtStart(crossing))) => Some(crossing),
            Ok(Some(Found::Inside(shortening))) if is_looked_at => {
                Some(run.monitor.shorten(&mut run.stepper, shortening))
            }
            Ok(Some(Found::Inside(shortening))) => {
                self.shortening = Some(shortening);
                return Outcome::Again;
            }
            Err(guard) => {
                return if run.reject_not_finite(Faulty::Guard(guard)).is_ok() {
                    Outcome::Again
                } else {
                    Outcome::Fails
                };
            }
        };
        self.concluded(crossing)
    }

    /// Looks at an attempt at the step that is being shortened.
    fn shortened<V: Vector>(&mut self, group: &Group<V>, place: usize, Step { h, t, .. }: Step) -> Outcome {
        self.run.stepper.statistics.rate_evaluations += self.method().rates();
        let Some(mut shortening) = self.shortening.take() else { return Outcome::Again };
        let stepper = &mut self.run.stepper;
        stepper.end.t = t;
        group.take_end(place, stepper.end.x.as_mut_slice());
        stepper.end.rate.fill(0.0);
        stepper.arrived(h);
        if stepper.system.held().is_some() {
            let mut reached = vec![0.0; stepper.end.x.len()];
            group.take_reached(place, &mut reached);
            let moved = stepper.moved(&reached, stepper.end.x.as_slice());
            stepper.settle_further(moved);
        }
        let run = &mut self.run;
        while !shortening.take(&run.monitor, &mut run.stepper) {
            if shortening.size() != h {
                self.shortening = Some(shortening);
                return Outcome::Again;
            }
        }
        let crossing = run.monitor.crossing(&mut run.stepper, shortening);
        self.concluded(Some(crossing))
    }

    /// The run takes its step over, and goes on after it.
    fn concluded(&mut self, crossing: Option<Crossing>) -> Outcome {
        if self.run.conclude(crossing, &mut self.observer).is_ok() { Outcome::Elsewhere } else { Outcome::Fails }
    }

    /// Takes over from the group where the run stands.
    fn take_start<V: Vector>(&mut self, group: &mut Group<V>, place: usize) {
        self.take_start_point(group, place);
        self.run.monitor.take_start(group.guards_at_start(place).each_ref().map(Vec::as_slice));
        group.take_compensation(place, self.method().compensation());
    }

    /// Takes over the point from which the group's step starts.
    fn take_start_point<V: Vector>(&mut self, group: &Group<V>, place: usize) {
        let Point { x, rate, .. } = &mut self.run.stepper.start;
        group.take_start(place, x.as_mut_slice(), rate.as_mut_slice());
    }

    /// Takes over the end of the group's step, at `t` (s).
    fn take_end<V: Vector>(&mut self, group: &Group<V>, place: usize, t: f64) {
        let end = &mut self.run.stepper.end;
        end.t = t;
        group.take_end(place, end.x.as_mut_slice());
        group.take_rate(place, end.rate.as_mut_slice());
    }

    /// Whether a step to `t` (s) begins or ends in the neighbourhood of a singular pose.
    fn is_around_singular<V: Vector>(&mut self, group: &Group<V>, place: usize, t: f64) -> bool {
        self.run.has_loops() && {
            self.take_start_point(group, place);
            let end = &mut self.run.stepper.end;
            end.t = t;
            group.take_reached(place, end.x.as_mut_slice());
            self.run.is_around_singular()
        }
    }

    /// Whether joints that close loops say where the mechanism goes at the end of a step to `t` (s).
    fn holds_together<V: Vector>(&mut self, group: &Group<V>, place: usize, t: f64) -> bool {
        !self.run.has_loops() || {
            let end = &mut self.run.stepper.end;
            end.t = t;
            group.take_end(place, end.x.as_mut_slice());
            self.run.check_joints().is_ok()
        }
    }
}

/// Makes the `jobs`, whose methods are those of `method`; `lifted` makes a model of parameters side by side. `done` is
/// told the number of each run with its observer, and where it has come to: nothing of one that is to be made by
/// itself.
pub(crate) fn integrate<'a, V: Vector, O: Observer>(
    mut jobs: impl Iterator<Item = Job<'a, O>>,
    method: AnyInLanes<V>,
    lifted: impl Fn(&[Lanes<V>]) -> Box<dyn Abreast<V>>,
    span: Span,
    settings: &'a Settings,
    sizes: [usize; 2],
    done: &mut dyn FnMut(usize, O, Option<Finish>),
) {
    let scale = Scale::new(&settings.tolerances, sizes[0]);
    let control = Control { span, largest: settings.largest_step, order: method.order() };
    let mut group = Group::new(method, control, &scale, sizes);
    let mut lanes: Vec<Option<Lane<'a, O>>> = (0..V::LANES).map(|_| None).collect();
    let mut system: Option<Box<dyn Abreast<V>>> = None;
    loop {
        // Free places take the next runs.
        let mut is_new = false;
        for (place, slot) in lanes.iter_mut().enumerate() {
            while slot.is_none() {
                let Some(job) = jobs.next() else { break };
                match Lane::new(job, span, settings) {
                    Ok(lane) if lane.is_at_end() => done(lane.number, lane.observer, Some(finish(lane.run))),
                    Ok(lane) => *slot = Some(lane),
                    Err((number, observer)) => done(number, observer, None),
                }
                is_new |= slot.is_some();
                if let Some(lane) = slot {
                    load(&mut group, place, lane);
                }
            }
        }
        let Some(any) = lanes.iter().flatten().next() else { return };
        if is_new || system.is_none() {
            // A free place calculates with what another has.
            let values = |lane: usize, k: usize| lanes[lane].as_ref().unwrap_or(any).values[k];
            let packed: Vec<Lanes<V>> = (0..any.values.len()).map(|k| Lanes::each(|lane| values(lane, k))).collect();
            let model = lifted(&packed);
            group.join(&*model);
            for (place, lane) in occupied(&mut lanes).filter(|(_, lane)| lane.shortening.is_none()) {
                lane.follow(&mut group, place);
                lane.lead(&mut group, place);
            }
            system = Some(model);
        }
        let Some(model) = &system else { return };
        let finished = round(&mut group, &mut lanes, &**model);
        for (place, slot) in lanes.iter_mut().enumerate() {
            let ended = finished & 1 << place != 0;
            let is_at_end = slot.as_ref().is_some_and(Lane::is_at_end);
            if !(ended || is_at_end) {
                continue;
            }
            let Some(mut lane) = slot.take() else { continue };
            group.leave(place);
            if !ended {
                lane.take_start(&mut group, place);
            }
            let Lane { number, run, observer, .. } = lane;
            done(number, observer, is_at_end.then(|| finish(run)));
        }
    }
}

/// Where a run has come to at its end. The largest values of its states are not known.
fn finish(run: Run<'_>) -> Finish {
    let mut finish = run.finish(Ended::AtEnd);
    finish.uncontrolled.fill(false);
    finish
}

/// A step, or an attempt at one, of each run; gives a bit for each run that cannot go on in company.
fn round<V: Vector, O: Observer>(
    group: &mut Group<V>,
    lanes: &mut [Option<Lane<'_, O>>],
    model: &dyn Abreast<V>,
) -> u8 {
    let second = if group.is_held() { model.second() } else { 0..0 };
    let (mut due, mut failed) = (0_u8, 0_u8);
    for (place, lane) in occupied(lanes) {
        if second.is_empty() || !lane.method().is_due() {
            continue;
        }
        due |= 1 << place;
        if lane.begins(&second) {
            group.set_compensation(place, lane.method().compensation());
        }
    }
    if due != 0 {
        let stiffnesses = group.follow(model, due);
        for (place, lane) in occupied(lanes).filter(|(place, _)| due & 1 << place != 0) {
            lane.method().stiffness(stiffnesses.as_ref()[place]);
            group.hold_to(place, lane.method().frequency());
            lane.run.stepper.statistics.rate_evaluations += 1;
        }
    }
    let planned = group.plan();
    let mut trying = planned;
    for (place, lane) in occupied(lanes).filter(|(place, _)| planned & 1 << place == 0) {
        lane.follow(group, place);
        match lane.next() {
            Next::Step(step) => {
                trying |= 1 << place;
                if lane.shortening.is_none() {
                    lane.lead(group, place);
                }
                group.step(place, step);
            }
            Next::Fails => failed |= 1 << place,
        }
    }
    if trying == 0 {
        return failed;
    }
    let Tried { fine, clear, accepted, refused } = group.attempt(model, MOVED);
    if group.is_held() {
        for (_, lane) in occupied(lanes).filter(|(place, _)| accepted & 1 << place != 0) {
            lane.method().advanced();
        }
    }
    let (others, mut accepted) = (trying & !(accepted | refused), accepted);
    for (place, lane) in occupied(lanes).filter(|(place, _)| others & 1 << place != 0) {
        lane.follow(group, place);
        let (step, error, judgement) = group.tried(place);
        let (bit, attempted) = (1 << place, Attempted { step, error, judgement });
        let outcome = match lane.attempted(group, place, attempted, [fine, clear].map(|bits| bits & bit != 0)) {
            Outcome::Alone => {
                lane.take_start(group, place);
                if lane.run.advance(&mut lane.observer).is_ok() { Outcome::Elsewhere } else { Outcome::Fails }
            }
            other => other,
        };
        match outcome {
            Outcome::Accepted => accepted |= bit,
            Outcome::Elsewhere => load(group, place, lane),
            Outcome::Fails => failed |= bit,
            Outcome::Again | Outcome::Alone => {}
        }
        if lane.shortening.is_none() {
            lane.lead(group, place);
        }
    }
    group.advance(accepted);
    failed
}

/// The runs at their places.
fn occupied<T>(lanes: &mut [Option<T>]) -> impl Iterator<Item = (usize, &mut T)> {
    lanes.iter_mut().enumerate().filter_map(|(place, lane)| Some((place, lane.as_mut()?)))
}

/// Takes a run over into the group.
fn load<V: Vector, O: Observer>(group: &mut Group<V>, place: usize, lane: &mut Lane<'_, O>) {
    let Run { stepper, monitor, .. } = &lane.run;
    group.load(place, stepper.start.borrowed(), &stepper.negative, monitor.at_start());
    group.set_compensation(place, lane.method().compensation());
    measure(group, place, &lane.run);
}

/// Takes over what errors are allowed in a run.
fn measure<V: Vector>(group: &mut Group<V>, place: usize, run: &Run<'_>) {
    let energy = run.sizes.moved(run.stepper.system).energy.unwrap_or(0.0);
    group.measure(place, &run.stepper.scale, &run.sizes.limits(), energy);
}
