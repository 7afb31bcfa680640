//! The step-size controllers of runs side by side: which steps they try, as far as that is the same operations for all.
//!
//! In: the controller of each run, the error norms of the steps tried. Out: the next steps, which each run's own
//! [`StepSizeController`] would choose to the bit, and the counts of steps since the controllers were taken over. For a
//! stabilised control on a system without breaks.
//!
//! [`StepSizeController`]: crate::solve::simulation::step_size::StepSizeController

use crate::model::scalar::Scalar;
use crate::model::scalar::lanes::{Lanes, Vector};
use crate::solve::integrator::smaller;
use crate::solve::simulation::settings::Span;
use crate::solve::simulation::step_size::{Kept, STRETCH, bounded, least, noted, shortening, stabilised, within};
use crate::solve::statistics::Statistics;

/// What the controllers of all runs have in common.
#[derive(Clone, Copy, Debug)]
pub(super) struct Control {
    /// The time that the runs cover.
    pub span: Span,
    /// The largest step, s.
    pub largest: f64,
    /// The power of the step with which the error norm falls.
    pub order: f64,
}

/// How a run goes on in company.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lead {
    /// Its controller.
    pub controller: Kept,
    /// The first instant at which a step is looked at by the run itself, s.
    pub until: f64,
    /// The attempts that it may still make.
    pub left: u64,
}

/// The controllers of runs side by side.
#[derive(Debug)]
pub(super) struct Controllers<V: Vector> {
    control: Control,
    step: Lanes<V>,
    /// The last accepted step, s, and the logarithm of its error norm.
    accepted: [Lanes<V>; 2],
    rejected: V::Mask,
    until: Lanes<V>,
    left: Lanes<V>,
    /// Since the controllers were taken over: steps, rejected attempts, the smallest and the largest step.
    steps: Lanes<V>,
    refused: Lanes<V>,
    smallest: Lanes<V>,
    largest: Lanes<V>,
}

/// What follows from the error norms of attempts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged<V> {
    /// Their logarithms.
    pub logarithm: Lanes<V>,
    /// What the next steps follow from.
    pub factor: Lanes<V>,
}

impl<V: Vector> Controllers<V> {
    /// Nobody's yet.
    pub fn new(control: Control) -> Self {
        let zero = Lanes::from_f64(0.0);
        Self {
            control,
            step: zero,
            accepted: [zero; 2],
            rejected: false.into(),
            until: zero,
            left: zero,
            steps: zero,
            refused: zero,
            smallest: zero,
            largest: zero,
        }
    }

    /// Takes over the controller of a run.
    pub fn take(&mut self, place: usize, Lead { controller, until, left }: Lead) {
        let (h, logarithm) = controller.accepted.unwrap_or_default();
        let [last, before] = &mut self.accepted;
        let numbers = [
            (&mut self.step, controller.step),
            (last, h),
            (before, logarithm),
            (&mut self.until, until),
            (&mut self.left, left as f64),
            (&mut self.steps, 0.0),
            (&mut self.refused, 0.0),
            (&mut self.smallest, f64::INFINITY),
            (&mut self.largest, 0.0),
        ];
        for (to, number) in numbers {
            *to.0.at_mut(place) = number;
        }
        let others = V::bits(self.rejected) & !(1 << place);
        self.rejected = V::mask(others | u8::from(controller.is_rejected) << place);
    }

    /// Gives back the controller of a run, and its steps and rejected attempts since that was taken over.
    pub fn give(&self, place: usize) -> (Kept, Statistics) {
        let at = |of: &Lanes<V>| *of.0.at(place);
        let (steps, rejected) = (at(&self.steps) as u64, at(&self.refused) as u64);
        let accepted = (steps > 0).then(|| (at(&self.accepted[0]), at(&self.accepted[1])));
        let is_rejected = V::bits(self.rejected) & 1 << place != 0;
        let (smallest_step, largest_step) = (at(&self.smallest), at(&self.largest));
        let made = Statistics { steps, rejected, smallest_step, largest_step, ..Statistics::default() };
        (Kept { step: at(&self.step), accepted, is_rejected }, made)
    }

    /// The next steps from `t` (s): their sizes (s), their ends (s), and a bit for each run that may make its step.
    #[inline(always)]
    pub fn next(&self, t: Lanes<V>) -> (Lanes<V>, Lanes<V>, u8) {
        let Control { span, largest, .. } = self.control;
        let (goal, step) = (t.alike(span.t_end), self.step);
        let is_short = V::below((t + step.times(1.0 + STRETCH)).0, goal.0);
        let is_far = V::below(t.alike((1.0 + 1e-9) * largest).0, (goal - t).0);
        let end = Lanes::select(V::mask(V::bits(is_short) | V::bits(is_far)), t + step, goal);
        let is_seen = V::below(least(t, span.t_end - span.t0).0, step.0);
        let is_allowed = V::below(t.alike(0.0).0, self.left.0);
        (end - t, end, V::bits(is_seen) & V::bits(is_allowed))
    }

    /// A bit for each step to `t_end` (s) that its run looks at.
    #[inline(always)]
    pub fn is_due(&self, t_end: Lanes<V>) -> u8 {
        !V::bits(V::below(t_end.0, self.until.0))
    }

    /// What follows from these error norms.
    #[inline(always)]
    pub fn judge(&self, error: Lanes<V>) -> Judged<V> {
        let logarithm = error.ln();
        let is_rejected = V::below(error.alike(1.0).0, error.0);
        let combined = Lanes::select(is_rejected, logarithm, stabilised(logarithm, self.accepted[1]));
        Judged { logarithm, factor: (-combined / error.alike(self.control.order)).exp() }
    }

    /// Goes on after the steps of size `h` (s) to `t_end` (s), of which those at the places of `accepted` were accepted
    /// and those at the places of `refused` rejected.
    #[inline(always)]
    pub fn go_on(
        &mut self,
        [h, t_end]: [Lanes<V>; 2],
        Judged { logarithm, factor }: Judged<V>,
        accepted: u8,
        refused: u8,
    ) {
        let Control { span, largest, .. } = self.control;
        let [is_accepted, is_refused, is_over] = [accepted, refused, accepted | refused].map(V::mask);
        let grown = h * bounded(factor);
        let grown = Lanes::select(self.rejected, smaller(h, grown), grown);
        let grown = within(grown, t_end, span.t_end - span.t0, largest);
        let step = Lanes::select(is_refused, h * shortening(factor), self.step);
        self.step = Lanes::select(is_accepted, grown, step);
        self.accepted[0] = Lanes::select(is_accepted, h, self.accepted[0]);
        self.accepted[1] = Lanes::select(is_accepted, noted(logarithm), self.accepted[1]);
        self.rejected = V::mask(V::bits(self.rejected) & !accepted | refused);
        let one = h.alike(1.0);
        self.left = Lanes::select(is_over, self.left - one, self.left);
        self.steps = Lanes::select(is_accepted, self.steps + one, self.steps);
        self.refused = Lanes::select(is_refused, self.refused + one, self.refused);
        self.smallest = Lanes::select(is_accepted, smaller(h, self.smallest), self.smallest);
        self.largest = Lanes::select(is_accepted, h.larger(self.largest), self.largest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::integrator::StepControl;
    use crate::solve::simulation::settings::Settings;
    use crate::solve::simulation::step_size::StepSizeController;

    /// Steps with these error norms, by the controller of a run and by those side by side: both choose the same ones.
    fn compared<V: Vector>(errors: &[f64]) {
        if !V::is_at_hand() {
            return;
        }
        let (span, order) = (Span { t0: 0.0, t_end: 100.0 }, 8.0);
        let settings = Settings { first_step: Some(1.0), ..Settings::default() };
        let mut own = StepSizeController::new(StepControl::Stabilised { order }, span, &settings, false);
        let place = V::LANES - 1;
        let mut others = Controllers::<V>::new(Control { span, largest: settings.largest_step, order });
        others.take(place, Lead { controller: own.kept(), until: span.t_end, left: 1000 });
        let (mut t, mut counts) = (0.0, [0, 0]);
        for &error in errors {
            let end = own.next_end(t, f64::INFINITY);
            let (size, side, possible) = others.next(Lanes::each(|_| t));
            assert_eq!([size.get(place), side.get(place)], [end - t, end], "{errors:?}");
            assert_ne!(possible & 1 << place, 0);
            let judged = others.judge(Lanes::each(|_| error));
            let is_accepted = error <= 1.0;
            let [accepted, refused] = [is_accepted, !is_accepted].map(|is| u8::from(is) << place);
            others.go_on([size, side], judged, accepted, refused);
            if is_accepted {
                own.accept(end, end - t, error);
                t = end;
            } else {
                own.reject(end - t, error);
            }
            counts[usize::from(!is_accepted)] += 1;
            let (kept, made) = others.give(place);
            assert_eq!(kept.step.to_bits(), own.kept().step.to_bits(), "{errors:?}: {} {}", kept.step, own.kept().step);
            assert_eq!(kept.is_rejected, own.kept().is_rejected);
            assert_eq!([made.steps, made.rejected], counts);
        }
    }

    #[test]
    fn steps_are_those_of_a_controller_by_itself() {
        let sequences: [&[f64]; 4] = [
            &[0.5, 0.1, 1e-6, 0.9, 0.3],
            // After a rejected step the next one is not longer, the one after that is.
            &[0.5, 30.0, 1e-4, 1e-4, 1e-4],
            &[2.0, 1e3, 1.5, 1e-3, 0.2, 1e-3],
            &[1.0, 1.0 + 1e-12, 1.0, 0.0, 0.7],
        ];
        for errors in sequences {
            #[cfg(target_arch = "x86_64")]
            compared::<crate::model::scalar::lanes::Avx2>(errors);
            #[cfg(target_arch = "x86_64")]
            compared::<crate::model::scalar::lanes::Avx512>(errors);
        }
    }
}
