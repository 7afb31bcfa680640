//! Back onto what rigid joints hold, after a step.
//!
//! In: equations whose reactions are solved for. Out: the same with `projections`, which close the gaps that truncation has
//! left, and `settled`, which then bring the flows to zero.
//! Method: one Newton step each, the smallest in the metric of kinetic energy. Impulses L with A L = -v change the momenta
//! by what they move, and so take away just the flows v; the same impulses for the gaps q in place of v give velocities
//! with which the pose moves for one unit of time (Bayo and Ledesma 1996, Augmented Lagrangian and mass-orthogonal
//! projection methods, Nonlinear Dynamics 9). What is left of a gap is of the order of its square.

use std::collections::BTreeMap;

use crate::expr::{Id, Pool, Symbol, derivative, substitute};
use crate::system::equations::definite::Factors;
use crate::system::equations::{Holding, Kind, StateEquations};

/// D over the mobility, the squared sine of the angle between a row and those before it, at which the projection is damped by half.
const NEAR: f64 = 1e-8;

/// Adds the projection onto what rigid joints hold, unless Baumgarte's terms stand for it.
pub fn complete(equations: &mut StateEquations) {
    if equations.holding.rigid.is_empty() || equations.baumgarte.is_some() {
        return;
    }
    let StateEquations { pool, holding, .. } = equations;
    let rows = &holding.rigid;
    let factors = Factors::of(pool, &holding.matrix, |pool, row, pivot, entry| match rows[row].kept {
        Some(kept) => damped(pool, kept, pivot, rows[row].mobility.unwrap_or(entry)),
        None => pool.powi(pivot, -1),
    });
    let zero = pool.zero();
    let flows: Vec<Id> = holding.rigid.iter().map(|slip| slip.flow).collect();
    let gaps: Vec<Id> = holding.rigid.iter().map(|slip| slip.gap.unwrap_or(zero)).collect();
    let velocities = impulses(pool, holding, &factors, &flows);
    equations.settled = velocities.into_iter().map(|(state, by)| (state, moved(pool, state, by))).collect();
    let pseudo = impulses(pool, holding, &factors, &gaps);
    close_gaps(equations, pseudo);
}

/// 1 / D of a row that may follow from others: 0 where it does, small where it nearly does. Near a singular pose a gap is
/// closed over several steps.
fn damped(pool: &mut Pool, kept: u32, pivot: Id, mobility: Id) -> Id {
    let kept = pool.symbol(Symbol::Kept(kept));
    let (square, least) = (pool.powi(pivot, 2), pool.powi(mobility, 2));
    let divisor = pool.linear(0.0, &[(square, 1.0), (least, NEAR * NEAR)]);
    let inverse = pool.div(pivot, divisor);
    pool.mul(kept, inverse)
}

/// By how much each momentum changes where the rigid motions change by `-motions`.
fn impulses(pool: &mut Pool, holding: &Holding, factors: &Factors, motions: &[Id]) -> Vec<(usize, Id)> {
    let right: Vec<Id> = motions.iter().map(|&motion| pool.neg(motion)).collect();
    let impulses = factors.solve(pool, &right);
    let change = |(state, moves): &(usize, Vec<Id>)| {
        let parts: Vec<Id> = moves.iter().zip(&impulses).map(|(&by, &impulse)| pool.mul(by, impulse)).collect();
        (*state, pool.sum(&parts))
    };
    holding.moves.iter().map(change).collect()
}

/// A state after a change.
fn moved(pool: &mut Pool, state: usize, by: Id) -> Id {
    let before = pool.symbol(Symbol::state(state));
    pool.add(before, by)
}

/// Moves the pose with the velocities that changes of the momenta give it; orientations are made orthogonal after that.
fn close_gaps(equations: &mut StateEquations, momenta: Vec<(usize, Id)>) {
    let pool = &mut equations.pool;
    let is_momentum = |&(state, _): &(usize, Id)| equations.states[state].origin.kind() == Kind::Momentum;
    let seeds = momenta.into_iter().filter(is_momentum).map(|(state, by)| (Symbol::state(state), by));
    let seeds: BTreeMap<Symbol, Id> = seeds.collect();
    let is_of_pose =
        |kind| matches!(kind, Kind::Position | Kind::Orientation | Kind::Angle | Kind::Displacement | Kind::Way);
    let states = &equations.states;
    let pose: Vec<usize> = (0..states.len()).filter(|&state| is_of_pose(states[state].origin.kind())).collect();
    let rates: Vec<Id> = pose.iter().map(|&state| states[state].rate).collect();
    let changes = derivative(pool, &rates, &seeds);
    let changed = pose.into_iter().zip(changes).filter(|&(_, by)| !pool.is_zero(by)).collect::<Vec<_>>();
    let after: BTreeMap<usize, Id> = changed.into_iter().map(|(state, by)| (state, moved(pool, state, by))).collect();
    let image = |symbol: Symbol| symbol.as_state().and_then(|state| after.get(&state).copied());
    let orthogonal: Vec<Id> = equations.projections.iter().map(|&(_, id)| id).collect();
    let orthogonal = substitute(pool, &orthogonal, &image);
    let mut projections = after;
    projections.extend(equations.projections.iter().map(|&(state, _)| state).zip(orthogonal));
    equations.projections = projections.into_iter().collect();
}
