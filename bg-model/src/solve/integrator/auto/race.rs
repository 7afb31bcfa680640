//! A race of explicit methods: which of them gets furthest with its rates.
//!
//! In: the steps of a run. Out: the steps of the method that was ahead in the last race. In a race the methods take turns at making steps of
//! the run; none of these is lost. Races come more seldom the longer the run is. What limits a step, stability or accuracy, does not
//! matter, and nothing is estimated: how far a method gets with its rates is what counts. Steps may become longer or shorter while others
//! run, so there are several rounds, and who takes over has to be ahead in each: who is behind once is out.

use nalgebra::SVector;

use crate::solve::integrator::hand_on::hand_on;
use crate::solve::integrator::{Cfmr7, Dop853, Flow, Method, Nystrom, Point, Scale, StepControl};

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
}

impl Runner {
    const ALL: [Self; 3] = [Self::Dop853, Self::Cfmr7, Self::Nystrom];

    /// The rates of a step.
    const fn rates(self) -> f64 {
        match self {
            Self::Dop853 => 12.0,
            Self::Cfmr7 | Self::Nystrom => 9.0,
        }
    }
}

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
        }
    };
}

/// The explicit methods, one of which makes the steps.
#[derive(Clone, Debug)]
pub(super) struct Race<const N: usize> {
    dop853: Dop853<N>,
    cfmr7: Cfmr7<N>,
    nystrom: Nystrom<N>,
    /// The method that makes the steps, and the one that was ahead.
    runner: Runner,
    ahead: Runner,
    /// By which factor it came further than the one before it.
    lead: f64,
    /// The round of a race, if one is on, how far each method came in each, s a rate, who is still in it, and the restarts during it.
    round: Option<usize>,
    speeds: [[f64; ROUNDS]; 3],
    is_in: [bool; 3],
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
            runner: Runner::Dop853,
            ahead: Runner::Dop853,
            lead: 1.0,
            round: None,
            speeds: [[0.0; ROUNDS]; 3],
            is_in: [false; 3],
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

    /// Passes on where a lap or a rest is over. A method for states of second order takes part where there are some.
    fn turn(&mut self, has_second_order: bool) {
        let Some(round) = self.round else {
            if self.steps >= self.rest {
                (self.round, self.restarts) = (Some(0), 0);
                self.is_in = Runner::ALL.map(|runner| runner != Runner::Nystrom || has_second_order);
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
            self.turn(flow.second_order().is_some());
        }
        self.h = h;
        self.rates += self.runner.rates();
        present!((&mut) self, method => method.attempt(flow, start, h, scale, end))
    }

    fn advance(&mut self) {
        self.is_fresh = true;
        self.steps += 1;
        self.way += self.h;
        present!((&mut) self, method => method.advance());
    }

    /// A lap begins anew: steps find their size. Where that happens too often for a race, there is none.
    fn restart(&mut self) {
        present!((&mut) self, method => method.restart());
        if self.round.is_some() {
            self.restarts += 1;
            if self.restarts > RESTARTS {
                self.is_in = [false; 3];
                self.end();
            } else {
                self.begin(self.runner);
            }
        }
    }
}
