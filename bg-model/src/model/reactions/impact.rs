//! Impacts on stops: how the state jumps where something hits one.
//!
//! In: a system with stops ([`Impacts`](crate::model::capability::Impacts)), the state before, the stops that are
//! reached. Out: the state after, and how each stop comes out of it.
//!
//! Newton's law: a flow v towards a stop becomes -e v, or leaves faster. Impulses L of the stops, which do not pull,
//! and of the rigid joints, whose flows stay zero, change the flows by A L, with A = -J M^-1 J^T of all of them. Which
//! of several stops give an impulse is a linear complementarity problem: an impulse that pulls is taken away, a stop
//! that is passed gets one, of several the last, until none is wrong. What leaves a stop too slowly to be seen is kept
//! there. Sources: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (1996), chapter 8; C. Glocker,
//! Set-Valued Force Laws (2001), chapter 9; K. G. Murty, Note on a Bard-type scheme for solving the complementarity
//! problem, Opsearch 11 (1974), whose choice of the last ends. Impulses of dry friction are none: what it can hold is
//! bounded.

use alloc::vec;
use alloc::vec::Vec;

use super::dropped_of;
use super::factors::{DISTINCT, Factors, Matrix};
use crate::model::dynamics::Dynamics;
use crate::model::holding::{Stop, Stops};
use crate::model::scalar::Scalar;

/// Flows and impulses that are smaller beside the largest are rounding.
const ROUNDING: f64 = 1e-12;
/// How often the choice of the stops that give an impulse is changed.
const CHANGES: usize = 100;
/// How often a solution is repeated where momenta are not linear in flows.
const ROUNDS: usize = 10;

/// How a stop comes out of an impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum After {
    /// It has not been reached.
    Untouched,
    /// What has hit it leaves.
    Clear,
    /// What has hit it, or was there, does not move towards it or away.
    Rests,
}

/// What an impact is calculated from: [`Impacts::impact`](crate::model::capability::Impacts::impact), over slices.
pub(crate) type Impact<'a, S> = dyn Fn(S, &[S], &[bool], &mut [S]) + 'a;

/// That of a system over slices.
pub(crate) fn impacts_of<S>(system: &dyn Dynamics<S>) -> impl Fn(S, &[S], &[bool], &mut [S])
where
    S: Scalar<Switch = bool>,
{
    |t, x, negative, entries| system.impact(t, x, negative, entries)
}

/// An impact, with room for its numbers.
#[derive(Debug)]
pub(crate) struct Collision<S> {
    table: Stops,
    /// The numbers of [`Impacts::impact`] before the impact, and after it.
    before: Vec<S>,
    after: Vec<S>,
    factors: Factors<S>,
    /// The rows of rigid joints that take no part.
    dropped: Vec<bool>,
    /// Minus the impulses, as far as they are found, and what is added to them.
    total: Vec<S>,
    part: Vec<S>,
    /// The flow that each row is to have after it.
    target: Vec<S>,
    /// Of each stop whether it is reached, gives an impulse, gives back nothing, keeps what would leave too slowly to
    /// be seen.
    closed: Vec<bool>,
    active: Vec<bool>,
    plastic: Vec<bool>,
    kept: Vec<bool>,
    outcome: Vec<After>,
}

impl<S: Scalar<Switch = bool>> Collision<S> {
    /// Room for the impacts of a system.
    pub fn new(table: Stops, kept_of_stops: &[f64]) -> Self {
        let (rows, stops, zero) = (table.rows(), table.stops.len(), S::from_f64(0.0));
        let dropped = dropped_of(table.rigid, table.closing, kept_of_stops);
        Self {
            table,
            before: vec![zero; table.entries()],
            after: vec![zero; table.entries()],
            factors: Factors::new(rows),
            dropped,
            total: vec![zero; rows],
            part: vec![zero; rows],
            target: vec![zero; rows],
            closed: vec![false; stops],
            active: vec![false; stops],
            plastic: vec![false; stops],
            kept: vec![false; stops],
            outcome: vec![After::Untouched; stops],
        }
    }

    /// The stops: of each its switch and how it has come out of the last impact.
    pub fn outcomes(&self) -> impl Iterator<Item = (usize, After)> {
        self.table.stops.iter().zip(&self.outcome).map(|(stop, &after)| (stop.switch, after))
    }

    /// The switches of the stops.
    pub fn switches(&self) -> impl Iterator<Item = usize> + use<S> {
        self.table.stops.iter().map(|stop| stop.switch)
    }

    /// Lets the state `x` at time `t` (s) jump where the stops whose switches are `closed` are reached. `is_low` says
    /// of a switch whether a rebound is as good as none that rises so far from the stop, in the unit of its
    /// displacement, and whether the accuracy of the run decides that or only rounding. Gives whether it jumps.
    pub fn strike(
        &mut self,
        impact: &Impact<'_, S>,
        (t, x): (S, &mut [S]),
        negative: &[bool],
        closed: impl Fn(usize) -> bool,
        mut is_low: impl FnMut(usize, f64, bool) -> bool,
    ) -> bool {
        let stops = self.table.stops.len();
        impact(t, x, negative, &mut self.before);
        for k in 0..stops {
            self.closed[k] = closed(self.table.stops[k].switch);
            let (speed, back) = (self.speed(k), self.restitution(k) * self.speed(k));
            self.plastic[k] = speed <= 0.0 || back <= self.rest(k).max(0.0);
            self.kept[k] = false;
        }
        let start = x.to_vec();
        for _ in 0..=stops {
            x.copy_from_slice(&start);
            let mut clear = negative.to_vec();
            self.solve(impact, (t, x), negative);
            for k in 0..stops {
                self.outcome[k] = self.comes_out(k);
                clear[self.table.stops[k].switch] |= self.outcome[k] == After::Clear;
            }
            // The loads when it leaves, for how far it does.
            impact(t, x, &clear, &mut self.after);
            let mut is_settled = true;
            for k in (0..stops).filter(|&k| self.outcome[k] == After::Clear) {
                if is_low(self.table.stops[k].switch, self.rise(k), self.rest(k) < 0.0) {
                    (self.plastic[k], self.kept[k], is_settled) = (true, true, false);
                }
            }
            if is_settled {
                break;
            }
        }
        self.integrate(x);
        self.active.contains(&true)
    }

    /// The state `x` at time `t` (s) with momenta by which in one unit of time everything moves back by as far as the
    /// stops are passed, `by` of their switches, while the rigid joints hold.
    pub fn displaced(
        &mut self,
        impact: &Impact<'_, S>,
        (t, x): (S, &[S]),
        negative: &[bool],
        by: impl Fn(usize) -> f64,
    ) -> Vec<S> {
        impact(t, x, negative, &mut self.after);
        self.target.copy_from_slice(&self.after[..self.table.rows()]);
        for (k, stop) in self.table.stops.iter().enumerate() {
            let passed = by(stop.switch);
            self.active[k] = passed > 0.0;
            let row = self.table.rigid + k;
            self.target[row] = self.target[row] - S::from_f64(passed);
        }
        self.find();
        let mut moved = x.to_vec();
        for (row, &part) in self.part.iter().enumerate() {
            for (&state, &by) in self.table.moved.iter().zip(self.moves(&self.after, row)) {
                moved[state] = moved[state] - by * part;
            }
        }
        moved
    }

    /// The switches of the stops that nothing leaves, in whose order they are looked at where several bear a load.
    pub fn resting(&self) -> impl Iterator<Item = (usize, usize)> {
        let rests = |&(k, _): &(usize, &Stop)| self.outcome[k] == After::Rests;
        self.table.stops.iter().enumerate().filter(rests).map(|(k, stop)| (k, stop.switch))
    }

    /// The rate of the flow towards a stop, where the loads are known.
    pub fn load(&self, k: usize) -> f64 {
        self.of_stop(&self.after, 2, k)
    }

    /// Finds the loads at this state and in these branches.
    pub fn loads(&mut self, impact: &Impact<'_, S>, (t, x): (S, &[S]), negative: &[bool]) {
        impact(t, x, negative, &mut self.after);
    }

    /// The flow of a row.
    fn flow(entries: &[S], row: usize) -> f64 {
        entries[row].to_f64()
    }

    fn of_stop(&self, entries: &[S], number: usize, k: usize) -> f64 {
        entries[self.table.rows() + number * self.table.stops.len() + k].to_f64()
    }

    /// The speed with which a stop is hit, not positive where it is not.
    fn speed(&self, k: usize) -> f64 {
        if self.closed[k] { Self::flow(&self.before, self.table.rigid + k) } else { 0.0 }
    }

    fn restitution(&self, k: usize) -> f64 {
        self.of_stop(&self.before, 0, k)
    }

    /// The speed below which something rests; negative where none is given.
    fn rest(&self, k: usize) -> f64 {
        self.of_stop(&self.before, 1, k)
    }

    /// How far a rebound rises from the stop, if the load stays.
    fn rise(&self, k: usize) -> f64 {
        let (speed, load) = (Self::flow(&self.after, self.table.rigid + k), self.load(k));
        if load > 0.0 { 0.5 * speed * speed / load } else { f64::INFINITY }
    }

    /// The largest flow before, beside which others are rounding.
    fn scale(&self) -> f64 {
        (0..self.table.rows()).fold(0.0, |largest, row| largest.max(Self::flow(&self.before, row).abs()))
    }

    fn matrix<'a>(&self, entries: &'a [S]) -> Matrix<'a, S> {
        let rows = self.table.rows();
        let (mobilities, rest) = entries[rows + 3 * self.table.stops.len()..].split_at(self.table.rigid);
        Matrix { lower: &rest[..rows * (rows + 1) / 2], mobilities }
    }

    /// How much one unit of a row's impulse changes the moved states, then the integrals.
    fn moves<'a>(&self, entries: &'a [S], row: usize) -> &'a [S] {
        let width = self.table.moved.len() + self.table.integrals.len();
        let first = entries.len() - (self.table.rows() - row) * width;
        &entries[first..first + width]
    }

    /// Whether a row takes no part.
    fn is_out(&self, row: usize) -> bool {
        row.checked_sub(self.table.rigid).map_or_else(|| self.dropped[row], |stop| !self.active[stop])
    }

    /// Finds the impulses and changes the momenta by them.
    fn solve(&mut self, impact: &Impact<'_, S>, (t, x): (S, &mut [S]), negative: &[bool]) {
        let (zero, rigid, scale) = (S::from_f64(0.0), self.table.rigid, self.scale());
        for k in 0..self.table.stops.len() {
            let flow = self.before[rigid + k];
            let restitution = self.before[self.table.rows() + k];
            self.target[rigid + k] = if self.plastic[k] { zero } else { -(restitution * flow) };
            self.active[k] = self.kept[k] || self.closed[k] && flow.to_f64() > 0.0;
        }
        self.after.copy_from_slice(&self.before);
        self.total.fill(zero);
        for _ in 0..CHANGES {
            self.find();
            let Some(wrong) = self.wrong(scale) else { break };
            self.active[wrong] = !self.active[wrong];
        }
        let mut error = f64::INFINITY;
        for _ in 0..ROUNDS {
            let before = x.to_vec();
            for (row, &part) in self.part.iter().enumerate() {
                for (&state, &by) in self.table.moved.iter().zip(self.moves(&self.after, row)) {
                    x[state] = x[state] - by * part;
                }
            }
            impact(t, x, negative, &mut self.after);
            let left = self.left();
            if left >= 0.5 * error {
                x.copy_from_slice(&before);
                impact(t, x, negative, &mut self.after);
                break;
            }
            self.total.iter_mut().zip(&self.part).for_each(|(total, &part)| *total = *total + part);
            if left <= f64::EPSILON * scale {
                break;
            }
            error = left;
            self.find();
        }
    }

    /// Minus the impulses that lead from the flows of `after` to the wanted ones, into `part`.
    fn find(&mut self) {
        for row in 0..self.table.rows() {
            let is_out = self.is_out(row);
            self.part[row] = if is_out { S::from_f64(0.0) } else { self.after[row] - self.target[row] };
        }
        let mut factors = core::mem::replace(&mut self.factors, Factors::new(0));
        factors.factor_where(self.matrix(&self.after), |row, pivot, mobility| {
            self.is_out(row) || pivot <= DISTINCT * mobility
        });
        factors.solve(&mut self.part);
        self.factors = factors;
    }

    /// The last stop whose impulse pulls, or that gives none and is passed.
    fn wrong(&self, scale: f64) -> Option<usize> {
        let (rigid, matrix) = (self.table.rigid, self.matrix(&self.after).lower);
        let entry = |i: usize, j: usize| matrix[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
        let changed = |row: usize| {
            let parts = (0..self.part.len()).map(|j| (entry(row, j) * self.part[j]).to_f64());
            parts.fold(self.after[row].to_f64(), |flow, part| flow - part)
        };
        let largest = self.part.iter().fold(0.0_f64, |largest, part| largest.max(part.to_f64().abs()));
        let is_wrong = |&k: &usize| {
            let row = rigid + k;
            if self.kept[k] {
                false
            } else if self.active[k] {
                self.part[row].to_f64() > ROUNDING * largest
            } else {
                self.closed[k] && changed(row) > self.target[row].to_f64() + ROUNDING * scale
            }
        };
        (0..self.active.len()).rev().find(is_wrong)
    }

    /// The largest difference to a wanted flow of those rows that take part and follow from no others.
    fn left(&self) -> f64 {
        let takes_part = |&row: &usize| !self.factors.follows(row);
        let rows = (0..self.table.rows()).filter(takes_part);
        rows.fold(0.0, |left, row| left.max((self.after[row] - self.target[row]).to_f64().abs()))
    }

    fn comes_out(&self, k: usize) -> After {
        let speed = Self::flow(&self.after, self.table.rigid + k);
        if !self.closed[k] {
            After::Untouched
        } else if speed < -ROUNDING * self.scale() && !(self.active[k] && self.plastic[k]) {
            After::Clear
        } else {
            After::Rests
        }
    }

    /// Changes the integrals by the impulses times the means of what these move before and after.
    fn integrate(&self, x: &mut [S]) {
        let (half, first) = (S::from_f64(0.5), self.table.moved.len());
        for (row, &total) in self.total.iter().enumerate() {
            let before = &self.moves(&self.before, row)[first..];
            let after = &self.moves(&self.after, row)[first..];
            for ((&state, &before), &after) in self.table.integrals.iter().zip(before).zip(after) {
                x[state] = x[state] - half * (before + after) * total;
            }
        }
    }
}
