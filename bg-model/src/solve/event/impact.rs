//! Impacts: the state jumps where something reaches a stop.
//!
//! In: a point at which the guards of stops are at zero. Out: the state after the impact ([`Collision`]), with the
//! branches of these stops. Where something is left without speed it rests if the load presses it there: of several
//! stops which bear one, one whose effort would pull is taken away, one towards which something would move is added, of
//! several the last, until none is wrong.
//!
//! A rebound is none where it rises less than [`LOW`] of what the tolerances allow for its place, unless the stop says
//! below which speed it is none, or where rounding does not let its end be found.

use alloc::vec;
use alloc::vec::Vec;

use super::guarded::{End, Guarded};
use super::{CERTAIN, EventMonitor};
use crate::model::reactions::{After, Collision, impacts_of};
use crate::solve::stepper::Stepper;

/// How often the choice of the stops that bear a load is changed.
const CHANGES: usize = 100;
/// The part of the error that the tolerances allow for a place.
const LOW: f64 = 0.01;

/// What an impact leaves to be decided.
#[derive(Debug)]
pub(crate) struct Struck {
    /// The switches whose branches the guards decide.
    pub switches: Vec<bool>,
    /// Those of stops that were hit and are left again.
    pub rebounds: Vec<bool>,
    /// Whether the state has jumped.
    pub jumps: bool,
}

impl EventMonitor {
    /// Lets the state at the start of the next step jump if a stop is reached there: `switches` are those whose guards
    /// have come to zero.
    pub fn strike(
        &mut self,
        stepper: &mut Stepper<'_>,
        mut switches: Vec<bool>,
        collision: Option<&mut Collision<f64>>,
    ) -> Struck {
        let negative = stepper.negative.clone();
        let mut rebounds = vec![false; switches.len()];
        let Some(collision) = collision.filter(|all| all.switches().any(|k| switches[k] && negative[k])) else {
            return Struck { switches, rebounds, jumps: false };
        };
        let reached = switches.clone();
        let closed = |k: usize| reached[k] || !negative[k];
        let jumps = self.collide(stepper, collision, closed, &mut switches);
        for (k, after) in collision.outcomes() {
            rebounds[k] = after == After::Clear && negative[k] && jumps;
            switches[k] &= after == After::Untouched;
        }
        self.rest(stepper, collision);
        Struck { switches, rebounds, jumps }
    }

    /// Lets the state at the start of the run jump where stops are reached, or where something rests on those that are
    /// `held`. Gives the switches of those that are left again.
    pub(super) fn strike_at_begin(
        &mut self,
        stepper: &mut Stepper<'_>,
        collision: Option<&mut Collision<f64>>,
        held: &[bool],
    ) -> Vec<bool> {
        let mut clear = vec![false; held.len()];
        let Some(collision) = collision else { return clear };
        collision.switches().for_each(|k| self.is_stop[k] = true);
        stepper.negative = stepper.system.first_branches();
        let beyond = stepper.guards_of(End::Start);
        self.collide(stepper, collision, |k| beyond[k] >= 0.0 || held[k], &mut vec![false; held.len()]);
        collision.outcomes().for_each(|(k, after)| clear[k] = after == After::Clear);
        clear
    }

    /// Finds the stops that bear the load among those on which something may rest. What is taken away and reached
    /// again without end stays: its load sets in at this instant, so that its effort pulls by rounding.
    fn rest(&mut self, stepper: &mut Stepper<'_>, collision: &mut Collision<f64>) {
        let impacts = impacts_of(stepper.system);
        let stays = self.repeats(stepper.start.t);
        collision.resting().for_each(|(_, switch)| stepper.negative[switch] = false);
        for _ in 0..CHANGES {
            let effort = stepper.guards_of(End::Start);
            let noise = self.noise_of(stepper, End::Start, &effort);
            collision.loads(&impacts, (stepper.start.t, stepper.start.x.as_slice()), &stepper.negative);
            let is_wrong = |&(k, switch): &(usize, usize)| {
                if stepper.negative[switch] {
                    collision.load(k) > 0.0
                } else {
                    !stays && effort[switch] < -noise[switch]
                }
            };
            let Some((_, wrong)) = collision.resting().filter(is_wrong).last() else {
                let pulls = |&(_, switch): &(usize, usize)| stays && !stepper.negative[switch] && effort[switch] < 0.0;
                collision.resting().filter(pulls).for_each(|(_, switch)| self.leave(switch, effort[switch]));
                return;
            };
            stepper.negative[wrong] = !stepper.negative[wrong];
        }
    }

    /// Lets the state jump where the stops of these switches are reached, and dry friction slide that an impact moves;
    /// what it brings to rest is added to `switches`. Gives whether the state jumps.
    fn collide(
        &mut self,
        stepper: &mut Stepper<'_>,
        collision: &mut Collision<f64>,
        closed: impl Fn(usize) -> bool,
        switches: &mut [bool],
    ) -> bool {
        let impacts = impacts_of(stepper.system);
        let (t, negative) = (stepper.start.t, stepper.negative.clone());
        // Where all that remembers is in its first branch guards are places of stops and flows of frictions.
        let first = stepper.system.first_branches();
        stepper.negative.iter_mut().zip(&first).for_each(|(negative, first)| *negative |= first);
        let place = stepper.guards_of(End::Start);
        let noise = self.noise_of(stepper, End::Start, &place);
        let allowed = allowed(stepper, &place);
        let mut x = stepper.start.x.clone();
        // What rebounds again and again at one instant does so by rounding.
        let repeats = self.repeats(t);
        let is_low = |k: usize, rise: f64, by_accuracy: bool| {
            repeats || rise <= CERTAIN * noise[k] || by_accuracy && rise <= LOW * allowed[k]
        };
        let jumps = collision.strike(&impacts, (t, x.as_mut_slice()), &negative, closed, is_low);
        if jumps {
            stepper.start.x = x;
        }
        let after = stepper.guards_of(End::Start);
        stepper.negative.copy_from_slice(&negative);
        for (k, outcome) in collision.outcomes() {
            stepper.negative[k] |= outcome == After::Clear;
            if outcome != After::Untouched {
                self.leave(k, place[k]);
            }
        }
        for k in (0..negative.len()).filter(|&k| jumps && first[k] && !self.is_stop[k]) {
            if (after[k] - place[k]).abs() > CERTAIN * noise[k] {
                switches[k] |= after[k].abs() <= CERTAIN * noise[k] && negative[k];
                stepper.negative[k] = if switches[k] { negative[k] } else { after[k] < 0.0 };
            }
        }
        jumps
    }
}

/// How much each guard, which has this value at the start of the step, changes where the states are off by what the
/// tolerances allow.
fn allowed(stepper: &mut Stepper<'_>, value: &[f64]) -> Vec<f64> {
    let (t, x) = (stepper.start.t, &stepper.start.x);
    let off: Vec<f64> = x.iter().enumerate().map(|(i, x)| x + stepper.scale.allowed(i, *x)).collect();
    let displaced = stepper.guards(t, &off);
    value.iter().zip(displaced).map(|(value, displaced)| (displaced - value).abs()).collect()
}
