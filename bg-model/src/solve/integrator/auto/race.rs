//! A race of explicit methods: which of them gets furthest with its rates.
//!
//! In: the steps of a run. Out: the steps of the method that was ahead in the last race. In a race the methods take
//! turns at making steps of the run; none of these is lost. Races come more seldom the longer the run is. What limits a
//! step, stability or accuracy, does not matter, and nothing is estimated: how far a method gets with its rates is what
//! counts. Steps may become longer or shorter while others run, so there are several rounds, and who takes over has to
//! be ahead in each: who is behind once is out. Only who has promised to be ahead where a step of it was tried since
//! the last race takes part, so many rests end without a race.

use alloc::vec::Vec;

use super::{MANY, price};
use crate::solve::integrator::hand_on::hand_on;
use crate::solve::integrator::{
    Cfmr7, Dop853, Flow, Integrator, Method, Nystrom, PointRef, Scale, StepControl, Taylor, is_finite,
};

/// Accepted steps before the first race, and the most between two races.
const REST: [u32; 2] = [16, 8192];
/// After a change a rest is so many times shorter than the last one, so that one by mistake does not last.
const SOONER: u32 = 4;
/// Steps at the beginning of a lap or a rest that do not count: they find their size. Then those of a lap that do.
const BEGINNING: u32 = 8;
const LAP: u32 = 16;
/// The steps after a restart that do not count.
const AFTER: u32 = 1;
/// The attempts by which an event is located. Of a series, which serves all of them, each has one rate.
const LOCATING: f64 = 3.0;
/// The rounds of a race.
const ROUNDS: usize = 3;
/// What is left of a step's weight after each further one, where the speed at a place is asked for.
const FADING: f64 = 0.75;
/// A race with more restarts than this is given up.
const RESTARTS: u32 = 32;
/// Another method has to be ahead by this factor, so that the choice does not swing.
const AHEAD: f64 = 1.05;
/// How often in a rest one looks at the other methods, and by which factor one has to promise to be ahead: a step at
/// the limit of the tolerances is a quarter longer than those that a run makes. The series, whose price is estimated,
/// has to promise more.
const LOOKS: u32 = 2;
const PROMISE: f64 = 1.1;
const PROMISE_OF_SERIES: f64 = 1.3;
/// The part of their errors that counts for Nystrom and the series: at the same tolerance runs by them err by a
/// thirtieth of those by DOP853, over 24 models, and in nine of ten hardly by more (`docs/benchmarks/errors.md`). So
/// who is ahead errs like the others.
const COUNTED: f64 = 0.2;
/// A method whose step errs by so many times what is allowed is not looked at again in this rest.
const FAR_OFF: f64 = 100.0;
/// The smallest relative tolerance at which CFMR7osc begins where there are few states: its steps are the cheapest, and
/// runs may be over before the first race. Of many states an implicit method may take over, which DOP853 confirms
/// sooner.
const LOOSE: f64 = 5e-6;

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

    /// The method of this name; none where it is none of them.
    const fn of(method: Integrator) -> Option<Self> {
        match method {
            Integrator::Dop853 => Some(Self::Dop853),
            Integrator::Cfmr7 => Some(Self::Cfmr7),
            Integrator::Nystrom => Some(Self::Nystrom),
            Integrator::Taylor => Some(Self::Taylor),
            _ => None,
        }
    }
}

/// What the looks of a rest have shown of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Promise {
    /// It would not get further.
    None,
    /// It would by far not.
    FarOff,
    /// It would.
    Given,
}

impl Promise {
    /// Of a step with this error, in parts of the tolerances.
    fn of(error: f64) -> Self {
        match error {
            _ if error <= 1.0 => Self::Given,
            _ if error <= FAR_OFF => Self::None,
            _ => Self::FarOff,
        }
    }
}

/// The number of methods.
const RUNNERS: usize = 4;
/// The rates of a step of DOP853, and those of CFMR7osc and Nystrom.
pub(super) const STEP: f64 = 12.0;
const SHORTER_STEP: f64 = 9.0;

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

/// Some steps: how many, how far they came, s, and their rates.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    steps: u32,
    way: f64,
    rates: f64,
}

impl Stretch {
    /// These and others.
    fn with(self, others: Self) -> Self {
        let Self { steps, way, rates } = others;
        Self { steps: self.steps + steps, way: self.way + way, rates: self.rates + rates }
    }

    /// These but for some of them.
    fn without(self, some: Self) -> Self {
        let Self { steps, way, rates } = some;
        Self { steps: self.steps - steps, way: self.way - way, rates: self.rates - rates }
    }

    /// These with less weight.
    fn faded(self) -> Self {
        Self { way: FADING * self.way, rates: FADING * self.rates, ..self }
    }
}

/// The explicit methods, one of which makes the steps.
#[derive(Clone, Debug)]
pub(super) struct Race {
    dop853: Dop853,
    cfmr7: Cfmr7,
    nystrom: Nystrom,
    taylor: Taylor,
    /// Where a step leads that is tried only.
    end: Vec<f64>,
    /// What a rate with second derivatives costs and a step of the Taylor series, in rates; none where they take no
    /// part.
    forces: Option<f64>,
    series: Option<f64>,
    /// What an accepted step costs beside.
    held: f64,
    /// What made most of the steps of a run before.
    hint: Option<Integrator>,
    /// Whether the first method has been chosen.
    has_begun: bool,
    /// The looks in this rest, and who has promised to be ahead in one of them.
    looks: u32,
    promises: [Promise; RUNNERS],
    /// The method that makes the steps, and the one that was ahead.
    runner: Runner,
    ahead: Runner,
    /// By which factor it came further than the one before it.
    lead: f64,
    /// The round of a race, if one is on, how far each method came in each, s a rate, who is still in it, and the
    /// restarts during it.
    round: Option<usize>,
    speeds: [[f64; ROUNDS]; RUNNERS],
    is_in: [bool; RUNNERS],
    restarts: u32,
    /// Whether the next attempt is the first after an accepted step.
    is_fresh: bool,
    /// Accepted steps of this lap or rest.
    steps: u32,
    /// Those of them that count, how far they came, s, and their rates; the same of the last step, and the steps to
    /// come that do not count.
    counted: Stretch,
    last: Stretch,
    /// The last of them, with weights that fade.
    recent: Stretch,
    skipped: u32,
    /// The rates of the attempts since the last accepted step.
    pending: f64,
    /// How far the run has come, s, with how many events, and whether a step has been accepted since the last one.
    way: f64,
    events: u32,
    is_under_way: bool,
    /// The accepted steps until the next race.
    rest: u32,
    /// The step under way, s.
    h: f64,
}

impl Race {
    /// DOP853 begins, or at loose tolerances CFMR7osc.
    pub fn new() -> Self {
        Self {
            dop853: Dop853::new(),
            cfmr7: Cfmr7::new(),
            nystrom: Nystrom::with_errors_counted(COUNTED),
            taylor: Taylor::with_errors_counted(COUNTED),
            end: Vec::new(),
            forces: None,
            series: None,
            held: 0.0,
            hint: None,
            has_begun: false,
            looks: 0,
            promises: [Promise::None; RUNNERS],
            runner: Runner::Dop853,
            ahead: Runner::Dop853,
            lead: 1.0,
            round: None,
            speeds: [[0.0; ROUNDS]; RUNNERS],
            is_in: [false; RUNNERS],
            restarts: 0,
            is_fresh: false,
            steps: 0,
            counted: Stretch::default(),
            last: Stretch::default(),
            recent: Stretch::default(),
            skipped: BEGINNING,
            pending: 0.0,
            way: 0.0,
            events: 0,
            is_under_way: false,
            rest: REST[0],
            h: 0.0,
        }
    }

    /// Whether the method of this name is one of these.
    pub const fn runs(method: Integrator) -> bool {
        Runner::of(method).is_some()
    }

    /// The method of this name begins, if it is one of these and the system has what it needs; there is no race for as
    /// long as possible.
    pub fn beginning_with(hint: Option<Integrator>) -> Self {
        let race = Self { hint, ..Self::new() };
        match hint.and_then(Runner::of) {
            Some(runner) => Self { runner, ahead: runner, rest: REST[1], ..race },
            None => race,
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

    /// What a step of the present method costs, in steps of DOP853.
    pub fn dearness(&self) -> f64 {
        let [attempt, accepted] = self.rates();
        (attempt + accepted) / (STEP + self.held)
    }

    /// What a step of a method costs, in rates; none where it cannot take part.
    fn price(&self, runner: Runner, flow: &Flow<'_>, scale: &Scale) -> Option<f64> {
        let of_series = || (runner == Runner::Taylor).then(|| price::of_step(flow, scale.relative / COUNTED)).flatten();
        self.of_attempt(runner).or_else(of_series).map(|price| price + self.held)
    }

    /// The rates of an attempt; none where it cannot take part, and of the series, of which one serves all attempts at
    /// a step.
    fn of_attempt(&self, runner: Runner) -> Option<f64> {
        match runner {
            Runner::Dop853 => Some(STEP),
            Runner::Cfmr7 => Some(SHORTER_STEP),
            Runner::Nystrom => self.forces.map(|rate| rate * SHORTER_STEP),
            Runner::Taylor => None,
        }
    }

    /// The rates of an attempt of the present method, and those of an accepted step beside.
    fn rates(&self) -> [f64; 2] {
        match self.of_attempt(self.runner) {
            Some(rates) => [rates, self.held],
            None => [0.0, self.series.unwrap_or(f64::INFINITY)],
        }
    }

    /// How far the present method comes with each rate, s, by these steps, the share of events in the whole run
    /// included.
    fn speed(&self, Stretch { way, rates, .. }: Stretch) -> f64 {
        way / (rates + way * self.of_events(self.runner))
    }

    /// The rates that this method needs to locate the events of a second, of which there were as many in the run so
    /// far.
    fn of_events(&self, runner: Runner) -> f64 {
        if self.events == 0 {
            0.0
        } else {
            LOCATING * self.of_attempt(runner).unwrap_or(1.0) * f64::from(self.events) / self.way
        }
    }

    /// Passes on where a lap or a rest is over. Who has promised to be ahead takes part.
    fn turn(&mut self, flow: &Flow<'_>, start: PointRef<'_>, scale: &Scale) {
        let Some(round) = self.round else {
            self.look(flow, start, scale);
            if self.steps >= self.rest {
                self.is_in = self.promises.map(|promise| promise == Promise::Given);
                self.is_in[self.ahead as usize] = true;
                if self.looks == LOOKS && self.is_in.iter().filter(|is_in| **is_in).count() > 1 {
                    (self.round, self.restarts) = (Some(0), 0);
                    self.begin(self.ahead);
                } else {
                    self.end();
                }
            }
            return;
        };
        if self.counted.steps < LAP {
            return;
        }
        let (runner, ahead) = (self.runner as usize, self.ahead as usize);
        self.speeds[runner][round] = self.speed(self.counted);
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

    /// Looks several times in a rest whether a step of another method from `start` would get further with its price
    /// than the last steps did with their rates. Who does so once takes part in the race.
    fn look(&mut self, flow: &Flow<'_>, start: PointRef<'_>, scale: &Scale) {
        let next = BEGINNING + (self.looks + 1) * (self.rest - BEGINNING) / LOOKS;
        if self.looks == LOOKS || self.steps < next || self.counted.steps == 0 {
            return;
        }
        self.looks += 1;
        for runner in Runner::ALL {
            if runner == self.ahead || self.promises[runner as usize] != Promise::None {
                continue;
            }
            // What the present method needs for a second, less the share of events: none is left for the steps of one
            // that they cost more.
            let rates = 1.0 / self.speed(self.recent) - self.of_events(runner);
            if rates > 0.0
                && let Some(price) = self.price(runner, flow, scale)
            {
                let error = self.error(runner, flow, start, price / rates, scale);
                self.promises[runner as usize] = Promise::of(error);
            }
        }
    }

    /// The error of a step of this method, in parts of the tolerances, that is longer than `h` (s) by what it has to
    /// promise; infinite where its end is not finite.
    fn error(&mut self, runner: Runner, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> f64 {
        if runner == Runner::Taylor {
            self.series = self.price(runner, flow, scale);
            return self.taylor.error(flow, start, PROMISE_OF_SERIES * h, scale, &mut self.end);
        }
        let mut end = core::mem::take(&mut self.end);
        end.copy_from_slice(start.x);
        let present = core::mem::replace(&mut self.runner, runner);
        let error = present!((&mut) self, method => {
            method.restart();
            let error = method.attempt(flow, start, PROMISE * h, scale, &mut end);
            method.restart();
            error
        });
        self.runner = present;
        let is_met = is_finite(&end);
        self.end = end;
        if is_met { error } else { f64::INFINITY }
    }

    /// Before the first attempt: prices, and who makes it.
    fn prepare(&mut self, flow: &Flow<'_>, scale: &Scale) {
        self.forces = price::of_forces(flow);
        self.held = if flow.is_held() { price::HELD } else { 0.0 };
        if let Some(runner) = self.hint.and_then(Runner::of)
            && let Some(price) = self.price(runner, flow, scale)
        {
            self.series = (runner == Runner::Taylor).then_some(price);
            return;
        }
        self.rest = REST[0];
        let begins_loosely = scale.relative >= LOOSE && flow.states() < MANY;
        self.ahead = if begins_loosely { Runner::Cfmr7 } else { Runner::Dop853 };
        self.begin(self.ahead);
    }

    /// A lap or a rest of this method begins.
    fn begin(&mut self, runner: Runner) {
        if runner != self.runner {
            self.runner = runner;
            present!((&mut) self, method => method.restart());
        }
        (self.steps, self.skipped, self.pending) = (0, BEGINNING, 0.0);
        (self.counted, self.last, self.recent) = (Stretch::default(), Stretch::default(), Stretch::default());
    }

    /// The race is over.
    fn end(&mut self) {
        let sum = |runner: Runner| self.speeds[runner as usize].iter().sum::<f64>();
        let others = Runner::ALL.into_iter().filter(|runner| *runner != self.ahead && self.is_in[*runner as usize]);
        let best = others.reduce(|best, next| if sum(next) > sum(best) { next } else { best });
        if self.round.is_some()
            && let Some(best) = best.filter(|best| sum(*best) > AHEAD * sum(self.ahead))
        {
            self.lead = sum(best) / sum(self.ahead);
            self.ahead = best;
            self.rest = (self.rest / SOONER).max(REST[0]);
        } else {
            self.rest = (2 * self.rest).min(REST[1]);
        }
        self.round = None;
        (self.looks, self.promises) = (0, [Promise::None; RUNNERS]);
        self.begin(self.ahead);
    }
}

impl Method for Race {
    hand_on!(present);

    fn fit(&mut self, states: usize) {
        if self.end.len() == states {
            return;
        }
        *self = Self::beginning_with(self.hint);
        self.dop853.fit(states);
        self.cfmr7.fit(states);
        self.nystrom.fit(states);
        self.taylor.fit(states);
        self.end.resize(states, 0.0);
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if !core::mem::replace(&mut self.has_begun, true) {
            self.prepare(flow, scale);
        }
        if core::mem::take(&mut self.is_fresh) {
            self.turn(flow, start, scale);
        }
        self.h = h;
        self.pending += self.rates()[0];
        present!((&mut) self, method => method.attempt(flow, start, h, scale, end))
    }

    fn advance(&mut self) {
        (self.is_fresh, self.is_under_way) = (true, true);
        self.steps += 1;
        self.way += self.h;
        let rates = core::mem::take(&mut self.pending) + self.rates()[1];
        self.last = Stretch::default();
        if self.skipped == 0 {
            self.last = Stretch { steps: 1, way: self.h, rates };
        }
        self.skipped = self.skipped.saturating_sub(1);
        self.counted = self.counted.with(self.last);
        self.recent = self.recent.faded().with(self.last);
        present!((&mut) self, method => method.advance());
    }

    /// The steps around an event do not count: it has cut the last one, and been located by attempts at it; these count
    /// by what is usual. Where that happens too often for a race, there is none.
    fn restart(&mut self) {
        present!((&mut) self, method => method.restart());
        self.events += u32::from(core::mem::take(&mut self.is_under_way));
        let last = core::mem::take(&mut self.last);
        self.counted = self.counted.without(last);
        self.recent = self.recent.without(last);
        self.pending = 0.0;
        self.skipped = self.skipped.max(AFTER);
        if self.round.is_some() {
            self.restarts += 1;
            if self.restarts > RESTARTS {
                self.is_in = [false; RUNNERS];
                self.end();
            }
        }
    }
}
