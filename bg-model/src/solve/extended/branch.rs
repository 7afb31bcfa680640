//! Branches: which one a switch takes where its guard is zero, as in a run ([`crate::simulation::integrate`]): a guard
//! is followed for small steps under a branch, which is right if the guard then has its sign.

use nalgebra::SVector;

use super::monitor::clearance;
use super::{CLOSEST, CROWD, Event, Fault, Run};
use crate::model::scalar::Scalar;
use crate::model::system::{System, branches_by_sign};

/// Small steps, as parts of the next step: the first shows the guard's derivative, the others a guard whose derivative
/// vanishes.
const PROBES: [f64; 3] = [1e-7, 1e-5, 1e-3];
/// A guard's sign is taken for certain above this multiple of its noise.
const CERTAIN: f64 = 16.0;

impl<S, Sys, const N: usize, const G: usize> Run<'_, S, Sys, N, G>
where
    S: Scalar<Switch = bool>,
    Sys: System<S, N, G>,
{
    /// Projects the start and chooses the branches there.
    pub(super) fn begin(&mut self) {
        self.system.project(self.t, &self.negative, &mut self.x);
        let guards = |negative: &[bool; G]| self.guards_in(negative);
        (self.negative, _) = branches_by_sign(self.system.first_branches(), guards);
        self.raise_sizes();
        let value = self.guards();
        let undecided: [bool; G] = std::array::from_fn(|k| value[k].to_f64() == 0.0);
        if undecided.contains(&true) {
            self.choose(&undecided);
        }
    }

    /// Decides the branches of `switches`, whose guards have come to zero, with the other branch as the candidate.
    /// Other switches whose guards that moves to the wrong side follow at once.
    pub(super) fn switch(&mut self, mut switches: [bool; G]) -> Result<(), Fault> {
        let before = self.negative;
        self.negative = std::array::from_fn(|k| before[k] != switches[k]);
        self.choose(&switches);
        for _ in 0..G {
            let value = self.guards();
            let is_wrong = |k: usize| clearance(value[k], self.negative[k]).to_f64() < -self.monitor.noise(k);
            let Some(pushed) = (0..G).find(|k| !switches[*k] && is_wrong(*k)) else { break };
            switches[pushed] = true;
            self.negative[pushed] = !self.negative[pushed];
        }
        for switch in (0..G).filter(|k| self.negative[*k] != before[*k]) {
            self.events.push(Event { t: self.t, switch });
        }
        self.check_crowd()
    }

    /// Gives those of `switches` whose guards disagree with their branches the other one, if that agrees.
    fn choose(&mut self, switches: &[bool; G]) {
        // Twice: the second time a branch that disagrees as well goes back to the candidate.
        for _ in 0..2 {
            let signs = self.probe(switches);
            let disagrees = |k: usize| switches[k] && signs[k].is_some_and(|negative| negative != self.negative[k]);
            let wrong: [bool; G] = std::array::from_fn(disagrees);
            if !wrong.contains(&true) {
                return;
            }
            self.negative = std::array::from_fn(|k| self.negative[k] != wrong[k]);
        }
    }

    /// Whether the guards of `switches` are negative a little later under the present branches; nothing where they stay
    /// zero.
    fn probe(&mut self, switches: &[bool; G]) -> [Option<bool>; G] {
        let mut signs = [None; G];
        for part in PROBES {
            self.attempt(S::from_f64(part * self.step));
            let value = self.monitor.end();
            for k in 0..G {
                if signs[k].is_none() && value[k].to_f64().abs() > CERTAIN * self.monitor.noise(k) {
                    signs[k] = Some(value[k].to_f64() < 0.0);
                }
            }
            if (0..G).all(|k| !switches[k] || signs[k].is_some()) {
                break;
            }
        }
        signs
    }

    /// The guards where the run has come to.
    fn guards(&self) -> SVector<S, G> {
        self.guards_in(&self.negative)
    }

    /// The same in these branches.
    fn guards_in(&self, negative: &[bool; G]) -> SVector<S, G> {
        let mut value = SVector::from_element(S::from_f64(0.0));
        self.system.guards(self.t, &self.x, negative, &mut value);
        value
    }

    fn check_crowd(&self) -> Result<(), Fault> {
        let [.., last] = self.events[..] else { return Ok(()) };
        let is_near = |event: &&Event<S>| (last.t - event.t).to_f64() <= CLOSEST * self.length;
        if self.events.iter().rev().take_while(is_near).count() > CROWD * G {
            let name = self.system.switch_name(last.switch).unwrap_or_default();
            return Err(Fault::EventsAccumulate { switch: last.switch, name, t: last.t.to_f64() });
        }
        Ok(())
    }
}
