//! What moves the links beside their hinges.
//!
//! In: the rates of the bodies' momenta without reactions. Out: for each link the torque about its hinge, moment and
//! force of everything else in its axes, and an acceleration of the ground in place of weights. Method: a torque is what
//! the moments of both bodies have opposite to each other along the axis.

use super::bodies::{self, Body};
use super::links::Link;
use super::motion::{self, Coordinate};
use super::numbers;
use super::recursion::Moved;
use crate::expr::{Function, Id, Node, Pool};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::reduce::is_constant;

/// What moves each link, and the acceleration of the ground that stands for the weights of all.
pub(super) fn of(
    equations: &mut StateEquations,
    bodies: &[Body],
    links: &[Link],
    coordinates: &[Coordinate],
) -> (Vec<Moved>, Value) {
    let StateEquations { pool, states, .. } = equations;
    let zero = pool.zero();
    let mut forces: Vec<[Value; 2]> = links
        .iter()
        .map(|link| {
            let body = &bodies[link.hinge.child];
            [&body.angular, &body.linear].map(|of| Value(of.iter().map(|&state| states[state].rate).collect()))
        })
        .collect();
    let fall = fall(pool, links, &mut forces);
    let mut torques = vec![zero; links.len()];
    for k in (0..links.len()).rev() {
        torques[k] = torque(pool, bodies, links, &mut forces, k);
    }
    let mut moved: Vec<Moved> = Vec::new();
    let mut axes: Vec<Value> = Vec::new();
    for (k, link) in links.iter().enumerate() {
        let [cosine, sine] = [Function::Cos, Function::Sin].map(|of| pool.call(of, &[coordinates[k].angle]));
        let still = [Value(vec![zero; 3]), Value(vec![zero; 3])];
        let mut own = Moved { cosine, sine, speed: coordinates[k].speed, torque: torques[k], load: still };
        axes.push(motion::axes(pool, links, &axes, k, &own));
        let back = axes[k].transpose();
        let [moment, force] = &forces[k];
        let force = back.multiply(pool, force);
        let arm = link.centre.cross(pool, &force);
        let moment = back.multiply(pool, moment).add(pool, &arm);
        own.load = [moment, force];
        moved.push(own);
    }
    (moved, fall.negate(pool))
}

/// The acceleration by which weights move all links, in place of these; zero where constant forces are no such weights.
fn fall(pool: &mut Pool, links: &[Link], forces: &mut [[Value; 2]]) -> Value {
    let weight = |pool: &mut Pool, force: &Value| Value(force.0.iter().map(|&id| constant_part(pool, id)).collect());
    let weights: Vec<Value> = forces.iter().map(|[_, force]| weight(pool, force)).collect();
    let falls: Vec<Value> =
        links.iter().zip(&weights).map(|(link, weight)| weight.divide(pool, link.mass)).collect();
    if !falls.iter().all(|fall| is_alike(pool, fall, &falls[0])) {
        return Value::zero(pool, 3);
    }
    for ([_, force], weight) in forces.iter_mut().zip(&weights) {
        let back = weight.negate(pool);
        *force = force.add(pool, &back);
    }
    falls[0].clone()
}

/// Whether vectors are one, but for the rounding of m g / m.
fn is_alike(pool: &Pool, a: &Value, b: &Value) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * a.abs();
    a.0.iter().zip(&b.0).all(|(&a, &b)| {
        a == b || pool.as_number(a).zip(pool.as_number(b)).is_some_and(|(a, b)| near(a, b))
    })
}

/// What of a sum depends on parameters alone.
fn constant_part(pool: &mut Pool, of: Id) -> Id {
    if is_constant(pool, of) {
        return of;
    }
    let Node::Sum { constant, terms } = pool.node(of).clone() else { return pool.zero() };
    let parts: Vec<(Id, f64)> =
        terms.iter().filter(|(term, _)| is_constant(pool, *term)).map(|(term, by)| (*term, by.value())).collect();
    pool.linear(constant.value(), &parts)
}

/// The torque about a hinge: what the moments of both bodies have opposite to each other, along its axis. It is taken
/// out of these.
fn torque(pool: &mut Pool, bodies: &[Body], links: &[Link], forces: &mut [[Value; 2]], of: usize) -> Id {
    let link = &links[of];
    let axis = numbers::constant(pool, &numbers::column(&link.hinge.frames[0], 2));
    let axis = match link.hinge.parent {
        Some(parent) => bodies::symbols(pool, &bodies[parent].axes).multiply(pool, &axis),
        None => axis,
    };
    let lead = (0..3).find(|&k| !pool.is_zero(axis.0[k])).unwrap_or(0);
    let terms = |pool: &Pool, id: Id| -> Vec<(Id, f64)> {
        match pool.node(id) {
            Node::Sum { terms, .. } => terms.iter().map(|(term, by)| (*term, by.value())).collect(),
            Node::Number(_) => Vec::new(),
            _ => vec![(id, 1.0)],
        }
    };
    let mut torques = Vec::new();
    for (term, by) in terms(pool, forces[of][0].0[lead]) {
        let effort = pool.div(term, axis.0[lead]);
        let effort = pool.scale(by, effort);
        let all: Vec<Id> = axis.0.iter().map(|&part| pool.mul(effort, part)).collect();
        let has = |pool: &mut Pool, moment: &Value, sign: f64| {
            all.iter().zip(&moment.0).all(|(&part, &sum)| {
                let wanted = pool.scale(sign, part);
                let wanted = terms(pool, wanted);
                wanted.iter().all(|one| terms(pool, sum).contains(one))
            })
        };
        let on_parent = link.parent.map(|parent| forces[parent][0].clone());
        if !has(pool, &forces[of][0].clone(), 1.0) || on_parent.is_some_and(|moment| !has(pool, &moment, -1.0)) {
            continue;
        }
        torques.push(effort);
        let all = Value(all);
        let back = all.negate(pool);
        forces[of][0] = forces[of][0].add(pool, &back);
        if let Some(parent) = link.parent {
            forces[parent][0] = forces[parent][0].add(pool, &all);
        }
    }
    pool.sum(&torques)
}
