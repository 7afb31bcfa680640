//! The equations of the momenta that stay.
//!
//! In: solved rows, images p = E q of all momenta over those that stay, q. Out: the rates of q, and the values of the
//! reactions of the solved rows.
//! Method: the velocities that these rows allow are T q, T = M^-1 E, so that T^T B = 0 for what their reactions B l add
//! to p' = f + B l. Hence S q' = T^T (f - E' q) with S = T^T E, symmetric and positive definite (Kane and Levinson,
//! Dynamics: Theory and Applications (1985), section 6.1, with momenta for speeds). S is factored in symbols. The
//! reactions follow from the rates of the momenta that go.

use std::collections::{BTreeMap, BTreeSet};

use super::dyad::Turned;
use super::inverse::Inverse;
use super::joined::Choice;
use super::speeds::of_kind;
use crate::expr::{Id, Linear, Pool, Symbol, derivative, partial, solve_linear, substitute};
use crate::system::equations::{Kind, StateEquations};

/// Gives the momenta that stay their rates, and returns the values of the solved rows' reactions; none where these act
/// on a momentum that nothing else depends on.
pub(super) fn equations(equations: &mut StateEquations, choice: &Choice) -> Option<BTreeMap<Symbol, Id>> {
    let momenta: Vec<usize> = of_kind(equations, Kind::Momentum).collect();
    let solved: BTreeSet<Symbol> = choice.rows.iter().map(|&(row, _)| equations.reactions[row].multiplier).collect();
    let forces = forces(equations, choice, &momenta, &solved);
    let images: Vec<Id> = momenta.iter().map(|&state| equations.pool.symbol(Symbol::state(state))).collect();
    let images = choice.applied(&mut equations.pool, &images);
    let drifts = drifts(equations, choice, &images);
    let velocities: Vec<Id> = momenta.iter().map(|state| choice.velocities[state]).collect();
    let velocities = choice.shortened(&mut equations.pool, &velocities);
    let active = active(equations, choice, &velocities);
    let is_free = |state: &usize| !active.contains(state) && !choice.images.contains_key(state);
    if momenta.iter().filter(|&state| is_free(state)).any(|state| {
        let rate = equations.states[*state].rate;
        equations.pool.symbols(&[rate]).iter().any(|symbol| solved.contains(symbol))
    }) {
        return None;
    }
    let pool = &mut equations.pool;
    let columns = |pool: &mut Pool, of: &[Id]| -> Vec<Vec<Id>> {
        active.iter().map(|&state| partial(pool, of, Symbol::state(state))).collect()
    };
    let (shapes, motions) = (columns(pool, &images), columns(pool, &velocities));
    let net: Vec<Id> = forces.iter().zip(&drifts).map(|(&force, &drift)| pool.sub(force, drift)).collect();
    let right: Vec<Id> = motions.iter().map(|motion| dot(pool, motion, &net)).collect();
    let right = choice.circles.shortened(pool, &right);
    let mut matrix = Vec::new();
    for (i, motion) in motions.iter().enumerate() {
        let row: Vec<Id> = shapes[..=i].iter().map(|shape| dot(pool, motion, shape)).collect();
        matrix.push(choice.circles.shortened(pool, &row));
    }
    let inverse = Inverse::of(pool, &matrix);
    let rates = superposed(pool, &inverse, &right);
    let values = reactions(equations, choice, (&momenta, &forces), (&shapes, &rates, &drifts))?;
    for (&state, rate) in active.iter().zip(rates) {
        equations.states[state].rate = rate;
    }
    Some(values)
}

fn dot(pool: &mut Pool, a: &[Id], b: &[Id]) -> Id {
    let parts: Vec<Id> = a.iter().zip(b).map(|(&a, &b)| pool.mul(a, b)).collect();
    pool.sum(&parts)
}

/// The solution for `right`, as that without the reactions that are left, and a multiple of each of these: so their
/// values, which are not known yet, are put in once.
fn superposed(pool: &mut Pool, inverse: &Inverse, right: &[Id]) -> Vec<Id> {
    let left: Vec<Symbol> =
        pool.symbols(right).into_iter().filter(|symbol| matches!(symbol, Symbol::Multiplier(_))).collect();
    let columns: Vec<Vec<Id>> = left.iter().map(|&multiplier| partial(pool, right, multiplier)).collect();
    let all: Vec<Id> = columns.iter().flatten().copied().collect();
    if pool.symbols(&all).iter().any(|symbol| left.contains(symbol)) {
        return inverse.times(pool, right, &[]);
    }
    let zero = pool.zero();
    let rest = substitute(pool, right, &|symbol| left.contains(&symbol).then_some(zero));
    let columns: Vec<(Id, Vec<Id>)> = left.iter().map(|&symbol| pool.symbol(symbol)).zip(columns).collect();
    inverse.times(pool, &rest, &columns)
}

/// The rates of the momenta without the reactions of the solved rows.
fn forces(equations: &mut StateEquations, choice: &Choice, momenta: &[usize], solved: &BTreeSet<Symbol>) -> Vec<Id> {
    let StateEquations { pool, states, .. } = equations;
    let (zero, rates) = (pool.zero(), momenta.iter().map(|&state| states[state].rate).collect::<Vec<_>>());
    let rates = substitute(pool, &rates, &|symbol| solved.contains(&symbol).then_some(zero));
    choice.shortened(pool, &rates)
}

/// How images change by the motion of the pose alone.
fn drifts(equations: &mut StateEquations, choice: &Choice, images: &[Id]) -> Vec<Id> {
    let StateEquations { pool, states, .. } = equations;
    let is_pose = |&state: &usize| states[state].origin.kind() != Kind::Momentum;
    let all: Vec<Id> = images.iter().copied().chain(choice.roots.iter().map(|root| root.slope)).collect();
    let pose: Vec<usize> = pool.symbols(&all).into_iter().filter_map(Symbol::as_state).filter(is_pose).collect();
    let rates: Vec<Id> = pose.iter().map(|&state| states[state].rate).collect();
    let rates = choice.applied(pool, &rates);
    let mut seeds: BTreeMap<Symbol, Id> = pose.into_iter().map(Symbol::state).zip(rates).collect();
    choice.seed_roots(pool, &mut seeds);
    let drifts = derivative(pool, images, &seeds);
    choice.circles.shortened(pool, &drifts)
}

/// The momenta that stay and whose equations belong together, as velocities of what goes depend on them.
fn active(equations: &StateEquations, choice: &Choice, velocities: &[Id]) -> Vec<usize> {
    let pool = &equations.pool;
    let momenta_of = |ids: &[Id]| -> BTreeSet<usize> {
        let states = pool.symbols(ids).into_iter().filter_map(Symbol::as_state);
        states.filter(|&state| equations.states[state].origin.kind() == Kind::Momentum).collect()
    };
    let mut active = momenta_of(&choice.images.values().copied().collect::<Vec<_>>());
    loop {
        let before = active.len();
        for &velocity in velocities {
            let of = momenta_of(&[velocity]);
            if !of.is_disjoint(&active) {
                active.extend(of);
            }
        }
        if active.len() == before {
            return active.into_iter().collect();
        }
    }
}

/// The reactions of the solved rows, from the rates of the momenta that go.
fn reactions(
    equations: &mut StateEquations,
    choice: &Choice,
    (momenta, forces): (&[usize], &[Id]),
    (shapes, rates, drifts): (&[Vec<Id>], &[Id], &[Id]),
) -> Option<BTreeMap<Symbol, Id>> {
    let multipliers: Vec<Symbol> = choice.rows.iter().map(|&(row, _)| equations.reactions[row].multiplier).collect();
    let pool = &mut equations.pool;
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for &(_, momentum) in &choice.rows {
        let k = momenta.iter().position(|&state| state == momentum)?;
        let parts: Vec<Id> = shapes.iter().zip(rates).map(|(shape, &rate)| pool.mul(shape[k], rate)).collect();
        let change = pool.sum(&parts);
        let change = pool.add(change, drifts[k]);
        right.push(pool.sub(change, forces[k]));
        let loads = choice.rows.iter().enumerate();
        let loads =
            loads.filter_map(|(column, &(row, _))| Some((column, *choice.loads[row].as_ref()?.get(&momentum)?)));
        let (columns, loads): (Vec<usize>, Vec<Id>) = loads.unzip();
        let loads = choice.applied(pool, &loads);
        rows.push(columns.into_iter().zip(loads).collect());
    }
    let turned = turned(pool, choice);
    for (columns, by) in &turned {
        rows.iter_mut().for_each(|row| turn(pool, row, *columns, *by, 1.0));
    }
    let mut values = solve_linear(pool, Linear { rows, right }, &|_, _| true).ok()?.values;
    for ([one, other], by) in turned {
        let mut pair = BTreeMap::from([(0, values[one]), (1, values[other])]);
        turn(pool, &mut pair, [0, 1], by, -1.0);
        (values[one], values[other]) = (pair[&0], pair[&1]);
    }
    Some(multipliers.into_iter().zip(values).collect())
}

/// The pins that close loops: the places of their two rows among the solved ones, and the vector along which and across
/// which their reactions give one momentum each.
fn turned(pool: &mut Pool, choice: &Choice) -> Vec<([usize; 2], [Id; 2])> {
    let place = |row: usize| choice.rows.iter().position(|&(solved, _)| solved == row);
    let pins = choice.turned.iter().filter_map(|Turned { rows: [one, other], by }| {
        let by = choice.applied(pool, by);
        Some(([place(*one)?, place(*other)?], [by[0], by[1]]))
    });
    pins.collect()
}

/// The parts of two columns along a vector and across it in their places; with the sense -1 what these are along the
/// axes.
fn turn(pool: &mut Pool, row: &mut BTreeMap<usize, Id>, [one, other]: [usize; 2], [x, y]: [Id; 2], sense: f64) {
    let part = |row: &BTreeMap<usize, Id>, place: usize, pool: &Pool| row.get(&place).copied().unwrap_or(pool.zero());
    let (a, b) = (part(row, one, pool), part(row, other, pool));
    if pool.is_zero(a) && pool.is_zero(b) {
        return;
    }
    let products = [pool.mul(x, a), pool.mul(y, b), pool.mul(x, b), pool.mul(y, a)];
    let along = pool.linear(0.0, &[(products[0], 1.0), (products[1], sense)]);
    let across = pool.linear(0.0, &[(products[2], 1.0), (products[3], -sense)]);
    row.extend([(one, along), (other, across)]);
}
