//! Choice between an explicit and an implicit method while a run is under way.
//!
//! In: a method of each kind. Out: their steps. Now and then, more seldom the longer the answer stays the same, the other method is
//! tried from the same start. The implicit one takes over where one step meets the tolerances that is so much longer that it is worth
//! its cost, where the explicit steps then arrive at the same state, and where it is not rounding that keeps those short; or where it
//! goes on and explicit steps do not. It hands back where several explicit steps in succession meet the tolerances. Stiffness is thus measured by what it does to the steps, not
//! guessed from eigenvalues, and oscillations that have to be followed anyway do not count as such.

use nalgebra::SVector;

use super::{Dop853, Flow, Method, Point, Radau9, Scale, StepControl, is_finite, rounding};

/// Steps before the first trial, and the most between two trials.
const WAIT: [u32; 2] = [16, 4096];
/// Steps that all fall below this part of the one at the last trial call for a trial before its time.
const FALL: f64 = 0.1;
/// The accepted steps by which the present one is judged: events, samples and rejections shorten single ones.
const RECENT: usize = 16;
/// A step below this part of their median is no measure: it only looks for a guard's sign, or an event or the end of the run has cut
/// it.
const CUT: f64 = 0.5;
/// The largest difference between the implicit step and the explicit ones, in parts of the tolerances. On stiff joints it is 0.1 to 0.5,
/// where a ring is passed over 2 to 70.
const AGREEMENT: f64 = 1.0;
/// What rounding may make of an explicit step's error, in parts of the tolerances. Stiff joints cause 3e-3 at most at 1e-11; steps that
/// rounding keeps short have 0.04 and more.
const NOISE: f64 = 1e-2;
/// The claims in succession that events cut off before the explicit steps come to their ends; the next one is believed. Explicit steps at
/// the limit of their stability let a guard change its sign in every step.
const CUT_OFF: u32 = 4;
/// An explicit step that fails though it is below this part of the longest one tried has an implicit one tried in its place.
const LAST: f64 = 1e-9;
/// The explicit steps in succession that are tried: as long together as the implicit step in sight. A single one may meet the
/// tolerances by luck.
const SUCCESSION: u32 = 8;
/// A method that hands back within so many steps took over by mistake: the next trial waits four times as long as before.
const STINT: u32 = 256;

/// An explicit and an implicit method, one of which makes the steps.
#[derive(Clone, Debug)]
pub struct Auto<const N: usize, E = Dop853<N>, I = Radau9<N>> {
    explicit: E,
    implicit: I,
    is_implicit: bool,
    /// How much longer an implicit step has to be to be worth its cost.
    worth: f64,
    /// Whether the next attempt is the first from the end of an accepted step: after a restart, short steps are tried that
    /// only look for a guard's sign.
    is_fresh: bool,
    /// Accepted steps since the last trial, and those after which the next one is due.
    since: u32,
    wait: u32,
    /// Accepted steps since the last change, and the waits for the first trial of the explicit and the implicit method.
    stint: u32,
    doubt: [u32; 2],
    /// The step at the last trial, s.
    tried: f64,
    /// The last accepted steps since the change, s; 0 where there are fewer.
    recent: [f64; RECENT],
    /// The step under way, s.
    step: f64,
    /// Where the implicit step led that is still to be confirmed.
    claim: Option<Claim<N>>,
    /// The claims in succession that events have cut off.
    cut_off: u32,
    /// The longest explicit step tried since the last change, s.
    longest: f64,
    changes: Vec<Change>,
}

/// An implicit step that satisfies the tolerances, with the explicit steps under way to its end.
#[derive(Clone, Debug)]
struct Claim<const N: usize> {
    /// Its end.
    t: f64,
    x: SVector<f64, N>,
    /// The start of the explicit step under way.
    start: Point<N>,
}

/// A change of method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// When, s.
    pub t: f64,
    /// The method that makes the steps from there on.
    pub method: &'static str,
}

/// The most changes that are remembered.
const REMEMBERED: usize = 256;

impl<const N: usize> Auto<N> {
    /// DOP853 and Radau IIA 9.
    #[must_use]
    pub fn new() -> Self {
        Self::between(Dop853::new(), Radau9::new())
    }
}

impl<const N: usize> Default for Auto<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize, E: Method<N>, I: Method<N>> Auto<N, E, I> {
    /// A step of the implicit method costs as much as about this many of the explicit one: measured, 11 on the hacksaw in the
    /// plane, 23 in three dimensions.
    const WORTH: f64 = 16.0;

    /// A choice between these two; the explicit one begins.
    #[must_use]
    pub fn between(explicit: E, implicit: I) -> Self {
        Self {
            explicit,
            implicit,
            is_implicit: false,
            worth: Self::WORTH,
            is_fresh: false,
            since: 0,
            wait: WAIT[0],
            stint: 0,
            doubt: [WAIT[0]; 2],
            tried: f64::NAN,
            recent: [0.0; RECENT],
            step: 0.0,
            claim: None,
            cut_off: 0,
            longest: 0.0,
            changes: Vec::with_capacity(REMEMBERED),
        }
    }

    /// The median of the last accepted steps, s.
    fn typical(&self) -> f64 {
        let mut recent = self.recent;
        recent.sort_unstable_by(f64::total_cmp);
        recent[RECENT / 2]
    }

    /// Whether the other method is to be tried from the present start with the step `h` (s) in sight.
    fn is_due(&self, h: f64) -> bool {
        if self.claim.is_some() || (self.stint as usize) < RECENT {
            return false;
        }
        let typical = self.typical();
        h >= CUT * typical && (self.since >= self.wait || typical < FALL * self.tried)
    }

    /// Tries the other method.
    fn try_other(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) {
        self.since = 0;
        self.tried = self.typical();
        if !self.is_implicit {
            let (h, mut x) = (self.worth * h, start.x);
            let is_met = self.implicit.attempt(flow, start, h, scale, &mut x) <= 1.0;
            if is_met && self.cut_off >= CUT_OFF {
                self.change(start.t);
            } else if is_met {
                self.claim = Some(Claim { t: start.t + h, x, start: *start });
            } else {
                self.stay();
            }
        } else if self.succeeds_explicitly(flow, start, h, scale) {
            self.change(start.t);
        } else {
            self.stay();
        }
    }

    /// Whether explicit steps meet the tolerances from `start` over the implicit step `h` (s). Each of them is twice as long as it
    /// has to be to be worth a change, so that the choice does not swing.
    fn succeeds_explicitly(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) -> bool {
        let h = 2.0 * h / self.worth;
        let (mut point, mut end) = (*start, start.x);
        let succeeds = (0..SUCCESSION).all(|_| {
            let is_met = self.explicit.attempt(flow, &point, h, scale, &mut end) <= 1.0 && is_finite(&end);
            if is_met {
                self.explicit.advance();
                (point.t, point.x) = (point.t + h, end);
                flow.rate(point.t, &end, &mut point.rate);
            }
            is_met
        });
        self.explicit.restart();
        succeeds
    }

    /// Holds the implicit step against the explicit ones, once these have come to its end.
    fn confirm(&mut self, flow: &impl Flow<N>, start: &Point<N>, scale: &Scale<N>) {
        let Some(claim) = self.claim.take_if(|claim| claim.t <= start.t) else { return };
        let before = claim.start;
        self.cut_off = 0;
        self.explicit.prepare_dense(flow, &before, self.step, start);
        let mut x = start.x;
        self.explicit.dense(&before, self.step, start, (claim.t - before.t) / self.step, &mut x);
        let agrees = scale.norm(&(claim.x - x), &x) <= AGREEMENT;
        if agrees && scale.norm(&(rounding(flow, start) * self.typical()), &start.x) < NOISE {
            self.change(start.t);
        } else {
            self.stay();
        }
    }

    /// Whether an implicit step goes on where explicit ones fail.
    fn goes_on(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) -> bool {
        // Where it has just handed back it does not go on either.
        let has_gone_on = !self.changes.is_empty() && self.stint < STINT;
        let mut end = start.x;
        !has_gone_on && self.implicit.attempt(flow, start, h, scale, &mut end) <= 1.0 && is_finite(&end)
    }

    /// The method stays: the next trial is later.
    fn stay(&mut self) {
        self.wait = (2 * self.wait).min(WAIT[1]);
    }

    /// The other method takes over at time `t` (s).
    fn change(&mut self, t: f64) {
        let doubt = &mut self.doubt[usize::from(self.is_implicit)];
        *doubt = if self.stint < STINT { (4 * *doubt).min(WAIT[1]) } else { WAIT[0] };
        self.wait = *doubt;
        self.is_implicit = !self.is_implicit;
        if self.is_implicit {
            self.implicit.restart()
        } else {
            self.explicit.restart()
        }
        self.stint = 0;
        self.cut_off = 0;
        self.longest = 0.0;
        self.recent = [0.0; RECENT];
        if self.changes.len() < REMEMBERED {
            self.changes.push(Change { t, method: self.name() });
        }
    }
}

impl<const N: usize, E: Method<N>, I: Method<N>> Method<N> for Auto<N, E, I> {
    fn name(&self) -> &'static str {
        if self.is_implicit { self.implicit.name() } else { self.explicit.name() }
    }

    fn control(&self) -> StepControl {
        if self.is_implicit { self.implicit.control() } else { self.explicit.control() }
    }

    fn attempt(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        if self.is_fresh {
            self.confirm(flow, start, scale);
        }
        if self.is_due(h) {
            self.try_other(flow, start, h, scale);
        }
        self.is_fresh = false;
        self.step = h;
        if let Some(claim) = &mut self.claim {
            claim.start = *start;
        }
        if !self.is_implicit {
            let error = self.explicit.attempt(flow, start, h, scale, end);
            self.longest = self.longest.max(h);
            let is_met = error <= 1.0 && is_finite(end);
            if is_met || h > LAST * self.longest || !self.goes_on(flow, start, h, scale) {
                return error;
            }
            self.change(start.t);
        }
        self.implicit.attempt(flow, start, h, scale, end)
    }

    fn advance(&mut self) {
        self.is_fresh = true;
        self.recent[self.stint as usize % RECENT] = self.step;
        self.since += 1;
        self.stint += 1;
        // Only the method that makes the steps has seen the last one.
        if self.is_implicit {
            self.implicit.advance();
            self.explicit.restart();
        } else {
            self.explicit.advance();
            self.implicit.restart();
        }
    }

    fn restart(&mut self) {
        self.is_fresh = false;
        self.cut_off += u32::from(self.claim.take().is_some());
        self.explicit.restart();
        self.implicit.restart();
    }

    /// The explicit method begins. The first 256 changes are remembered.
    fn changes(&self) -> &[Change] {
        &self.changes
    }

    fn error_after(
        &mut self,
        flow: &impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &SVector<f64, N>,
        project: impl Fn(&mut SVector<f64, N>),
    ) -> Option<f64> {
        if self.is_implicit { None } else { self.explicit.error_after(flow, start, h, scale, end, project) }
    }

    fn largest_error(&self, start: &Point<N>, scale: &Scale<N>, end: &SVector<f64, N>) -> usize {
        if self.is_implicit {
            self.implicit.largest_error(start, scale, end)
        } else {
            self.explicit.largest_error(start, scale, end)
        }
    }

    fn faulty_rate(&self) -> Option<(usize, f64)> {
        if self.is_implicit { self.implicit.faulty_rate() } else { self.explicit.faulty_rate() }
    }

    fn prepare_dense(&mut self, flow: &impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
        if self.is_implicit {
            self.implicit.prepare_dense(flow, start, h, end);
        } else {
            self.explicit.prepare_dense(flow, start, h, end);
        }
    }

    fn dense(&self, start: &Point<N>, h: f64, end: &Point<N>, theta: f64, x: &mut SVector<f64, N>) {
        if self.is_implicit {
            self.implicit.dense(start, h, end, theta, x);
        } else {
            self.explicit.dense(start, h, end, theta, x);
        }
    }
}
