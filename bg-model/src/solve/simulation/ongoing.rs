//! A run that is made piece by piece, each to an end that is known only when the one before is done: co-simulation,
//! control.
//!
//! In: a state, then one end after the other. Out: the state there. From piece to piece stay the rate, the branches,
//! what is known of the guards, the size of the next step and what the method keeps; only where the system has changed
//! in between is the start looked at anew, and then too the size of the step stays.

use alloc::boxed::Box;
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::DVector;

use super::history::History;
use super::observer::Observer;
use super::rounding::RoundingMonitor;
use super::run::Run;
use super::settings::{self, Settings, Span};
use super::sizes::{SizeMonitor, raise};
use super::step_size::StepSizeController;
use crate::model::dynamics::{Dynamics, Typed};
use crate::model::system::System;
use crate::solve::event::EventMonitor;
use crate::solve::failure::{Cause, Failure};
use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{Method, Point, Scale};
use crate::solve::statistics::Statistics;
use crate::solve::stepper::Stepper;

/// A run that goes on.
///
/// ```
/// use bg_model::integrator::Dop853;
/// use bg_model::nalgebra::SVector;
/// use bg_model::simulation::{Ongoing, Settings};
/// use bg_model::system::System;
///
/// struct Decay;
/// impl System<f64, 1, 0> for Decay {
///     fn rate(&self, _: f64, x: &SVector<f64, 1>, _: &[bool; 0], dx: &mut SVector<f64, 1>) {
///         dx[0] = -x[0];
///     }
/// }
///
/// let (mut run, mut method) = (Ongoing::at(0.0, &[1.0]), Dop853::new());
/// for k in 1..=10 {
///     run.advance(&Decay, &mut method, 0.1 * f64::from(k), &Settings::default(), &mut ())?;
/// }
/// assert!((run.state()[0] - (-1.0_f64).exp()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Ongoing {
    start: Point,
    negative: Vec<bool>,
    /// Whether these branches are known.
    is_known: bool,
    monitor: EventMonitor,
    rounding: Option<RoundingMonitor>,
    /// None before the first piece.
    sizes: Option<SizeMonitor>,
    /// How large each state has been before that.
    largest: DVector<f64>,
    /// None where the start has to be looked at.
    controller: Option<StepSizeController>,
    /// The size of the next step, s, where it is known.
    step: Option<f64>,
    /// The past of signals that the system delays, where it does.
    history: Option<History>,
    statistics: Statistics,
}

impl Ongoing {
    /// A run from state `x` at time `t` (s).
    #[must_use]
    pub fn at(t: f64, x: &[f64]) -> Self {
        Self::with(t, x, None)
    }

    /// The same in these branches of the switches. A branch that the sign of its guard contradicts is found anew.
    #[must_use]
    pub fn standing(t: f64, x: &[f64], negative: &[bool]) -> Self {
        Self::with(t, x, Some(negative))
    }

    /// The same where the states have been as large as `largest` before: errors are measured by that.
    #[must_use]
    pub fn grown(mut self, largest: &[f64]) -> Self {
        raise(self.largest.as_mut_slice(), largest);
        self
    }

    fn with(t: f64, x: &[f64], negative: Option<&[bool]>) -> Self {
        let x = DVector::from_column_slice(x);
        let (largest, statistics) = (x.abs(), Statistics::default());
        Self {
            start: Point::at(t, x),
            negative: negative.unwrap_or_default().to_vec(),
            is_known: negative.is_some(),
            monitor: EventMonitor::new(0),
            rounding: None,
            sizes: None,
            largest,
            controller: None,
            step: None,
            history: None,
            statistics,
        }
    }

    /// The time that it has reached, s.
    #[must_use]
    pub const fn time(&self) -> f64 {
        self.start.t
    }

    /// The state there.
    #[must_use]
    pub fn state(&self) -> &[f64] {
        self.start.x.as_slice()
    }

    /// The branches from there on; none before the first piece, unless they were given.
    #[must_use]
    pub fn negative(&self) -> &[bool] {
        &self.negative
    }

    /// The size that the next step is to have, s, where that is known.
    #[must_use]
    pub const fn next_step(&self) -> Option<f64> {
        self.step
    }

    /// What all pieces have cost.
    #[must_use]
    pub const fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The system has changed, as where an input has jumped: the rate is found anew, and the branches are whose guards
    /// have got another sign; what sticks or rests stays so as long as it can. The next step is tried with `step` (s),
    /// where that is given, else with the size that it was to have.
    pub fn renew(&mut self, step: Option<f64>) {
        self.controller = None;
        self.step = step.or(self.step);
    }

    /// Goes on to `t_end` (s), where a step ends. Samples are those of this piece.
    ///
    /// # Errors
    /// As [`integrate`](super::integrate); the run then is at its last good point.
    pub fn advance<Sys, M, O, const N: usize, const G: usize>(
        &mut self,
        system: &Sys,
        method: &mut M,
        t_end: f64,
        settings: &Settings,
        observer: &mut O,
    ) -> Result<Ended, Failure>
    where
        Sys: System<f64, N, G>,
        M: Method,
        O: Observer,
    {
        self.drive(&Typed::system(system), method, t_end, settings, observer)
    }

    /// The same of a system over slices.
    ///
    /// # Errors
    /// As there.
    pub fn drive(
        &mut self,
        system: &dyn Dynamics,
        method: &mut dyn Method,
        t_end: f64,
        settings: &Settings,
        observer: &mut dyn Observer,
    ) -> Result<Ended, Failure> {
        settings::check_fit(system, self.start.t, &self.start.x)?;
        let span = Span { t0: self.start.t, t_end };
        let control = method.control();
        let needs_series = method.needs_series().then(|| method.name());
        // A step that was shortened to nothing says nothing of the next one.
        let step = self.step.filter(|step| *step > span.resolution());
        let settings = &Settings { first_step: step.or(settings.first_step), ..settings.clone() };
        let scale = Scale::new(&settings.tolerances, system.states());
        let stepper = Stepper::new(system, method, scale, self.start.clone());
        let mut run = Run::new(stepper, None, control, span, settings);
        run.stepper.statistics = self.statistics;
        run.history = self.history.take().or(run.history);
        if let Some(mut sizes) = self.sizes.take() {
            sizes.go_on(&run.sizes, &mut run.stepper.scale);
            run.sizes = sizes;
        } else {
            run.sizes.remember(&run.stepper, &self.largest);
        }
        let outcome = settings::check(system, control, self.start.x.as_slice(), span, settings)
            .and_then(|()| settings::check_series(system, needs_series))
            .map_err(Cause::from)
            .and_then(|()| match self.controller.take().filter(|known| !known.is_adaptive() || step.is_some()) {
                None => run.begin(control, settings, self.is_known.then_some(self.negative.as_slice())),
                Some(controller) => {
                    (run.stepper.negative, run.controller, run.monitor) =
                        (self.negative.clone(), controller, self.monitor.clone());
                    run.rounding = self.rounding.take();
                    Ok(())
                }
            })
            .and_then(|()| {
                run.controller.go_on(span);
                run.advance_to_end(observer)
            });
        let Run { stepper, controller, monitor, rounding, sizes, history, .. } = run;
        self.history = history;
        self.sizes = Some(sizes);
        (self.start, self.negative, self.monitor, self.rounding) = (stepper.start, stepper.negative, monitor, rounding);
        self.statistics = stepper.statistics;
        match outcome {
            Ok(ended) => {
                self.step = controller.is_adaptive().then(|| controller.step());
                self.is_known = true;
                self.controller = Some(controller);
                Ok(ended)
            }
            Err(cause) => {
                let (Point { t, x, .. }, negative) = (self.start.clone(), self.negative.clone());
                let (ended, uncontrolled) = (Ended::ByFailure, vec![false; x.len()]);
                let last = Finish { t, x, negative, ended, uncontrolled, statistics: self.statistics };
                Err(Failure { cause, last: Box::new(last) })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::integrator::{Dop853, Tolerances};
    use crate::solve::simulation::integrate;
    use nalgebra::SVector;

    /// A mass of 1 kg on a spring of 1 N/m that is pulled with 0.3 N to the middle: by a relay.
    struct Relay;
    impl System<f64, 2, 1> for Relay {
        fn rate(&self, _: f64, x: &SVector<f64, 2>, negative: &[bool; 1], dx: &mut SVector<f64, 2>) {
            *dx = SVector::from([x[1], -x[0] + if negative[0] { 0.3 } else { -0.3 }]);
        }
        fn guards(&self, _: f64, x: &SVector<f64, 2>, _: &[bool; 1], guards: &mut SVector<f64, 1>) {
            guards[0] = x[0];
        }
    }

    fn settings() -> Settings {
        Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() }
    }

    #[test]
    fn pieces_lead_where_one_run_does_and_start_once() {
        let start = SVector::from([1.0, 0.0]);
        let span = Span { t0: 0.0, t_end: 10.0 };
        let whole = integrate(&Relay, &mut Dop853::new(), &start, span, &settings(), &mut ()).unwrap();
        let (mut run, mut method) = (Ongoing::at(0.0, start.as_slice()), Dop853::new());
        let mut ends = Vec::new();
        for k in 1..=1000 {
            run.advance(&Relay, &mut method, f64::from(k) / 100.0, &settings(), &mut ()).unwrap();
            ends.push(run.time());
        }
        assert_eq!((ends[0], ends[999], run.negative()), (0.01, 10.0, whole.negative.as_slice()));
        let reached = DVector::from_column_slice(run.state());
        assert!((&reached - &whole.x).amax() < 1e-8, "{reached} {}", whole.x);
        let (cost, events) = (run.statistics(), whole.statistics.events);
        // At acos(0.3 / 1.3) = 1.338 s, then every 2.676 s.
        assert_eq!((cost.events, events), (4, 4));
        // Two more, since the first step is estimated.
        assert_eq!(cost.steps, 1000 + events + 2);
        // No piece estimates a first step: the next one is as long as the tolerances allow all the time.
        assert!(run.next_step().is_some_and(|step| step > 0.05), "{:?}", run.next_step());
        // DOP853 takes twelve rates a step; a piece that began anew would take two more.
        assert!(cost.rate_evaluations < 13 * cost.steps, "{cost:?}");
    }

    #[test]
    fn what_changes_in_between_is_looked_at() {
        struct Pushed(f64);
        impl System<f64, 1, 1> for Pushed {
            fn rate(&self, _: f64, _: &SVector<f64, 1>, negative: &[bool; 1], dx: &mut SVector<f64, 1>) {
                dx[0] = if negative[0] { -1.0 } else { 1.0 };
            }
            fn guards(&self, _: f64, _: &SVector<f64, 1>, _: &[bool; 1], guards: &mut SVector<f64, 1>) {
                guards[0] = self.0;
            }
        }
        let (mut run, mut method) = (Ongoing::at(0.0, &[0.0]), Dop853::new());
        run.advance(&Pushed(1.0), &mut method, 1.0, &Settings::default(), &mut ()).unwrap();
        run.renew(None);
        run.advance(&Pushed(-1.0), &mut method, 3.0, &Settings::default(), &mut ()).unwrap();
        assert!((run.state()[0] + 1.0).abs() < 1e-12, "{:?}", run.state());
        let failure = run.advance(&Pushed(-1.0), &mut method, 2.0, &Settings::default(), &mut ()).unwrap_err();
        assert_eq!((run.time(), failure.last.t), (3.0, 3.0));
    }
}
