//! The step-size controller: which step is tried next.
//!
//! In: the error norms of the steps tried, the instants at which the system has steps end. Out: the end of the next
//! step; one that such an instant cuts short leaves the size of the step after it as it was.
//!
//! Source: the step-size control of Hairer's `dop853.f` with its estimate of the first step (function HINIT).
//! Stabilised control: the proportional-integral one of K. Gustafsson (Hairer, Wanner II, section IV.2), with beta =
//! 0.4 / order, without which a tenth of all steps is rejected where stability limits them. Predictive control:
//! Gustafsson's for implicit methods, as in Hairer's `radau5.f` (Hairer, Wanner II, section IV.8, equation (8.25)).

use nalgebra::DVector;

use super::settings::{Settings, Span};
use crate::model::scalar::Scalar;
use crate::solve::integrator::{Flow, Point, Scale, StepControl, smaller};

/// The part of the step that would just satisfy the tolerances.
const SAFETY: f64 = 0.9;
/// Limits of the ratio of a step to the one before.
const RATIO: [f64; 2] = [0.333, 6.0];
/// The ratio after an attempt that gave no number.
const NO_NUMBER: f64 = 0.1;
/// The ratio after an iteration that did not converge.
const HALF: f64 = 0.5;
/// A predictive control keeps a step that would grow by less than this ratio.
const HOLD: f64 = 1.2;
/// The part of a stabilised control that looks at the step before.
const DAMPING: f64 = 0.4;
/// The least logarithm of an error norm that is taken for that of the step before, which is that of 0.01.
const LEAST: f64 = -2.0 * core::f64::consts::LN_10;
/// A step that would leave less than this part of itself to the end, or to a break, is stretched to it.
pub(super) const STRETCH: f64 = 0.01;
/// A part of a fixed step that rounding may make: such a sliver is no step.
const SLIVER: f64 = 1e-9;

/// What the size of the next step follows from: the logarithm of an error norm, and the exponential of
/// [`StepSizeController::exponent`] of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judgement {
    pub logarithm: f64,
    pub factor: f64,
}

impl Judgement {
    /// That the next step is as long.
    pub const NONE: Self = Self { logarithm: 0.0, factor: 1.0 };
}

/// What a stabilised control goes on from.
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept {
    /// The step to try, s.
    pub step: f64,
    /// The last accepted step, s, and the logarithm of its error norm, where there is one.
    pub accepted: Option<(f64, f64)>,
    /// Whether the last attempt was rejected.
    pub is_rejected: bool,
}

/// Chooses steps.
#[derive(Clone, Debug)]
pub(super) struct StepSizeController {
    control: StepControl,
    span: Span,
    largest: f64,
    /// The step to try, s.
    step: f64,
    /// Whether the last attempt was rejected.
    rejected: bool,
    /// The last accepted step, s, and the logarithm of its error norm.
    accepted: Option<(f64, f64)>,
    /// Fixed steps end at t0 + grid * step.
    grid: u64,
    /// The longest of the next fixed step after one that was rejected, s.
    short: f64,
    /// A fixed step that would be shorter than this is none, s: 0 where the system has no breaks.
    sliver: f64,
    /// Whether a break has cut the step that is tried.
    is_cut: bool,
    /// Whether the run goes on from the end of the span, which then is a break.
    goes_on: bool,
}

impl StepSizeController {
    pub fn new(control: StepControl, span: Span, settings: &Settings, has_breaks: bool) -> Self {
        let asked = match control {
            StepControl::Fixed { step } => step,
            _ => settings.first_step.unwrap_or(span.t_end - span.t0),
        };
        let largest = settings.largest_step;
        Self {
            control,
            span,
            largest,
            step: asked.min(largest),
            rejected: false,
            accepted: None,
            grid: 1,
            short: f64::INFINITY,
            sliver: if has_breaks { SLIVER * asked.min(largest) } else { 0.0 },
            is_cut: false,
            goes_on: false,
        }
    }

    /// The next piece of a run that goes on from its end.
    pub fn go_on(&mut self, span: Span) {
        (self.span, self.grid, self.goes_on) = (span, 1, true);
    }

    /// The size of the next step if nothing is in its way, s.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The same, but not longer than the run, s: a step that was asked for may be, or be infinite.
    pub fn reach(&self) -> f64 {
        self.step.min(self.span.length())
    }

    /// What the next steps follow from, of a stabilised control without breaks ahead.
    #[cfg(feature = "std")]
    pub fn kept(&self) -> Kept {
        Kept { step: self.step, accepted: self.accepted, is_rejected: self.rejected }
    }

    /// Goes on from there: what is accepted stays where nothing else was.
    #[cfg(feature = "std")]
    pub fn keep(&mut self, Kept { step, accepted, is_rejected }: Kept) {
        (self.step, self.rejected) = (step, is_rejected);
        self.accepted = accepted.or(self.accepted);
    }

    /// Whether steps are chosen by the error.
    pub fn is_adaptive(&self) -> bool {
        self.control.order().is_some()
    }

    /// Steps are chosen as the method wants it from now on.
    pub fn follow(&mut self, control: StepControl) {
        self.control = control;
    }

    /// Takes an estimate of the first step, s; one that rounding does not allow is raised, and left to the error
    /// estimate.
    pub fn begin(&mut self, step: f64) {
        self.step = step.max(2.0 * self.least(self.span.t0)).min(self.largest);
    }

    /// The end of the next step from `t` (s), not beyond `next_break` (s), after which the system follows another law.
    pub fn next_end(&mut self, t: f64, next_break: f64) -> f64 {
        let t_end = self.span.t_end;
        if self.is_adaptive() {
            let goal = if next_break < t_end { next_break } else { t_end };
            let stretched = t + (1.0 + STRETCH) * self.step >= goal;
            let reaches = stretched && goal - t <= (1.0 + 1e-9) * self.largest;
            // Of a run that goes on all pieces end like that: two even steps, not a whole one and a rest that says
            // little of the next.
            let halves = !reaches && self.goes_on && goal - t < 2.0 * self.step;
            let end = if reaches { goal } else { t + if halves { 0.5 * (goal - t) } else { self.step } };
            self.is_cut = halves || reaches && (next_break < t_end || self.goes_on) && goal - t < self.step;
            return end;
        }
        let end_of = |grid: u64| self.span.t0 + grid as f64 * self.step;
        while end_of(self.grid) <= t + self.sliver {
            self.grid += 1;
        }
        // A sliver that rounding leaves at the end belongs to the last step; a billionth of the step is no error.
        let end = if end_of(self.grid) >= t_end - SLIVER * self.step { t_end } else { end_of(self.grid) };
        let end = if next_break < t_end && next_break <= end + self.sliver { next_break } else { end };
        end.min(t + self.short)
    }

    /// The step `h` (s) to `t` (s) satisfied the tolerances with the error norm `error`. The next one is at least tried
    /// with a size that rounding allows.
    pub fn accept(&mut self, t: f64, h: f64, error: f64) {
        self.accept_by(t, h, if self.is_adaptive() { self.judge(error, true) } else { Judgement::NONE });
    }

    /// The same where the error has been judged.
    pub fn accept_by(&mut self, t: f64, h: f64, judgement: Judgement) {
        if self.is_adaptive() {
            let next = if self.is_cut { self.after_cut(h, judgement) } else { h * self.ratio_after(h, judgement) };
            let longest = if self.is_cut { self.step } else { h };
            let next = if self.rejected { next.min(longest) } else { next };
            self.step = within(next, t, self.length(), self.largest);
        }
        self.short = f64::INFINITY;
        self.rejected = false;
    }

    /// The step after one of size `h` (s) that was cut short: as long as that was to be, unless its error says
    /// otherwise.
    fn after_cut(&self, h: f64, Judgement { factor, .. }: Judgement) -> f64 {
        (h * bounded(factor)).max(self.step.min(h * SAFETY * factor))
    }

    /// The step `h` (s) did not satisfy the tolerances; `error` is not a number where the step gave none, infinite
    /// where an iteration did not converge.
    pub fn reject(&mut self, h: f64, error: f64) {
        let ratio = match error {
            _ if error.is_nan() => NO_NUMBER,
            f64::INFINITY => HALF,
            _ if self.is_adaptive() => shortening(self.judge(error, false).factor),
            _ => SAFETY,
        };
        self.shorten(h, ratio);
    }

    /// The same where the error has been judged, and is finite.
    #[cfg(feature = "std")]
    pub fn reject_by(&mut self, h: f64, Judgement { factor, .. }: Judgement) {
        self.shorten(h, shortening(factor));
    }

    fn shorten(&mut self, h: f64, ratio: f64) {
        self.rejected = true;
        if self.is_adaptive() {
            self.step = h * ratio;
        } else {
            self.short = h * ratio;
        }
    }

    /// Whether the step to try from `t` (s) is too small to be told apart from rounding.
    pub fn is_lost(&self, t: f64) -> bool {
        self.step.min(self.short) <= self.least(t)
    }

    /// The largest step from `t` (s) that is lost in rounding, s.
    pub fn least(&self, t: f64) -> f64 {
        least(t, self.length())
    }

    fn length(&self) -> f64 {
        self.span.t_end - self.span.t0
    }

    fn judge(&self, error: f64, is_accepted: bool) -> Judgement {
        let logarithm = libm::log(error);
        Judgement { logarithm, factor: libm::exp(self.exponent(logarithm, is_accepted)) }
    }

    /// The exponent of the factor in the size of the next step, after an attempt whose error norm has this logarithm:
    /// an exponential, where powers of the norms of this step and the one before would take a tenth of the hacksaw's
    /// time.
    pub fn exponent(&self, logarithm: f64, is_accepted: bool) -> f64 {
        let before = self.accepted.map_or(0.0, |(_, before)| before);
        let combined = match self.control {
            StepControl::Stabilised { .. } if is_accepted && !self.is_cut => stabilised(logarithm, before),
            _ => logarithm,
        };
        -combined / self.control.order().unwrap_or(1.0)
    }

    /// The ratio after the accepted step `h` (s).
    fn ratio_after(&mut self, h: f64, Judgement { logarithm, factor }: Judgement) -> f64 {
        let ratio = bounded(factor);
        match self.control {
            StepControl::Fixed { .. } | StepControl::Adaptive { .. } => ratio,
            StepControl::Stabilised { .. } => {
                self.accept_norm(h, logarithm);
                ratio
            }
            StepControl::Predictive { .. } => {
                let ratio = match self.accept_norm(h, logarithm) {
                    Some((h_before, before)) => {
                        let foreseen = libm::exp(self.exponent(2.0 * logarithm - before, true));
                        ratio.min(h / h_before * bounded(foreseen))
                    }
                    None => ratio,
                };
                if (1.0..=HOLD).contains(&ratio) { 1.0 } else { ratio.max(RATIO[0]) }
            }
        }
    }

    /// Notes the step `h` (s) and the logarithm of its error norm; gives those of the step before.
    fn accept_norm(&mut self, h: f64, logarithm: f64) -> Option<(f64, f64)> {
        self.accepted.replace((h, noted(logarithm)))
    }
}

/// The ratio of the next step to this one by this factor.
#[inline(always)]
pub(super) fn bounded<S: Scalar>(factor: S) -> S {
    smaller(factor.alike(RATIO[1]), factor.alike(RATIO[0]).larger(factor.times(SAFETY)))
}

/// The same after a rejected one.
#[inline(always)]
pub(super) fn shortening<S: Scalar>(factor: S) -> S {
    smaller(factor.alike(SAFETY), bounded(factor))
}

/// The combination of the logarithms of the error norms of an accepted step and of the one before, from which a
/// stabilised control judges.
#[inline(always)]
pub(super) fn stabilised<S: Scalar>(logarithm: S, before: S) -> S {
    logarithm.times(1.0 - 0.75 * DAMPING) - before.times(DAMPING)
}

/// The largest step from `t` (s) that is lost in rounding in a run of this length (s), s.
#[inline(always)]
pub(super) fn least<S: Scalar>(t: S, length: f64) -> S {
    t.alike(f64::EPSILON * length).larger(t.abs()).times(16.0 * f64::EPSILON)
}

/// The next step (s) from `t` (s), one that rounding allows and not longer than `largest` (s).
#[inline(always)]
pub(super) fn within<S: Scalar>(next: S, t: S, length: f64, largest: f64) -> S {
    smaller(t.alike(largest), least(t, length).times(2.0).larger(next))
}

/// The logarithm of an error norm that is taken for that of the step before.
#[inline(always)]
pub(super) fn noted<S: Scalar>(logarithm: S) -> S {
    logarithm.larger(logarithm.alike(LEAST))
}

/// An estimate of a first step from `start`, s, at most `longest`. Takes one rate.
///
/// HINIT takes (0.01 / d)^(1 / order), d the larger one of the scaled first and second derivatives, the one in 1/s, the
/// other in 1/s^2: of a machine whose time is not about a second that is far too long or too short. Here they count in
/// the time T in which a state changes by itself, or its rate does: h = T (0.01 / a)^(1 / order) with a the change in
/// that time. With T = 1 s that is HINIT's.
pub(super) fn first_step(flow: &Flow<'_>, start: &Point, scale: &Scale, order: f64, longest: f64) -> f64 {
    // The factors are those of HINIT; where it takes 1e-6 for a state at rest, this part of the longest step is taken.
    const AT_REST: f64 = 1e-6;
    let rates = scale.norm(start.rate.as_slice(), start.x.as_slice());
    let states = scale.norm(start.x.as_slice(), start.x.as_slice());
    let is_at_rest = rates * longest <= 1e-5 || states <= 1e-5;
    let guess = if is_at_rest { AT_REST * longest } else { states / rates * 0.01 }.min(longest);
    let ahead = &start.x + &start.rate * guess;
    let mut rate = DVector::zeros(ahead.len());
    flow.rate(start.t + guess, ahead.as_slice(), rate.as_mut_slice());
    let change = scale.norm((rate - &start.rate).as_slice(), start.x.as_slice());
    let steepest = change.max(rates);
    let of_rates = if change > 0.0 { steepest / change * guess } else { longest };
    let time = if is_at_rest { of_rates } else { of_rates.min(states / rates) };
    let step = if steepest * longest <= 1e-15 {
        (AT_REST * longest).max(guess * 1e-3)
    } else {
        time * libm::pow(0.01 / (steepest * time), 1.0 / order)
    };
    let step = step.min(100.0 * guess).min(longest);
    if step > 0.0 { step } else { (AT_REST * longest).max(f64::MIN_POSITIVE).min(longest) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A controller of a run of 100 s from a first step of 1 s.
    fn controller(control: StepControl, largest_step: f64) -> StepSizeController {
        let settings = Settings { first_step: Some(1.0), largest_step, ..Settings::default() };
        StepSizeController::new(control, Span { t0: 0.0, t_end: 100.0 }, &settings, true)
    }

    /// `dop853.f` and `radau5.f`: the step after a rejected one is not longer than it.
    #[test]
    fn a_step_does_not_grow_after_a_rejection() {
        let order = 5.0;
        let controls =
            [StepControl::Adaptive { order }, StepControl::Stabilised { order }, StepControl::Predictive { order }];
        for control in controls {
            let mut controller = controller(control, f64::INFINITY);
            controller.reject(1.0, 32.0);
            let h = controller.step();
            assert!((h - 0.45).abs() < 1e-15, "{control:?}: {h}");
            controller.accept(h, h, 1e-12);
            assert_eq!(controller.step(), h, "{control:?}");
            controller.accept(2.0 * h, h, 1e-12);
            assert!(controller.step() > 1.5 * h, "{control:?}: {}", controller.step());
        }
    }

    /// A rest of up to a hundredth of a step is added to the last one, but not beyond the largest step.
    #[test]
    fn the_last_step_is_stretched_up_to_the_largest() {
        let control = StepControl::Adaptive { order: 5.0 };
        assert_eq!(controller(control, f64::INFINITY).next_end(98.995, f64::INFINITY), 100.0);
        assert_eq!(controller(control, 1.0).next_end(98.995, f64::INFINITY), 99.995);
        assert_eq!(controller(control, 1.0).next_end(99.0, f64::INFINITY), 100.0);
        assert_eq!(controller(control, 1.01).next_end(98.995, f64::INFINITY), 100.0);
    }

    /// Pieces of a run that goes on end in two even steps; a whole run ends as `dop853.f` does, in a whole step and the
    /// rest.
    #[test]
    fn a_piece_ends_in_even_steps() {
        let mut controller = controller(StepControl::Adaptive { order: 5.0 }, f64::INFINITY);
        assert_eq!(controller.next_end(98.75, f64::INFINITY), 99.75);
        controller.go_on(Span { t0: 0.0, t_end: 100.0 });
        assert_eq!(controller.next_end(97.5, f64::INFINITY), 98.5);
        assert_eq!(controller.next_end(98.75, f64::INFINITY), 99.375);
        // Both are cut, so the step after them is as long as it was to be.
        controller.accept(99.375, 0.625, 1e-3);
        assert_eq!(controller.next_end(99.375, f64::INFINITY), 100.0);
        controller.accept(100.0, 0.625, 0.2);
        assert!(controller.step() >= 0.7, "{}", controller.step());
    }

    #[test]
    fn a_first_step_beyond_the_end_reaches_as_far_as_the_run() {
        let settings = Settings { first_step: Some(f64::INFINITY), ..Settings::default() };
        let span = Span { t0: 1.0, t_end: 3.0 };
        let mut controller = StepSizeController::new(StepControl::Adaptive { order: 5.0 }, span, &settings, false);
        assert_eq!((controller.reach(), controller.next_end(1.0, f64::INFINITY)), (2.0, 3.0));
    }
}
