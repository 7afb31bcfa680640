//! Momenta that rigid joints determine.
//!
//! In: equations with the reactions of rigid joints. Out: the same in fewer unknowns: the momenta and positions that
//! joints determine are expressions of the others, and the reactions of these joints occur in no rate.
//! Method: a row that a joint holds, J v = 0, is solved for a momentum with a pivot that is constant along every motion
//! (`joined`). What is left of the momenta obeys the equations projected on the motions that these rows allow
//! (`projected`). Rows without such a pivot, as those that close a loop, keep their reactions.
//! The step is taken back as a whole where something does not fit it: velocities at the start that the rows do not
//! allow for all parameters, as many rows left as momenta; or where rates would take more operations, as those of a
//! long chain do, whose matrix is full where that of the reactions is a band.

use std::collections::BTreeSet;

use super::joined::Choice;
use super::report::{Kept, Report};
use super::{Operations, Wanted, closing, friction, projected};
use crate::expr::{Id, Symbol, partial, same_polynomial, substitute};
use crate::system::equations::{Kind, Origin, StateEquations};

/// The rates of a step, those of DOP853.
const RATES: usize = 12;

/// Takes momenta out of the equations that rigid joints determine, where rates take fewer operations then; else says
/// why not.
pub(super) fn choose(
    equations: &mut StateEquations,
    wanted: &Wanted,
    report: &mut Report,
    operations: &mut Operations<'_>,
) -> Result<(), Kept> {
    if !wanted.speeds {
        return Err(Kept::Asked);
    }
    if friction::rigid(&equations.reactions) == 0 {
        return Err(Kept::NothingRigid);
    }
    if equations.baumgarte.is_some() {
        return Err(Kept::Baumgarte);
    }
    let is_asked = !wanted.links.is_empty();
    let closed = chosen(equations, Some(&wanted.links)).filter(|(_, choice)| !choice.roots.is_empty());
    let closes = closed.is_some();
    // What the scene asks for, else with loops and without them.
    let without = if closes && is_asked { None } else { chosen(equations, None) };
    let mut reason = Kept::NoPivot;
    let mut found: Vec<(usize, StateEquations, Choice)> = Vec::new();
    for (mut changed, choice) in without.into_iter().chain(closed) {
        match put(&mut changed, &choice) {
            Ok(()) => found.push((cost(&changed, &choice.kept(&changed), operations), changed, choice)),
            Err(kept) => reason = kept,
        }
    }
    let (by_speeds, changed, choice) = found.into_iter().min_by_key(|&(cost, ..)| cost).ok_or(reason)?;
    let before = cost(equations, &vec![true; equations.states.len()], operations);
    if by_speeds >= before && !(is_asked && closes) {
        return Err(Kept::Costs(by_speeds, before));
    }
    for (&state, fate) in &choice.fates {
        report.say(state, fate.clone());
    }
    let track = |state: &usize| match equations.states[*state].origin {
        Origin::Orientation(track, ..) => Some(equations.tracks[track].clone()),
        _ => None,
    };
    report.closed = choice.given.keys().filter_map(track).collect();
    *equations = changed;
    super::live::keep_states(equations, report, &choice.kept(equations));
    Ok(())
}

/// What can be taken out of the equations, which are a copy; with `links` loops are closed in closed form.
fn chosen(equations: &StateEquations, links: Option<&[String]>) -> Option<(StateEquations, Choice)> {
    let mut changed = equations.clone();
    let choice = Choice::of(&mut changed, links)?;
    Some((changed, choice))
}

/// Puts what is chosen into the equations, where the mechanism can do without the reactions of the chosen rows.
fn put(equations: &mut StateEquations, choice: &Choice) -> Result<(), Kept> {
    check(equations, choice)?;
    if closing::is_any(equations) && !keep_mobilities(equations, choice) {
        return Err(Kept::Load);
    }
    let Some(values) = projected::equations(equations, choice) else { return Err(Kept::Load) };
    equations.replace(&|symbol| match symbol {
        Symbol::Multiplier(_) => values.get(&symbol).copied(),
        _ => symbol.as_state().and_then(|state| choice.images.get(&state).copied()),
    });
    equations.rewrite(&|pool, ids| choice.circles.shortened(pool, ids));
    let mut row = 0;
    equations.reactions.retain(|_| {
        row += 1;
        !choice.is_solved(row - 1)
    });
    write_by_momenta(equations, choice);
    if !choice.roots.is_empty() {
        choice.put_roots(equations);
    }
    Ok(())
}

/// Gives the rows that are left their mobilities, by all momenta: the pivot of a row that is alone is its own entry of
/// the matrix, and tells nothing of how near to a singular pose the mechanism is. False where a row of a joint acts on
/// something else.
fn keep_mobilities(equations: &mut StateEquations, choice: &Choice) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    for (row, reaction) in reactions.iter_mut().enumerate().filter(|(row, _)| !choice.is_solved(*row)) {
        let loads: Option<Vec<(usize, Id)>> = if row < choice.rigid {
            choice.loads[row].as_ref().map(|loads| loads.iter().map(|(&state, &load)| (state, load)).collect())
        } else {
            // Dry friction and stops act on their guards, too.
            let by = |&state: &usize| (state, partial(pool, &[states[state].rate], reaction.multiplier)[0]);
            Some(choice.velocities.keys().map(by).collect())
        };
        let Some(loads) = loads else { return false };
        reaction.slip.mobility = Some(closing::mobility(pool, reaction.slip.flow, &loads));
    }
    true
}

/// How many operations a rate of these states takes when the reactions are solved for, with its part of the projection
/// after a step: what joints hold takes about as many for the pose and again for the momenta.
fn cost(equations: &StateEquations, kept: &[bool], operations: &mut Operations<'_>) -> usize {
    let mut solved = equations.clone();
    super::live::keep_states(&mut solved, &mut Report::new(equations), kept);
    super::reaction::solve(&mut solved);
    let held = solved.holding.entries(&solved.pool);
    operations(&mut solved) + 2 * solved.pool.cost(&held) / RATES
}

/// Says why the mechanism cannot do without the reactions of the chosen rows, if so.
fn check(equations: &mut StateEquations, choice: &Choice) -> Result<(), Kept> {
    let left: Vec<usize> = (0..choice.rigid).filter(|&row| !choice.is_solved(row)).collect();
    let moved: BTreeSet<usize> = choice.survivors(equations).collect();
    // As many rows as momenta: they may follow from each other, and reactions of least norm be asked for, or nothing
    // may move.
    if !left.is_empty() && left.len() >= moved.len() {
        return Err(Kept::Immobile);
    }
    // Where several rows close loops, some of them may follow from others; what is shared then is shared among all
    // joints.
    if left.len() > 1 && is_watched(equations, choice) {
        return Err(Kept::Shared);
    }
    match choice.rows.iter().find(|&&(row, _)| !starts_at_rest(equations, row)) {
        Some(&(row, _)) => Err(Kept::Start(equations.reactions[row].slip.joint.clone())),
        None => Ok(()),
    }
}

/// Whether an output shows a reaction of a chosen row.
fn is_watched(equations: &StateEquations, choice: &Choice) -> bool {
    let outputs: Vec<Id> = equations.outputs.iter().map(|output| output.value).collect();
    let watched = equations.pool.symbols(&outputs);
    choice.rows.iter().any(|&(row, _)| watched.contains(&equations.reactions[row].multiplier))
}

/// Whether the flow of a row is zero at the start, whatever the parameters and the pose are.
pub(super) fn starts_at_rest(equations: &mut StateEquations, row: usize) -> bool {
    let StateEquations { pool, states, reactions, .. } = equations;
    let flow = reactions[row].slip.flow;
    let at_start = substitute(pool, &[flow], &|symbol| symbol.as_state().map(|state| states[state].start))[0];
    let zero = pool.zero();
    same_polynomial(pool, at_start, zero)
}

/// The flows that are still held, each as a sum over the momenta with coefficients as short as they can be.
fn write_by_momenta(equations: &mut StateEquations, choice: &Choice) {
    let survivors: Vec<usize> = choice.survivors(equations).collect();
    let StateEquations { pool, reactions, .. } = equations;
    let zero = pool.zero();
    for reaction in reactions {
        let flow = &mut reaction.slip.flow;
        let is_momentum = |symbol: Symbol| symbol.as_state().is_some_and(|state| survivors.contains(&state));
        let rest = substitute(pool, &[*flow], &|symbol| is_momentum(symbol).then_some(zero))[0];
        let mut parts = vec![rest];
        for &state in &survivors {
            let slope = partial(pool, &[*flow], Symbol::state(state));
            let slope = choice.circles.shortened(pool, &slope)[0];
            let momentum = pool.symbol(Symbol::state(state));
            parts.push(pool.mul(slope, momentum));
        }
        *flow = pool.sum(&parts);
    }
}

/// The states of one kind.
pub(super) fn of_kind(equations: &StateEquations, kind: Kind) -> impl Iterator<Item = usize> + '_ {
    (0..equations.states.len()).filter(move |&state| equations.states[state].origin.kind() == kind)
}
