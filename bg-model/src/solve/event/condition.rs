//! The condition that ends a run: where a function of time and state passes through zero.
//!
//! In: accepted steps. Out: whether the condition has come to zero in a step, which is then shortened to that instant.
//! The condition is a guard of its own, found and located as those of switches are. Its side is its sign at the start
//! of the run, or a little later where it is zero there by rounding; as long as it stays zero it has no side and ends
//! nothing.

use super::guarded::{End, Guarded};
use super::noise::larger;
use super::{CERTAIN, EventMonitor, check_finite, clearance};
use crate::solve::integrator::Point;
use crate::solve::stepper::Stepper;

/// Where in a step a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    /// At its start: it is not made.
    AtStart,
    /// At its end, to which it has been shortened.
    AtEnd,
}

/// A function of time (s), state and branches.
pub(crate) type Condition<'a> = dyn FnMut(f64, &[f64], &[bool]) -> f64 + 'a;

/// A condition and what is known of it. What looks at it fails with its value where that is not finite.
pub(crate) struct Located<'a> {
    condition: &'a mut Condition<'a>,
    monitor: EventMonitor,
    /// Whether it is on its negative side; nothing as long as it stays zero.
    side: Option<bool>,
}

impl<'a> Located<'a> {
    pub fn new(condition: &'a mut Condition<'a>) -> Self {
        Self { condition, monitor: EventMonitor::new(1), side: None }
    }

    /// The step with the condition as its guard.
    fn on<'s>(&'s mut self, stepper: &'s mut Stepper<'a>) -> (&'s mut EventMonitor, Conditional<'s, 'a>) {
        let Self { condition, monitor, side } = self;
        (monitor, Conditional { stepper, condition: &mut **condition, is_negative: [side.unwrap_or(false)] })
    }

    /// Finds the side at the start of the run, by steps that are small compared with `reach` (s).
    pub fn begin(&mut self, stepper: &mut Stepper<'a>, reach: f64) -> Result<(), f64> {
        let (monitor, mut step) = self.on(stepper);
        let value = value_at_start(monitor, &mut step, reach)?;
        let rounding = rounding(monitor, &mut step, End::Start, value, monitor.start.slope[0]);
        self.side = if value.abs() > CERTAIN * rounding {
            Some(value < 0.0)
        } else {
            // What a run that ended here before has left.
            monitor.leave(0, value);
            monitor.probe(&mut step, &[true], reach)[0]
        };
        Ok(())
    }

    /// Looks for the end of the run in the step just made, whose end has been projected and whose rates are known at
    /// both ends; `is_at_event` where it ends with an event.
    pub fn inspect(&mut self, stepper: &mut Stepper<'a>, is_at_event: bool) -> Result<Option<Stop>, f64> {
        let is_undecided = self.side.is_none();
        let (monitor, mut step) = self.on(stepper);
        if is_undecided {
            monitor.read_end(&mut step);
            check_finite(&monitor.end.value).map_err(|(_, value)| value)?;
            let value = monitor.end.value[0];
            let is_certain = value.abs() > CERTAIN * monitor.noise_of(&mut step, End::End, &[value])[0];
            self.side = is_certain.then_some(value < 0.0);
            return Ok(None);
        }
        Ok(match monitor.inspect(&mut step).map_err(|(_, value)| value)? {
            Some(crossing) if crossing.is_at_start => Some(Stop::AtStart),
            Some(_) => Some(Stop::AtEnd),
            None => (is_at_event && arrives(monitor, &mut step)).then_some(Stop::AtEnd),
        })
    }

    /// The end of the step becomes the start of the next one; the branches stay.
    pub fn advance(&mut self) {
        self.monitor.advance();
    }

    /// The branches at the start of the next step are new: whether the condition has jumped to the other side.
    pub fn jumps(&mut self, stepper: &mut Stepper<'a>, reach: f64) -> Result<bool, f64> {
        let side = self.side;
        let (monitor, mut step) = self.on(stepper);
        monitor.forget();
        let value = value_at_start(monitor, &mut step, reach)?;
        let noise = monitor.noise_of(&mut step, End::Start, &[value])[0];
        Ok(side.is_some_and(|negative| clearance(value, negative) < -noise))
    }
}

/// Reads the condition at the start of the step.
fn value_at_start(monitor: &mut EventMonitor, step: &mut dyn Guarded, reach: f64) -> Result<f64, f64> {
    monitor.read_start(step, reach);
    check_finite(&monitor.start.value).map_err(|(_, value)| value)?;
    Ok(monitor.start.value[0])
}

/// Whether the condition has come from its side to zero, to rounding, at the end of a step: at an event it may stay
/// there.
fn arrives(monitor: &EventMonitor, step: &mut dyn Guarded) -> bool {
    let (from, to, negative) = (monitor.start.value[0], monitor.end.value[0], step.negative()[0]);
    let rounding = rounding(monitor, step, End::End, to, monitor.end.slope[0]);
    to.abs() <= rounding && clearance(from, negative) > CERTAIN * rounding
}

/// How far from zero the condition may be by rounding at an end of the step where it is at zero, of the states or of
/// the time.
fn rounding(monitor: &EventMonitor, step: &mut dyn Guarded, end: End, value: f64, slope: f64) -> f64 {
    let t = step.point(end).t;
    let noise = monitor.noise_of(step, end, &[value])[0];
    larger(4.0 * f64::EPSILON * (t * slope).abs(), noise)
}

/// A step with the condition as its only guard; the branches of the switches stay.
struct Conditional<'s, 'a> {
    stepper: &'s mut Stepper<'a>,
    condition: &'s mut Condition<'a>,
    is_negative: [bool; 1],
}

impl Guarded for Conditional<'_, '_> {
    fn point(&self, end: End) -> &Point {
        self.stepper.point(end)
    }

    fn size(&self) -> f64 {
        self.stepper.size()
    }

    fn negative(&self) -> &[bool] {
        &self.is_negative
    }

    fn read(&mut self, t: f64, x: &[f64], guards: &mut [f64]) {
        self.stepper.statistics.guard_evaluations += 1;
        guards[0] = (self.condition)(t, x, &self.stepper.negative);
    }

    fn read_end(&mut self, end: End, guards: &mut [f64]) {
        self.stepper.statistics.guard_evaluations += 1;
        let Point { t, x, .. } = self.stepper.point(end);
        guards[0] = (self.condition)(*t, x.as_slice(), &self.stepper.negative);
    }

    fn dense(&mut self, theta: f64, x: &mut [f64]) {
        Guarded::dense(self.stepper, theta, x);
    }

    fn resize(&mut self, h: f64) {
        self.stepper.resize(h);
    }

    fn close(&mut self, latest: f64) {
        self.stepper.close(latest);
    }
}
