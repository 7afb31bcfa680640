//! Branches: which one a switch takes where its guard is zero, as in a run ([`crate::simulation::integrate`]): a guard
//! is followed for small steps under a branch, which is right if the guard then has its sign.

use super::monitor::clearance;
use super::{CLOSEST, CROWD, Event, Fault, Run, guards};
use crate::model::dynamics::branches;
use crate::model::scalar::Scalar;

/// Small steps, as parts of the next step: the first shows the guard's derivative, the others a guard whose derivative
/// vanishes.
const PROBES: [f64; 3] = [1e-7, 1e-5, 1e-3];
/// A guard's sign is taken for certain above this multiple of its noise.
const CERTAIN: f64 = 16.0;

impl<S: Scalar<Switch = bool>> Run<'_, S> {
    /// Projects the start and chooses the branches there.
    pub(super) fn begin(&mut self) {
        self.system.project(self.t, &self.negative, &mut self.x);
        self.negative = branches(self.system, self.t.to_f64(), &self.x);
        self.raise_sizes();
        let undecided: Vec<bool> = self.guards().iter().map(|value| value.to_f64() == 0.0).collect();
        if undecided.contains(&true) {
            self.choose(&undecided);
        }
    }

    /// Decides the branches of `switches`, whose guards have come to zero, with the other branch as the candidate.
    /// Other switches whose guards that moves to the wrong side follow at once.
    pub(super) fn switch(&mut self, mut switches: Vec<bool>) -> Result<(), Fault> {
        let (before, count) = (self.negative.clone(), switches.len());
        self.negative = differing(&before, &switches);
        self.choose(&switches);
        for _ in 0..count {
            let value = self.guards();
            let is_wrong = |k: usize| clearance(value[k], self.negative[k]).to_f64() < -self.monitor.noise(k);
            let Some(pushed) = (0..count).find(|k| !switches[*k] && is_wrong(*k)) else { break };
            switches[pushed] = true;
            self.negative[pushed] = !self.negative[pushed];
        }
        for switch in (0..count).filter(|k| self.negative[*k] != before[*k]) {
            self.events.push(Event { t: self.t, switch });
        }
        self.check_crowd()
    }

    /// Gives those of `switches` whose guards disagree with their branches the other one, if that agrees.
    fn choose(&mut self, switches: &[bool]) {
        // Twice: the second time a branch that disagrees as well goes back to the candidate.
        for _ in 0..2 {
            let signs = self.probe(switches);
            let disagrees = |k: usize| switches[k] && signs[k].is_some_and(|negative| negative != self.negative[k]);
            let wrong: Vec<bool> = (0..switches.len()).map(disagrees).collect();
            if !wrong.contains(&true) {
                return;
            }
            self.negative = differing(&self.negative, &wrong);
        }
    }

    /// Whether the guards of `switches` are negative a little later under the present branches; nothing where they stay
    /// zero.
    fn probe(&mut self, switches: &[bool]) -> Vec<Option<bool>> {
        let mut signs = vec![None; switches.len()];
        for part in PROBES {
            self.attempt(S::from_f64(part * self.step));
            let value = self.monitor.end();
            for (k, sign) in signs.iter_mut().enumerate() {
                if sign.is_none() && value[k].to_f64().abs() > CERTAIN * self.monitor.noise(k) {
                    *sign = Some(value[k].to_f64() < 0.0);
                }
            }
            if signs.iter().zip(switches).all(|(sign, is_asked)| !is_asked || sign.is_some()) {
                break;
            }
        }
        signs
    }

    /// The guards where the run has come to.
    fn guards(&self) -> Vec<S> {
        guards(self.system, self.t, &self.x, &self.negative)
    }

    fn check_crowd(&self) -> Result<(), Fault> {
        let [.., last] = self.events[..] else { return Ok(()) };
        let is_near = |event: &&Event<S>| (last.t - event.t).to_f64() <= CLOSEST * self.length;
        if self.events.iter().rev().take_while(is_near).count() > CROWD * self.negative.len() {
            let name = self.system.switch_name(last.switch).unwrap_or_default();
            return Err(Fault::EventsAccumulate { switch: last.switch, name, t: last.t.to_f64() });
        }
        Ok(())
    }
}

/// These branches, but the other ones of `switches`.
fn differing(branches: &[bool], switches: &[bool]) -> Vec<bool> {
    branches.iter().zip(switches).map(|(branch, is_other)| branch != is_other).collect()
}
