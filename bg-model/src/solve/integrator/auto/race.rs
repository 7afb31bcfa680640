//! A race of explicit methods: which of them gets furthest with its rates.
//!
//! In: the steps of a run. Out: the steps of the method that was ahead in the last race. In a race the methods take turns at making steps of
//! the run; none of these is lost. Races come more seldom the longer the run is. What limits a step, stability or accuracy, does not
//! matter, and nothing is estimated: how far a method gets with its rates is what counts. Steps may become longer or shorter while others
//! run, so there are several rounds, and who takes over has to be ahead in each: who is behind once is out. The Taylor series, whose
//! steps are the dearest, takes part where it has promised to be ahead each time that it was tried since the last race.

use nalgebra::SVector;

use super::price;
use crate::solve::integrator::hand_on::hand_on;
use crate::solve::integrator::{Cfmr7, Dop853, Flow, Method, Nystrom, Point, Scale, StepControl, Taylor};

/// Accepted steps before the first race, and the most between two races.
const REST: [u32; 2] = [128, 8192];
/// Accepted steps of a lap, and those at its beginning that do not count: steps find their size.
const LAP: u32 = 24;
const BEGINNING: u32 = 8;
/// The rounds of a race.
const ROUNDS: usize = 3;
/// A race with more restarts than this is given up.
const RESTARTS: u32 = 8;
/// Another method has to be ahead by this factor, so that the choice does not swing.
const AHEAD: f64 = 1.05;

/// The methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Runner {
    Dop853,
    Cfmr7,
    Nystrom,
    Taylor,
}

impl Runner {
    const ALL: [Self; RUNNERS] = [Self::Dop853, Self::Cfmr7, Self::Nystrom, Self::Taylor];
}

/// How often in a rest one looks at the Taylor series, and by which factor it has to promise to be ahead each time: a step at the limit of
/// the tolerances is a quarter longer than those that a run makes.
const LOOKS: u32 = 4;
const PROMISE: f64 = 1.5;
/// The number of methods.
const RUNNERS: usize = 4;
/// The rates of a step of DOP853.
pub(super) const STEP: f64 = 12.0;

/// Calls the method that makes the steps, borrowed as `$borrow`.
macro_rules! present {
    (($($borrow:tt)+) $race:expr, $method:ident => $then:expr) => {
        match $race.runner {
            Runner::Dop853 => {
                let $method = $($borrow)+ $race.dop853;
                $then
            }
            Runner::Cfmr7 => {
                let $method = $($borrow)+ $race.cfmr7;
                $then
            }
            Runner::Nystrom => {
                let $method = $($borrow)+ $race.nystrom;
                $then
            }
            Runner::Taylor => {
                let $method = $($borrow)+ $race.taylor;
                $then
            }
        }
    };
}

/// The explicit methods, one of which makes the steps.
#[derive(Clone, Debug)]
pub(super) struct Race<const N: usize> {
    dop853: Dop853<N>,
    cfmr7: Cfmr7<N>,
    nystrom: Nystrom<N>,
    taylor: Taylor<N>,
    /// What a step of the Taylor series costs, in rates; none where it takes no part.
    series: Option<f64>,
    /// How often in a row it has promised to be ahead, in this rest.
    promises: u32,
    /// The method that makes the steps, and the one that was ahead.
    runner: Runner,
    ahead: Runner,
    /// By which factor it came further than the one before it.
    lead: f64,
    /// The round of a race, if one is on, how far each method came in each, s a rate, who is still in it, and the restarts during it.
    round: Option<usize>,
    speeds: [[f64; ROUNDS]; RUNNERS],
    is_in: [bool; RUNNERS],
    restarts: u32,
    /// Whether the next attempt is the first after an accepted step.
    is_fresh: bool,
    /// Accepted steps of this lap or rest; how far they came since its beginning, s, and their rates.
    steps: u32,
    way: f64,
    rates: f64,
    /// The accepted steps until the next race.
    rest: u32,
    /// The step under way, s.
    h: f64,
}

impl<const N: usize> Race<N> {
    /// DOP853 begins.
    pub fn new() -> Self {
        Self {
            dop853: Dop853::new(),
            cfmr7: Cfmr7::new(),
            nystrom: Nystrom::new(),
            taylor: Taylor::new(),
            series: None,
            promises: 0,
            runner: Runner::Dop853,
            ahead: Runner::Dop853,
            lead: 1.0,
            round: None,
            speeds: [[0.0; ROUNDS]; RUNNERS],
            is_in: [false; RUNNERS],
            restarts: 0,
            is_fresh: false,
            steps: 0,
            way: 0.0,
            rates: 0.0,
            rest: REST[0],
            h: 0.0,
        }
    }

    /// The method that was ahead, where no race is on.
    pub fn ahead(&self) -> Option<&'static str> {
        self.round.is_none().then(|| self.name())
    }

    /// By which factor the method that was ahead came further with its rates than the one before it; above 1.
    pub const fn lead(&self) -> f64 {
        self.lead
    }

    /// What a step of the present method costs, in steps of DOP853 where that is known to differ much.
    pub fn dearness(&self) -> f64 {
        self.series.filter(|_| self.runner == Runner::Taylor).map_or(1.0, |rates| rates / STEP)
    }

    /// The rates of a step of the present method.
    fn rates(&self) -> f64 {
        match self.runner {
            Runner::Dop853 => STEP,
            Runner::Cfmr7 | Runner::Nystrom => 9.0,
            Runner::Taylor => self.series.unwrap_or(f64::INFINITY),
        }
    }

    /// Passes on where a lap or a rest is over. A method for states of second order takes part where there are some, and the Taylor
    /// series where it promises to be ahead.
    fn turn(&mut self, flow: &impl Flow<N>, start: &Point<N>, scale: &Scale<N>) {
        let Some(round) = self.round else {
            self.look_at_series(flow, start, scale);
            if self.steps >= self.rest {
                (self.round, self.restarts) = (Some(0), 0);
                self.is_in = Runner::ALL.map(|runner| match runner {
                    Runner::Dop853 | Runner::Cfmr7 => true,
                    Runner::Nystrom => flow.second_order().is_some(),
                    Runner::Taylor => self.promises == LOOKS,
                });
                self.begin(self.ahead);
            }
            return;
        };
        if self.steps == BEGINNING {
            (self.way, self.rates) = (0.0, 0.0);
        }
        if self.steps < LAP {
            return;
        }
        let (runner, ahead) = (self.runner as usize, self.ahead as usize);
        self.speeds[runner][round] = self.way / self.rates;
        self.is_in[runner] &= runner == ahead || self.speeds[runner][round] > self.speeds[ahead][round];
        // The one that was ahead begins each round.
        let is_next = |next: &Runner| *next != self.ahead && (runner == ahead || *next as usize > runner);
        let is_another = |next: &Runner| *next != self.ahead && self.is_in[*next as usize];
        match Runner::ALL.into_iter().find(|next| is_next(next) && is_another(next)) {
            Some(next) => self.begin(next),
            None if round + 1 < ROUNDS && Runner::ALL.iter().any(is_another) => {
                self.round = Some(round + 1);
                self.begin(self.ahead);
            }
            None => self.end(),
        }
    }

    /// Looks several times in a rest whether a step of the Taylor series from `start` would get further with its price than the
    /// steps since the last race did with their rates. Who breaks its promise once is not looked at again in this rest.
    fn look_at_series(&mut self, flow: &impl Flow<N>, start: &Point<N>, scale: &Scale<N>) {
        if self.promises == LOOKS || self.steps != (self.promises + 1) * self.rest / LOOKS {
            return;
        }
        self.series = price::of_step(flow, scale.relative);
        let Some(price) = self.series else { return };
        let h = PROMISE * price * self.way / self.rates;
        if self.ahead == Runner::Taylor || self.taylor.reaches(flow, start, h, scale) {
            self.promises += 1;
        }
    }

    /// A lap or a rest of this method begins.
    fn begin(&mut self, runner: Runner) {
        if runner != self.runner {
            self.runner = runner;
            present!((&mut) self, method => method.restart());
        }
        (self.steps, self.way, self.rates) = (0, 0.0, 0.0);
    }

    /// The race is over.
    fn end(&mut self) {
        let sum = |runner: Runner| self.speeds[runner as usize].iter().sum::<f64>();
        let others = Runner::ALL.into_iter().filter(|runner| *runner != self.ahead && self.is_in[*runner as usize]);
        let best = others.reduce(|best, next| if sum(next) > sum(best) { next } else { best });
        if let Some(best) = best.filter(|best| sum(*best) > AHEAD * sum(self.ahead)) {
            self.lead = sum(best) / sum(self.ahead);
            self.ahead = best;
        }
        self.round = None;
        self.rest = (2 * self.rest).min(REST[1]);
        self.promises = 0;
        self.begin(self.ahead);
    }
}

impl<const N: usize> Method<N> for Race<N> {
    hand_on!(present);

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        if core::mem::take(&mut self.is_fresh) {
            self.turn(flow, start, scale);
        }
        self.h = h;
        // One series serves all attempts from its start.
        if self.runner != Runner::Taylor {
            self.rates += self.rates();
        }
        present!((&mut) self, method => method.attempt(flow, start, h, scale, end))
    }

    fn advance(&mut self) {
        self.is_fresh = true;
        self.steps += 1;
        self.way += self.h;
        if self.runner == Runner::Taylor {
            self.rates += self.rates();
        }
        present!((&mut) self, method => method.advance());
    }

    /// A lap begins anew: steps find their size. Where that happens too often for a race, there is none.
    fn restart(&mut self) {
        present!((&mut) self, method => method.restart());
        if self.round.is_some() {
            self.restarts += 1;
            if self.restarts > RESTARTS {
                self.is_in = [false; RUNNERS];
                self.end();
            } else {
                self.begin(self.runner);
            }
        }
    }
}
