//! Which rigid joints close loops.
//!
//! In: the reactions with the momenta that they move. Out: the same, those of joints that close a loop after all
//! others, each of them with a number.
//! Method: the joints are gone through in their order; one that moves a momentum which none before it has moved hangs
//! something new on the tree of joints, and holds nothing that others hold. The others may: two hinges of a door do.
//! Their rows come last, so that they are the ones that follow from the others where something follows.

use std::collections::BTreeSet;

use super::friction;
use crate::expr::{Id, Pool, Symbol, partial};
use crate::system::equations::impact::Moves;
use crate::system::equations::{Kind, Origin, Reaction, State, StateEquations};

/// The reactions, those of loops after those of the tree, with what they move; stops and dry friction, which come last,
/// are none that hold a joint, and what it moves is not asked for.
pub(super) fn arrange(equations: &mut StateEquations, mut reactions: Vec<Reaction>) -> (Vec<Reaction>, Moves) {
    let frictions = reactions.split_off(friction::rigid(&reactions));
    let moves = moves(&mut equations.pool, &equations.states, &reactions, &is_moved);
    let (tree, closing) = split(equations, &reactions, &moves);
    for (&row, number) in closing.iter().zip(0..) {
        reactions[row].slip.kept = Some(number);
    }
    let order: Vec<usize> = tree.into_iter().chain(closing).collect();
    let arranged = order.iter().map(|&row| reactions[row].clone()).chain(frictions).collect();
    let rows = |by: &[Id]| order.iter().map(|&row| by[row]).collect();
    (arranged, moves.iter().map(|(state, by)| (*state, rows(by))).collect())
}

/// Whether a joint closes a loop.
pub(super) fn is_any(equations: &mut StateEquations) -> bool {
    let rigid = friction::rigid(&equations.reactions);
    let StateEquations { pool, states, reactions, .. } = &mut *equations;
    let moves = moves(pool, states, &reactions[..rigid], &is_moved);
    !split(equations, &equations.reactions[..rigid], &moves).1.is_empty()
}

/// The rows of joints that hang something new on the tree, and those of the others: of rows that are left when others
/// are solved their own momenta do not tell it, but these have mobilities.
fn split(equations: &StateEquations, reactions: &[Reaction], moves: &Moves) -> (Vec<usize>, Vec<usize>) {
    let pool = &equations.pool;
    let node = |state: usize| match equations.states[state].origin {
        Origin::Momentum(node, _) => Some(node),
        _ => None,
    };
    let moved = |row: usize| moves.iter().filter(move |(_, by)| !pool.is_zero(by[row])).map(|(state, _)| *state);
    let mut seen = BTreeSet::new();
    let (mut tree, mut closing) = (Vec::new(), Vec::new());
    for rows in of_joints(reactions, 0..reactions.len()) {
        let states: BTreeSet<usize> = rows.iter().flat_map(|&row| moved(row)).collect();
        let is_new = |state: &&usize| node(**state).is_none_or(|node| !seen.contains(&node));
        let is_new_to_tree = states.iter().filter(is_new).count() >= rows.len();
        seen.extend(states.iter().filter_map(|&state| node(state)));
        let hangs = is_new_to_tree && rows.iter().all(|&row| reactions[row].slip.mobility.is_none());
        if hangs { tree.extend(rows) } else { closing.extend(rows) }
    }
    (tree, closing)
}

/// These rows by their joints, in the order of the joints' first rows.
pub(super) fn of_joints(reactions: &[Reaction], rows: impl Iterator<Item = usize>) -> Vec<Vec<usize>> {
    let mut joints: Vec<Vec<usize>> = Vec::new();
    for row in rows {
        match joints.iter_mut().find(|rows| reactions[rows[0]].slip.joint == reactions[row].slip.joint) {
            Some(rows) => rows.push(row),
            None => joints.push(vec![row]),
        }
    }
    joints
}

/// How much one unit of a reaction changes the rate of its flow: by its loads, each the rate of a momentum by it.
pub(super) fn mobility(pool: &mut Pool, flow: Id, loads: &[(usize, Id)]) -> Id {
    let part = |&(state, load): &(usize, Id)| {
        let slope = partial(pool, &[flow], Symbol::state(state))[0];
        pool.mul(slope, load)
    };
    let parts: Vec<Id> = loads.iter().map(part).collect();
    pool.sum(&parts)
}

/// Whether reactions may change states of this kind.
pub(super) fn is_moved(kind: Kind) -> bool {
    matches!(kind, Kind::Momentum | Kind::Displacement)
}

/// The states of some kinds whose rates depend on multipliers, and how.
pub(super) fn moves(
    pool: &mut Pool,
    states: &[State],
    reactions: &[Reaction],
    is_moved: &dyn Fn(Kind) -> bool,
) -> Moves {
    let momenta: Vec<usize> = (0..states.len()).filter(|&state| is_moved(states[state].origin.kind())).collect();
    let rates: Vec<Id> = momenta.iter().map(|&state| states[state].rate).collect();
    let columns: Vec<Vec<Id>> = reactions.iter().map(|reaction| partial(pool, &rates, reaction.multiplier)).collect();
    let row = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<Id>>();
    let rows = momenta.into_iter().enumerate().map(|(k, state)| (state, row(k)));
    rows.filter(|(_, row)| row.iter().any(|&id| !pool.is_zero(id))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::source::syntax;

    /// Joint and number of each row after the arrangement.
    fn arranged(statements: &str) -> Vec<(String, Option<u32>)> {
        let text = format!("graph G {{ {statements} }}");
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let mut equations = pipeline::derive(&source.graphs[0]).expect("equations").equations;
        assert_eq!(is_any(&mut equations), statements.contains("closes"));
        let reactions = std::mem::take(&mut equations.reactions);
        let (reactions, moves) = arrange(&mut equations, reactions);
        assert!(moves.iter().all(|(_, by)| by.len() == reactions.len()));
        reactions.into_iter().map(|reaction| (reaction.slip.joint, reaction.slip.kept)).collect()
    }

    fn rows(joint: &str, first: Option<u32>, count: u32) -> impl Iterator<Item = (String, Option<u32>)> {
        (0..count).map(move |row| (joint.to_owned(), first.map(|first| first + row)))
    }

    const RODS: &str = "ground { point O = [0, 0, 0]; point P = [1, 0, 0]; }
        body a { mass 1; inertia [0.1, 0.1, 0.1]; point left = [-0.5, 0, 0]; point right = [0.5, 0, 0]; }
        body b { mass 1; inertia [0.1, 0.1, 0.1]; point left = [-0.5, 0, 0]; point right = [0.5, 0, 0]; }";

    #[test]
    fn a_chain_closes_no_loop() {
        let text = format!(
            "{RODS} joint p: spherical (ground.O -> a.left) {{ rigid; }} joint q: spherical (a.right -> b.left) {{ \
            rigid; }}"
        );
        assert_eq!(arranged(&text), rows("p", None, 3).chain(rows("q", None, 3)).collect::<Vec<_>>());
    }

    /// Whether it does only the run time knows.
    #[test]
    fn a_joint_on_bodies_that_hang_already_may_close_a_loop() {
        let text = format!(
            "{RODS} joint q: spherical (a.right -> b.left) {{ rigid; }} joint closes: spherical (ground.O -> a.left) \
            {{ rigid; }}"
        );
        assert_eq!(arranged(&text), rows("q", None, 3).chain(rows("closes", Some(0), 3)).collect::<Vec<_>>());
    }

    #[test]
    fn rows_that_close_a_loop_come_last_with_their_numbers() {
        // The joint that stands second holds what the first one has hung on the ground.
        let text = format!(
            "{RODS} joint p: spherical (ground.O -> a.left) {{ rigid; }} joint closes: spherical (ground.P -> a.right) \
            {{ rigid; }}
             joint q: spherical (a.right -> b.left) {{ rigid; }}"
        );
        let expected: Vec<_> = rows("p", None, 3).chain(rows("q", None, 3)).chain(rows("closes", Some(0), 3)).collect();
        assert_eq!(arranged(&text), expected);
    }
}
