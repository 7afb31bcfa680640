//! The steps of runs side by side, as far as they are the same operations for all.
//!
//! In: where each run stands, the step that it is to try. Out: where that leads, its error, whether it can be taken
//! over without a closer look. Nothing of one place enters another.

use nalgebra::DVector;
use pulp::NullaryFnOnce;

use super::controllers::{Control, Controllers, Judged, Lead};
use super::{Judgement, Kept, Step};
use crate::model::dynamics::Abreast;
use crate::model::reactions::LoopsInLanes;
use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector, at, put, replace, take};
use crate::solve::event::{Readings, Steps};
use crate::solve::integrator::{AnyInLanes, Begin, OfOne, PointRef, Rates, Scale, Side};
use crate::solve::statistics::Statistics;

/// How much less than the projection that is looked at a projection may move a state.
const CERTAIN: f64 = 0.99;

/// States of all runs.
type States<V> = Vec<Lanes<V>>;

/// Runs side by side where they stand.
pub(super) struct Group<V: Vector> {
    t: Lanes<V>,
    h: Lanes<V>,
    t_end: Lanes<V>,
    /// States and rates at the start and at the end of the steps.
    start: [States<V>; 2],
    end: [States<V>; 2],
    /// States at the end before they were projected, where joints may be rigid.
    reached: States<V>,
    negative: Vec<V::Mask>,
    readings: Readings<V>,
    method: AnyInLanes<V>,
    controllers: Controllers<V>,
    /// A bit for each run whose controller is among them.
    led: u8,
    /// A bit for each run whose plain steps are judged here: of its guards nothing is known but what they are at the
    /// start.
    plain: u8,
    /// What errors are allowed, and the magnitudes and the step (s) from which on runs have outgrown their sizes.
    scale: Scale<Lanes<V>>,
    limit: States<V>,
    longest: Lanes<V>,
    /// The largest energies so far, J; zero where they are not known.
    energy: Lanes<V>,
    /// Joints that close loops, if they are looked at here.
    loops: Option<LoopsInLanes<V>>,
    /// A bit for each run that is known not to start in the neighbourhood of a singular pose, and for the ends of the
    /// last attempts.
    whole: [u8; 2],
    /// The error norms by which the steps are stable, and those of the last attempts, with what follows from them.
    reach: Lanes<V>,
    errors: Lanes<V>,
    judged: Judged<V>,
}

/// What has come of steps: a bit for each run.
pub(super) struct Tried {
    /// It leads to finite states and rates, and is moved by the projection by no more than `moved`.
    pub fine: u8,
    /// All guards keep to their sides.
    pub clear: u8,
    /// It is accepted, and the controller of its run has chosen the next one.
    pub accepted: u8,
    /// It is rejected, and the controller of its run has chosen a shorter one.
    pub refused: u8,
}

impl<V: Vector> Group<V> {
    /// Nobody yet, with room for so many states and switches; steps by `method` with the tolerances of this scale.
    pub fn new(method: AnyInLanes<V>, control: Control, scale: &Scale, [states, switches]: [usize; 2]) -> Self {
        let zero = Lanes::from_f64(0.0);
        let &Scale { relative, coarsest, growth, .. } = scale;
        let lifted = |of: &[f64]| of.iter().map(|number| Lanes::from_f64(*number)).collect();
        let (absolute, weights) = (lifted(&scale.absolute), lifted(&scale.weights));
        let filled = |number: f64| vec![Lanes::from_f64(number); states];
        let none = || [filled(0.0), filled(0.0)];
        Self {
            t: zero,
            h: zero,
            t_end: zero,
            start: none(),
            end: none(),
            reached: filled(0.0),
            negative: vec![false.into(); switches],
            readings: Readings::new(switches, states),
            method,
            controllers: Controllers::new(control),
            led: 0,
            plain: 0,
            scale: Scale { relative, absolute, coarsest, growth, weights },
            limit: filled(f64::INFINITY),
            longest: Lanes::from_f64(f64::INFINITY),
            energy: zero,
            loops: None,
            whole: [0; 2],
            reach: zero,
            errors: zero,
            judged: Judged { logarithm: zero, factor: zero },
        }
    }

    /// The joints of the runs that are side by side now.
    pub fn join(&mut self, system: &dyn Abreast<V>) {
        self.loops = LoopsInLanes::new(system);
        self.whole = [0; 2];
    }

    /// The joints that close loops, if they are looked at here.
    pub fn loops(&self) -> Option<&LoopsInLanes<V>> {
        self.loops.as_ref()
    }

    /// Takes over the controller of a run, which is `plain` where nothing is known of its guards but what they are at
    /// the start, with the frequency (rad/s) that holds its steps.
    pub fn lead(&mut self, place: usize, lead: Lead, is_plain: bool, frequency: f64) {
        self.controllers.take(place, lead);
        self.method.hold_to(place, frequency);
        self.led |= 1 << place;
        self.plain = self.plain & !(1 << place) | u8::from(is_plain) << place;
    }

    /// Gives back the controller of a run, with its steps and rejected attempts since, and the time that it has come
    /// to, s; none where it is not here.
    pub fn leave(&mut self, place: usize) -> Option<(Kept, Statistics, f64)> {
        let is_led = self.led & 1 << place != 0;
        self.led &= !(1 << place);
        is_led.then(|| {
            let (controller, made) = self.controllers.give(place);
            (controller, made, *self.t.0.at(place))
        })
    }

    /// Whether steps are held to where the fastest oscillation is stable.
    pub fn is_held(&self) -> bool {
        self.method.is_held()
    }

    /// The frequency of the fastest oscillation of a run is this, rad/s.
    pub fn hold_to(&mut self, place: usize, frequency: f64) {
        self.method.hold_to(place, frequency);
    }

    /// Plans the next steps; gives a bit for each run that may make its step.
    pub fn plan(&mut self) -> u8 {
        V::vectorized(Plan { group: self })
    }

    /// A run makes this step next.
    pub fn step(&mut self, place: usize, Step { h, t, reach }: Step) {
        *self.h.0.at_mut(place) = h;
        *self.t_end.0.at_mut(place) = t;
        *self.reach.0.at_mut(place) = reach;
    }

    /// The step that a run has tried, its error norm and what follows from that.
    pub fn tried(&self, place: usize) -> (Step, f64, Judgement) {
        let Judged { logarithm, factor } = &self.judged;
        let at = |of: &Lanes<V>| *of.0.at(place);
        let step = Step { h: at(&self.h), t: at(&self.t_end), reach: at(&self.reach) };
        (step, at(&self.errors), Judgement { logarithm: at(logarithm), factor: at(factor) })
    }

    /// Takes over a run at a place: where it stands, its branches, the readings of its guards.
    pub fn load(&mut self, lane: usize, point: PointRef<'_>, negative: &[bool], guards: [&[f64]; 2]) {
        let bit = 1 << lane;
        for (mask, is_negative) in self.negative.iter_mut().zip(negative) {
            let others = V::bits(*mask) & !bit;
            *mask = V::mask(others | if *is_negative { bit } else { 0 });
        }
        self.whole[0] &= !bit;
        *self.t.0.at_mut(lane) = point.t;
        let [x, rate] = &mut self.start;
        put(lane, x, point.x);
        put(lane, rate, point.rate);
        for (to, from) in self.readings.start.iter_mut().zip(guards) {
            put(lane, to, from);
        }
    }

    /// What errors are allowed in a run, from which magnitudes and step (s) on it has outgrown its sizes, and the
    /// largest energy so far, J.
    pub fn measure(&mut self, lane: usize, scale: &Scale, (limit, longest): &(DVector<f64>, f64), energy: f64) {
        *self.energy.0.at_mut(lane) = energy;
        put(lane, &mut self.scale.absolute, &scale.absolute);
        put(lane, &mut self.scale.weights, &scale.weights);
        put(lane, &mut self.limit, limit.as_slice());
        *self.longest.0.at_mut(lane) = *longest;
    }

    /// Writes the state and the rate at the start of a run's step.
    pub fn take_start(&self, lane: usize, x: &mut [f64], rate: &mut [f64]) {
        take(lane, &self.start[0], x);
        take(lane, &self.start[1], rate);
    }

    /// Writes what a run's method carries over from step to step into `to`.
    pub fn take_compensation(&mut self, lane: usize, to: &mut [f64]) {
        take(lane, self.method.compensation(), to);
    }

    /// What a run's method carries over is this now.
    pub fn set_compensation(&mut self, lane: usize, compensation: &[f64]) {
        put(lane, self.method.compensation(), compensation);
    }

    /// Hands the stages of a run's step over to its own method.
    pub fn hand_over(&self, lane: usize, method: &mut dyn OfOne) {
        self.method.hand_over(lane, method);
    }

    /// Writes the state at the end of a run's step before it was projected, where joints may be rigid.
    pub fn take_reached(&self, lane: usize, x: &mut [f64]) {
        take(lane, &self.reached, x);
    }

    /// Writes the state at the end of a run's step.
    pub fn take_end(&self, lane: usize, x: &mut [f64]) {
        take(lane, &self.end[0], x);
    }

    /// Writes the rate there.
    pub fn take_rate(&self, lane: usize, rate: &mut [f64]) {
        take(lane, &self.end[1], rate);
    }

    /// The readings of the guards at the end of a run's step: values, slopes (per s), values in its middle.
    pub fn guards(&self, lane: usize) -> ([Vec<f64>; 2], Vec<f64>) {
        (self.readings.end.each_ref().map(|guards| at(lane, guards)), at(lane, &self.readings.middle))
    }

    /// The readings of the guards at the start of a run's step: values, slopes (per s).
    pub fn guards_at_start(&self, lane: usize) -> [Vec<f64>; 2] {
        self.readings.start.each_ref().map(|guards| at(lane, guards))
    }

    /// Iterates towards the fastest oscillations of the runs at the places of `due`; gives their stiffnesses.
    pub fn follow(&mut self, system: &dyn Abreast<V>, due: u8) -> V::Numbers {
        V::vectorized(Following { group: self, system, due })
    }

    /// Tries the steps. Those of plain runs are judged: accepted where nothing happens in them, rejected where they err
    /// too much, both far from singular poses.
    pub fn attempt(&mut self, system: &dyn Abreast<V>, moved: f64) -> Tried {
        V::vectorized(Attempt { group: self, system, moved })
    }

    /// The steps at the places of `accepted` are made.
    pub fn advance(&mut self, accepted: u8) {
        V::vectorized(Advance { group: self, accepted });
    }
}

struct Following<'a, V: Vector> {
    group: &'a mut Group<V>,
    system: &'a dyn Abreast<V>,
    due: u8,
}

impl<V: Vector> NullaryFnOnce for Following<'_, V> {
    type Output = V::Numbers;

    #[inline(always)]
    fn call(self) -> V::Numbers {
        let Group { t, start: [x, rate], negative, method, scale, .. } = self.group;
        let side = Side { system: self.system, negative };
        method.follow(&side, V::mask(self.due), (*t, x, rate), scale).0.numbers()
    }
}

struct Plan<'a, V: Vector> {
    group: &'a mut Group<V>,
}

impl<V: Vector> NullaryFnOnce for Plan<'_, V> {
    type Output = u8;

    #[inline(always)]
    fn call(self) -> u8 {
        let Group { t, h, t_end, method, controllers, led, reach, .. } = self.group;
        let (size, end, is_possible) = controllers.next(*t);
        (*h, *t_end, *reach) = (size, end, method.reach(size));
        let is_stable = !V::bits(V::below(size.alike(1.0).0, reach.0));
        *led & is_possible & is_stable
    }
}

struct Attempt<'a, V: Vector> {
    group: &'a mut Group<V>,
    system: &'a dyn Abreast<V>,
    moved: f64,
}

impl<V: Vector> NullaryFnOnce for Attempt<'_, V> {
    type Output = Tried;

    #[inline(always)]
    fn call(self) -> Tried {
        let Self { group, system, moved } = self;
        let Group { t, h, t_end, start: [x, rate], end: [end, end_rate], reached, negative, readings, .. } = group;
        let Group { method, scale, limit, longest, .. } = group;
        let (t, h, t_end) = (*t, *h, *t_end);
        let side = Side { system, negative };
        let norm = method.attempt(&side, &Begin { t, h, x, rate }, scale, end);
        let mut fine = finite(end);
        let has_joints = system.held().is_some();
        if has_joints {
            reached.copy_from_slice(end);
        }
        system.project(t_end, negative, end);
        if has_joints {
            fine &= near(reached, end, scale, CERTAIN * moved);
        }
        side.rate(t_end, end, end_rate);
        fine &= finite(end_rate);
        let steps = Steps { t, h, t_end, x: [x, end], rate: [rate, end_rate] };
        let clear = if negative.is_empty() { u8::MAX } else { V::bits(readings.read(side, &steps)) };
        let Group { controllers, led, plain, reach, errors, judged, loops, whole, energy, .. } = group;
        let error = Lanes::select(V::below(norm.0, reach.0), *reach, norm);
        // Of the others it is a number of an ordinary size.
        *errors = Lanes::select(V::mask(*led), error, h.alike(1.5));
        *judged = controllers.judge(*errors);
        let [one, infinity] = [1.0, f64::INFINITY].map(|number| h.alike(number));
        let is_large = V::bits(V::below(one.0, errors.0));
        let is_number = V::bits(V::below(errors.0, infinity.0));
        let keeps_size = !(outgrown(end, limit) | V::bits(V::below(longest.0, h.0)));
        let is_plain = fine & clear & keeps_size & !controllers.is_due(t_end);
        let mut accepted = *led & *plain & is_number & !is_large & is_plain;
        let mut refused = *led & *plain & is_number & is_large;
        if let Some(loops) = loops {
            // The ends of steps that may be accepted, then those of steps that err too much before they were projected.
            let mut ends = [0; 2];
            for (whole, x) in ends.iter_mut().zip([&*end, &*reached]) {
                *whole = loops.whole(system, (t_end, x), negative, *energy);
                if refused == 0 {
                    break;
                }
            }
            accepted &= ends[0];
            refused &= whole[0] & ends[1];
            whole[1] = ends[0];
        }
        controllers.go_on([h, t_end], *judged, accepted, refused);
        Tried { fine, clear, accepted, refused }
    }
}

/// A bit for each run whose numbers are all finite.
#[inline(always)]
fn finite<V: Vector>(of: &[Lanes<V>]) -> u8 {
    // What is finite times 0 is 0; anything else times 0 is no number.
    let mut sum = of[0].times(0.0);
    for value in of {
        sum = sum + value.times(0.0);
    }
    V::bits(V::below(sum.abs().0, sum.alike(1.0).0))
}

/// A bit for each run with a state of a larger magnitude than its limit.
#[inline(always)]
fn outgrown<V: Vector>(of: &[Lanes<V>], limit: &[Lanes<V>]) -> u8 {
    let mut outgrown = 0;
    for (of, limit) in of.iter().zip(limit) {
        outgrown |= V::bits(V::below(limit.0, of.abs().0));
    }
    outgrown
}

/// A bit for each run none of whose states is further from the one before than `most` of what is allowed there.
#[inline(always)]
fn near<V: Vector>(before: &[Lanes<V>], after: &[Lanes<V>], scale: &Scale<Lanes<V>>, most: f64) -> u8 {
    let mut near = u8::MAX;
    for (i, (from, to)) in before.iter().zip(after).enumerate() {
        let allowed = scale.allowed(i, *to).times(most);
        near &= V::bits(V::below((*to - *from).abs().0, allowed.0));
    }
    near
}

struct Advance<'a, V: Vector> {
    group: &'a mut Group<V>,
    accepted: u8,
}

impl<V: Vector> NullaryFnOnce for Advance<'_, V> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Group { t, t_end, start, end, readings, method, whole, .. } = self.group;
        whole[0] = whole[0] & !self.accepted | whole[1] & self.accepted;
        let accepted = V::mask(self.accepted);
        *t = Lanes::select(accepted, *t_end, *t);
        for part in 0..2 {
            replace(&mut start[part], accepted, &end[part]);
            replace(&mut readings.start[part], accepted, &readings.end[part]);
        }
        method.advance(accepted);
    }
}
