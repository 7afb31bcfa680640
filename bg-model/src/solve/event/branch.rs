//! Branches: which one a switch takes where its guard is zero.
//!
//! A guard is followed for a small step of the method under a branch; the branch is right if the guard then has its
//! sign. Where the other branch is right in this sense and this one is not, the other one is taken.

use super::guarded::Guarded;
use super::{CERTAIN, EventMonitor, check_finite, clearance};
use crate::model::reactions::Collision;
use crate::model::system::{System, branches_by_sign};
use crate::solve::integrator::{Method, Point, is_finite};
use crate::solve::stepper::Stepper;

/// Small steps, as parts of the next step: the first shows the guard's derivative, the others a guard whose derivative
/// vanishes.
const PROBES: [f64; 3] = [1e-7, 1e-5, 1e-3];

impl<const G: usize> EventMonitor<G> {
    /// Chooses the branches at the start of the run by the signs of the guards, where stops are reached after the
    /// impact; what sticks or rests in branches that are `known` stays so. Gives the switches that are not to be looked
    /// at any more: those of stops that are left again, and those that stay.
    pub fn begin_by_sign<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        collision: Option<&mut Collision<f64>>,
        known: Option<[bool; G]>,
    ) -> [bool; G]
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        if G == 0 {
            return [false; G];
        }
        let first = stepper.system.first_branches();
        let known = known.unwrap_or(first);
        let held: [bool; G] = core::array::from_fn(|k| first[k] && !known[k]);
        let clear = self.strike_at_begin(stepper, collision, held);
        let start = stepper.start;
        (stepper.negative, self.start.value) = branches_by_sign(known, |negative| {
            stepper.negative = *negative;
            stepper.guards(start.t, &start.x)
        });
        stepper.negative = core::array::from_fn(|k| stepper.negative[k] || clear[k]);
        core::array::from_fn(|k| clear[k] || held[k])
    }

    /// Decides the branches of the guards that are exactly zero at the start of the run, by steps that are small
    /// compared with `step` (s); where these leave the guard zero, the positive branch holds. Those that are `known`
    /// stay.
    pub fn begin_by_probe<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        known: [bool; G],
        step: f64,
    ) where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let undecided: [bool; G] = core::array::from_fn(|k| self.start.value[k] == 0.0 && !known[k]);
        if undecided.contains(&true) {
            self.choose(stepper, &undecided, [false; G], step);
        }
        if G > 0 {
            self.read_start(stepper, step);
        }
    }

    /// Decides the branches of `switches`, whose guards have come to zero at the start of the next step, by steps that
    /// are small compared with `step` (s). Other switches whose guards that moves to the wrong side follow at once.
    pub fn settle<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        switches: [bool; G],
        step: f64,
    ) where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let settled = self.follow(stepper, switches, step);
        let remembers = stepper.system.first_branches();
        // Friction at its limit on a motion that others hold: what rounding leaves of the flow may have the wrong sign.
        for k in (0..G).filter(|&k| settled[k] && remembers[k]) {
            let value = self.start.value[k];
            if clearance(value, stepper.negative[k]) < 0.0 {
                self.leave(k, value);
            }
        }
    }

    /// Decides the branches of `switches` and of those that follow; gives all of them, with the guards at the start
    /// read.
    fn follow<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        mut switches: [bool; G],
        step: f64,
    ) -> [bool; G]
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let flipped = core::array::from_fn(|k| stepper.negative[k] != switches[k]);
        self.choose(stepper, &switches, flipped, step);
        for _ in 0..G {
            self.read_start(stepper, step);
            let value = self.start.value;
            let start = stepper.start;
            let noise = self.noise(stepper, start.t, &start.x, &value);
            let is_pushed = |k: &usize| !switches[*k] && clearance(value[*k], stepper.negative[*k]) < -noise[*k];
            let Some(pushed) = (0..G).find(is_pushed).filter(|_| check_finite(&value).is_ok()) else { return switches };
            switches[pushed] = true;
            stepper.negative[pushed] = value[pushed] < 0.0;
            stepper.evaluate_start();
        }
        self.read_start(stepper, step);
        switches
    }

    /// Gives each of `switches` its branch in `candidate`, or the other one if only that agrees with its guard; the
    /// rate at the start is that of the branches chosen.
    fn choose<Sys, M, const N: usize>(
        &self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        switches: &[bool; G],
        candidate: [bool; G],
        step: f64,
    ) where
        Sys: System<f64, N, G>,
        M: Method,
    {
        for k in 0..G {
            if switches[k] {
                stepper.negative[k] = candidate[k];
            }
        }
        stepper.evaluate_start();
        // Twice: the second time a branch that disagrees as well goes back to the candidate.
        for _ in 0..2 {
            let wrong = self.wrong_branches(stepper, switches, step);
            if !wrong.contains(&true) {
                return;
            }
            stepper.negative = core::array::from_fn(|k| stepper.negative[k] != wrong[k]);
            stepper.evaluate_start();
        }
    }

    /// Which of `switches` are in a branch that disagrees with its guard a little later. Where the rate is no number,
    /// as that of a root on the wrong side of its zero by rounding, all of them are.
    fn wrong_branches<Sys, M, const N: usize>(
        &self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        switches: &[bool; G],
        step: f64,
    ) -> [bool; G]
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        if !is_finite(stepper.start.rate.as_slice()) {
            return *switches;
        }
        if self.agree(stepper, switches, step) {
            return [false; G];
        }
        let signs = self.probe(stepper, switches, step);
        core::array::from_fn(|k| switches[k] && signs[k].is_some_and(|negative| negative != stepper.negative[k]))
    }

    /// Whether the guards of all `switches` beyond doubt move to the side of their present branches: after Euler's step
    /// as long as the first small one they are there, and their changes at the rates at both of its ends are much
    /// alike. One rate in place of a method's.
    fn agree<Sys, M, const N: usize>(
        &self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        switches: &[bool; G],
        reach: f64,
    ) -> bool
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let (start, h) = (stepper.start, small(PROBES[0], reach, stepper.start.t));
        stepper.take_over(h, Point::at(start.t + h, start.x + start.rate * h));
        stepper.evaluate_end();
        let end = stepper.end;
        let before = stepper.guards(start.t, &start.x);
        let value = stepper.guards(end.t, &end.x);
        let further = stepper.guards(end.t + h, &(end.x + end.rate * h));
        let noise = self.noise(stepper, end.t, &end.x, &value);
        (0..G).filter(|&k| switches[k]).all(|k| {
            let side = |value: f64| clearance(value, stepper.negative[k]);
            let (first, second) = (side(value[k] - before[k]), side(further[k] - value[k]));
            side(value[k]) > CERTAIN * noise[k] && first < 2.0 * second && second < 2.0 * first
        })
    }

    /// Whether the guards of `switches` are negative a little later under the present branches, by steps that are small
    /// compared with `reach` (s); nothing where they stay zero.
    pub(super) fn probe<const N: usize>(
        &self,
        step: &mut impl Guarded<N, G>,
        switches: &[bool; G],
        reach: f64,
    ) -> [Option<bool>; G] {
        let mut signs = [None; G];
        for part in PROBES {
            step.resize(small(part, reach, step.start().t));
            let end = *step.end();
            let value = step.guards(end.t, &end.x);
            let noise = self.noise(step, end.t, &end.x, &value);
            for k in 0..G {
                if signs[k].is_none() && value[k].abs() > CERTAIN * noise[k] {
                    signs[k] = Some(value[k] < 0.0);
                }
            }
            if (0..G).all(|k| !switches[k] || signs[k].is_some()) {
                break;
            }
        }
        signs
    }
}

/// The size (s) of a small step from time `t` (s): a part of `reach` (s), and long enough to be seen in the time as
/// well.
fn small(part: f64, reach: f64, t: f64) -> f64 {
    (part * reach).max(1024.0 * f64::EPSILON * t.abs())
}
