//! Branches: which one a switch takes where its guard is zero.
//!
//! A guard is followed for a small step of the method under a branch; the branch is right if the guard then has its
//! sign. Where the other branch is right in this sense and this one is not, the other one is taken.

use alloc::vec;
use alloc::vec::Vec;

use super::guarded::{End, Guarded};
use super::{CERTAIN, EventMonitor, check_finite, clearance};
use crate::model::reactions::Collision;
use crate::model::system::decide_by_sign;
use crate::solve::integrator::{PointRef, is_finite};
use crate::solve::stepper::Stepper;

/// Small steps, as parts of the next step: the first shows the guard's derivative, the others a guard whose derivative
/// vanishes.
const PROBES: [f64; 3] = [1e-7, 1e-5, 1e-3];

impl EventMonitor {
    /// Chooses the branches at the start of the run by the signs of the guards, where stops are reached after the
    /// impact; what sticks or rests in branches that are `known` stays so. Gives the switches that are not to be looked
    /// at any more: those of stops that are left again, and those that stay.
    pub fn begin_by_sign(
        &mut self,
        stepper: &mut Stepper<'_>,
        collision: Option<&mut Collision<f64>>,
        known: Option<&[bool]>,
    ) -> Vec<bool> {
        if self.guards() == 0 {
            return Vec::new();
        }
        let first = stepper.system.first_branches();
        let mut negative = known.map_or_else(|| first.clone(), <[bool]>::to_vec);
        let held: Vec<bool> = first.iter().zip(&negative).map(|(first, known)| *first && !known).collect();
        let clear = self.strike_at_begin(stepper, collision, &held);
        decide_by_sign(&mut negative, &mut self.start.value, |negative, value| {
            stepper.negative.copy_from_slice(negative);
            stepper.read_end(End::Start, value);
        });
        let negative = negative.iter().zip(&clear).map(|(negative, clear)| *negative || *clear);
        stepper.negative = negative.collect();
        clear.iter().zip(held).map(|(clear, held)| *clear || held).collect()
    }

    /// Decides the branches of the guards that are exactly zero at the start of the run, by steps that are small
    /// compared with `step` (s); where these leave the guard zero, the positive branch holds. Those that are `known`
    /// stay.
    pub fn begin_by_probe(&mut self, stepper: &mut Stepper<'_>, known: &[bool], step: f64) {
        let values = self.start.value.iter().zip(known);
        let undecided: Vec<bool> = values.map(|(value, known)| *value == 0.0 && !known).collect();
        if undecided.contains(&true) {
            self.choose(stepper, &undecided, &vec![false; undecided.len()], step);
        }
        if self.guards() > 0 {
            self.read_start(stepper, step);
        }
    }

    /// Decides the branches of `switches`, whose guards have come to zero at the start of the next step, by steps that
    /// are small compared with `step` (s). Other switches whose guards that moves to the wrong side follow at once.
    pub fn settle(&mut self, stepper: &mut Stepper<'_>, switches: Vec<bool>, step: f64) {
        let settled = self.follow(stepper, switches, step);
        let remembers = stepper.system.first_branches();
        // Friction at its limit on a motion that others hold: what rounding leaves of the flow may have the wrong sign.
        for k in (0..settled.len()).filter(|&k| settled[k] && remembers[k]) {
            let value = self.start.value[k];
            if clearance(value, stepper.negative[k]) < 0.0 {
                self.leave(k, value);
            }
        }
    }

    /// Decides the branches of `switches` and of those that follow; gives all of them, with the guards at the start
    /// read.
    fn follow(&mut self, stepper: &mut Stepper<'_>, mut switches: Vec<bool>, step: f64) -> Vec<bool> {
        let flipped: Vec<bool> = stepper.negative.iter().zip(&switches).map(|(is, turns)| is != turns).collect();
        self.choose(stepper, &switches, &flipped, step);
        for _ in 0..switches.len() {
            self.read_start(stepper, step);
            let value = self.start.value.clone();
            let noise = self.noise_of(stepper, End::Start, &value);
            let is_pushed = |k: &usize| !switches[*k] && clearance(value[*k], stepper.negative[*k]) < -noise[*k];
            let pushed = (0..switches.len()).find(is_pushed).filter(|_| check_finite(&value).is_ok());
            let Some(pushed) = pushed else { return switches };
            switches[pushed] = true;
            stepper.negative[pushed] = value[pushed] < 0.0;
            stepper.evaluate_start();
        }
        self.read_start(stepper, step);
        switches
    }

    /// Gives each of `switches` its branch in `candidate`, or the other one if only that agrees with its guard; the
    /// rate at the start is that of the branches chosen.
    fn choose(&self, stepper: &mut Stepper<'_>, switches: &[bool], candidate: &[bool], step: f64) {
        for k in 0..switches.len() {
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
            stepper.negative.iter_mut().zip(wrong).for_each(|(negative, wrong)| *negative ^= wrong);
            stepper.evaluate_start();
        }
    }

    /// Which of `switches` are in a branch that disagrees with its guard a little later. Where the rate is no number,
    /// as that of a root on the wrong side of its zero by rounding, all of them are.
    fn wrong_branches(&self, stepper: &mut Stepper<'_>, switches: &[bool], step: f64) -> Vec<bool> {
        if !is_finite(stepper.start.rate.as_slice()) {
            return switches.to_vec();
        }
        if self.agree(stepper, switches, step) {
            return vec![false; switches.len()];
        }
        let signs = self.probe(stepper, switches, step);
        let is_wrong = |k: usize| switches[k] && signs[k].is_some_and(|negative| negative != stepper.negative[k]);
        (0..switches.len()).map(is_wrong).collect()
    }

    /// Whether the guards of all `switches` beyond doubt move to the side of their present branches: after Euler's step
    /// as long as the first small one they are there, and their changes at the rates at both of its ends are much
    /// alike. One rate in place of a method's.
    fn agree(&self, stepper: &mut Stepper<'_>, switches: &[bool], reach: f64) -> bool {
        let h = small(PROBES[0], reach, stepper.start.t);
        let start = &stepper.start;
        let (t, x) = (start.t + h, &start.x + &start.rate * h);
        stepper.take_over(h, PointRef { t, x: x.as_slice(), rate: &vec![0.0; x.len()] });
        stepper.evaluate_end();
        let before = stepper.guards_of(End::Start);
        let value = stepper.guards_of(End::End);
        let ahead = &stepper.end.x + &stepper.end.rate * h;
        let further = stepper.guards(t + h, ahead.as_slice());
        let noise = self.noise_of(stepper, End::End, &value);
        (0..switches.len()).filter(|&k| switches[k]).all(|k| {
            let side = |value: f64| clearance(value, stepper.negative[k]);
            let (first, second) = (side(value[k] - before[k]), side(further[k] - value[k]));
            side(value[k]) > CERTAIN * noise[k] && first < 2.0 * second && second < 2.0 * first
        })
    }

    /// Whether the guards of `switches` are negative a little later under the present branches, by steps that are small
    /// compared with `reach` (s); nothing where they stay zero.
    pub(super) fn probe(&self, step: &mut dyn Guarded, switches: &[bool], reach: f64) -> Vec<Option<bool>> {
        let mut signs = vec![None; switches.len()];
        for part in PROBES {
            step.resize(small(part, reach, step.point(End::Start).t));
            let value = step.guards_of(End::End);
            let noise = self.noise_of(step, End::End, &value);
            for k in 0..signs.len() {
                if signs[k].is_none() && value[k].abs() > CERTAIN * noise[k] {
                    signs[k] = Some(value[k] < 0.0);
                }
            }
            if signs.iter().zip(switches).all(|(sign, is_asked)| !is_asked || sign.is_some()) {
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
