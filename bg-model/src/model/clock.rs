//! Clocks: the instants at which samples are computed.
//!
//! In: the switches and times of a system's clocks. Out: which instants are next. Instant k of a clock is first + k
//! period, calculated from k, so that nothing adds up. Instants of several clocks that differ by rounding are one.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::scalar::Scalar;

/// By how much two times that are one may differ, as a part of them: more than the shortest step of a run.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// When samples are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock<S = f64> {
    /// The switch in whose negative branch the projection computes them.
    pub switch: usize,
    /// The time from one instant to the next, s, above 0.
    pub period: S,
    /// The first instant, s.
    pub first: S,
}

/// The clocks with these switches; `instants` writes of each its period and its first instant, s.
#[must_use]
pub fn listed<S: Scalar>(switches: &[usize], instants: &dyn Fn(&mut [S])) -> Vec<Clock<S>> {
    if switches.is_empty() {
        return Vec::new();
    }
    let mut times = vec![S::from_f64(0.0); 2 * switches.len()];
    instants(&mut times);
    let clock = |(&switch, times): (&usize, &[S])| Clock { switch, period: times[0], first: times[1] };
    switches.iter().zip(times.chunks_exact(2)).map(clock).collect()
}

/// How far an instant may be from `t` (s) that is the same, s.
pub(crate) fn rounding(t: f64) -> f64 {
    ROUNDING * t.abs()
}

impl<S: Scalar> Clock<S> {
    /// The number of the instant that is nearest to `t` (s), not below 0.
    fn nearest(&self, t: f64) -> f64 {
        let number = libm::round((t - self.first.to_f64()) / self.period.to_f64());
        if number > 0.0 { number } else { 0.0 }
    }

    /// Instant `number`, s.
    fn instant(&self, number: f64) -> S {
        self.first + self.period * S::from_f64(number)
    }

    /// The instant that is at `t` (s), to rounding, if there is one.
    pub fn at(&self, t: f64) -> Option<S> {
        let instant = self.instant(self.nearest(t));
        let apart = (instant.to_f64() - t).abs();
        (apart <= rounding(t)).then_some(instant)
    }

    /// The first instant after `t` (s), by more than rounding, s.
    #[must_use]
    pub fn next(&self, t: f64) -> f64 {
        let nearest = self.nearest(t);
        let instant = self.instant(nearest).to_f64();
        if instant > t + rounding(t) { instant } else { self.instant(nearest + 1.0).to_f64() }
    }
}

/// The first instant of the clocks after `t` (s); infinity where there is none.
#[must_use]
pub fn next<S: Scalar>(clocks: &[Clock<S>], t: f64) -> f64 {
    clocks.iter().map(|clock| clock.next(t)).fold(f64::INFINITY, |first, next| if next < first { next } else { first })
}

/// Whether one of the clocks has an instant at `t` (s).
#[must_use]
pub fn is_due<S: Scalar>(clocks: &[Clock<S>], t: f64) -> bool {
    clocks.iter().any(|clock| clock.at(t).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_multiples_that_nothing_adds_up_in() {
        let clock = Clock { switch: 0, period: 1e-3, first: 0.0 };
        let mut t = 0.0;
        for k in 1..=100_000_u32 {
            t = clock.next(t);
            assert_eq!(t, f64::from(k) * 1e-3);
            assert_eq!(clock.at(t), Some(t));
        }
        assert_eq!(clock.at(0.5e-3), None);
    }

    #[test]
    fn the_first_instant_is_the_offset_and_none_is_before() {
        let clock = Clock { switch: 0, period: 0.5, first: 0.2 };
        assert_eq!([-3.0, 0.0, 0.2, 0.3, 0.7].map(|t| clock.next(t)), [0.2, 0.2, 0.7, 0.7, 1.2]);
        assert_eq!((clock.at(-0.3), clock.at(0.2)), (None, Some(0.2)));
    }

    /// 0.3 is no multiple of 0.1 in binary numbers: three times 0.1 is its neighbour.
    #[test]
    fn instants_that_differ_by_rounding_are_one() {
        let [fast, slow] = [0.1, 0.3].map(|period| Clock { switch: 0, period, first: 0.0 });
        let t = next(&[fast, slow], 0.2);
        assert!(fast.at(t).is_some() && slow.at(t).is_some());
        assert!((next(&[fast, slow], t) - 0.4).abs() < 1e-15);
    }
}
