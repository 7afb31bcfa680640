//! The sequence of sample instants.
//!
//! In: the span and what is asked for. Out: one instant after the other. An instant t0 + k dt that differs from the end
//! of the run by rounding only is the end.

use super::settings::{Samples, Span};

/// Walks along the sample instants.
#[derive(Debug)]
pub(super) struct Sampling<'a> {
    samples: &'a Samples,
    span: Span,
    given: usize,
    /// The instant of the last one, s.
    last: f64,
    ended: bool,
}

impl<'a> Sampling<'a> {
    pub fn new(samples: &'a Samples, span: Span) -> Self {
        Self { samples, span, given: 0, last: f64::NEG_INFINITY, ended: false }
    }

    /// The next instant up to `t` (s), where a step ends or the run starts; moves on to the one after it.
    pub fn next_up_to(&mut self, t: f64) -> Option<f64> {
        let instant = self.instant(t)?;
        if instant > t {
            return None;
        }
        self.given += 1;
        self.last = instant;
        self.ended = instant >= self.span.t_end && !matches!(self.samples, Samples::At(_));
        Some(instant)
    }

    /// The next instant before `t` (s) inside of a step, as [`Sampling::next_up_to`].
    pub fn next_before(&mut self, t: f64) -> Option<f64> {
        let is_inside = !matches!(self.samples, Samples::Steps) && self.instant(t)? < t;
        is_inside.then(|| self.next_up_to(t)).flatten()
    }

    /// Whether there is an instant up to `t` (s).
    #[cfg(feature = "std")]
    pub fn is_due(&self, t: f64) -> bool {
        self.instant(t).is_some_and(|instant| instant <= t)
    }

    /// The next instant, s; infinity where there is none. Not where steps end.
    #[cfg(feature = "std")]
    pub fn next(&self) -> f64 {
        self.instant(f64::INFINITY).unwrap_or(f64::INFINITY)
    }

    fn instant(&self, t: f64) -> Option<f64> {
        match self.samples {
            _ if self.ended => None,
            Samples::At(instants) => instants.get(self.given).copied(),
            Samples::Every(interval) => {
                // Not zero times an interval that may be infinite.
                let after = if self.given == 0 { 0.0 } else { self.given as f64 * interval };
                let instant = self.span.t0 + after;
                let is_end = instant >= self.span.t_end - 0.5 * self.span.resolution();
                Some(if is_end { self.span.t_end } else { instant })
            }
            // One at the start and one at the end of each step: the walk is only moved on by `next_step`.
            Samples::Steps => (self.given == 0).then_some(t),
        }
    }

    /// The run ends at `t` (s), which is before the end of the span.
    pub fn end(&mut self, t: f64) {
        self.span.t_end = t;
        self.ended |= !matches!(self.samples, Samples::At(_)) && self.last >= t - 0.5 * self.span.resolution();
    }

    /// Begins a new step.
    pub fn next_step(&mut self) {
        if *self.samples == Samples::Steps {
            self.given = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instants(samples: &Samples, span: Span, ends: &[f64]) -> Vec<f64> {
        let mut sampling = Sampling::new(samples, span);
        let mut found = Vec::new();
        for &end in ends {
            sampling.next_step();
            while let Some(t) = sampling.next_up_to(end) {
                found.push(t);
            }
        }
        found
    }

    #[test]
    fn multiples_are_not_summed_up_and_the_end_comes_once() {
        let span = Span { t0: 1.0, t_end: 1.3 };
        let found = instants(&Samples::Every(0.1), span, &[1.0, 1.15, 1.3]);
        assert_eq!(found, [1.0, 1.1, 1.2, 1.3]);
        let found = instants(&Samples::Every(0.2), span, &[1.0, 1.3]);
        assert_eq!(found, [1.0, 1.2, 1.3]);
        let found = instants(&Samples::Every(9.0), span, &[1.0, 1.3]);
        assert_eq!(found, [1.0, 1.3]);
        let found = instants(&Samples::Every(f64::INFINITY), span, &[1.0, 1.15, 1.3]);
        assert_eq!(found, [1.0, 1.3]);
    }

    #[test]
    fn ten_thousand_instants_have_no_sliver_at_the_end() {
        for k in [3_usize, 7, 10, 49, 1000, 9999] {
            let interval = 0.1;
            let span = Span { t0: 0.0, t_end: (1..=k).fold(0.0, |t, _| t + interval) };
            let exact = Span { t_end: k as f64 / 10.0, ..span };
            assert_eq!(instants(&Samples::Every(interval), exact, &[0.0, exact.t_end]).len(), k + 1);
        }
    }

    #[test]
    fn a_run_that_ends_early_gives_its_end_once() {
        let samples = Samples::Every(0.25);
        for (end, expected) in [(0.5, None), (0.6, Some(0.6)), (0.5 + f64::EPSILON, None)] {
            let mut sampling = Sampling::new(&samples, Span { t0: 0.0, t_end: 9.0 });
            while sampling.next_up_to(0.5).is_some() {}
            sampling.end(end);
            assert_eq!(sampling.next_up_to(end), expected);
            assert_eq!(sampling.next_up_to(9.0), None);
        }
    }

    #[test]
    fn given_instants_and_step_ends_are_given_as_they_are() {
        let span = Span { t0: 0.0, t_end: 1.0 };
        assert_eq!(instants(&Samples::At(vec![0.25, 0.25, 1.0]), span, &[0.0, 0.5, 1.0]), [0.25, 0.25, 1.0]);
        assert_eq!(instants(&Samples::Steps, span, &[0.0, 0.5, 1.0]), [0.0, 0.5, 1.0]);
        let point = Span { t0: 2.0, t_end: 2.0 };
        assert_eq!(instants(&Samples::Every(0.1), point, &[2.0]), [2.0]);
    }
}
