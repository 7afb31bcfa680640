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

use nalgebra::SVector;

pub(crate) use condition::{Condition, Located, Never, Stop};
use guarded::Guarded;
pub(crate) use impact::Struck;
#[cfg(feature = "std")]
pub(crate) use lanes::{Readings, Steps};
#[cfg(feature = "std")]
pub(crate) use locate::{Found, Shortening};

/// Events at one instant, to a millionth of a millionth of the time, that end a run.
const CROWD: u32 = 1000;
const INSTANT: f64 = 1e-12;
/// The part of a step for the difference that gives a guard's derivative: it keeps nine digits and its truncation error
/// is as small.
const AHEAD: f64 = 1e-6;
/// A guard's sign is taken for certain above this multiple of its rounding error.
const CERTAIN: f64 = 16.0;

/// Guards and their derivatives along the flow (per s) at one point.
#[derive(Clone, Copy, Debug)]
struct Reading<const G: usize> {
    value: SVector<f64, G>,
    slope: SVector<f64, G>,
    /// Their rounding errors; known where a step is looked at closely.
    noise: [f64; G],
}

/// What is known of the guards.
#[derive(Clone, Debug)]
pub(crate) struct EventMonitor<const G: usize> {
    start: Reading<G>,
    end: Reading<G>,
    /// What its last event has left of each guard that has stayed near zero since.
    remainder: [f64; G],
    /// The switches of stops, whose guards are places: what passes its end further than before has come to it again.
    is_stop: [bool; G],
    /// Events since `crowd_start` (s).
    crowd: u32,
    crowd_start: f64,
}

/// A step that ends at an event.
#[derive(Debug)]
pub(crate) struct Crossing<const G: usize> {
    /// The switches whose guards are at zero.
    pub switches: [bool; G],
    /// Whether the event is at the start of the step, which then is no step.
    pub is_at_start: bool,
}

impl<const G: usize> EventMonitor<G> {
    pub fn new() -> Self {
        let reading = Reading { value: SVector::zeros(), slope: SVector::zeros(), noise: [0.0; G] };
        Self { start: reading, end: reading, remainder: [0.0; G], is_stop: [false; G], crowd: 0, crowd_start: f64::NAN }
    }

    /// The end of the step becomes the start of the next one; the branches stay.
    pub fn advance(&mut self) {
        self.forget();
        self.start = self.end;
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

    /// Those of `switches` whose guards are at zero, to rounding, at the end of a step that was shortened further.
    pub fn still_at_zero<const N: usize>(&self, step: &mut impl Guarded<N, G>, switches: [bool; G]) -> [bool; G] {
        let end = *step.end();
        let value = step.guards(end.t, &end.x);
        let noise = self.noise(step, end.t, &end.x, &value);
        core::array::from_fn(|k| switches[k] && value[k].abs() <= noise[k])
    }

    /// Reads the guards at the start of the step, where the rate is known.
    fn read_start<const N: usize>(&mut self, step: &mut impl Guarded<N, G>, h: f64) {
        let start = *step.start();
        self.start = read(step, start.t, &start.x, &start.rate, h);
    }
}

/// The clearance of a guard: positive on the side of its branch.
fn clearance(value: f64, negative: bool) -> f64 {
    if negative { -value } else { value }
}

fn check_finite<const G: usize>(value: &SVector<f64, G>) -> Result<(), (usize, f64)> {
    value.iter().copied().enumerate().find(|(_, value)| !value.is_finite()).map_or(Ok(()), Err)
}

/// The guards at a point with the given rate, and their derivatives along the flow by a forward difference.
fn read<const N: usize, const G: usize>(
    step: &mut impl Guarded<N, G>,
    t: f64,
    x: &SVector<f64, N>,
    rate: &SVector<f64, N>,
    h: f64,
) -> Reading<G> {
    let ahead = AHEAD * h;
    let value = step.guards(t, x);
    let mut x_ahead = *x;
    for (x, rate) in x_ahead.data.0[0].iter_mut().zip(&rate.data.0[0]) {
        *x += rate * ahead;
    }
    let slope = (step.guards(t + ahead, &x_ahead) - value) / ahead;
    Reading { value, slope, noise: [0.0; G] }
}
