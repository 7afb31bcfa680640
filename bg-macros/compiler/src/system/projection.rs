//! Back onto what rigid joints hold, after a step.
//!
//! In: equations whose reactions are solved for. Out: the same with `projections`, which close the gaps that truncation
//! has left, and `settled`, which then bring the flows to zero.
//! Method: one Newton step each, the smallest in the metric of kinetic energy. Impulses L with A L = -v change the
//! momenta by what they move, and so take away just the flows v; the same impulses for the gaps q in place of v give
//! velocities with which the pose moves for one unit of time (Bayo and Ledesma 1996, Augmented Lagrangian and
//! mass-orthogonal projection methods, Nonlinear Dynamics 9). What is left of a gap is of the order of its square.

use std::collections::BTreeMap;

use crate::expr::{Id, Pool, Symbol, derivative, substitute};
use crate::system::equations::definite::Factors;
use crate::system::equations::stage::{Projected, Solved};
use crate::system::equations::{Holding, Kind, StateEquations};

/// D over the mobility, the squared sine of the angle between a row and those before it, at which the projection is
/// damped by half.
const NEAR: f64 = 1e-8;

/// Adds the projection onto what rigid joints hold, unless Baumgarte's terms stand for it.
#[must_use]
pub fn complete(Solved(mut equations): Solved) -> Projected {
    add(&mut equations);
    Projected(equations)
}

fn add(equations: &mut StateEquations) {
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

/// 1 / D of a row that may follow from others: 0 where it does, small where it nearly does. Near a singular pose a gap
/// is closed over several steps.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Environment, evaluate};
    use crate::pipeline;
    use crate::source::syntax;
    use crate::system::reduce;

    /// A body whose point `top` is 0.5 m above its centre of mass.
    const BOB: &str = "ground { point O = [0, 0, 0]; point P = [0.3, 0, 1]; }
        body bob { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; point side = [0.4, 0.5, 1];
            start top at [0, 0, 0]; start turned rotation_z(0.7); start velocity [0.3, 0.1, 0]; \
            start spin [0.1, 0, 2]; }
        joint pin: revolute z (ground.O -> bob.top) { rigid; }";
    const SECOND: &str = "joint second: revolute z (ground.P -> bob.side) { rigid; }";

    /// The literal equations with their projection; rows that close loops are kept or not.
    fn completed(statements: &str, is_kept: bool) -> StateEquations {
        let text = format!("graph G {{ {statements} }}");
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let solved = reduce::literal(pipeline::derive(&source.graphs[0]).expect("equations").equations);
        let Projected(mut equations) = complete(solved);
        equations.close();
        let kept = equations.pool.number(f64::from(u8::from(is_kept)));
        equations.replace(&|symbol| matches!(symbol, Symbol::Kept(_)).then_some(kept));
        equations
    }

    fn values(of: &StateEquations, roots: &[Id], states: &[f64]) -> Vec<f64> {
        evaluate(&of.pool, roots, &Environment { states, ..Environment::default() })
    }

    /// The start, every state moved by up to `by`.
    fn start_moved(of: &StateEquations, by: f64) -> Vec<f64> {
        let starts: Vec<Id> = of.states.iter().map(|state| state.start).collect();
        let start = values(of, &starts, &[]);
        (0..).zip(start).map(|(k, value)| value + by * f64::from(k).sin()).collect()
    }

    /// A state after a projection: that of the pose, or that of the momenta.
    fn projected(of: &StateEquations, by: &[(usize, Id)], states: &[f64]) -> Vec<f64> {
        let (places, ids): (Vec<usize>, Vec<Id>) = by.iter().copied().unzip();
        let mut after = states.to_vec();
        places.into_iter().zip(values(of, &ids, states)).for_each(|(place, value)| after[place] = value);
        after
    }

    /// The largest of the rigid gaps, and of the rigid flows.
    fn open(of: &StateEquations, states: &[f64]) -> [f64; 2] {
        let slips = &of.holding.rigid;
        let ids = [slips.iter().filter_map(|slip| slip.gap).collect(), slips.iter().map(|slip| slip.flow).collect()];
        ids.map(|ids: Vec<Id>| values(of, &ids, states).iter().fold(0.0, |most: f64, value| most.max(value.abs())))
    }

    fn named(of: &StateEquations, states: &[f64], name: &str) -> f64 {
        states[of.states.iter().position(|state| state.name == name).expect("a state")]
    }

    /// The first step makes the orientation orthogonal as well, which opens the gap again where that was far off.
    #[test]
    fn what_is_left_of_a_gap_is_of_the_order_of_its_square() {
        let of = completed(BOB, true);
        for by in [1e-2, 1e-4] {
            let rotated = projected(&of, &of.projections, &start_moved(&of, by));
            let [before, after] = [&rotated, &projected(&of, &of.projections, &rotated)].map(|x| open(&of, x)[0]);
            assert!(before > 0.1 * by && after < 10.0 * before * before, "{by}: {before:e} {after:e}");
        }
    }

    #[test]
    fn flows_are_zero_after_impulses_that_the_free_motion_does_not_feel() {
        let of = completed(BOB, true);
        let start = start_moved(&of, 0.0);
        let after = projected(&of, &of.settled, &start);
        assert!(open(&of, &start)[1] > 0.1 && open(&of, &after)[1] < 1e-14, "{:?}", open(&of, &after));
        // The pin's impulses have no moment about its axis.
        let about_pin = |x: &[f64]| {
            let of = |name: &str| named(&of, x, name);
            let moment = of("bob.position_x") * of("bob.linear.p_y") - of("bob.position_y") * of("bob.linear.p_x");
            of("bob.angular.p_z") + moment
        };
        let [before, after] = [&start, &after].map(|x| about_pin(x));
        assert!((after / before - 1.0).abs() < 1e-14, "{before} {after}");
    }

    #[test]
    fn rows_that_follow_from_others_take_no_part() {
        let both = format!("{BOB} {SECOND}");
        let [without, with] = [(BOB, true), (&both, false)].map(|(text, is_kept)| completed(text, is_kept));
        let moved = start_moved(&without, 1e-3);
        let both = [&without, &with];
        for [without, with] in [both.map(|of| (of, &of.projections)), both.map(|of| (of, &of.settled))] {
            let [expected, found] = [without, with].map(|(of, by)| projected(of, by, &moved));
            let apart = expected.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(expected != moved && apart < 1e-14, "{apart:e}");
        }
    }

    #[test]
    fn near_a_singular_pose_a_gap_is_closed_over_several_steps() {
        let mut pool = Pool::new();
        let [pivot, mobility] = [0, 1].map(|state| pool.symbol(Symbol::state(state)));
        let inverse = damped(&mut pool, 0, pivot, mobility);
        let at = |pivot: f64, mobility: f64| {
            let states = [pivot, mobility];
            evaluate(&pool, &[inverse], &Environment { states: &states, ..Environment::default() })[0] * pivot
        };
        // The part of a gap that a step closes: all far from such a pose, half where the pivot is 1e-8 of the mobility,
        // none in it.
        for (pivot, mobility, part) in
            [(3.0, 3.0, 1.0), (2e-4, 2.0, 1.0), (2e-8, 2.0, 0.5), (2e-9, 2.0, 1.0 / 101.0), (0.0, 2.0, 0.0)]
        {
            assert!((at(pivot, mobility) - part).abs() < 1e-7, "{pivot} {mobility}: {}", at(pivot, mobility));
        }
    }

    #[test]
    fn baumgarte_s_terms_stand_for_a_projection() {
        let of = completed(&format!("baumgarte 50; {BOB}"), true);
        let is_of_pose = |&(state, _): &(usize, Id)| of.states[state].origin.kind() == Kind::Orientation;
        assert!(of.settled.is_empty() && of.projections.len() == 9 && of.projections.iter().all(is_of_pose));
    }
}
