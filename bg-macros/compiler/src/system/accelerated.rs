//! The derivatives of the rates of trees of joints, with the accelerations as unknowns.
//!
//! In: [`StateEquations`] with bodies in joint coordinates. Out: the entries of f_x, f_l, r_x and r_l, where l are the
//! accelerations and then the reactions of joints that close loops, r the efforts of the tree and the rates of the
//! flows that these joints hold. A rate of a speed is its acceleration. An effort depends on nothing beyond the joints
//! that carry its link and those that it carries (`inverse`), so there are no more entries, and the inverse of the mass
//! matrix is never multiplied out: the elimination factors the matrix by its branches (Featherstone, Rigid Body
//! Dynamics Algorithms, 2008, section 6.5).

use std::collections::BTreeMap;

use super::inverse::{InverseDynamics, Row, Variable};
use super::jacobian::{Entry, Jacobian, equations_of};
use crate::expr::{Id, Pool, Symbol, derivative, substitute};
use crate::system::equations::StateEquations;

/// The derivatives; none where the states are no coordinates of more than one freedom, or reactions of dry friction and
/// of stops are left, which lock no joint (`reduce::tree::locking`).
pub(super) fn differentiate(equations: &StateEquations) -> Option<Jacobian> {
    let mut pool = equations.pool.clone();
    let inverse = equations.inverse.as_ref()?;
    let rows = equations.holding.rigid.len();
    let multipliers = &equations.solution.multipliers;
    if multipliers.len() > rows {
        return None;
    }
    let accelerations: Vec<(usize, usize)> = inverse.all().collect();
    if accelerations.len() < 2 {
        return None;
    }
    let unknowns: Vec<Symbol> =
        accelerations.iter().map(|&of| inverse.symbol(of)).chain(multipliers.iter().copied()).collect();
    let rates = by_accelerations(&mut pool, equations, inverse);
    let efforts = inverse.rows(&mut pool);
    let flows = flow_rates(&mut pool, equations, &rates);
    let flows = equations_of(&mut pool, equations, multipliers, &flows);
    let n = rates.len();
    let symbols: Vec<Symbol> = (0..n).map(Symbol::state).chain(unknowns.iter().copied()).collect();
    let dynamics: Vec<Id> = accelerations.iter().map(|&of| left_side(&mut pool, inverse, &efforts, of)).collect();
    let sides: Vec<Id> = [rates, dynamics, flows].concat();
    let places: Vec<Id> = inverse.moved.iter().flat_map(|moved| [moved.moves.place, moved.moves.speed]).collect();
    let roots: Vec<Id> = sides.iter().chain(&places).copied().collect();
    let mut entries = Vec::new();
    for (column, &symbol) in symbols.iter().enumerate() {
        let seeds = BTreeMap::from([(symbol, pool.one())]);
        let mut slopes = derivative(&mut pool, &roots, &seeds);
        let changes = slopes.split_off(sides.len());
        let own = column.checked_sub(n).and_then(|unknown| accelerations.get(unknown));
        for effort in &efforts {
            let row = n + accelerations.iter().position(|&of| of == effort.of).expect("an effort gives an unknown");
            let taken = taken(&mut pool, effort, &changes, own.copied());
            let [slides, _] = held(&mut pool, inverse, effort.of);
            let taken = pool.mul(slides, taken);
            slopes[row] = pool.add(taken, slopes[row]);
        }
        let entry = |(row, value)| Entry { row, column, value };
        entries.extend(slopes.into_iter().enumerate().map(entry).filter(|entry| !pool.is_zero(entry.value)));
    }
    let needed = needed(&entries, n, unknowns.len());
    let late = needed[unknowns.len() - rows..].iter().filter(|&&needed| needed).count();
    let unknowns = unknowns.into_iter().zip(&needed).filter(|(_, needed)| **needed).map(|(symbol, _)| symbol).collect();
    let mut entries = numbered(entries, n, &needed);
    entries.sort_by_key(|entry| (entry.row, entry.column));
    Some(closed(pool, equations, inverse, (unknowns, late), entries))
}

/// Which unknowns the rates depend on, through the equations of others as well: not those of joints that nobody
/// watches.
fn needed(entries: &[Entry], n: usize, unknowns: usize) -> Vec<bool> {
    let mut needed = vec![false; unknowns];
    let mut is_open = true;
    while is_open {
        is_open = false;
        for Entry { row, column, .. } in entries {
            let Some(unknown) = column.checked_sub(n).filter(|&unknown| !needed[unknown]) else { continue };
            if row.checked_sub(n).is_none_or(|row| needed[row]) {
                needed[unknown] = true;
                is_open = true;
            }
        }
    }
    needed
}

/// The entries without the unknowns that are not needed and their equations.
fn numbered(entries: Vec<Entry>, n: usize, needed: &[bool]) -> Vec<Entry> {
    let place = |place: usize| match place.checked_sub(n) {
        None => Some(place),
        Some(unknown) => needed[unknown].then(|| n + needed[..unknown].iter().filter(|&&needed| needed).count()),
    };
    let moved = |entry: Entry| Some(Entry { row: place(entry.row)?, column: place(entry.column)?, ..entry });
    entries.into_iter().filter_map(moved).collect()
}

/// The rates with the accelerations in their places.
fn by_accelerations(pool: &mut Pool, equations: &StateEquations, inverse: &InverseDynamics) -> Vec<Id> {
    let mut places: BTreeMap<Id, Id> = inverse.written.iter().map(|&[rate, written]| (rate, written)).collect();
    for (link, unknown) in inverse.all().filter(|&(link, _)| inverse.links[link].freedom.has_coordinate()) {
        places.insert(inverse.rates[link], pool.symbol(inverse.symbol((link, unknown))));
    }
    let rate =
        |rate: Id| if pool.as_number(rate).is_some() { rate } else { places.get(&rate).copied().unwrap_or(rate) };
    equations.states.iter().map(|state| rate(state.rate)).collect()
}

/// The rates of the flows that joints hold, with these rates of the states.
fn flow_rates(pool: &mut Pool, equations: &StateEquations, rates: &[Id]) -> Vec<Id> {
    let states = rates.iter().enumerate().map(|(state, &rate)| (Symbol::state(state), rate));
    let seeds: BTreeMap<Symbol, Id> = states.chain([(Symbol::Time, pool.one())]).collect();
    let flows: Vec<Id> = equations.holding.rigid.iter().map(|slip| slip.flow).collect();
    derivative(pool, &flows, &seeds)
}

/// 1 where a link slides or nothing holds it, else 0; and what a link that sticks has in its equation: the rate of its
/// speed is known.
fn held(pool: &mut Pool, inverse: &InverseDynamics, of: (usize, usize)) -> [Id; 2] {
    let Some(locked) = inverse.moved[of.0].locked else { return [pool.one(), pool.zero()] };
    let (slides, unknown) = (locked.slides(pool), pool.symbol(inverse.symbol(of)));
    let apart = pool.sub(unknown, locked.rate);
    [slides, pool.mul(locked.acts, apart)]
}

/// What of an unknown's equation is no effort that accelerations take: less what acts, or the unknown less its value.
fn left_side(pool: &mut Pool, inverse: &InverseDynamics, efforts: &[Row], of: (usize, usize)) -> Id {
    match efforts.iter().find(|effort| effort.of == of) {
        Some(effort) => {
            let [slides, held] = held(pool, inverse, of);
            let acting = pool.mul(slides, effort.acting);
            pool.sub(held, acting)
        }
        None => {
            let unknown = pool.symbol(inverse.symbol(of));
            pool.sub(unknown, inverse.value(of))
        }
    }
}

/// How what an effort takes changes, where the places and speeds of the links change so, or this unknown does.
fn taken(pool: &mut Pool, effort: &Row, changes: &[Id], own: Option<(usize, usize)>) -> Id {
    let parts: Vec<Id> = effort
        .slopes
        .iter()
        .map(|&(variable, slope)| match variable {
            Variable::Place(link) => pool.mul(slope, changes[2 * link]),
            Variable::Speed(link) => pool.mul(slope, changes[2 * link + 1]),
            Variable::Unknown(link, unknown) if own == Some((link, unknown)) => slope,
            Variable::Unknown(..) => pool.zero(),
        })
        .collect();
    pool.sum(&parts)
}

/// The values of all unknowns in their places.
fn closed(
    mut pool: Pool,
    equations: &StateEquations,
    inverse: &InverseDynamics,
    unknowns: (Vec<Symbol>, usize),
    mut entries: Vec<Entry>,
) -> Jacobian {
    let values: BTreeMap<Symbol, Id> = inverse.all().map(|of| (inverse.symbol(of), inverse.value(of))).collect();
    let ids: Vec<Id> = entries.iter().map(|entry| entry.value).collect();
    let ids = substitute(&mut pool, &ids, &|symbol| values.get(&symbol).copied());
    entries.iter_mut().zip(ids).for_each(|(entry, id)| entry.value = id);
    Jacobian::closed(pool, equations, unknowns, entries)
}
