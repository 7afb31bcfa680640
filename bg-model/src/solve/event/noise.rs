//! Noise: how far rounding alone may take a guard from zero.
//!
//! In: a point of the step. Out: how much each guard changes there if the time and the states are displaced by what
//! rounding may have done to them. It is a matter of this point alone: of the states and of their changes in this step,
//! not of how large a guard has been. A guard that jumps there is not noisy, so of the two directions the smaller
//! change counts.

use alloc::vec::Vec;

use super::EventMonitor;
use super::guarded::{End, Guarded};
use crate::solve::integrator::Point;

/// How far rounding displaces a sum of some terms, in parts of the largest: the weights of methods go up to 30.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// How much more than the remainder of its last event a guard may be off.
const MARGIN: f64 = 4.0;

impl EventMonitor {
    /// How far each guard may be on the wrong side by rounding alone at time `t` (s) and state `x`, where they have
    /// this `value`, in a step that begins where `step` does. Evaluates the guards twice.
    pub(super) fn noise(&self, step: &mut dyn Guarded, t: f64, x: &[f64], value: &[f64]) -> Vec<f64> {
        let (Point { t: from, x: before, rate }, h) = (step.point(End::Start), step.size());
        let moves = x.iter().zip(before).zip(rate).enumerate().map(|(i, ((x, before), rate))| {
            let size = larger(before.abs(), x.abs()) + (h * rate).abs();
            irregular(i) * ROUNDING * size
        });
        let moves: Vec<f64> = moves.collect();
        let wait = ROUNDING * larger(from.abs(), t.abs());
        let mut displaced = |by: f64| {
            let displaced: Vec<f64> = x.iter().zip(&moves).map(|(x, moves)| x + by * moves).collect();
            step.guards(t + by * wait, &displaced)
        };
        let (ahead, back) = (displaced(1.0), displaced(-1.0));
        let of = |k: usize| {
            let (ahead, back) = ((ahead[k] - value[k]).abs(), (back[k] - value[k]).abs());
            let change = if ahead < back { ahead } else { back };
            // No number beside the point says nothing about it.
            let margin = if self.is_stop[k] { 1.0 } else { MARGIN };
            larger(margin * self.remainder[k], if change.is_finite() { change } else { 0.0 })
        };
        (0..value.len()).map(of).collect()
    }

    /// The same at an end of the step.
    pub(super) fn noise_of(&self, step: &mut dyn Guarded, end: End, value: &[f64]) -> Vec<f64> {
        let Point { t, x, .. } = step.point(end).clone();
        self.noise(step, t, x.as_slice(), value)
    }

    /// Takes note of what an event at which guard `k` has this value leaves of it.
    pub(super) fn leave(&mut self, k: usize, value: f64) {
        self.remainder[k] = larger(self.remainder[k], value.abs());
    }

    /// Forgets what the last events have left of guards that are far from zero at the end of the step.
    pub(super) fn forget(&mut self) {
        for (remainder, value) in self.remainder.iter_mut().zip(&self.end.value) {
            if value.abs() > super::CERTAIN * MARGIN * *remainder {
                *remainder = 0.0;
            }
        }
    }
}

/// A factor for state `i`, of size 1/2 to 1: of irregular sizes and signs, so that what states have in common does not
/// cancel. Source of the sequence: multiples of the golden ratio (Knuth, The Art of Computer Programming 3, section
/// 6.4).
fn irregular(i: usize) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let multiple = (i + 1) as f64 * GOLDEN;
    let fraction = multiple - multiple as u64 as f64;
    if fraction < 0.5 { -0.5 - fraction } else { fraction }
}

/// The larger number; `b` where `a` is none.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    /// A step of a state from 2 at the time 0.5, of 0.25 s at the rate 4, with guards: a jump of the time, and the
    /// state itself.
    struct Step {
        start: Point,
        jump: f64,
    }

    impl Guarded for Step {
        fn point(&self, _: End) -> &Point {
            &self.start
        }
        fn size(&self) -> f64 {
            0.25
        }
        fn negative(&self) -> &[bool] {
            &[false; 2]
        }
        fn read(&mut self, t: f64, x: &[f64], guards: &mut [f64]) {
            guards.copy_from_slice(&[if t < self.jump { 1.0 } else { -1.0 }, x[0]]);
        }
        fn read_end(&mut self, _: End, guards: &mut [f64]) {
            let Point { t, x, .. } = self.start.clone();
            self.read(t, x.as_slice(), guards);
        }
        fn dense(&mut self, _: f64, x: &mut [f64]) {
            x.copy_from_slice(self.start.x.as_slice());
        }
        fn resize(&mut self, _: f64) {}
        fn close(&mut self, _: f64) {}
    }

    #[test]
    fn a_guard_is_noisy_by_the_rounding_of_its_states_and_not_by_a_jump() {
        let start = Point { t: 0.5, x: DVector::from_element(1, 2.0), rate: DVector::from_element(1, 4.0) };
        // The jump is at the point itself: a little earlier the guard is on its other side.
        let (mut step, mut monitor) = (Step { start, jump: 0.5 }, EventMonitor::new(2));
        let value = step.guards_of(End::End);
        let noise = |monitor: &EventMonitor, step: &mut Step| {
            <[f64; 2]>::try_from(monitor.noise_of(step, End::End, &value)).unwrap()
        };
        let [jump, state] = noise(&monitor, &mut step);
        assert_eq!((value[0], jump), (-1.0, 0.0));
        // Half to all of 16 times the rounding of 2 + 0.25 * 4.
        assert!((24.0..=49.0).contains(&(state / f64::EPSILON)), "{state:e}");
        // What an event has left counts four times, of a stop once.
        monitor.leave(0, -1e-3);
        assert_eq!(noise(&monitor, &mut step), [4e-3, state]);
        monitor.is_stop[0] = true;
        assert_eq!(noise(&monitor, &mut step), [1e-3, state]);
    }

    #[test]
    fn factors_are_of_both_signs_and_of_sizes_from_a_half_to_one() {
        let factors: [f64; 64] = core::array::from_fn(irregular);
        assert!(factors.iter().all(|factor| (0.5..=1.0).contains(&factor.abs())));
        let positive = factors.iter().filter(|factor| **factor > 0.0).count();
        assert!((28..=36).contains(&positive), "{positive}");
        // The sum of two neighbours, as in a difference of two equal states, does not vanish.
        assert!(factors.windows(2).all(|pair| (pair[0] - pair[1]).abs() > 0.05), "{factors:?}");
    }
}
