//! Stops of joints where accelerations are unknowns: a joint that rests on a stop has a known acceleration.
//!
//! In: a tree of links in motion, reactions of stops. Out: the same tree, in which stops lock links as dry friction does,
//! so that none of their reactions is left. Method: where a link rests, the rate of its speed is the one that the stop's
//! equation asks for (`reduce::reaction`); where it is clear of all of its stops, these apply nothing.

use crate::expr::{Id, Node, Pool, Symbol, partial, substitute};
use crate::system::equations::StateEquations;
use crate::system::equations::impact::Struck;
use crate::system::equations::stop::RETURN;
use crate::system::inverse::InverseDynamics;
use crate::system::jacobian::Entry;
use crate::system::link::{Locked, Moved};

/// How far from 1 a factor may be that is 1 but for rounding.
const ROUNDING: f64 = 1e-12;

/// The tree with its stops as what locks links, each link with a coordinate by those on its own speed. None where other
/// reactions are switched, as those of dry friction are, where a stop is on no such speed, or acts elsewhere as well.
pub(super) fn with_stops(
    pool: &mut Pool,
    equations: &StateEquations,
    inverse: &InverseDynamics,
) -> Option<InverseDynamics> {
    let mut inverse = inverse.clone();
    let switched = switched(equations);
    if !switched.is_empty() && inverse.moved.iter().any(|own| own.locked.is_some()) {
        return None;
    }
    for &(multiplier, effort) in &switched {
        let stop = stop(pool, equations, multiplier, effort)?;
        let (link, sign) =
            inverse.moved.iter().enumerate().find_map(|(link, own)| Some((link, sign(pool, stop, own)?)))?;
        rest(pool, &mut inverse.moved[link], (stop, sign), multiplier);
    }
    let stops: Vec<Symbol> = switched.into_iter().map(|(multiplier, _)| multiplier).collect();
    let acting: Vec<Id> = inverse
        .moved
        .iter()
        .flat_map(|own| [own.effort].into_iter().chain(own.load.iter().flat_map(|part| part.0.clone())))
        .collect();
    (!reads(pool, &acting, &stops)).then_some(inverse)
}

/// Whether these rates depend on what stops apply.
pub(super) fn are_read(pool: &Pool, equations: &StateEquations, rates: &[Id]) -> bool {
    let stops: Vec<Symbol> = switched(equations).into_iter().map(|(multiplier, _)| multiplier).collect();
    reads(pool, rates, &stops)
}

/// Whether the reactions beside the accelerations can be solved for, whichever links rest. Rows and columns begin with
/// `n` states and then so many accelerations, of which `is_free` are those of links that nothing locks. Where any link
/// can be locked each reaction has to hold one of these alone.
pub(super) fn are_regular(
    pool: &mut Pool,
    entries: &[Entry],
    (n, accelerations): (usize, usize),
    is_free: &dyn Fn(usize) -> bool,
) -> bool {
    if (0..accelerations).all(is_free) {
        return true;
    }
    let one = pool.one();
    let of_reactions: Vec<&Entry> = entries.iter().filter(|entry| entry.row >= n + accelerations).collect();
    let mut holds_alone = |entry: &Entry| {
        let unknown = entry.column.checked_sub(n).filter(|&unknown| unknown < accelerations && is_free(unknown));
        // A reaction that is not kept is zero.
        let kept = substitute(pool, &[entry.value], &|symbol| matches!(symbol, Symbol::Kept(_)).then_some(one))[0];
        let is_alone = of_reactions.iter().filter(|other| other.column == entry.column).count() == 1;
        unknown.is_some() && is_alone && pool.as_number(kept).is_some()
    };
    of_reactions.iter().all(|of| of_reactions.iter().any(|entry| entry.row == of.row && holds_alone(entry)))
}

/// The reactions after those of rigid joints, each with what it applies.
fn switched(equations: &StateEquations) -> Vec<(Symbol, Id)> {
    let solution = &equations.solution;
    let all = solution.multipliers.iter().copied().zip(solution.efforts.iter().copied());
    all.skip(equations.holding.rigid.len()).collect()
}

/// The stop whose reaction this is: it applies nothing while its switch is negative, itself where something rests on it.
fn stop<'a>(pool: &Pool, equations: &'a StateEquations, multiplier: Symbol, effort: Id) -> Option<&'a Struck> {
    let &Node::Select { switch, negative, positive } = pool.node(effort) else { return None };
    let is_stop = pool.is_zero(negative) && *pool.node(positive) == Node::Symbol(multiplier);
    equations.impacts.stops.iter().find(|stop| is_stop && stop.rebound.switch == switch)
}

/// 1 where the flow of a stop is the speed of this link, -1 where it is the opposite, none otherwise.
fn sign(pool: &mut Pool, stop: &Struck, own: &Moved) -> Option<f64> {
    let &Node::Symbol(speed) = pool.node(own.moves.speed) else { return None };
    let (flow, zero) = (stop.slip.flow, pool.zero());
    let by = partial(pool, &[flow], speed)[0];
    let by = pool.as_number(by).filter(|by| own.own.is_none() && (by.abs() - 1.0).abs() < ROUNDING)?;
    let rest = substitute(pool, &[flow], &|symbol| (symbol == speed).then_some(zero))[0];
    pool.is_zero(rest).then_some(by.signum())
}

/// Locks a link where it rests on a stop on whose flow its speed has this sign.
fn rest(pool: &mut Pool, own: &mut Moved, (stop, sign): (&Struck, f64), multiplier: Symbol) {
    let (zero, one, switch) = (pool.zero(), pool.one(), stop.rebound.switch);
    let gap = stop.slip.gap.unwrap_or(zero);
    let asked = pool.linear(0.0, &[(stop.slip.flow, -2.0 * RETURN * sign), (gap, -RETURN * RETURN * sign)]);
    let before = own.locked.unwrap_or(Locked { acts: zero, rate: zero });
    own.locked =
        Some(Locked { acts: pool.select(switch, before.acts, one), rate: pool.select(switch, before.rate, asked) });
    own.effort = substitute(pool, &[own.effort], &|symbol| (symbol == multiplier).then_some(zero))[0];
}

fn reads(pool: &Pool, ids: &[Id], symbols: &[Symbol]) -> bool {
    let read = pool.symbols(ids);
    symbols.iter().any(|symbol| read.contains(symbol))
}
