//! Impacts: the state jumps where something reaches a stop.
//!
//! In: a point at which the guards of stops are at zero. Out: the state after the impact ([`Collision`]), with the
//! branches of these stops. Where something is left without speed it rests if the load presses it there: of several
//! stops which bear one, one whose effort would pull is taken away, one towards which something would move is added, of
//! several the last, until none is wrong.
//!
//! A rebound is none where it rises less than [`LOW`] of what the tolerances allow for its place, unless the stop says
//! below which speed it is none, or where rounding does not let its end be found.

use nalgebra::SVector;

use super::guarded::Guarded;
use super::{CERTAIN, EventMonitor};
use crate::model::reactions::{After, Collision};
use crate::model::system::System;
use crate::solve::integrator::Method;
use crate::solve::stepper::Stepper;

/// How often the choice of the stops that bear a load is changed.
const CHANGES: usize = 100;
/// The part of the error that the tolerances allow for a place.
const LOW: f64 = 0.01;

/// What an impact leaves to be decided.
#[derive(Debug)]
pub(crate) struct Struck<const G: usize> {
    /// The switches whose branches the guards decide.
    pub switches: [bool; G],
    /// Those of stops that were hit and are left again.
    pub rebounds: [bool; G],
    /// Whether the state has jumped.
    pub jumps: bool,
}

impl<const G: usize> EventMonitor<G> {
    /// Lets the state at the start of the next step jump if a stop is reached there: `switches` are those whose guards
    /// have come to zero.
    pub fn strike<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        mut switches: [bool; G],
        collision: Option<&mut Collision<f64>>,
    ) -> Struck<G>
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let negative = stepper.negative;
        let none = Struck { switches, rebounds: [false; G], jumps: false };
        let Some(collision) = collision.filter(|all| all.switches().any(|k| switches[k] && negative[k])) else {
            return none;
        };
        let reached = switches;
        let closed = |k: usize| reached[k] || !negative[k];
        let jumps = self.collide(stepper, collision, closed, &mut switches);
        let mut rebounds = [false; G];
        for (k, after) in collision.outcomes() {
            rebounds[k] = after == After::Clear && negative[k] && jumps;
            switches[k] &= after == After::Untouched;
        }
        self.rest(stepper, collision);
        Struck { switches, rebounds, jumps }
    }

    /// Lets the state at the start of the run jump where stops are reached, or where something rests on those that are
    /// `held`. Gives the switches of those that are left again.
    pub(super) fn strike_at_begin<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        collision: Option<&mut Collision<f64>>,
        held: [bool; G],
    ) -> [bool; G]
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let mut clear = [false; G];
        let Some(collision) = collision else { return clear };
        collision.switches().for_each(|k| self.is_stop[k] = true);
        stepper.negative = stepper.system.first_branches();
        let start = stepper.start;
        let beyond = stepper.guards(start.t, &start.x);
        self.collide(stepper, collision, |k| beyond[k] >= 0.0 || held[k], &mut [false; G]);
        collision.outcomes().for_each(|(k, after)| clear[k] = after == After::Clear);
        clear
    }

    /// Finds the stops that bear the load among those on which something may rest.
    fn rest<Sys, M, const N: usize>(&self, stepper: &mut Stepper<'_, Sys, M, N, G>, collision: &mut Collision<f64>)
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let system = stepper.system;
        let Some(impacts) = system.impacts() else { return };
        collision.resting().for_each(|(_, switch)| stepper.negative[switch] = false);
        let start = stepper.start;
        for _ in 0..CHANGES {
            let effort = stepper.guards(start.t, &start.x);
            let noise = self.noise(stepper, start.t, &start.x, &effort);
            collision.loads(impacts, (start.t, &start.x), &stepper.negative);
            let is_wrong = |&(k, switch): &(usize, usize)| {
                if stepper.negative[switch] { collision.load(k) > 0.0 } else { effort[switch] < -noise[switch] }
            };
            let Some((_, wrong)) = collision.resting().filter(is_wrong).last() else { return };
            stepper.negative[wrong] = !stepper.negative[wrong];
        }
    }

    /// Lets the state jump where the stops of these switches are reached, and dry friction slide that an impact moves;
    /// what it brings to rest is added to `switches`. Gives whether the state jumps.
    fn collide<Sys, M, const N: usize>(
        &mut self,
        stepper: &mut Stepper<'_, Sys, M, N, G>,
        collision: &mut Collision<f64>,
        closed: impl Fn(usize) -> bool,
        switches: &mut [bool; G],
    ) -> bool
    where
        Sys: System<f64, N, G>,
        M: Method,
    {
        let system = stepper.system;
        let Some(impacts) = system.impacts() else { return false };
        let (start, negative) = (stepper.start, stepper.negative);
        // Where all that remembers is in its first branch guards are places of stops and flows of frictions.
        let first = system.first_branches();
        stepper.negative = core::array::from_fn(|k| negative[k] || first[k]);
        let place = stepper.guards(start.t, &start.x);
        let noise = self.noise(stepper, start.t, &start.x, &place);
        let allowed = allowed(stepper, &place);
        let mut x = start.x;
        let is_low = |k: usize, rise: f64, by_accuracy: bool| {
            rise <= CERTAIN * noise[k] || by_accuracy && rise <= LOW * allowed[k]
        };
        let jumps = collision.strike(impacts, (start.t, &mut x), &negative, closed, is_low);
        if jumps {
            stepper.start.x = x;
        } else {
            x = start.x;
        }
        let after = stepper.guards(start.t, &x);
        stepper.negative = negative;
        for (k, outcome) in collision.outcomes() {
            stepper.negative[k] |= outcome == After::Clear;
            if outcome != After::Untouched {
                self.leave(k, place[k]);
            }
        }
        for k in (0..G).filter(|&k| jumps && first[k] && !self.is_stop[k]) {
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
fn allowed<Sys, M, const N: usize, const G: usize>(
    stepper: &mut Stepper<'_, Sys, M, N, G>,
    value: &SVector<f64, G>,
) -> [f64; G]
where
    Sys: System<f64, N, G>,
    M: Method,
{
    let start = stepper.start;
    let off = SVector::from_fn(|i, _| start.x[i] + stepper.scale.allowed(i, start.x[i]));
    let displaced = stepper.guards(start.t, &off);
    core::array::from_fn(|k| (displaced[k] - value[k]).abs())
}
