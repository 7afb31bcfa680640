//! One step of a system by a method: the attempt, the projection, the rate at its end and the states in between.

use alloc::vec;
use alloc::vec::Vec;

use nalgebra::DVector;

use crate::model::dynamics::Dynamics;
use crate::model::origin::Origin;
use crate::solve::integrator::{Flow, Method, Point, PointRef, Scale, first_not_finite, is_finite};
use crate::solve::statistics::Statistics;

/// The norm of a projection above which it is looked at more closely. It is below 2 where a step errs by as much as is
/// allowed.
pub(crate) const MOVED: f64 = 10.0;
/// How far a projection may move a state, in its unit or in parts of it, for the next one, whose change is the square,
/// to be lost in rounding.
const SETTLED: f64 = 1e-8;
/// What rounding may leave of a projection, beside what another rounding of the same state changes.
const ROUNDING: f64 = 10.0;

/// A system, a method and the step between two points that is being made.
pub(crate) struct Stepper<'a> {
    pub system: &'a dyn Dynamics,
    pub method: &'a mut dyn Method,
    pub scale: Scale,
    /// The branches that hold during the step.
    pub negative: Vec<bool>,
    pub statistics: Statistics,
    /// Where the step starts; the rate is known.
    pub start: Point,
    /// Where the last attempt led.
    pub end: Point,
    /// The size of the last attempt, s. More precise than the difference of the two times.
    pub h: f64,
    dense_is_ready: bool,
    samples_are_ready: bool,
    /// Whether joints may be rigid.
    is_held: bool,
    /// What memories keep, which a projection moves far.
    memories: Vec<usize>,
    /// A state before it is projected.
    before: DVector<f64>,
}

impl<'a> Stepper<'a> {
    pub fn new(system: &'a dyn Dynamics, method: &'a mut dyn Method, scale: Scale, start: Point) -> Self {
        method.fit(system.states());
        Self {
            system,
            method,
            scale,
            negative: vec![false; system.switches()],
            statistics: Statistics::default(),
            before: start.x.clone(),
            end: start.clone(),
            start,
            h: 0.0,
            dense_is_ready: false,
            samples_are_ready: false,
            is_held: system.held().is_some(),
            memories: system.memories(),
        }
    }

    /// The method, the flow of the present branches, the start, the end and the scale, apart from each other.
    pub fn split(&mut self) -> (&mut dyn Method, Flow<'_>, &Point, &mut Point, &Scale) {
        let flow = Flow::new(self.system, &self.negative, &mut self.statistics);
        (self.method, flow, &self.start, &mut self.end, &self.scale)
    }

    /// Tries a step of size `h` (s); gives its error norm.
    pub fn attempt(&mut self, h: f64) -> f64 {
        self.arrived(h);
        let (method, flow, start, end, scale) = self.split();
        end.t = start.t + h;
        let (start, end) = (start.borrowed(), end.x.as_mut_slice());
        method.attempt(&flow, start, h, scale, end)
    }

    /// Takes over an attempt of size `h` (s) to `end`, which was made elsewhere. Its method is to know its stages.
    pub fn take_over(&mut self, h: f64, end: PointRef<'_>) {
        self.end.become_that(end);
        self.arrived(h);
    }

    /// The same where the end is written already.
    pub fn arrived(&mut self, h: f64) {
        self.h = h;
        (self.dense_is_ready, self.samples_are_ready) = (false, false);
    }

    /// The norm of what the projection leaves of the last attempt's error, at most 1 where that is rounding; none where
    /// the method does not say.
    pub fn error_after_projection(&mut self) -> Option<f64> {
        let (system, negative, h) = (self.system, self.negative.clone(), self.h);
        let (method, flow, start, end, scale) = self.split();
        // Newton's steps: what the second leaves is rounding.
        let project = |x: &mut [f64]| {
            system.project(end.t, &negative, x);
            system.project(end.t, &negative, x);
        };
        let error = method.error_after(&flow, start.borrowed(), h, scale, end.x.as_slice(), &project)?;
        let mut reached = end.x.clone();
        project(reached.as_mut_slice());
        let rounding = self.rounding_of_projection(&reached);
        Some(if error <= ROUNDING * rounding { error.min(1.0) } else { error })
    }

    /// Moves the end of the step back onto the invariants. Gives the norm of what that changes where joints may be
    /// rigid: it is of the size of the error, unless the step has led to another branch of the motion.
    pub fn project(&mut self) -> f64 {
        if !self.is_held {
            self.system.project(self.end.t, &self.negative, self.end.x.as_mut_slice());
            return 0.0;
        }
        let Self { system, scale, negative, end, before, memories, .. } = self;
        before.copy_from(&end.x);
        system.project(end.t, negative, end.x.as_mut_slice());
        moved(scale, memories, before.as_slice(), end.x.as_slice())
    }

    /// The same until it moves no more. What one of Newton's steps leaves is below the tolerances, but not below what a
    /// guard at zero is known by: another projection would move a state at an event to either side of it.
    pub fn settle(&mut self) {
        let moved = self.project();
        self.settle_further(moved);
    }

    /// The same where one projection has been made, with this norm of what it has changed.
    pub fn settle_further(&mut self, mut moved: f64) {
        const MORE: usize = 3;
        for _ in 0..MORE {
            if moved * self.scale.coarsest <= SETTLED {
                return;
            }
            moved = self.project();
        }
    }

    /// Lets what memories keep follow at the start of the next step, where these switches change: also where the branch
    /// in which they follow holds at that instant only, because what they give leads out of it.
    pub fn remember(&mut self, switches: &[bool]) {
        if self.memories.is_empty() {
            return;
        }
        let changed: Vec<bool> =
            self.negative.iter().zip(switches).map(|(negative, changes)| negative != changes).collect();
        self.system.project(self.start.t, &changed, self.start.x.as_mut_slice());
    }

    /// Projects any state, at time `t` (s); gives the norm of what that changes, as [`Stepper::project`].
    pub fn project_state(&mut self, t: f64, x: &mut [f64]) -> f64 {
        if !self.is_held {
            self.system.project(t, &self.negative, x);
            return 0.0;
        }
        self.before.as_mut_slice().copy_from_slice(x);
        self.system.project(t, &self.negative, x);
        moved(&self.scale, &self.memories, self.before.as_slice(), x)
    }

    /// The norm of what a projection has changed where joints may be rigid, else 0.
    #[cfg(feature = "std")]
    pub fn moved(&self, before: &[f64], after: &[f64]) -> f64 {
        if self.is_held { moved(&self.scale, &self.memories, before, after) } else { 0.0 }
    }

    /// The norm of what the projection makes of the rounding of a state `x` at the end of the step, which grows into a
    /// singular pose. It is the difference to the same state rounded otherwise: what is left of its own rounding may be
    /// nothing by chance.
    pub fn rounding_of_projection(&self, x: &DVector<f64>) -> f64 {
        let [projected, otherwise] = [x.clone(), rounded_otherwise(x)].map(|mut x| {
            self.system.project(self.end.t, &self.negative, x.as_mut_slice());
            x
        });
        self.scale.norm((otherwise - &projected).as_slice(), projected.as_slice())
    }

    /// The rate at time `t` (s) and state `x` in the branches of the step.
    pub fn rate(&mut self, t: f64, x: &[f64]) -> DVector<f64> {
        let mut rate = DVector::zeros(x.len());
        self.statistics.rate_evaluations += 1;
        self.system.rate(t, x, &self.negative, rate.as_mut_slice());
        rate
    }

    /// Evaluates the rate at the end of the step.
    pub fn evaluate_end(&mut self) {
        let (_, flow, _, end, _) = self.split();
        let Point { t, x, rate } = end;
        flow.rate(*t, x.as_slice(), rate.as_mut_slice());
    }

    /// Evaluates the rate at the start of the step, whose branches may be new.
    pub fn evaluate_start(&mut self) {
        self.method.restart();
        self.statistics.rate_evaluations += 1;
        let Point { t, x, rate } = &mut self.start;
        self.system.rate(*t, x.as_slice(), &self.negative, rate.as_mut_slice());
    }

    /// The first state whose rate has a derivative at the start of the step that is not finite, and that derivative;
    /// none where no derivative has been asked for.
    pub fn faulty_derivative(&self) -> Option<(usize, f64)> {
        let mut statistics = self.statistics;
        if statistics.jacobian_evaluations == 0 {
            return None;
        }
        let states = self.system.states();
        let flow = Flow::new(self.system, &self.negative, &mut statistics);
        let sparsity = flow.sparsity();
        let (mut entries, mut slope) = (vec![0.0; sparsity.len(states)], vec![0.0; states]);
        flow.jacobian(self.start.t, self.start.x.as_slice(), &mut entries, &mut slope);
        let is_faulty = |(_, value): &(usize, f64)| !value.is_finite();
        let state = |k: usize| {
            let (row, column) = sparsity.place(k, states);
            if row < states { Some(row) } else { Some(column).filter(|&column| column < states) }
        };
        let mut faulty = entries.into_iter().enumerate().filter(is_faulty);
        let entry = faulty.find_map(|(k, value)| Some((state(k)?, value)));
        entry.or_else(|| first_not_finite(&slope))
    }

    /// The input or element that gives a number that is not finite at the start of the last attempt or on the way to
    /// its end, or for `at_least` (s), as far as the system can tell: the way is that of the rate at the start. Of a
    /// step that rounding has ended the way is followed further, since a stage may have been anywhere near it.
    pub fn origin(&self, at_least: f64) -> Option<Origin> {
        const PARTS: u32 = 16;
        const FURTHER: [f64; 7] = [8.0, 64.0, 512.0, 4096.0, 32_768.0, 262_144.0, 2_097_152.0];
        let Point { t, x, rate } = &self.start;
        let way = self.h.max(at_least);
        let inside = (1..=PARTS).map(|part| f64::from(part) / f64::from(PARTS));
        let ahead = inside.chain(FURTHER).map(|part| way * part);
        let on_the_way = ahead.map(|ahead| (t + ahead, x + rate * ahead));
        let mut points = core::iter::once((*t, x.clone())).chain(on_the_way).chain([(self.end.t, self.end.x.clone())]);
        let not_finite = |t: f64, x: &[f64]| self.system.not_finite(t, x, &self.negative);
        points.find_map(|(t, x)| is_finite(x.as_slice()).then(|| not_finite(t, x.as_slice())).flatten())
    }

    /// The end of the step becomes the start of the next one.
    pub fn advance(&mut self) {
        self.method.advance();
        self.start.become_that(self.end.borrowed());
    }

    /// Writes the state at the part `theta` of the step, not projected, into `x`. The rates at both ends must be known.
    /// One polynomial of the whole step, by which events are found.
    pub fn dense(&mut self, theta: f64, x: &mut [f64]) {
        self.prepare_dense();
        self.method.dense(self.start.borrowed(), self.h, self.end.borrowed(), theta, x);
    }

    /// The same as exact as the tolerances ask, for a sample.
    pub fn sample(&mut self, theta: f64, x: &mut [f64]) {
        self.prepare_dense();
        if !self.samples_are_ready {
            self.prepare(|method, flow, start, h, end, scale| method.prepare_samples(flow, start, h, end, scale));
            self.samples_are_ready = true;
        }
        self.method.sample(self.start.borrowed(), self.h, self.end.borrowed(), theta, x);
    }

    /// The same at time `t` (s), projected so many times at most. The dense output errs more than the step, and most
    /// near a singular pose.
    pub fn projected_sample(&mut self, theta: f64, t: f64, most: usize, x: &mut [f64]) {
        self.sample(theta, x);
        let _ = (0..most).find(|_| self.project_state(t, x) <= MOVED);
    }

    fn prepare_dense(&mut self) {
        if !self.dense_is_ready {
            self.prepare(|method, flow, start, h, end, _| method.prepare_dense(flow, start, h, end));
            self.dense_is_ready = true;
        }
    }

    /// Prepares states inside of the step, whose rates are counted.
    fn prepare(&mut self, by: impl FnOnce(&mut dyn Method, &Flow<'_>, PointRef<'_>, f64, PointRef<'_>, &Scale)) {
        let (before, h) = (self.statistics.rate_evaluations, self.h);
        let (method, flow, start, end, scale) = self.split();
        by(method, &flow, start.borrowed(), h, end.borrowed(), scale);
        self.statistics.dense_evaluations += self.statistics.rate_evaluations - before;
    }
}

/// The norm of what a projection has changed, but for what memories keep.
fn moved(scale: &Scale, memories: &[usize], before: &[f64], after: &[f64]) -> f64 {
    scale.norm_of(after, |i| if memories.contains(&i) { 0.0 } else { after[i] - before[i] })
}

/// A state with each number as the next rounding would have it, up or down.
pub(crate) fn rounded_otherwise(x: &DVector<f64>) -> DVector<f64> {
    let otherwise = |i: usize| if i.count_ones().is_multiple_of(2) { 1.0 + f64::EPSILON } else { 1.0 - f64::EPSILON };
    DVector::from_fn(x.len(), |i, _| x[i] * otherwise(i))
}
