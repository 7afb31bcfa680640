//! Choice between explicit, partly implicit and implicit steps while a run is under way.
//!
//! In: a method of each kind. Out: their steps. Now and then, more seldom the longer the answer stays the same, another
//! method is tried from the same start. A more implicit one takes over where one step meets the tolerances that is so
//! much longer that it is worth its cost, where the steps of the present one then arrive at the same state, and where
//! it is not rounding that keeps those short; or where it goes on and the present one does not. A less implicit one
//! takes over where several of its steps in succession meet the tolerances. Stiffness is thus measured by what it does
//! to the steps, not guessed from eigenvalues, and oscillations that have to be followed anyway do not count as such.

mod change;
mod price;
mod race;

use alloc::vec::Vec;

pub use self::change::{Change, Reason};
use self::race::Race;
use super::hand_on::hand_on;
use super::{Ark5, Flow, Integrator, Method, PointRef, Radau9, Scale, StepControl, is_finite, rounding};

/// Steps before the first trial, and the most between two trials.
const WAIT: [u32; 2] = [16, 4096];
/// Steps that all fall below this part of the one at the last trial call for a trial before its time.
const FALL: f64 = 0.1;
/// The accepted steps by which the present one is judged: events, samples and rejections shorten single ones.
const RECENT: usize = 16;
/// A step below this part of their median is no measure: it only looks for a guard's sign, or an event or the end of
/// the run has cut it.
const CUT: f64 = 0.5;
/// The largest difference between the long step and the short ones, in parts of the tolerances. On stiff joints it is
/// 0.1 to 0.5, where a ring is passed over 2 to 70.
const AGREEMENT: f64 = 1.0;
/// What rounding may make of an explicit step's error, in parts of the tolerances. Stiff joints cause 3e-3 at most at
/// 1e-11; steps that rounding keeps short have 0.04 and more.
const NOISE: f64 = 1e-2;
/// The claims in succession that events cut off before the explicit steps come to their ends; the next one is believed.
/// Explicit steps at the limit of their stability let a guard change its sign in every step.
const CUT_OFF: u32 = 4;
/// An explicit step that fails though it is below this part of the longest one tried has an implicit one tried in its
/// place.
const LAST: f64 = 1e-9;
/// The explicit steps in succession that are tried: as long together as the implicit step in sight. A single one may
/// meet the tolerances by luck.
const SUCCESSION: u32 = 8;
/// So few accepted steps between two events are a hurry, and so many of those in succession show that a switch follows
/// errors far below the tolerances: of what is damped stiffly only an implicit method keeps these small.
const HURRY: u32 = 2;
const HURRIED: u32 = 4;
/// Where the errors of all trials were so many times what is allowed, the next one is later than else.
const HOPELESS: f64 = 1e3;
/// How often a step is doubled at most to find the longest one.
const DOUBLINGS: usize = 16;
/// A method that hands back within so many steps took over by mistake: the next trial waits four times as long as
/// before.
const STINT: u32 = 256;

/// The smallest relative tolerance at which steps are worth their cost that are implicit in some states only: below it
/// order 9 takes far longer ones.
const LOOSE: f64 = 1e-10;

/// The least number of states, for the same reason: of few states a factorisation costs little beside the rates.
const MANY: usize = 24;

/// The methods, the more implicit ones later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Implicitness {
    Explicit,
    Partitioned,
    Implicit,
}

/// Calls the method of a kind, borrowed as `$borrow`.
macro_rules! of {
    (($($borrow:tt)+) $auto:expr, $kind:expr, $method:ident => $then:expr) => {
        match $kind {
            Implicitness::Explicit => {
                let $method = $($borrow)+ $auto.explicit;
                $then
            }
            Implicitness::Partitioned => {
                let $method = $($borrow)+ $auto.partitioned;
                $then
            }
            Implicitness::Implicit => {
                let $method = $($borrow)+ $auto.implicit;
                $then
            }
        }
    };
}

/// Calls the method that makes the steps.
macro_rules! present {
    (($($borrow:tt)+) $auto:expr, $method:ident => $then:expr) => {
        of!(($($borrow)+) $auto, $auto.kind, $method => $then)
    };
}

impl Implicitness {
    const ALL: [Self; 3] = [Self::Explicit, Self::Partitioned, Self::Implicit];

    /// That of the method of this name; none where it is none of them.
    const fn of(method: Integrator) -> Option<Self> {
        match method {
            Integrator::Ark5 => Some(Self::Partitioned),
            Integrator::Radau9 => Some(Self::Implicit),
            _ if Race::runs(method) => Some(Self::Explicit),
            _ => None,
        }
    }

    /// The other kinds that are worth trying, those first that are implicit in fewer states.
    fn others(self, relative: f64, n: usize) -> impl Iterator<Item = Self> {
        let has_partitioned = relative >= LOOSE && n >= MANY;
        let is_worth = move |kind: &Self| *kind != self && (*kind != Self::Partitioned || has_partitioned);
        Self::ALL.into_iter().filter(is_worth)
    }

    /// How many steps of a less implicit kind cost as much as one of this kind, of `n` states: as measured on the
    /// hacksaw, where a step of Radau IIA 9 takes as long as 11 of DOP853 in the plane, 23 in three dimensions, and
    /// half a step of `ARK5(4)8L[2]SAb` as long as one of DOP853.
    fn worth(self, less: Self, n: usize) -> f64 {
        match (less, self) {
            (Self::Explicit, Self::Partitioned) => 2.0,
            (Self::Partitioned, _) => (0.5 * n as f64).min(40.0),
            _ => 16.0,
        }
    }
}

/// Three methods, one of which makes the steps.
#[derive(Clone, Debug)]
pub struct Auto {
    explicit: Race,
    partitioned: Ark5,
    implicit: Radau9,
    kind: Implicitness,
    /// Whether the next attempt is the first from the end of an accepted step: after a restart, short steps are tried
    /// that only look for a guard's sign.
    is_fresh: bool,
    /// Accepted steps since the last trial, and those after which the next one is due.
    since: u32,
    wait: u32,
    /// Accepted steps since the last change, and the waits for the first trial of each method.
    stint: u32,
    doubt: [u32; 3],
    /// The step at the last trial, s.
    tried: f64,
    /// The last accepted steps since the change, s; 0 where there are fewer.
    recent: [f64; RECENT],
    /// The step under way, s.
    step: f64,
    /// Where the longer step led that is still to be confirmed.
    claim: Option<Claim>,
    /// Its end, and the start of the step under way.
    claimed: Vec<f64>,
    before: Noted,
    /// The start and the end of steps that are tried only, a rate.
    trial: Noted,
    end: Vec<f64>,
    rate: Vec<f64>,
    /// The claims in succession that events have cut off.
    cut_off: u32,
    /// Accepted steps since the last restart, and the restarts in succession that came after few of them.
    since_event: u32,
    hurried: u32,
    /// The longest step tried since the last change, s.
    longest: f64,
    /// The least error norm of the last trials.
    nearest: f64,
    changes: Vec<Change>,
    /// The explicit method that was told last.
    told: &'static str,
    /// What made most of the steps of a run before.
    hint: Option<Integrator>,
}

/// A step of a more implicit method that satisfies the tolerances, with the steps of the present one under way to its
/// end.
#[derive(Clone, Debug)]
struct Claim {
    kind: Implicitness,
    /// How many times as long it is as the step that was in sight.
    longer: f64,
    /// The time of its end, s.
    t: f64,
}

/// A point that is kept.
#[derive(Clone, Debug, Default)]
struct Noted {
    t: f64,
    x: Vec<f64>,
    rate: Vec<f64>,
}

impl Noted {
    fn fit(&mut self, states: usize) {
        self.x.resize(states, 0.0);
        self.rate.resize(states, 0.0);
    }

    fn note(&mut self, PointRef { t, x, rate }: PointRef<'_>) {
        self.t = t;
        self.x.copy_from_slice(x);
        self.rate.copy_from_slice(rate);
    }

    fn point(&self) -> PointRef<'_> {
        PointRef { t: self.t, x: &self.x, rate: &self.rate }
    }
}

/// The most changes that are remembered.
const REMEMBERED: usize = 256;

impl Auto {
    /// DOP853, CFMR7osc, Nystrom and Taylor series, `ARK5(4)8L[2]SAb`, Radau IIA 9; DOP853 begins, at loose
    /// tolerances where there are few states CFMR7osc.
    #[must_use]
    pub fn new() -> Self {
        let explicit = Race::new();
        let told = explicit.name();
        Self {
            explicit,
            partitioned: Ark5::new(),
            implicit: Radau9::new(),
            kind: Implicitness::Explicit,
            is_fresh: false,
            since: 0,
            wait: WAIT[0],
            stint: 0,
            doubt: [WAIT[0]; 3],
            tried: f64::NAN,
            recent: [0.0; RECENT],
            step: 0.0,
            claim: None,
            claimed: Vec::new(),
            before: Noted::default(),
            trial: Noted::default(),
            end: Vec::new(),
            rate: Vec::new(),
            cut_off: 0,
            since_event: 0,
            hurried: 0,
            longest: 0.0,
            nearest: 0.0,
            changes: Vec::with_capacity(REMEMBERED),
            told,
            hint: None,
        }
    }

    /// The same, but for `method` to begin: one of those named above, that made most of the steps of a run like this.
    /// The first trials of others come as late as they do in a long run. A method that is none of these, or needs what
    /// the system does not have, is no hint.
    #[must_use]
    pub fn beginning_with(method: Integrator) -> Self {
        let kind = Implicitness::of(method);
        let wait = if kind.is_some() { WAIT[1] } else { WAIT[0] };
        let explicit = Race::beginning_with(Some(method));
        let told = explicit.name();
        Self { kind: kind.unwrap_or(Implicitness::Explicit), wait, told, explicit, hint: Some(method), ..Self::new() }
    }

    /// What a step of the method of a kind costs beside one that its worth was measured with.
    fn dearness(&self, kind: Implicitness) -> f64 {
        if kind == Implicitness::Explicit { self.explicit.dearness() } else { 1.0 }
    }

    /// The median of the last accepted steps, s.
    fn typical(&self) -> f64 {
        let mut recent = self.recent;
        recent.sort_unstable_by(f64::total_cmp);
        recent[RECENT / 2]
    }

    /// Whether other methods are to be tried from the present start with the step `h` (s) in sight.
    fn is_due(&self, h: f64) -> bool {
        // Steps near what they were at the last trial call for none, and need no median.
        let is_near = self.since < self.wait && h > 2.0 * FALL * self.tried;
        if self.claim.is_some() || (self.stint as usize) < RECENT || is_near {
            return false;
        }
        let typical = self.typical();
        h >= CUT * typical && (self.since >= self.wait || typical < FALL * self.tried)
    }

    /// Tries the other methods.
    fn try_others(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) {
        self.since = 0;
        self.nearest = f64::INFINITY;
        self.tried = self.typical();
        let is_cut_off = self.cut_off >= CUT_OFF;
        for kind in self.kind.others(scale.relative, flow.states()) {
            if is_cut_off && kind == Implicitness::Partitioned {
                continue;
            }
            if kind < self.kind && self.succeeds(kind, flow, start, h, scale) {
                return self.change(kind, start.t, Reason::Cheaper);
            }
            if kind > self.kind && self.reaches(kind, flow, start, h, scale) {
                return;
            }
        }
        self.stay();
    }

    /// Whether a step of a more implicit method meets the tolerances that is worth its cost. It takes over, or has to
    /// be confirmed.
    fn reaches(&mut self, kind: Implicitness, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        // Twice as long as it has to be where what it costs varies as much as what the present one does.
        let gain = if kind == Implicitness::Partitioned { 2.0 } else { 1.0 };
        let longer = gain * kind.worth(self.kind, flow.states()) / self.dearness(self.kind);
        let (h, mut x) = (longer * h, core::mem::take(&mut self.claimed));
        x.copy_from_slice(start.x);
        let error = of!((&mut) self, kind, method => {
            // Only the method that makes the steps has seen the last ones.
            method.restart();
            method.attempt(flow, start, h, scale, &mut x)
        });
        self.nearest = self.nearest.min(error);
        let is_met = error <= 1.0 && is_finite(&x);
        self.claimed = x;
        if is_met && self.cut_off >= CUT_OFF {
            self.change(kind, start.t, Reason::Longer(longer));
        } else if is_met {
            self.claim = Some(Claim { kind, longer, t: start.t + h });
            self.before.note(start);
        }
        is_met
    }

    /// Whether steps of a less implicit method meet the tolerances from `start` over the step `h` (s) of the present
    /// one. Each of them is twice as long as it has to be to be worth a change, so that the choice does not swing.
    fn succeeds(&mut self, kind: Implicitness, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        let h = 2.0 * h * self.dearness(kind) / self.kind.worth(kind, flow.states());
        let (mut from, mut end) = (core::mem::take(&mut self.trial), core::mem::take(&mut self.end));
        from.note(start);
        of!((&mut) self, kind, method => method.restart());
        let succeeds = (0..SUCCESSION).all(|_| {
            let error = of!((&mut) self, kind, method => method.attempt(flow, from.point(), h, scale, &mut end));
            let is_met = error <= 1.0 && is_finite(&end);
            if is_met {
                of!((&mut) self, kind, method => method.advance());
                from.t += h;
                from.x.copy_from_slice(&end);
                flow.rate(from.t, &end, &mut from.rate);
            }
            is_met
        });
        (self.trial, self.end) = (from, end);
        succeeds
    }

    /// Holds the longer step against the present method's, once these have come to its end.
    fn confirm(&mut self, flow: &Flow<'_>, start: PointRef<'_>, scale: &Scale) {
        let Some(claim) = self.claim.take_if(|claim| claim.t <= start.t) else { return };
        let (before, step) = (core::mem::take(&mut self.before), self.step);
        self.cut_off = 0;
        let mut x = core::mem::take(&mut self.end);
        let since = claim.t - before.t;
        present!((&mut) self, method => {
            method.prepare_dense(flow, before.point(), step, start);
            method.dense(before.point(), step, start, since / step, &mut x);
        });
        let agrees = scale.norm_of(&x, |i| self.claimed[i] - x[i]) <= AGREEMENT;
        (self.before, self.end) = (before, x);
        if agrees && self.noise(flow, start, scale) < NOISE {
            let kind = if claim.kind == Implicitness::Partitioned && self.is_stiff_throughout(flow, start, since, scale)
            {
                Implicitness::Implicit
            } else {
                claim.kind
            };
            self.change(kind, start.t, Reason::Longer(claim.longer));
        } else {
            self.stay();
        }
    }

    /// What rounding makes of the error of a typical step, in parts of the tolerances.
    fn noise(&mut self, flow: &Flow<'_>, start: PointRef<'_>, scale: &Scale) -> f64 {
        let typical = self.typical();
        let Self { end, rate, trial, .. } = self;
        rounding(flow, start, [&mut trial.x, rate, end]);
        scale.norm_of(start.x, |i| end[i] * typical)
    }

    /// Whether from `start` a step meets the tolerances that is implicit in all states and worth more than the longest
    /// one that is implicit in some, from `h` (s) on.
    fn is_stiff_throughout(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        let Self { partitioned, implicit, end, .. } = self;
        partitioned.restart();
        implicit.restart();
        let longer = core::iter::successors(Some(h), |h| Some(2.0 * h)).take(DOUBLINGS);
        let is_met = |h: &f64| partitioned.attempt(flow, start, *h, scale, end) <= 1.0 && is_finite(end);
        let longest = longer.take_while(is_met).last().unwrap_or(h);
        let h = Implicitness::Implicit.worth(Implicitness::Partitioned, flow.states()) * longest;
        implicit.attempt(flow, start, h, scale, end) <= 1.0 && is_finite(end)
    }

    /// Whether an implicit step goes on where those of the present method fail.
    fn goes_on(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale) -> bool {
        // Where it has just handed back it does not go on either.
        let has_gone_on = !self.changes.is_empty() && self.stint < STINT;
        let Self { implicit, end, .. } = self;
        implicit.restart();
        !has_gone_on && implicit.attempt(flow, start, h, scale, end) <= 1.0 && is_finite(end)
    }

    /// The method stays: the next trial is later.
    fn stay(&mut self) {
        let factor = if self.nearest > HOPELESS { 4 } else { 2 };
        self.wait = (factor * self.wait).min(WAIT[1]);
    }

    /// Another method takes over at time `t` (s).
    fn change(&mut self, kind: Implicitness, t: f64, reason: Reason) {
        let doubt = &mut self.doubt[self.kind as usize];
        *doubt = if self.stint < STINT { (4 * *doubt).min(WAIT[1]) } else { WAIT[0] };
        self.wait = *doubt;
        self.kind = kind;
        of!((&mut) self, kind, method => method.restart());
        self.stint = 0;
        self.cut_off = 0;
        self.hurried = 0;
        self.longest = 0.0;
        self.recent = [0.0; RECENT];
        self.tell(t, reason);
    }

    /// Remembers that the present method makes the steps from time `t` (s) on, and why.
    fn tell(&mut self, t: f64, reason: Reason) {
        let method = self.name();
        if self.kind == Implicitness::Explicit {
            self.told = method;
        }
        if self.changes.len() < REMEMBERED {
            self.changes.push(Change { t, method, reason });
        }
    }
}

impl Default for Auto {
    fn default() -> Self {
        Self::new()
    }
}

impl Method for Auto {
    hand_on!(present);

    fn fit(&mut self, states: usize) {
        if self.end.len() == states {
            return;
        }
        *self = self.hint.map_or_else(Self::new, Self::beginning_with);
        self.explicit.fit(states);
        self.partitioned.fit(states);
        self.implicit.fit(states);
        self.before.fit(states);
        self.trial.fit(states);
        for room in [&mut self.claimed, &mut self.end, &mut self.rate] {
            room.resize(states, 0.0);
        }
    }

    fn attempt(&mut self, flow: &Flow<'_>, start: PointRef<'_>, h: f64, scale: &Scale, end: &mut [f64]) -> f64 {
        if self.is_fresh {
            self.confirm(flow, start, scale);
        }
        if self.kind == Implicitness::Partitioned && self.hurried >= HURRIED {
            self.change(Implicitness::Implicit, start.t, Reason::Switches);
        }
        if self.is_due(h) {
            self.try_others(flow, start, h, scale);
        }
        self.is_fresh = false;
        self.step = h;
        if self.claim.is_some() {
            self.before.note(start);
        }
        let error = present!((&mut) self, method => method.attempt(flow, start, h, scale, end));
        if self.kind == Implicitness::Implicit {
            return error;
        }
        if self.kind == Implicitness::Explicit && self.explicit.ahead().is_some_and(|ahead| ahead != self.told) {
            let lead = self.explicit.lead();
            self.tell(start.t, if lead > 1.0 { Reason::Further(lead) } else { Reason::First });
        }
        self.longest = self.longest.max(h);
        let is_met = error <= 1.0 && is_finite(end);
        if is_met || h > LAST * self.longest || !self.goes_on(flow, start, h, scale) {
            return error;
        }
        self.change(Implicitness::Implicit, start.t, Reason::GoesOn);
        self.implicit.attempt(flow, start, h, scale, end)
    }

    fn advance(&mut self) {
        self.is_fresh = true;
        self.recent[self.stint as usize % RECENT] = self.step;
        self.since += 1;
        self.since_event += 1;
        self.stint += 1;
        // Before the first trial it is these steps that later ones are held against.
        if self.tried.is_nan() && self.stint as usize == RECENT {
            self.tried = self.typical();
        }
        present!((&mut) self, method => method.advance());
    }

    fn restart(&mut self) {
        self.is_fresh = false;
        self.cut_off += u32::from(self.claim.take().is_some());
        self.hurried = if self.since_event <= HURRY { self.hurried + 1 } else { 0 };
        self.since_event = 0;
        for kind in Implicitness::ALL {
            of!((&mut) self, kind, method => method.restart());
        }
    }

    /// DOP853 begins where the first of them is none of [`Reason::First`]. The first 256 changes are remembered.
    fn changes(&self) -> &[Change] {
        &self.changes
    }
}
