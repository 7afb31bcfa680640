//! What moves the links beside their joints.
//!
//! In: the rates of the bodies' momenta without reactions. Out: for each link the torque about its hinge, moment and
//! force of everything else in its axes, and an acceleration of the ground in place of weights. Method: a torque is what
//! the moments of both bodies have opposite to each other along the axis.

use super::bodies::{self, Body};
use super::joints::{Freedom, Joint, Kind, Moves};
use super::links::{Link, Seat};
use super::motion;
use super::numbers;
use super::recursion::{Moved, Own};
use crate::expr::{Id, Node, Pool};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::reduce::is_constant;

/// A tree of joints with its links and the bodies on them.
pub(super) struct Tree<'a> {
    pub bodies: &'a [Body],
    pub joints: &'a [Joint],
    pub links: &'a [Link],
    pub seats: &'a [Seat],
}

/// What moves the links.
pub(super) struct Loads {
    pub moved: Vec<Moved>,
    /// The axes of the links in inertial axes.
    pub axes: Vec<Value>,
    /// The acceleration of the ground that stands for the weights of all.
    pub ground: Value,
}

impl Loads {
    pub fn of(equations: &mut StateEquations, tree: &Tree<'_>, coordinates: &[Vec<Moves>]) -> Self {
        let StateEquations { pool, states, .. } = equations;
        let rates = |of: &[usize; 3]| Value(of.iter().map(|&state| states[state].rate).collect());
        let mut forces: Vec<[Value; 2]> =
            tree.bodies.iter().map(|body| [&body.angular, &body.linear].map(rates)).collect();
        let fall = fall(pool, tree, &mut forces);
        let (mut moved, mut axes): (Vec<Moved>, Vec<Value>) = (Vec::new(), Vec::new());
        for (k, link) in tree.links.iter().enumerate() {
            let moves = coordinates[link.step.0][link.step.1];
            if link.freedom.has_coordinate() {
                axes.push(motion::axes(pool, tree.links, &axes, k, &moves));
                moved.push(Moved::new(pool, link, moves, None));
                continue;
            }
            let body = &tree.bodies[tree.joints[link.step.0].child];
            let turned = bodies::symbols(pool, &body.axes);
            let own = own(pool, body, link.freedom, &turned, link.parent.map(|parent| &axes[parent]));
            axes.push(turned);
            let mut all = Moved::new(pool, link, moves, Some(own));
            if link.freedom == Freedom::Free {
                all.offset = bodies::symbols(pool, &body.place);
            }
            moved.push(all);
        }
        for (k, link) in tree.links.iter().enumerate().rev() {
            if link.freedom == Freedom::Turn {
                moved[k].effort = torque(pool, tree, &mut forces, link);
            }
        }
        for seat in tree.seats {
            let Some(link) = seat.link else { continue };
            let back = axes[link].transpose();
            let [moment, force] = &forces[seat.body];
            let force = back.multiply(pool, force);
            let arm = seat.centre.cross(pool, &force);
            let moment = back.multiply(pool, moment).add(pool, &arm);
            let load = &mut moved[link].load;
            *load = [load[0].add(pool, &moment), load[1].add(pool, &force)];
        }
        Self { moved, axes, ground: fall.negate(pool) }
    }
}

/// What the states of a body say of a link whose axes are the body's, `turned`, on one with axes `under`.
fn own(pool: &mut Pool, body: &Body, freedom: Freedom, turned: &Value, under: Option<&Value>) -> Own {
    let back = turned.transpose();
    let [angular, linear] = [&body.angular, &body.linear].map(|of| bodies::symbols(pool, of));
    let inside = back.multiply(pool, &angular);
    let spin = body.mobility.multiply(pool, &inside);
    let fast = (freedom == Freedom::Free).then(|| back.multiply(pool, &linear).divide(pool, body.mass));
    let turned = match under {
        Some(under) => under.transpose().multiply(pool, turned),
        None => turned.clone(),
    };
    Own { turned, spin, fast }
}

/// The acceleration by which weights move all bodies of the tree, in place of these; zero where constant forces are no
/// such weights.
fn fall(pool: &mut Pool, tree: &Tree<'_>, forces: &mut [[Value; 2]]) -> Value {
    let weight = |pool: &mut Pool, force: &Value| Value(force.0.iter().map(|&id| constant_part(pool, id)).collect());
    let moved: Vec<usize> = tree.seats.iter().filter(|seat| seat.link.is_some()).map(|seat| seat.body).collect();
    let weights: Vec<Value> = moved.iter().map(|&body| weight(pool, &forces[body][1])).collect();
    let falls: Vec<Value> =
        moved.iter().zip(&weights).map(|(&body, weight)| weight.divide(pool, tree.bodies[body].mass)).collect();
    let Some(fall) = falls.first().filter(|first| falls.iter().all(|fall| is_alike(pool, fall, first))) else {
        return Value::zero(pool, 3);
    };
    for (&body, weight) in moved.iter().zip(&weights) {
        let back = weight.negate(pool);
        forces[body][1] = forces[body][1].add(pool, &back);
    }
    fall.clone()
}

/// Whether vectors are one, but for the rounding of m g / m.
fn is_alike(pool: &Pool, a: &Value, b: &Value) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= 4.0 * f64::EPSILON * a.abs();
    a.0.iter()
        .zip(&b.0)
        .all(|(&a, &b)| a == b || pool.as_number(a).zip(pool.as_number(b)).is_some_and(|(a, b)| near(a, b)))
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
fn torque(pool: &mut Pool, tree: &Tree<'_>, forces: &mut [[Value; 2]], of: &Link) -> Id {
    let joint = &tree.joints[of.step.0];
    // Of two axes that cross the second one is the child's.
    let (body, frame) = if joint.kind == Kind::Universal && of.step.1 == 1 {
        (Some(joint.child), &joint.frames[1])
    } else {
        (joint.parent, &joint.frames[0])
    };
    let axis = numbers::constant(pool, &numbers::column(frame, 2));
    let axis = match body {
        Some(body) => bodies::symbols(pool, &tree.bodies[body].axes).multiply(pool, &axis),
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
    for (term, by) in terms(pool, forces[joint.child][0].0[lead]) {
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
        let on_parent = joint.parent.map(|parent| forces[parent][0].clone());
        if !has(pool, &forces[joint.child][0].clone(), 1.0) || on_parent.is_some_and(|moment| !has(pool, &moment, -1.0))
        {
            continue;
        }
        torques.push(effort);
        let all = Value(all);
        let back = all.negate(pool);
        forces[joint.child][0] = forces[joint.child][0].add(pool, &back);
        if let Some(parent) = joint.parent {
            forces[parent][0] = forces[parent][0].add(pool, &all);
        }
    }
    pool.sum(&torques)
}
