//! Guards during a step: whether one changes its sign, and where.
//!
//! In: the guards at the substeps of the finest midpoint rule, roughly right, and at the step's ends, as exact as the
//! step. Out: that all keep their sides, that the step is too long to tell, or the first crossing; then the step that
//! ends there. A guard that comes near to zero and turns back inside the step calls for a shorter step, which tells.

use super::Run;
use crate::model::scalar::Scalar;

/// A minimum inside the step below this part of the guard's variation is looked at closely.
const NEAR: f64 = 0.25;

/// What is known of the guards during the last step tried.
#[derive(Debug)]
pub struct GuardMonitor<S> {
    tolerance: f64,
    /// The size of the step, s.
    h: S,
    /// At the start, at the substeps and at the end.
    values: Vec<Vec<S>>,
    /// The largest magnitude of each guard so far.
    largest: Vec<f64>,
}

/// A foreseen change of sign.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<S> {
    switch: usize,
    /// The step that ends there, s, by interpolation, and the clearance's slope, per s.
    guess: S,
    slope: S,
}

/// How the guards run in a step.
#[derive(Clone, Copy, Debug)]
pub enum Course<S> {
    /// All keep to their sides.
    Clear,
    /// A shorter step is needed to tell.
    Unclear,
    /// A guard leaves its side right at the start.
    WrongFromStart,
    /// The first one to cross.
    Crosses(Crossing<S>),
}

impl<S: Scalar> GuardMonitor<S> {
    /// Of so many switches.
    pub fn new(tolerance: f64, switches: usize) -> Self {
        Self { tolerance, h: S::from_f64(0.0), values: Vec::new(), largest: vec![0.0; switches] }
    }

    /// Begins a step of size `h` (s).
    pub fn begin_step(&mut self, value: Vec<S>, h: S) {
        self.h = h;
        self.values.clear();
        self.end_step(value);
    }

    /// The guards at a substep.
    pub fn pass(&mut self, value: Vec<S>) {
        self.values.push(value);
    }

    /// The guards at an end of the step.
    pub fn end_step(&mut self, value: Vec<S>) {
        for (largest, value) in self.largest.iter_mut().zip(&value) {
            *largest = largest.max(value.to_f64().abs());
        }
        self.values.push(value);
    }

    /// How far guard `k` may be on the wrong side by the errors of the steps.
    pub fn noise(&self, k: usize) -> f64 {
        self.tolerance * self.largest[k]
    }

    /// The guards at the end of the step.
    pub fn end(&self) -> &[S] {
        &self.values[self.values.len() - 1]
    }

    /// The switches whose guards are on the wrong side at the end of the step.
    pub fn wrong(&self, negative: &[bool]) -> Vec<bool> {
        let is_wrong = |(k, (&value, &negative))| clearance::<S>(value, negative).to_f64() < -self.noise(k);
        self.end().iter().zip(negative).enumerate().map(is_wrong).collect()
    }

    /// How the guards have run under the branches `negative`.
    pub fn course(&self, negative: &[bool]) -> Course<S> {
        let courses: Vec<Course<S>> =
            negative.iter().enumerate().map(|(k, &negative)| self.course_of(k, negative)).collect();
        if courses.iter().any(|course| matches!(course, Course::Unclear)) {
            return Course::Unclear;
        }
        if courses.iter().any(|course| matches!(course, Course::WrongFromStart)) {
            return Course::WrongFromStart;
        }
        let crossings = courses.iter().filter_map(|course| match course {
            Course::Crosses(crossing) => Some(*crossing),
            _ => None,
        });
        let first = crossings.reduce(|first, other| if other.guess < first.guess { other } else { first });
        first.map_or(Course::Clear, Course::Crosses)
    }

    fn course_of(&self, k: usize, negative: bool) -> Course<S> {
        let noise = self.noise(k);
        let at = |place: usize| clearance(self.values[place][k], negative);
        let last = self.values.len() - 1;
        let clearances: Vec<f64> = (0..=last).map(|place| at(place).to_f64()).collect();
        let wrong = (1..=last).find(|place| clearances[*place] < -noise);
        let before = wrong.map_or(last, |wrong| wrong - 1);
        let (low, high) = clearances.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (if *value < low { *value } else { low }, if *value > high { *value } else { high })
        });
        let is_dip = |place: usize| {
            let value = clearances[place];
            value <= clearances[place - 1] && value <= clearances[place + 1] && value < NEAR * (high - low)
        };
        if (1..before).any(is_dip) {
            return Course::Unclear;
        }
        let Some(wrong) = wrong else { return Course::Clear };
        let comes_back = clearances[wrong..].iter().any(|value| *value >= -noise || value.is_nan());
        if !comes_back && clearances[..wrong].iter().all(|value| *value <= noise) {
            return Course::WrongFromStart;
        }
        if comes_back || clearances[before] <= noise {
            return Course::Unclear;
        }
        let part = self.h / S::from_f64(last as f64);
        let slope = (at(wrong) - at(before)) / part;
        Course::Crosses(Crossing { switch: k, guess: S::from_f64(before as f64) * part - at(before) / slope, slope })
    }
}

/// The clearance of a guard: positive on the side of its branch.
pub fn clearance<S: Scalar>(value: S, negative: bool) -> S {
    if negative { -value } else { value }
}

impl<S: Scalar<Switch = bool>> Run<'_, S> {
    /// Shortens the step of size `h` (s) to `crossing`, or to one that turns out to be earlier; gives the step, which
    /// is the last one tried, and the switches whose guards are at zero there.
    pub(super) fn locate(&mut self, mut h: S, mut crossing: Crossing<S>) -> (S, Vec<bool>) {
        let switches = self.negative.len();
        for _ in 0..switches {
            let (zero, slope) = self.zero(h, crossing);
            h = zero;
            let wrong = self.monitor.wrong(&self.negative);
            let Some(switch) = (0..switches).find(|k| *k != crossing.switch && wrong[*k]) else { break };
            crossing = Crossing { switch, guess: S::from_f64(0.5) * h, slope };
        }
        let value = self.monitor.end();
        let is_at_zero = |k: usize| k == crossing.switch || value[k].to_f64().abs() <= self.monitor.noise(k);
        (h, (0..switches).map(is_at_zero).collect())
    }

    /// The step of at most `h` (s) at whose end the guard of `crossing` vanishes to rounding, tried last, and the slope
    /// there: Newton's method with the slope of the last two steps tried, inside a bracket that is halved where that
    /// fails.
    fn zero(&mut self, h: S, crossing: Crossing<S>) -> (S, S) {
        // More than the bits of any scalar here.
        const STEPS: usize = 400;
        const STALLS: usize = 3;
        let Crossing { switch, guess, mut slope } = crossing;
        let half = S::from_f64(0.5);
        let (mut right, mut wrong) = (S::from_f64(0.0), h);
        let mut at = if guess > right && guess < wrong { guess } else { half * h };
        let mut value = self.clearance_after(at, switch);
        let (mut best, mut least, mut stalls) = (at, value.abs(), 0);
        for step in 0..STEPS {
            let is_done = stalls >= STALLS && least.to_f64() <= self.monitor.noise(switch);
            if value.to_f64() == 0.0 || is_done {
                break;
            }
            if value.to_f64() > 0.0 {
                right = at;
            } else {
                wrong = at;
            }
            let newton = at - value / slope;
            let is_inside = newton > right && newton < wrong && step < STEPS / 10;
            let next = if is_inside { newton } else { half * (right + wrong) };
            if !(next > right && next < wrong) {
                break;
            }
            let next_value = self.clearance_after(next, switch);
            slope = (next_value - value) / (next - at);
            (at, value) = (next, next_value);
            if value.abs() < least {
                (best, least, stalls) = (at, value.abs(), 0);
            } else {
                stalls += 1;
            }
        }
        // At a jump the end on the wrong side.
        let end = if least.to_f64() <= self.monitor.noise(switch) { best } else { wrong };
        self.clearance_after(end, switch);
        (end, slope)
    }

    fn clearance_after(&mut self, h: S, switch: usize) -> S {
        self.rejected += 1;
        self.attempt(h);
        clearance(self.monitor.end()[switch], self.negative[switch])
    }
}
