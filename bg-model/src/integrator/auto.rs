//! Choice between an explicit and an implicit method while a run is under way.
//!
//! In: a method of each kind. Out: their steps. Now and then, more seldom the longer the answer stays the same, a step of
//! the other method is tried from the same start: the implicit one takes over where its tolerances are met by a step so
//! much longer that it is worth its cost, and hands back where they are not. Stiffness is thus measured by what it does to
//! the steps, not guessed from eigenvalues, and oscillations that have to be followed anyway do not count as such.

use nalgebra::SVector;

use super::{Dop853, Flow, Method, Point, Radau9, Scale, StepControl};

/// Steps before the first trial, and the most between two trials.
const WAIT: [u32; 2] = [16, 4096];
/// A step that falls below this part of the one at the last trial calls for a trial before its time.
const FALL: f64 = 0.1;
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
    changes: Vec<Change>,
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
            changes: Vec::with_capacity(REMEMBERED),
        }
    }

    /// Whether the other method is to be tried from the present start with the step `h` (s) in sight.
    fn is_due(&self, h: f64) -> bool {
        self.is_fresh && (self.since >= self.wait || h < FALL * self.tried)
    }

    /// Tries the other method, and changes to it if it is worth it.
    fn try_other(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64, scale: &Scale<N>) {
        let mut end = start.x;
        let is_worth = if self.is_implicit {
            // Half as long a step, so that the choice does not swing.
            self.explicit.attempt(flow, start, 2.0 * h / self.worth, scale, &mut end) <= 1.0
        } else {
            self.implicit.attempt(flow, start, self.worth * h, scale, &mut end) <= 1.0
        };
        self.since = 0;
        self.tried = h;
        if is_worth {
            self.change(start.t);
        } else {
            self.wait = (2 * self.wait).min(WAIT[1]);
        }
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
        flow: &mut impl Flow<N>,
        start: &Point<N>,
        h: f64,
        scale: &Scale<N>,
        end: &mut SVector<f64, N>,
    ) -> f64 {
        if self.is_due(h) {
            self.try_other(flow, start, h, scale);
        }
        self.is_fresh = false;
        if self.is_implicit {
            self.implicit.attempt(flow, start, h, scale, end)
        } else {
            self.explicit.attempt(flow, start, h, scale, end)
        }
    }

    fn advance(&mut self) {
        self.is_fresh = true;
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
        self.explicit.restart();
        self.implicit.restart();
    }

    /// The explicit method begins. The first 256 changes are remembered.
    fn changes(&self) -> &[Change] {
        &self.changes
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

    fn prepare_dense(&mut self, flow: &mut impl Flow<N>, start: &Point<N>, h: f64, end: &Point<N>) {
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
