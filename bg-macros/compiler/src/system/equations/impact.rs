//! Impacts: from what the run time calculates how momenta jump where something hits a stop.
//!
//! In: the reactions of rigid joints and of stops, with the rates. Out: [`Impacts`]. What impulses L change obeys the
//! equations of the reactions: flows by A L, momenta by what the reactions move. The integrals of outputs go along:
//! during an impact the flows change in proportion to the impulse, so an integral of what is linear in an effort
//! changes by the impulse times the mean of its coefficient before and after; that of a power gives the work (W.
//! Thomson, P. G. Tait, Treatise on Natural Philosophy (1879), article 309).

use super::holding::{Slip, mobilities};
use super::{Reaction, State};
use crate::expr::{Branch, Id, Pool, Symbol, substitute_switched};
use crate::system::equations::definite::filter;
use crate::system::equations::solution::Known;

/// States whose rates depend on reactions, each with the dependence on every row.
pub type Moves = Vec<(usize, Vec<Id>)>;

/// What impacts are calculated from; nothing where there is no stop.
#[derive(Clone, Debug, Default)]
pub struct Impacts {
    /// The motions that rigid joints hold, which come first among the rows.
    pub rigid: Vec<Slip>,
    /// The stops, whose rows come after them.
    pub stops: Vec<Struck>,
    /// How much each reaction changes the rate of each flow: symmetric, the lower triangle by rows.
    pub matrix: Vec<Vec<Id>>,
    /// The momenta that impulses change: the state, and its rate by one unit of each reaction.
    pub moves: Moves,
    /// The integrals that go along, alike.
    pub integrals: Moves,
}

/// A stop that something can hit.
#[derive(Clone, Debug)]
pub struct Struck {
    /// Its flow, positive towards the stop.
    pub slip: Slip,
    /// Its switch, negative while something is clear of it.
    pub rebound: Rebound,
    /// The rate of the flow.
    pub acceleration: Id,
}

/// A tree whose joints stops may lock, as impacts find it: no joint is locked, and what stops apply are symbols.
#[derive(Clone, Debug, Default)]
pub struct Unlocked {
    /// These stops.
    pub stops: Vec<Reaction>,
    /// The rates that differ from those of the states, each with its state.
    pub rates: Vec<(usize, Id)>,
}

impl Unlocked {
    /// Every expression.
    pub fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        self.stops.iter_mut().flat_map(Reaction::roots).chain(self.rates.iter_mut().map(|(_, rate)| rate))
    }

    /// Puts these rates in the places of those of the states, which it has then.
    pub fn exchange(&mut self, states: &mut [State]) {
        for (state, rate) in &mut self.rates {
            std::mem::swap(&mut states[*state].rate, rate);
        }
    }

    /// Gives the states their new numbers; those without one are gone.
    pub fn renumber(&mut self, to: &dyn Fn(usize) -> Option<usize>) {
        let rates = std::mem::take(&mut self.rates);
        self.rates = rates.into_iter().filter_map(|(state, rate)| Some((to(state)?, rate))).collect();
    }
}

/// How something leaves a stop.
#[derive(Clone, Copy, Debug)]
pub struct Rebound {
    /// The switch, negative while it is clear of the stop.
    pub switch: u32,
    /// The part of its speed with which it leaves.
    pub restitution: Id,
    /// The speed below which it rests.
    pub rest: Option<Id>,
}

impl Rebound {
    /// Every expression.
    pub fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        [&mut self.restitution].into_iter().chain(&mut self.rest)
    }
}

impl Struck {
    fn roots(&mut self) -> impl Iterator<Item = &mut Id> {
        let Self { slip, rebound, acceleration } = self;
        [&mut slip.flow, acceleration].into_iter().chain(&mut slip.gap).chain(rebound.roots())
    }

    fn ids(&self) -> Vec<Id> {
        self.clone().roots().map(|id| *id).collect()
    }
}

impl Impacts {
    /// Whether nothing can be hit.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.stops.is_empty()
    }

    /// Every expression: the flows of all rows, of each stop the restitution, the speed of rest (-1 where none is
    /// given) and the rate of its flow, the mobilities of the rigid motions, the matrix, then for each reaction what it
    /// moves.
    #[must_use]
    pub fn entries(&self, pool: &mut Pool) -> Vec<Id> {
        let none = pool.number(-1.0);
        let slips = self.rigid.iter().chain(self.stops.iter().map(|stop| &stop.slip));
        let flows = slips.map(|slip| slip.flow);
        let restitutions = self.stops.iter().map(|stop| stop.rebound.restitution);
        let rests = self.stops.iter().map(|stop| stop.rebound.rest.unwrap_or(none));
        let rates = self.stops.iter().map(|stop| stop.acceleration);
        let moved = |k: usize| self.moves.iter().chain(&self.integrals).map(move |(_, moves)| moves[k]);
        let moves = (0..self.matrix.len()).flat_map(moved);
        let matrix = self.matrix.iter().flatten().copied();
        let mobilities = mobilities(&self.rigid, &self.matrix);
        flows.chain(restitutions).chain(rests).chain(rates).chain(mobilities).chain(matrix).chain(moves).collect()
    }

    /// What must stay where this switch does.
    #[must_use]
    pub fn of_switch(&self, switch: usize) -> Vec<Id> {
        let own = self.stops.iter().filter(|stop| stop.rebound.switch as usize == switch);
        own.flat_map(Struck::ids).collect()
    }

    /// Replaces symbols and decides switches everywhere; a stop whose switch is decided is hit no more.
    pub fn replace(&mut self, pool: &mut Pool, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let rigid = self.rigid.len();
        let is_kept = |stop: &Struck| matches!(branch(stop.rebound.switch), Branch::Kept(_));
        let kept: Vec<bool> = (0..rigid).map(|_| true).chain(self.stops.iter().map(is_kept)).collect();
        self.keep(pool, &kept);
        for stop in &mut self.stops {
            if let Branch::Kept(number) = branch(stop.rebound.switch) {
                stop.rebound.switch = number;
            }
        }
        let rigid = self.rigid.iter_mut().flat_map(|slip| [&mut slip.flow].into_iter().chain(&mut slip.mobility));
        let moves = self.moves.iter_mut().chain(&mut self.integrals).flat_map(|(_, moves)| moves);
        let matrix = self.matrix.iter_mut().flatten();
        let roots: Vec<&mut Id> =
            rigid.chain(self.stops.iter_mut().flat_map(Struck::roots)).chain(matrix).chain(moves).collect();
        let before: Vec<Id> = roots.iter().map(|id| **id).collect();
        let after = substitute_switched(pool, &before, replace, branch);
        roots.into_iter().zip(after).for_each(|(root, id)| *root = id);
    }

    /// Forgets the rows that need what is not there.
    pub fn prune(&mut self, pool: &Pool, known: &Known) {
        let has = |slip: &Slip| [slip.flow].into_iter().chain(slip.mobility).all(|id| known.has(pool, id));
        let has_all = |stop: &Struck| stop.ids().into_iter().all(|id| known.has(pool, id));
        let stays = |stop: &Struck| known.has_switch(stop.rebound.switch) && has_all(stop);
        let kept: Vec<bool> = self.rigid.iter().map(has).chain(self.stops.iter().map(stays)).collect();
        for moves in [&mut self.moves, &mut self.integrals] {
            moves.retain(|(state, _)| known.has_state(*state));
        }
        self.keep(pool, &kept);
    }

    /// Forgets the rows that are not kept, and what none of the others moves; without a stop all of it.
    fn keep(&mut self, pool: &Pool, kept: &[bool]) {
        let (rigid, stops) = kept.split_at(self.rigid.len());
        if !stops.contains(&true) {
            *self = Self::default();
            return;
        }
        filter(&mut self.rigid, rigid);
        filter(&mut self.stops, stops);
        filter(&mut self.matrix, kept);
        self.matrix.iter_mut().for_each(|row| filter(row, kept));
        for moved in [&mut self.moves, &mut self.integrals] {
            moved.iter_mut().for_each(|(_, moves)| filter(moves, kept));
            moved.retain(|(_, moves)| moves.iter().any(|&id| !pool.is_zero(id)));
        }
    }

    /// Gives the states that impulses change their new numbers; those without one are gone.
    pub fn renumber(&mut self, to: &dyn Fn(usize) -> Option<usize>) {
        for moved in [&mut self.moves, &mut self.integrals] {
            let moves = std::mem::take(moved);
            *moved = moves.into_iter().filter_map(|(state, moves)| Some((to(state)?, moves))).collect();
        }
    }
}
