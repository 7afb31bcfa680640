//! Noise: how far rounding alone may take a guard from zero.
//!
//! In: a point of the step. Out: how much each guard changes there if the time and the states are displaced by what
//! rounding may have done to them. It is a matter of this point alone: of the states and of their changes in this step,
//! not of how large a guard has been. A guard that jumps there is not noisy, so of the two directions the smaller
//! change counts.

use nalgebra::SVector;

use super::EventMonitor;
use super::guarded::Guarded;

/// How far rounding displaces a sum of some terms, in parts of the largest: the weights of methods go up to 30.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// How much more than the remainder of its last event a guard may be off.
const MARGIN: f64 = 4.0;

impl<const G: usize> EventMonitor<G> {
    /// How far each guard may be on the wrong side by rounding alone at time `t` (s) and state `x`, where they have
    /// this `value`, in a step that begins where `step` does. Evaluates the guards twice.
    pub(super) fn noise<const N: usize>(
        &self,
        step: &mut impl Guarded<N, G>,
        t: f64,
        x: &SVector<f64, N>,
        value: &SVector<f64, G>,
    ) -> [f64; G] {
        let (start, h) = (step.start(), step.size());
        let mut moves = Irregular::<N>::FACTORS;
        for (i, moves) in moves.iter_mut().enumerate() {
            let [x, before, rate] = [x, &start.x, &start.rate].map(|of| of.data.0[0][i]);
            *moves *= ROUNDING;
            *moves *= larger(before.abs(), x.abs()) + (h * rate).abs();
        }
        let wait = ROUNDING * larger(start.t.abs(), t.abs());
        let mut displaced = |by: f64| {
            let mut displaced = *x;
            for (x, moves) in displaced.data.0[0].iter_mut().zip(&moves) {
                *x += by * moves;
            }
            step.guards(t + by * wait, &displaced)
        };
        let (ahead, back) = (displaced(1.0), displaced(-1.0));
        core::array::from_fn(|k| {
            let (ahead, back) = ((ahead[k] - value[k]).abs(), (back[k] - value[k]).abs());
            let change = if ahead < back { ahead } else { back };
            // No number beside the point says nothing about it.
            let margin = if self.is_stop[k] { 1.0 } else { MARGIN };
            larger(margin * self.remainder[k], if change.is_finite() { change } else { 0.0 })
        })
    }

    /// Takes note of what an event at which guard `k` has this value leaves of it.
    pub(super) fn leave(&mut self, k: usize, value: f64) {
        self.remainder[k] = larger(self.remainder[k], value.abs());
    }

    /// Forgets what the last events have left of guards that are far from zero at the end of the step.
    pub(super) fn forget(&mut self) {
        for k in 0..G {
            if self.end.value[k].abs() > super::CERTAIN * MARGIN * self.remainder[k] {
                self.remainder[k] = 0.0;
            }
        }
    }
}

/// Factors for states, of size 1/2 to 1: of irregular sizes and signs, so that what states have in common does not
/// cancel. Source of the sequence: multiples of the golden ratio (Knuth, The Art of Computer Programming 3, section
/// 6.4).
struct Irregular<const N: usize>;

impl<const N: usize> Irregular<N> {
    const FACTORS: [f64; N] = {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let mut factors = [0.0; N];
        let mut i = 0;
        while i < N {
            let multiple = (i + 1) as f64 * GOLDEN;
            let fraction = multiple - multiple as u64 as f64;
            factors[i] = if fraction < 0.5 { -0.5 - fraction } else { fraction };
            i += 1;
        }
        factors
    };
}

/// The larger number; `b` where `a` is none.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::integrator::Point;

    /// A step of a state from 2 at the time 0.5, of 0.25 s at the rate 4, with guards: a jump of the time, and the
    /// state itself.
    struct Step {
        start: Point<1>,
        jump: f64,
    }

    impl Guarded<1, 2> for Step {
        fn start(&self) -> &Point<1> {
            &self.start
        }
        fn end(&self) -> &Point<1> {
            &self.start
        }
        fn size(&self) -> f64 {
            0.25
        }
        fn negative(&self) -> [bool; 2] {
            [false; 2]
        }
        fn guards(&mut self, t: f64, x: &SVector<f64, 1>) -> SVector<f64, 2> {
            SVector::from([if t < self.jump { 1.0 } else { -1.0 }, x[0]])
        }
        fn dense(&mut self, _: f64) -> SVector<f64, 1> {
            self.start.x
        }
        fn resize(&mut self, _: f64) {}
        fn close(&mut self, _: f64) {}
    }

    #[test]
    fn a_guard_is_noisy_by_the_rounding_of_its_states_and_not_by_a_jump() {
        let mut start = Point::at(0.5, SVector::from([2.0]));
        start.rate = SVector::from([4.0]);
        // The jump is at the point itself: a little earlier the guard is on its other side.
        let (mut step, mut monitor) = (Step { start, jump: 0.5 }, EventMonitor::<2>::new());
        let value = step.guards(start.t, &start.x);
        let noise = |monitor: &EventMonitor<2>, step: &mut Step| monitor.noise(step, start.t, &start.x, &value);
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
        let factors = Irregular::<64>::FACTORS;
        assert!(factors.iter().all(|factor| (0.5..=1.0).contains(&factor.abs())));
        let positive = factors.iter().filter(|factor| **factor > 0.0).count();
        assert!((28..=36).contains(&positive), "{positive}");
        // The sum of two neighbours, as in a difference of two equal states, does not vanish.
        assert!(factors.windows(2).all(|pair| (pair[0] - pair[1]).abs() > 0.05), "{factors:?}");
    }
}
