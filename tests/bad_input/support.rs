//! A trial: a run that cannot end well, and what is expected of it.

use bg_model::failure::Cause;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::statistics::Statistics;
use bg_model::system::System;
use bond_graph_tests::hardcases::integrators_of_rates;
use bond_graph_tests::switching::flow::Flow;

/// The most attempted steps of a trial.
pub const LIMIT: u64 = 3000;

/// What a run gave.
pub struct Outcome {
    pub cause: Option<Cause>,
    pub t: f64,
    pub x: Vec<f64>,
    pub statistics: Statistics,
}

/// What is expected of a trial.
#[derive(Clone, Copy)]
pub enum Expected {
    /// Refused before the first rate.
    Refused,
    /// Refused where the step is fixed, or where it is not; else as usual.
    RefusedIf { has_fixed_step: bool },
    /// Comes to the end with this first state, to a part of 1e-3, if it is large.
    Ends(f64),
    /// Does, or stops with an error.
    EndsOrStops(f64),
    /// Stops with an error, its last good state within the given distance of this time, s, a fixed step before it at
    /// most.
    StopsAt(f64, f64),
    /// The same with error control; else stops or comes to the end, since a fixed step may step over it.
    StopsAtUnlessFixed(f64, f64),
    /// Stops with an error or comes to the end.
    Either,
}

type Runner = Box<dyn Fn(Integrator) -> Outcome>;

/// A run by any integrator.
pub struct Trial {
    pub name: String,
    pub expected: Expected,
    span: [f64; 2],
    step: f64,
    run: Runner,
}

/// A system of `N` states, and what is asked of its run.
#[derive(Clone)]
pub struct Request<const N: usize> {
    pub start: [f64; N],
    pub span: [f64; 2],
    pub settings: Settings,
    pub step: f64,
}

impl Default for Request<2> {
    fn default() -> Self {
        let settings = Settings { tolerances: Tolerances::new(1e-6, 1e-9), step_limit: LIMIT, ..Settings::default() };
        Self { start: [1.0, 0.0], span: [0.0, 1.0], settings, step: 0.01 }
    }
}

impl Trial {
    pub fn new<Sys, const N: usize, const G: usize>(
        name: impl Into<String>,
        expected: Expected,
        system: Sys,
        request: Request<N>,
    ) -> Self
    where
        Sys: System<f64, N, G> + 'static,
    {
        let (span, step) = (request.span, request.step);
        let run = move |integrator: Integrator| {
            let mut method: AnyMethod = integrator.method(request.step);
            let (start, [t0, t_end]) = (SVector::from(request.start), request.span);
            let outcome = integrate(&system, &mut method, &start, Span { t0, t_end }, &request.settings, &mut ());
            let (last, cause) = match outcome {
                Ok(finish) => (finish, None),
                Err(failure) => (*failure.last, Some(failure.cause)),
            };
            Outcome { cause, t: last.t, x: last.x.as_slice().to_vec(), statistics: last.statistics }
        };
        Self { name: name.into(), expected, span, step, run: Box::new(run) }
    }

    /// Holds every integrator to what is expected.
    pub fn check(&self) {
        for integrator in integrators_of_rates() {
            let name = format!("{} by {}", self.name, integrator.name());
            let outcome = (self.run)(integrator);
            self.check_last(&name, &outcome);
            match self.expected {
                Expected::Refused => refused(&name, &outcome),
                Expected::RefusedIf { has_fixed_step } if integrator.has_fixed_step() == has_fixed_step => {
                    refused(&name, &outcome);
                }
                Expected::StopsAtUnlessFixed(..) if integrator.has_fixed_step() => {}
                Expected::RefusedIf { .. } | Expected::Either => {}
                Expected::EndsOrStops(_) if outcome.cause.is_some() => {}
                Expected::Ends(value) | Expected::EndsOrStops(value) => {
                    assert_eq!(outcome.cause, None, "{name}");
                    let size = value.abs().max(1.0);
                    assert!((outcome.x[0] - value).abs() <= 1e-3 * size, "{name}: {}", outcome.x[0]);
                }
                Expected::StopsAt(t, within) | Expected::StopsAtUnlessFixed(t, within) => {
                    assert!(outcome.cause.is_some(), "{name}");
                    let within = if integrator.has_fixed_step() { 1.01 * self.step } else { within };
                    assert!((outcome.t - t).abs() <= within, "{name}: {} for {t}", outcome.t);
                }
            }
        }
    }

    /// The last good point is one.
    fn check_last(&self, name: &str, outcome: &Outcome) {
        let Outcome { cause, t, x, statistics } = outcome;
        assert!(statistics.steps + statistics.rejected <= LIMIT, "{name}: {statistics}");
        if !matches!(cause, Some(Cause::BadInput(_))) {
            assert!(x.iter().all(|x| x.is_finite()), "{name}: {x:?}");
            assert!(self.span[0] <= *t && *t <= self.span[1], "{name}: {t}");
            assert!(cause.is_some() || *t == self.span[1], "{name}: {t}");
        }
    }

    /// The messages, each with the integrators that give it, in the order in which they came.
    pub fn messages(&self) -> Vec<(String, Vec<&'static str>)> {
        let mut messages: Vec<(String, Vec<&'static str>)> = Vec::new();
        for integrator in integrators_of_rates() {
            let cause = (self.run)(integrator).cause;
            let message = match cause {
                None => "ends".to_owned(),
                Some(cause @ Cause::BadInput(_)) => cause.to_string(),
                Some(cause) => rounded(&cause.to_string()),
            };
            match messages.iter_mut().find(|(known, _)| *known == message) {
                Some((_, names)) => names.push(integrator.name()),
                None => messages.push((message, vec![integrator.name()])),
            }
        }
        messages
    }
}

fn refused(name: &str, outcome: &Outcome) {
    assert!(matches!(outcome.cause, Some(Cause::BadInput(_))), "{name}: {:?}", outcome.cause);
    assert_eq!(outcome.statistics.rate_evaluations, 0, "{name}");
}

/// A message whose numbers are rounded to what does not hang on the integrator's last bits.
fn rounded(message: &str) -> String {
    let shown = |word: &str| match word.parse::<f64>() {
        Ok(value) if value.fract() == 0.0 && value.abs() < 1e6 => word.to_owned(),
        Ok(value) if value.is_finite() && value.abs() < 5e-3 => "(small)".to_owned(),
        Ok(value) if value.is_finite() && value.abs() > 1e9 => "(large)".to_owned(),
        Ok(value) if value.is_finite() && value.abs() < 0.1 => format!("{value:.0e}"),
        Ok(value) if value.is_finite() => format!("{value:.1}"),
        _ => word.to_owned(),
    };
    message.split(' ').map(shown).collect::<Vec<_>>().join(" ")
}

/// The names of the two states.
pub const NAMES: [&str; 2] = ["tank.level", "tank.flow"];

/// Two states without switches.
pub fn smooth(rate: impl Fn(f64, &[f64; 2]) -> [f64; 2] + 'static) -> Flow<2, 0> {
    Flow::new(NAMES, [], move |t, x, _| rate(t, x))
}

/// x'' = -x.
pub fn oscillator() -> Flow<2, 0> {
    smooth(|_, x| [x[1], -x[0]])
}
