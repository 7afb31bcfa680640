//! Dry friction and stops among the reactions: what sticks or rests is a constraint, what slides is a known effort, what is clear
//! of a stop is not there.
//!
//! In: reactions with dry friction and stops, the equations A l + b = 0 of all of them. Out: equations that hold in every branch.
//! Method: the row and the column of what slides are multiplied by 0 but for the diagonal, so that it takes no part; what it
//! gives is in b. Its own l is not used then.

use crate::expr::{Id, Pool, Symbol, substitute};
use crate::system::equations::Reaction;

/// Rate at which a flow that truncation leaves decays while it sticks, 1/s: slow, so that no explicit step is the shorter for it.
pub(super) const DECAY: f64 = 1.0;
/// The rate with which truncation of what rests decays, 1/s: as slow, and critically damped, since a stop knows its place.
pub(super) const PLACE: f64 = 1.0;
/// The part of its diagonal entry below which a pivot of dry friction counts as zero: others hold that motion already.
const PART: f64 = 1e-10;

/// The left sides of the equations: of a residual sink with every effort as it is applied, of dry friction with its own as if
/// it stuck.
pub(super) fn residuals(pool: &mut Pool, multipliers: &[Symbol], efforts: &[Id], expressions: &[Id]) -> Vec<Id> {
    let place = |symbol: Symbol| multipliers.iter().position(|&multiplier| multiplier == symbol);
    let residual = |(row, &expression): (usize, &Id)| {
        let effort = |symbol: Symbol| place(symbol).filter(|&other| other != row).map(|other| efforts[other]);
        substitute(pool, &[expression], &effort)[0]
    };
    expressions.iter().enumerate().map(residual).collect()
}

/// What each reaction applies, by its multiplier.
pub(super) fn efforts(pool: &mut Pool, reactions: &[Reaction]) -> Vec<Id> {
    let effort = |reaction: &Reaction| {
        let own = pool.symbol(reaction.multiplier);
        reaction.switched.as_ref().map_or(own, |switched| switched.effort)
    };
    reactions.iter().map(effort).collect()
}

/// How many of the reactions are those of residual sinks, which come first.
pub(super) fn rigid(reactions: &[Reaction]) -> usize {
    reactions.iter().take_while(|reaction| reaction.switched.is_none()).count()
}

/// The lower triangle of A without the couplings of what slides.
pub(super) fn decoupled(pool: &mut Pool, reactions: &[Reaction], matrix: &[Vec<Id>]) -> Vec<Vec<Id>> {
    let acts = |k: usize| reactions[k].switched.as_ref().map(|switched| switched.acts);
    let mut entry = |i: usize, j: usize| {
        let couplings = [acts(i), acts(j)].into_iter().flatten().filter(|_| i != j);
        let factors: Vec<Id> = couplings.chain([matrix[i][j]]).collect();
        pool.product(&factors)
    };
    (0..matrix.len()).map(|i| (0..=i).map(|j| entry(i, j)).collect()).collect()
}

/// The reciprocal of a pivot of dry friction, 0 where it vanishes beside the entry that it came from: p / (p^2 + d^2).
pub(super) fn reciprocal(pool: &mut Pool, pivot: Id, entry: Id) -> Id {
    if pivot == entry {
        let one = pool.one();
        return pool.div(one, pivot);
    }
    let least = pool.scale(PART, entry);
    let squares = [pool.powi(pivot, 2), pool.powi(least, 2)];
    let squares = pool.sum(&squares);
    pool.div(pivot, squares)
}
