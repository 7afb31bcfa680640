//! Joints that close loops among bodies that another one carries, in its axes.
//!
//! In: equations with joints of a tree and others that close loops. Out: the same, where three rows of a closing joint
//! hold the directions of the inertial axes those of the body that carries both ends. They hold as much; a direction in
//! which nothing moves there is one row, in every pose, and what the rows read are relative motions.

use std::collections::{BTreeMap, BTreeSet};

use super::Literal;
use super::bodies::{symbols, velocity};
use super::numbers::{self, Vector};
use super::relative::{Coordinated, between, owners};
use crate::expr::{Id, Pool, Symbol, partial, substitute};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::reduce::{closing, friction};

/// Turns the rows of closing joints, and the literal ones with them.
pub(super) fn turn(equations: &mut StateEquations, literal: &mut Literal, tree: Coordinated<'_>) {
    let owners = owners(tree.bodies);
    let rigid = friction::rigid(&equations.reactions);
    for rows in closing::of_joints(&equations.reactions, 0..rigid) {
        let flows: Vec<Id> = rows.iter().map(|&row| equations.reactions[row].slip.flow).collect();
        let ends: BTreeSet<usize> =
            equations.pool.symbols(&flows).iter().filter_map(|symbol| owners.get(symbol).copied()).collect();
        let Some((base, _)) = between(tree, &ends).filter(|_| ends.len() == 2) else { continue };
        let Some(held) = ends.iter().find_map(|&end| constant(equations, tree, end, &rows)) else { continue };
        turn_rows(equations, literal, tree, (base, &held));
    }
}

/// Three rows with the directions in which they hold a body, constant and perpendicular to each other.
fn constant(
    equations: &mut StateEquations,
    tree: Coordinated<'_>,
    body: usize,
    rows: &[usize],
) -> Option<[(usize, Vector); 3]> {
    let StateEquations { pool, states, reactions, .. } = equations;
    let rates = tree.bodies[body].linear.map(|state| states[state].rate);
    let direction = |&row: &usize| -> Option<(usize, Vector)> {
        let force = partial(pool, &rates, reactions[row].multiplier);
        let force: Vec<f64> = force.into_iter().map(|id| pool.as_number(id)).collect::<Option<_>>()?;
        let force: Vector = force.try_into().expect("three components");
        (numbers::norm(&force) > 0.0).then_some((row, force))
    };
    let held: [(usize, Vector); 3] = rows.iter().filter_map(direction).collect::<Vec<_>>().try_into().ok()?;
    numbers::are_perpendicular(&held.map(|(_, direction)| direction)).then_some(held)
}

/// Puts rows along the axes of a body in place of those along other ones.
fn turn_rows(
    equations: &mut StateEquations,
    literal: &mut Literal,
    tree: Coordinated<'_>,
    (base, held): (usize, &[(usize, Vector); 3]),
) {
    let pool = &mut equations.pool;
    let axes = symbols(pool, &tree.bodies[base].axes).0;
    // By the new row and the one before.
    let by: [[Id; 3]; 3] = std::array::from_fn(|j| {
        std::array::from_fn(|k| {
            let parts: Vec<(Id, f64)> = (0..3).map(|i| (axes[3 * i + j], held[k].1[i])).collect();
            pool.linear(0.0, &parts)
        })
    });
    let sums = |pool: &mut Pool, of: [Id; 3]| {
        by.map(|row| {
            let parts = [0, 1, 2].map(|k| pool.mul(row[k], of[k]));
            pool.sum(&parts)
        })
    };
    let slips = held.map(|(row, _)| &equations.reactions[row].slip);
    let Some(gaps) = slips.iter().map(|slip| slip.gap).collect::<Option<Vec<Id>>>() else { return };
    let gaps = [gaps[0], gaps[1], gaps[2]];
    // What the gap changes in axes that turn.
    let apart: Vec<Id> = (0..3).map(|i| pool.linear(0.0, &[0, 1, 2].map(|k| (gaps[k], held[k].1[i])))).collect();
    let spin = Value((3..6).map(|k| pool.symbol(velocity(base, k))).collect());
    let carried = spin.cross(pool, &Value(apart)).0;
    let flows = [0, 1, 2].map(|k| {
        let along: Vec<(Id, f64)> = (0..3).map(|i| (carried[i], -held[k].1[i])).collect();
        pool.linear(0.0, &[&[(slips[k].flow, 1.0)], &along[..]].concat())
    });
    let (flows, gaps) = (sums(pool, flows), sums(pool, gaps));
    let multipliers = held.map(|(row, _)| equations.reactions[row].multiplier);
    let before = multipliers.map(|multiplier| literal.flows[&multiplier]);
    let literal_flows = sums(pool, before);
    let unknown = multipliers.map(|multiplier| pool.symbol(multiplier));
    let images: BTreeMap<Symbol, Id> = (0..3)
        .map(|k| {
            let parts = [0, 1, 2].map(|j| pool.mul(by[j][k], unknown[j]));
            (multipliers[k], pool.sum(&parts))
        })
        .collect();
    let rates: Vec<Id> = literal.rates.iter().map(|(_, rate)| *rate).collect();
    let rates = substitute(pool, &rates, &|symbol| images.get(&symbol).copied());
    literal.rates.iter_mut().zip(rates).for_each(|((_, own), rate)| *own = rate);
    literal.flows.extend(multipliers.into_iter().zip(literal_flows));
    equations.replace(&|symbol| images.get(&symbol).copied());
    for (j, (row, _)) in held.iter().enumerate() {
        let slip = &mut equations.reactions[*row].slip;
        slip.flow = flows[j];
        slip.gap = Some(gaps[j]);
    }
}
