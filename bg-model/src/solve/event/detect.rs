//! Detection: has a guard been on the wrong side during a step, and where.
//!
//! Both ends of the step and a quartic in between, through the guard's values and slopes at the ends and its value in
//! the middle, are looked at in every step; the middle state is that of the cubic Hermite polynomial, so this costs
//! three evaluations of the guards and none of the rate. Only where that raises a suspicion the dense output is asked.

use alloc::vec;
use alloc::vec::Vec;

use super::guarded::{End, Guarded};
use super::locate::{Found, Shortening};
use super::minimum::minimum;
use super::noise::larger;
use super::{Crossing, EventMonitor, Reading, check_finite, clearance};
use crate::model::scalar::Scalar;
use crate::solve::integrator::hermite;

/// The number of parts of a step at whose ends the dense output is looked at.
const PARTS: usize = 8;
/// A clearance below this part of its variation in the step is looked at closely.
const NEAR: f64 = 0.5;
/// The least clearance of an enclosing course, in parts of its variation, that needs no look at the course itself.
pub(super) const FAR: f64 = 1.01 * NEAR;
/// Halvings of the distance to the start of the step on the search for a point on the right side.
const HALVINGS: usize = 40;

/// A part of the step in which a guard crosses: parts of the step with their clearances.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    /// The end on the right side.
    pub right: (f64, f64),
    /// The end on the wrong side.
    pub wrong: (f64, f64),
}

/// What is known of a guard's course in a step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Course {
    /// It keeps to its side.
    Clear,
    /// It leaves its side right at the start.
    WrongFromStart,
    /// It crosses here first.
    Crosses(Bracket),
}

/// Bernstein's coefficients of the quartic through a guard's clearances at both ends and in the `middle` of a step, and
/// its changes in a step at the rates there: they enclose it.
#[inline(always)]
pub(super) fn enclosing<S: Scalar>([from, to]: [S; 2], middle: S, [leaving, arriving]: [S; 2]) -> [S; 5] {
    let (leave, arrive) = (from + leaving.times(0.25), to - arriving.times(0.25));
    let bend = (middle.times(16.0) - from - to - (leave + arrive).times(4.0)) / from.alike(6.0);
    [from, leave, bend, arrive, to]
}

/// Whether a polynomial with these Bernstein coefficients is so far above zero that what it stands for needs no look.
fn is_far(coefficients: &[f64]) -> bool {
    let low = coefficients.iter().copied().fold(f64::INFINITY, smaller);
    let high = coefficients.iter().copied().fold(f64::NEG_INFINITY, larger);
    low > FAR * (high - low)
}

/// Whether the quartic with these Bernstein coefficients, of which the first is zero, rises from there on: its mean
/// slope since the start, a cubic, is far from zero.
fn rises(&[_, first, second, third, fourth]: &[f64; 5]) -> bool {
    is_far(&[4.0 * first, 2.0 * second, 4.0 / 3.0 * third, fourth])
}

/// The smaller number; `a` where `b` is none. Comparisons, not `f64::min`: its optimised form was seen to drop an end.
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

impl EventMonitor {
    /// Looks for events in the step just made, whose end has been projected and whose rates are known at both ends.
    ///
    /// Shortens the step to the first event. Fails with the first guard that is not finite.
    pub fn inspect(&mut self, step: &mut dyn Guarded) -> Result<Option<Crossing>, (usize, f64)> {
        Ok(self.look(step)?.map(|found| match found {
            Found::AtStart(crossing) => crossing,
            Found::Inside(shortening) => self.shorten(step, shortening),
        }))
    }

    /// Shortens the step to its first event.
    pub fn shorten(&mut self, step: &mut dyn Guarded, mut shortening: Shortening) -> Crossing {
        loop {
            // The last attempt may be of this size.
            if step.size() != shortening.size() {
                step.resize(shortening.size());
            }
            if shortening.take(self, step) {
                return self.crossing(step, shortening);
            }
        }
    }

    /// Looks for events in the step just made, as [`EventMonitor::inspect`] does, but leaves it as it is.
    pub fn look(&mut self, step: &mut dyn Guarded) -> Result<Option<Found>, (usize, f64)> {
        if self.guards() == 0 {
            return Ok(None);
        }
        let h = step.size();
        self.read_end(step);
        check_finite(&self.end.value)?;
        // In the middle.
        let [start, end] = [End::Start, End::End].map(|end| step.point(end).borrowed());
        hermite(start, h, end, 0.5, &mut self.state);
        let middle = start.t + 0.5 * h;
        step.read(middle, &self.state, &mut self.middle);
        // As long as the noise is not known it counts as none: there are only more suspects.
        if !(0..self.guards()).any(|k| self.is_suspect(k, step.negative()[k], self.middle[k], h)) {
            return Ok(None);
        }
        self.start.noise = self.noise_of(step, End::Start, &self.start.value);
        self.end.noise = self.noise_of(step, End::End, &self.end.value);
        let is_suspect = |k: usize| self.is_suspect(k, step.negative()[k], self.middle[k], h);
        let suspects: Vec<bool> = (0..self.guards()).map(is_suspect).collect();
        if !suspects.contains(&true) {
            return Ok(None);
        }
        let courses = self.courses(step, &suspects);
        Ok(self.first_crossing(step, courses))
    }

    /// Takes over a step of size `h` (s) at whose ends and in whose `middle` all guards keep to their sides; gives
    /// whether they do, which counts three evaluations, as [`EventMonitor::inspect`] does. Nothing changes where they
    /// may not.
    #[cfg(feature = "std")]
    pub fn pass(&mut self, negative: &[bool], end: [&[f64]; 2], middle: &[f64], h: f64, is_clear: bool) -> bool {
        let [value, slope] = end;
        self.end.value.copy_from_slice(value);
        self.end.slope.copy_from_slice(slope);
        self.end.noise.fill(0.0);
        // What is known to be noisy at the start changes the question.
        let is_clear = is_clear && self.start.noise.iter().all(|noise| *noise == 0.0);
        let mut suspects = (0..self.guards()).map(|k| self.is_suspect(k, negative[k], middle[k], h));
        if !is_clear && (check_finite(value).is_err() || suspects.any(|is_suspect| is_suspect)) {
            return false;
        }
        self.advance();
        true
    }

    /// The guards' values and slopes (per s) at the start of the step.
    #[cfg(feature = "std")]
    pub fn at_start(&self) -> [&[f64]; 2] {
        [&self.start.value, &self.start.slope]
    }

    /// Takes these over, of a start that steps have led to in which all guards kept to their sides.
    #[cfg(feature = "std")]
    pub fn take_start(&mut self, [value, slope]: [&[f64]; 2]) {
        self.start.value.copy_from_slice(value);
        self.start.slope.copy_from_slice(slope);
    }

    /// Whether nothing is known of the guards but what they are at the start of the step: no noise there, nothing that
    /// events have left.
    #[cfg(feature = "std")]
    pub fn is_plain(&self) -> bool {
        self.start.noise.iter().chain(&self.remainder).all(|left| *left == 0.0)
    }

    /// Whether guard `k` is on the wrong side at the end of the step or may have been in it.
    fn is_suspect(&self, k: usize, negative: bool, middle: f64, h: f64) -> bool {
        let is_wrong = clearance(self.end.value[k], negative) < -self.end.noise[k];
        is_wrong || self.is_near(k, negative, middle, h)
    }

    /// Whether guard `k` comes so near to zero in the step that it may dip to the wrong side and come back.
    fn is_near(&self, k: usize, negative: bool, middle: f64, h: f64) -> bool {
        const SAMPLES: usize = 16;
        let noise = larger(self.start.noise[k], self.end.noise[k]);
        let side = |value: f64| clearance(value, negative);
        let from = if self.start.value[k].abs() <= self.start.noise[k] { 0.0 } else { side(self.start.value[k]) };
        let (middle, to) = (side(middle), side(self.end.value[k]));
        let (leaving, arriving) = (h * side(self.start.slope[k]), h * side(self.end.slope[k]));
        let bulge = 16.0 * (middle - 0.5 * (from + to) - 0.125 * (leaving - arriving));
        let enclosing = enclosing([from, to], middle, [leaving, arriving]);
        if is_far(&enclosing) || from == 0.0 && rises(&enclosing) {
            return false;
        }
        let quartic = |part: f64| {
            let (rest, chord) = (1.0 - part, to - from);
            let bend = (rest - part) * chord - rest * leaving + part * arriving;
            rest * from + part * to - part * rest * bend + bulge * (part * rest) * (part * rest)
        };
        let inside = (1..SAMPLES).map(|sample| quartic(sample as f64 / SAMPLES as f64));
        let ends = (f64::INFINITY, larger(from, to));
        let (lowest, highest) = inside.fold(ends, |(low, high), value| (smaller(low, value), larger(high, value)));
        let bottom = smaller(lowest, smaller(from, to));
        highest > noise && lowest < NEAR * (highest - bottom)
    }

    /// The course of the suspects by the dense output; the other guards are clear.
    fn courses(&self, step: &mut dyn Guarded, suspects: &[bool]) -> Vec<Course> {
        let mut values = vec![self.start.value.clone()];
        values.extend((1..PARTS).map(|part| step.dense_guards(part as f64 / PARTS as f64)));
        values.push(self.end.value.clone());
        let of = |k: usize| if suspects[k] { self.course(step, k, &values) } else { Course::Clear };
        (0..suspects.len()).map(of).collect()
    }

    /// The course of guard `k`, whose values at the parts of the step are known.
    fn course(&self, step: &mut dyn Guarded, k: usize, values: &[Vec<f64>]) -> Course {
        let negative = step.negative()[k];
        let clearances: Vec<f64> = values.iter().map(|value| clearance(value[k], negative)).collect();
        let at = |part: usize| (part as f64 / PARTS as f64, clearances[part]);
        let wrong = (1..=PARTS).map(at).find(|place| self.is_wrong(step, k, *place));
        // Every minimum in front of that may reach the wrong side between two parts.
        let falls = |reading: &Reading| clearance(reading.slope[k], negative) < 0.0;
        let is_minimum = |part: &usize| {
            let is_below = |other: usize| clearances[*part] <= clearances[other];
            match *part {
                0 => falls(&self.start) && is_below(1),
                PARTS => !falls(&self.end) && is_below(PARTS - 1),
                inside => is_below(inside - 1) && is_below(inside + 1),
            }
        };
        let is_in_front = |part: &usize| wrong.is_none_or(|wrong| at(*part).0 < wrong.0);
        let mut minima = (0..=PARTS).filter(is_in_front).filter(is_minimum);
        let dip = minima.find_map(|part| {
            let lowest = self.lowest(step, k, at(part).0);
            self.is_wrong(step, k, lowest).then_some(lowest)
        });
        let Some(wrong) = dip.or(wrong) else { return Course::Clear };
        let mut in_front = (0..PARTS).rev().map(at).filter(|place| place.0 < wrong.0);
        let right = in_front.find(|place| self.is_right(step, k, *place));
        match right {
            Some(right) => Course::Crosses(Bracket { right, wrong }),
            None => self.bracket_near_start(step, k, wrong),
        }
    }

    /// Whether the clearance of guard `k` at this part of the step is negative by more than rounding.
    fn is_wrong(&self, step: &mut dyn Guarded, k: usize, (part, clearance): (f64, f64)) -> bool {
        clearance < 0.0 && clearance < -self.noise_inside(step, k, part)
    }

    /// Whether it is positive by more than rounding.
    fn is_right(&self, step: &mut dyn Guarded, k: usize, (part, clearance): (f64, f64)) -> bool {
        clearance > 0.0 && clearance > self.noise_inside(step, k, part)
    }

    /// The rounding error of guard `k` at this part of the step, by the dense output.
    pub(super) fn noise_inside(&self, step: &mut dyn Guarded, k: usize, part: f64) -> f64 {
        if part == 0.0 {
            return self.start.noise[k];
        }
        if part == 1.0 {
            return self.end.noise[k];
        }
        let (t, x) = step.inside(part);
        let value = step.guards(t, &x);
        self.noise(step, t, &x, &value)[k]
    }

    /// The lowest clearance of guard `k` near the part `near` of the step; stops on the wrong side.
    fn lowest(&self, step: &mut dyn Guarded, k: usize, near: f64) -> (f64, f64) {
        let width = 1.0 / PARTS as f64;
        let (low, high) = ((near - width).max(0.0), (near + width).min(1.0));
        let enough = -self.noise_inside(step, k, near);
        minimum(low, high, enough, |part| clearance(step.dense_guards(part)[k], step.negative()[k]))
    }

    /// The course of guard `k` that starts at zero and is on the wrong side at `wrong`.
    fn bracket_near_start(&self, step: &mut dyn Guarded, k: usize, mut wrong: (f64, f64)) -> Course {
        for _ in 0..HALVINGS {
            let part = 0.5 * wrong.0;
            let near = clearance(step.dense_guards(part)[k], step.negative()[k]);
            if self.is_right(step, k, (part, near)) {
                return Course::Crosses(Bracket { right: (part, near), wrong });
            }
            wrong = (part, near);
        }
        Course::WrongFromStart
    }
}

#[cfg(test)]
mod tests {
    use super::{enclosing, rises};

    #[test]
    fn a_guard_that_starts_at_zero_is_clear_where_it_rises_for_good() {
        // Values at the end and in the middle, changes in a step at the rates of both ends.
        let of = |guard: fn(f64) -> f64, slope: fn(f64) -> f64| {
            rises(&enclosing([0.0, guard(1.0)], guard(0.5), [slope(0.0), slope(1.0)]))
        };
        assert!(of(|s| s, |_| 1.0));
        assert!(of(|s| s + s * s, |s| 1.0 + 2.0 * s));
        // It returns to zero, dips below it, touches it.
        assert!(!of(|s| s * (1.0 - s), |s| 1.0 - 2.0 * s));
        assert!(!of(|s| s * (s - 0.4) * (s - 0.6), |s| 3.0 * s * s - 2.0 * s + 0.24));
        assert!(!of(|s| s * (s - 0.5) * (s - 0.5), |s| 3.0 * s * s - 2.0 * s + 0.25));
        // At rest and falling.
        assert!(!of(|_| 0.0, |_| 0.0));
        assert!(!of(|s| -s, |_| -1.0));
    }
}
