//! The condition that ends a run: where a function of time and state passes through zero.
//!
//! In: accepted steps. Out: whether the condition has come to zero in a step, which is then shortened to that instant.
//! The condition is a guard of its own, found and located as those of switches are. Its side is its sign at the start
//! of the run, or a little later where it is zero there by rounding; as long as it stays zero it has no side and ends
//! nothing.

use nalgebra::SVector;

use super::guarded::Guarded;
use super::noise::larger;
use super::{CERTAIN, EventMonitor, check_finite, clearance, read};
use crate::model::system::System;
use crate::solve::integrator::{Method, Point};
use crate::solve::stepper::Stepper;

/// Where in a step a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stop {
    /// At its start: it is not made.
    AtStart,
    /// At its end, to which it has been shortened.
    AtEnd,
}

/// What may end a run. Each fails with the value of the condition where that is not finite.
pub(crate) trait Condition<const N: usize, const G: usize> {
    /// Finds the side at the start of the run, by steps that are small compared with `reach` (s).
    fn begin<Sys, M>(&mut self, _stepper: &mut Stepper<'_, Sys, M, N, G>, _reach: f64) -> Result<(), f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        Ok(())
    }

    /// Looks for the end of the run in the step just made, whose end has been projected and whose rates are known at
    /// both ends; `is_at_event` where it ends with an event.
    fn inspect<Sys, M>(
        &mut self,
        _stepper: &mut Stepper<'_, Sys, M, N, G>,
        _is_at_event: bool,
    ) -> Result<Option<Stop>, f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        Ok(None)
    }

    /// The end of the step becomes the start of the next one; the branches stay.
    fn advance(&mut self) {}

    /// The branches at the start of the next step are new: whether the condition has jumped to the other side.
    fn jumps<Sys, M>(&mut self, _stepper: &mut Stepper<'_, Sys, M, N, G>, _reach: f64) -> Result<bool, f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        Ok(false)
    }
}

/// No condition: only the end of the span ends the run.
#[derive(Debug)]
pub(crate) struct Never;

impl<const N: usize, const G: usize> Condition<N, G> for Never {}

/// A condition and what is known of it.
#[derive(Debug)]
pub(crate) struct Located<C> {
    condition: C,
    monitor: EventMonitor<1>,
    /// Whether it is on its negative side; nothing as long as it stays zero.
    side: Option<bool>,
}

impl<C> Located<C> {
    pub fn new(condition: C) -> Self {
        Self { condition, monitor: EventMonitor::new(), side: None }
    }

    /// The step with the condition as its guard.
    fn on<'s, 'a, Sys, M, const N: usize, const G: usize>(
        &'s mut self,
        stepper: &'s mut Stepper<'a, Sys, M, N, G>,
    ) -> (&'s mut EventMonitor<1>, Conditional<'s, 'a, Sys, M, C, N, G>) {
        let Self { condition, monitor, side } = self;
        (monitor, Conditional { stepper, condition, is_negative: side.unwrap_or(false) })
    }
}

impl<C, const N: usize, const G: usize> Condition<N, G> for Located<C>
where
    C: FnMut(f64, &SVector<f64, N>, &[bool; G]) -> f64,
{
    fn begin<Sys, M>(&mut self, stepper: &mut Stepper<'_, Sys, M, N, G>, reach: f64) -> Result<(), f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let (monitor, mut step) = self.on(stepper);
        monitor.read_start(&mut step, reach);
        check_finite(&monitor.start.value).map_err(|(_, value)| value)?;
        let (start, value) = (*step.start(), monitor.start.value);
        self.side = if value[0].abs() > CERTAIN * rounding(monitor, &mut step, &start, value, monitor.start.slope[0]) {
            Some(value[0] < 0.0)
        } else {
            // What a run that ended here before has left.
            monitor.leave(0, value[0]);
            monitor.probe(&mut step, &[true], reach)[0]
        };
        Ok(())
    }

    fn inspect<Sys, M>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        is_at_event: bool,
    ) -> Result<Option<Stop>, f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let is_undecided = self.side.is_none();
        let (monitor, mut step) = self.on(stepper);
        if is_undecided {
            let (end, h) = (*step.end(), step.size());
            monitor.end = read(&mut step, end.t, &end.x, &end.rate, h);
            check_finite(&monitor.end.value).map_err(|(_, value)| value)?;
            let value = monitor.end.value;
            let is_certain = value[0].abs() > CERTAIN * monitor.noise(&mut step, end.t, &end.x, &value)[0];
            self.side = is_certain.then_some(value[0] < 0.0);
            return Ok(None);
        }
        Ok(match monitor.inspect(&mut step).map_err(|(_, value)| value)? {
            Some(crossing) if crossing.is_at_start => Some(Stop::AtStart),
            Some(_) => Some(Stop::AtEnd),
            None => (is_at_event && arrives(monitor, &mut step)).then_some(Stop::AtEnd),
        })
    }

    fn advance(&mut self) {
        self.monitor.advance();
    }

    fn jumps<Sys, M>(&mut self, stepper: &mut Stepper<'_, Sys, M, N, G>, reach: f64) -> Result<bool, f64>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let side = self.side;
        let (monitor, mut step) = self.on(stepper);
        monitor.forget();
        monitor.read_start(&mut step, reach);
        check_finite(&monitor.start.value).map_err(|(_, value)| value)?;
        let (start, value) = (*step.start(), monitor.start.value);
        let noise = monitor.noise(&mut step, start.t, &start.x, &value)[0];
        Ok(side.is_some_and(|negative| clearance(value[0], negative) < -noise))
    }
}

/// Whether the condition has come from its side to zero, to rounding, at the end of a step: at an event it may stay
/// there.
fn arrives<const N: usize>(monitor: &EventMonitor<1>, step: &mut impl Guarded<N, 1>) -> bool {
    let (end, negative) = (*step.end(), step.negative()[0]);
    let (from, to) = (monitor.start.value[0], monitor.end.value);
    let rounding = rounding(monitor, step, &end, to, monitor.end.slope[0]);
    to[0].abs() <= rounding && clearance(from, negative) > CERTAIN * rounding
}

/// How far from zero the condition may be by rounding at a point where it is at zero, of the states or of the time.
fn rounding<const N: usize>(
    monitor: &EventMonitor<1>,
    step: &mut impl Guarded<N, 1>,
    at: &Point<N>,
    value: SVector<f64, 1>,
    slope: f64,
) -> f64 {
    let noise = monitor.noise(step, at.t, &at.x, &value)[0];
    larger(4.0 * f64::EPSILON * (at.t * slope).abs(), noise)
}

/// A step with the condition as its only guard; the branches of the switches stay.
struct Conditional<'s, 'a, Sys, M, C, const N: usize, const G: usize> {
    stepper: &'s mut Stepper<'a, Sys, M, N, G>,
    condition: &'s mut C,
    is_negative: bool,
}

impl<Sys, M, C, const N: usize, const G: usize> Guarded<N, 1> for Conditional<'_, '_, Sys, M, C, N, G>
where
    Sys: System<f64, N, G>,
    M: Method,
    C: FnMut(f64, &SVector<f64, N>, &[bool; G]) -> f64,
{
    fn start(&self) -> &Point<N> {
        self.stepper.start()
    }

    fn end(&self) -> &Point<N> {
        self.stepper.end()
    }

    fn size(&self) -> f64 {
        self.stepper.size()
    }

    fn negative(&self) -> [bool; 1] {
        [self.is_negative]
    }

    fn guards(&mut self, t: f64, x: &SVector<f64, N>) -> SVector<f64, 1> {
        self.stepper.statistics.guard_evaluations += 1;
        SVector::from([(self.condition)(t, x, &self.stepper.negative)])
    }

    fn dense(&mut self, theta: f64) -> SVector<f64, N> {
        self.stepper.dense(theta)
    }

    fn resize(&mut self, h: f64) {
        self.stepper.resize(h);
    }

    fn close(&mut self, latest: f64) {
        self.stepper.close(latest);
    }
}
