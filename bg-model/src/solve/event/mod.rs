//! Events: the instants at which a switch has to change its branch.
//!
//! In: an accepted step whose branches were frozen. Out: nothing, or the step shortened to the first instant at which
//! a guard has the sign of the other branch, and the switches concerned; then the branches that hold from there on.
//!
//! A guard counts as crossed where it is on the wrong side by more than rounding makes of it at that point (`noise`): a
//! remainder of that size, which an event leaves behind, does not trigger another one. A branch is decided by the sign
//! of the guard after the event, under that branch, and not by the direction of the crossing.

mod branch;
mod condition;
mod detect;
mod guarded;
mod impact;
#[cfg(feature = "std")]
mod lanes;
mod locate;
mod minimum;
mod noise;
mod zero;

use alloc::vec;
use alloc::vec::Vec;

pub(crate) use condition::{Condition, Located, Stop};
use guarded::{End, Guarded};
pub(crate) use impact::Struck;
#[cfg(feature = "std")]
pub(crate) use lanes::{Readings, Steps};
#[cfg(feature = "std")]
pub(crate) use locate::{Found, Shortening};
pub(crate) use minimum::minimum;

use crate::solve::integrator::{Point, first_not_finite};

/// Events at one instant, to a millionth of a millionth of the time, that end a run.
const CROWD: u32 = 1000;
const INSTANT: f64 = 1e-12;
/// Events at one instant, from which on what rounding decides is decided for rest.
const REPEATED: u32 = CROWD / 10;
/// The part of a step for the difference that gives a guard's derivative: it keeps nine digits and its truncation error
/// is as small.
const AHEAD: f64 = 1e-6;
/// A guard's sign is taken for certain above this multiple of its rounding error.
const CERTAIN: f64 = 16.0;

/// Guards and their derivatives along the flow (per s) at one point.
#[derive(Clone, Debug)]
struct Reading {
    value: Vec<f64>,
    slope: Vec<f64>,
    /// Their rounding errors; known where a step is looked at closely.
    noise: Vec<f64>,
}

impl Reading {
    fn new(guards: usize) -> Self {
        Self { value: vec![0.0; guards], slope: vec![0.0; guards], noise: vec![0.0; guards] }
    }

    /// Becomes another one of as many guards.
    fn become_that(&mut self, other: &Self) {
        self.value.copy_from_slice(&other.value);
        self.slope.copy_from_slice(&other.slope);
        self.noise.copy_from_slice(&other.noise);
    }

    /// Reads the guards at an end of the step, where the rate is known, and their derivatives along the flow by a
    /// forward difference of a part of `h` (s); `ahead` is room for a state.
    fn take(&mut self, step: &mut dyn Guarded, end: End, h: f64, ahead: &mut Vec<f64>) {
        let by = AHEAD * h;
        step.read_end(end, &mut self.value);
        let Point { t, x, rate } = step.point(end);
        let t = *t;
        ahead.resize(x.len(), 0.0);
        for ((ahead, x), rate) in ahead.iter_mut().zip(x.as_slice()).zip(rate.as_slice()) {
            *ahead = x + rate * by;
        }
        step.read(t + by, ahead, &mut self.slope);
        self.slope.iter_mut().zip(&self.value).for_each(|(slope, value)| *slope = (*slope - value) / by);
        self.noise.fill(0.0);
    }
}

/// What is known of the guards.
#[derive(Clone, Debug)]
pub(crate) struct EventMonitor {
    start: Reading,
    end: Reading,
    /// What its last event has left of each guard that has stayed near zero since.
    remainder: Vec<f64>,
    /// The switches of stops, whose guards are places: what passes its end further than before has come to it again.
    is_stop: Vec<bool>,
    /// Events since `crowd_start` (s).
    crowd: u32,
    crowd_start: f64,
    /// Room for a state and for the guards in the middle of a step.
    state: Vec<f64>,
    middle: Vec<f64>,
}

/// A step that ends at an event.
#[derive(Debug)]
pub(crate) struct Crossing {
    /// The switches whose guards are at zero.
    pub switches: Vec<bool>,
    /// Whether the event is at the start of the step, which then is no step.
    pub is_at_start: bool,
}

impl EventMonitor {
    /// Of so many guards.
    pub fn new(guards: usize) -> Self {
        Self {
            start: Reading::new(guards),
            end: Reading::new(guards),
            remainder: vec![0.0; guards],
            is_stop: vec![false; guards],
            crowd: 0,
            crowd_start: f64::NAN,
            state: Vec::new(),
            middle: vec![0.0; guards],
        }
    }

    /// The number of guards.
    fn guards(&self) -> usize {
        self.remainder.len()
    }

    /// The end of the step becomes the start of the next one; the branches stay.
    pub fn advance(&mut self) {
        self.forget();
        self.start.become_that(&self.end);
    }

    /// The first guard at the start that is not finite.
    pub fn check_start(&self) -> Result<(), (usize, f64)> {
        check_finite(&self.start.value)
    }

    /// Counts an event at `t` (s); whether too many have come at one instant of a run of the given length (s).
    pub fn is_crowded(&mut self, t: f64, length: f64) -> bool {
        let apart = t - self.crowd_start > INSTANT * t.abs().max(length);
        if apart || self.crowd_start.is_nan() {
            (self.crowd, self.crowd_start) = (0, t);
        }
        self.crowd += 1;
        self.crowd > CROWD
    }

    /// Whether so many events have been at the instant `t` (s) that rounding is their cause.
    fn repeats(&self, t: f64) -> bool {
        self.crowd_start == t && self.crowd > REPEATED
    }

    /// Those of `switches` whose guards are at zero, to rounding, at the end of a step that was shortened further.
    pub fn still_at_zero(&self, step: &mut dyn Guarded, switches: &[bool]) -> Vec<bool> {
        let value = step.guards_of(End::End);
        let noise = self.noise_of(step, End::End, &value);
        (0..switches.len()).map(|k| switches[k] && value[k].abs() <= noise[k]).collect()
    }

    /// Reads the guards at the start of the step, where the rate is known.
    fn read_start(&mut self, step: &mut dyn Guarded, h: f64) {
        self.start.take(step, End::Start, h, &mut self.state);
    }

    /// Reads the guards at the end of the step, where the rate is known.
    fn read_end(&mut self, step: &mut dyn Guarded) {
        let h = step.size();
        self.end.take(step, End::End, h, &mut self.state);
    }
}

/// The clearance of a guard: positive on the side of its branch.
fn clearance(value: f64, negative: bool) -> f64 {
    if negative { -value } else { value }
}

fn check_finite(value: &[f64]) -> Result<(), (usize, f64)> {
    first_not_finite(value).map_or(Ok(()), Err)
}
