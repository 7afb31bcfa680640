//! The driver: integrates a system over a span of time, step by step.
//!
//! In: a system, a method, the start, the span and the settings. Out: the state at the end, with samples and events
//! told to an observer on the way, or a typed failure with the last good state. Switches change their branch at located
//! instants only ([`crate::system::System`]); a step never runs over such an instant.

mod cause;
mod extremes;
mod history;
#[cfg(feature = "std")]
pub(crate) mod lanes;
mod observer;
mod ongoing;
mod peaks;
mod recording;
mod rounding;
mod run;
mod sampling;
mod settings;
mod sizes;
mod step_size;

use alloc::boxed::Box;
use alloc::vec::Vec;

use nalgebra::{DVector, SVector};

pub use extremes::{Peak, Peaks};
pub use observer::{EachSample, EachStep, Inside, Observer, Switching};
pub use ongoing::Ongoing;
pub use peaks::{PeakMonitor, Watched};
pub use recording::{Column, MissingColumn, Part, Recorder, Recording};
pub use settings::{Samples, Settings, Span};
#[cfg(feature = "std")]
pub(crate) use sizes::sizes_within;
pub use sizes::{raise, sizes, sizes_of};

use crate::model::dynamics::{Dynamics, Typed};
use crate::model::system::{System, switches, values};
use crate::solve::event::{Condition, Located};
pub use crate::solve::failure::NoNumber;
use crate::solve::failure::{Cause, Failure};
pub use crate::solve::finish::{Ended, Finish};
use crate::solve::integrator::{Method, Point, Scale};
use crate::solve::stepper::Stepper;
use run::Run;

/// The state at `span.t_end`, from `start` at `span.t0`, or where the observer ends the run.
///
/// The branches at the start follow from the signs of the guards there; a guard that is exactly zero is decided by its
/// sign a little later. The observer gets the samples and events in the order of time. Nothing is allocated on the way.
///
/// # Errors
/// [`Failure`]: input that cannot be, a number that is not finite, a step or an interval between events that rounding
/// does not allow, or too many steps; with the last good state, which the failing step has not touched.
pub fn integrate<Sys, M, O, const N: usize, const G: usize>(
    system: &Sys,
    method: &mut M,
    start: &SVector<f64, N>,
    span: Span,
    settings: &Settings,
    observer: &mut O,
) -> Result<Finish, Failure>
where
    Sys: System<f64, N, G>,
    M: Method,
    O: Observer,
{
    drive(&Typed::system(system), method, start.as_slice(), span, settings, None, observer)
}

/// As [`integrate`], but the run also ends where `condition` passes through zero, in either direction.
///
/// The condition is a function of time (s), state and branches of the switches, in any unit, smooth inside a step like
/// a guard. It is located like an event: by steps of the method to its zero, not by interpolation, and also where it
/// passes through zero twice in one step. Its side is its sign at `span.t0`. Where it is zero there, to rounding, its
/// sign a little later counts, so a run goes on from where the same condition has ended one. As long as it stays zero
/// it ends nothing; nor does a function that touches zero and turns back, unless that is at an event. Where a switching
/// makes it jump through zero, the run ends there. An event at the instant of the condition is still told, and its
/// branches are those of the finish. The last sample is the state at the end, as at the end of the span.
///
/// ```
/// use bg_model::integrator::{Dop853, Tolerances};
/// use bg_model::nalgebra::SVector;
/// use bg_model::simulation::{Ended, Settings, Span, integrate_until};
/// use bg_model::system::System;
///
/// /// A mass of 1 kg on a spring of 1 N/m: position and velocity.
/// struct Oscillator;
/// impl System<f64, 2, 0> for Oscillator {
///     fn rate(&self, _: f64, x: &SVector<f64, 2>, _: &[bool; 0], dx: &mut SVector<f64, 2>) {
///         *dx = SVector::from([x[1], -x[0]]);
///     }
/// }
///
/// let settings = Settings { tolerances: Tolerances::new(1e-12, 1e-12), ..Settings::default() };
/// let (start, span) = (SVector::from([1.0, 0.0]), Span { t0: 0.0, t_end: 10.0 });
/// let at_half = |_: f64, x: &SVector<f64, 2>, _: &[bool; 0]| x[0] - 0.5;
/// let finish = integrate_until(&Oscillator, &mut Dop853::new(), &start, span, &settings, at_half, &mut ())?;
/// assert_eq!(finish.ended, Ended::ByCondition);
/// assert!((finish.t - std::f64::consts::FRAC_PI_3).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`integrate`], and where the condition is not finite.
pub fn integrate_until<Sys, M, C, O, const N: usize, const G: usize>(
    system: &Sys,
    method: &mut M,
    start: &SVector<f64, N>,
    span: Span,
    settings: &Settings,
    mut condition: C,
    observer: &mut O,
) -> Result<Finish, Failure>
where
    Sys: System<f64, N, G>,
    M: Method,
    C: FnMut(f64, &SVector<f64, N>, &[bool; G]) -> f64,
    O: Observer,
{
    let mut condition = |t: f64, x: &[f64], negative: &[bool]| condition(t, values(x), switches(negative));
    drive(&Typed::system(system), method, start.as_slice(), span, settings, Some(&mut condition), observer)
}

/// As [`integrate`], of a system over slices, whatever the number of its states; with a condition as
/// [`integrate_until`].
///
/// ```
/// use bg_model::dynamics::Dynamics;
/// use bg_model::integrator::Dop853;
/// use bg_model::simulation::{Settings, Span, drive};
/// use std::f64::consts::PI;
///
/// /// Masses of 1 kg in a row between two walls, on springs of 1 N/m: displacements, then velocities.
/// struct Row(usize);
/// impl Dynamics for Row {
///     fn states(&self) -> usize {
///         2 * self.0
///     }
///     fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
///         let (q, v) = x.split_at(self.0);
///         let beside = |i: Option<usize>| i.and_then(|i| q.get(i)).copied().unwrap_or(0.0);
///         for i in 0..self.0 {
///             dx[i] = v[i];
///             dx[self.0 + i] = beside(i.checked_sub(1)) - 2.0 * q[i] + beside(Some(i + 1));
///         }
///     }
/// }
///
/// for masses in [1, 2, 20] {
///     // The slowest mode, at 2 sin(pi / (2 n + 2)) rad/s.
///     let wave = |i: usize| if i < masses { (PI * (i + 1) as f64 / (masses + 1) as f64).sin() } else { 0.0 };
///     let start: Vec<f64> = (0..2 * masses).map(wave).collect();
///     let span = Span { t0: 0.0, t_end: 3.0 };
///     let finish = drive(&Row(masses), &mut Dop853::new(), &start, span, &Settings::default(), None, &mut ())?;
///     let turned = 2.0 * (0.5 * PI / (masses + 1) as f64).sin() * finish.t;
///     assert!((finish.x[0] - start[0] * turned.cos()).abs() < 1e-7);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As there.
pub fn drive<'a>(
    system: &'a dyn Dynamics,
    method: &'a mut dyn Method,
    start: &[f64],
    span: Span,
    settings: &'a Settings,
    condition: Option<&'a mut Condition<'a>>,
    observer: &mut dyn Observer,
) -> Result<Finish, Failure> {
    make(system, method, &Beginning::at(DVector::from_column_slice(start)), span, settings, condition, observer)
}

/// What is known of a state that a run starts from.
#[derive(Clone, Debug)]
pub struct Beginning {
    /// The state.
    pub x: DVector<f64>,
    /// How large each state has been in the runs that led here: errors are measured by that.
    pub largest: DVector<f64>,
    /// The branches of the switches, where they are known.
    pub negative: Option<Vec<bool>>,
}

impl Beginning {
    /// A state that nothing has led to.
    pub(crate) fn at(x: DVector<f64>) -> Self {
        let largest = x.abs();
        Self { x, largest, negative: None }
    }
}

/// Makes a run that `condition` may end.
pub(crate) fn make<'a>(
    system: &'a dyn Dynamics,
    method: &'a mut dyn Method,
    Beginning { x: start, largest, negative }: &Beginning,
    span: Span,
    settings: &'a Settings,
    condition: Option<&'a mut Condition<'a>>,
    observer: &mut dyn Observer,
) -> Result<Finish, Failure> {
    let control = method.control();
    let needs_series = method.needs_series().then(|| method.name());
    settings::check_fit(system, span.t0, start)?;
    let scale = Scale::new(&settings.tolerances, system.states());
    let stepper = Stepper::new(system, method, scale, Point::at(span.t0, start.clone()));
    let mut run = Run::new(stepper, condition.map(Located::new), control, span, settings);
    run.sizes.remember(&run.stepper, largest);
    let outcome = settings::check(system, control, start.as_slice(), span, settings)
        .and_then(|()| settings::check_series(system, needs_series))
        .map_err(Cause::from)
        .and_then(|()| run.begin(control, settings, negative.as_deref()))
        .and_then(|()| run.advance_to_end(observer));
    match outcome {
        Ok(ended) => Ok(run.finish(ended)),
        Err(cause) => Err(Failure { cause, last: Box::new(run.finish(Ended::ByFailure)) }),
    }
}
