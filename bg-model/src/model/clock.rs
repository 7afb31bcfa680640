//! Clocks: the instants at which samples are computed.
//!
//! In: the switches and times of a system's clocks. Out: which instants are next; the state after one. Instant k of a
//! clock is first + k period, calculated from k, so that nothing adds up. Instants of several clocks that differ by
//! rounding are one.

use alloc::vec;
use alloc::vec::Vec;

use crate::model::dynamics::{Dynamics, branches};
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
pub(crate) fn listed<S: Scalar>(switches: &[usize], instants: impl FnOnce(&mut [S])) -> Vec<Clock<S>> {
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

/// Decides the branches in which samples are computed: of each switch that is not `fixed` and whose guard depends on
/// them, by its sign, again until nothing changes. `before` are the guards before the instant; `guards` writes them
/// into `value`.
pub(crate) fn decide<S: Scalar>(
    negative: &mut [bool],
    fixed: impl Fn(usize) -> bool,
    [before, value]: [&mut [S]; 2],
    mut guards: impl FnMut(&[bool], &mut [S]),
) {
    for _ in 0..=negative.len() {
        guards(negative, value);
        let mut agree = true;
        for (k, negative) in negative.iter_mut().enumerate() {
            let [before, value] = [before[k].to_f64(), value[k].to_f64()];
            let next = if fixed(k) || value == before || value == 0.0 { *negative } else { value < 0.0 };
            agree &= core::mem::replace(negative, next) == next;
        }
        if agree {
            return;
        }
    }
}

/// Computes the samples of the clocks with these switches at time `t` (s) in state `x`, whose switches have the branches
/// `negative`. Everything else of the state stays. Allocates.
pub(crate) fn compute<S: Scalar>(system: &dyn Dynamics<S>, ticking: &[usize], t: S, negative: &[bool], x: &mut [S]) {
    let remembers = system.first_branches();
    let mut room = vec![S::from_f64(0.0); 2 * negative.len()];
    let (before, value) = room.split_at_mut(negative.len());
    let switches = |negative: &[bool]| negative.iter().copied().map(S::Switch::from).collect::<Vec<_>>();
    system.guards(t, x, &switches(negative), before);
    let mut now = negative.to_vec();
    ticking.iter().for_each(|&switch| now[switch] = true);
    decide(
        &mut now,
        |k| remembers[k] || ticking.contains(&k),
        [before, value],
        |negative, value| {
            system.guards(t, x, &switches(negative), value);
        },
    );
    let mut projected = x.to_vec();
    system.project(t, &switches(&now), &mut projected);
    system.memories().into_iter().for_each(|held| x[held] = projected[held]);
}

/// The same of all clocks that have an instant at `t` (s).
pub(crate) fn compute_due<S: Scalar>(
    system: &dyn Dynamics<S>,
    clocks: &[Clock<S>],
    t: f64,
    negative: &[bool],
    x: &mut [S],
) {
    let due = clocks.iter().filter(|clock| clock.at(t).is_some());
    let due: Vec<usize> = due.map(|clock| clock.switch).collect();
    compute(system, &due, S::from_f64(t), negative, x);
}

/// The state of `system` after the samples of all clocks are computed that have an instant at `t` (s), from the state `x`
/// before, whose switches have the branches `negative`, or those of their signs. Allocates.
#[must_use]
pub fn computed(system: &dyn Dynamics, t: f64, x: &[f64], negative: Option<&[bool]>) -> Vec<f64> {
    let (clocks, mut after) = (system.clocks(), x.to_vec());
    if is_due(&clocks, t) {
        let negative = negative.map_or_else(|| branches(system, t, x), <[bool]>::to_vec);
        compute_due(system, &clocks, t, &negative, &mut after);
    }
    after
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
