//! What moves the links beside their joints.
//!
//! In: the rates of the bodies' momenta without reactions. Out: for each link the torque about its hinge or the force
//! along its slide, moment and force of everything else in its axes, and an acceleration of the ground in place of
//! weights. Method: a torque is what the moments of both bodies have opposite to each other along the axis, a force
//! what their forces have so.

use super::bodies::{self, Body};
use super::joints::{Joint, Kind};
use super::links::Seat;
use super::motion;
use super::numbers;
use crate::expr::{Id, Node, Pool};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::link::{Freedom, Link, Moved, Moves, Own};
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
            if link.freedom.has_coordinate() {
                moved[k].effort = effort(pool, tree, &mut forces, link);
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
        forces[body][1] = added(pool, &forces[body][1], &back);
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
    let (constant, terms) = flat(pool, of);
    let parts: Vec<(Id, f64)> = terms.into_iter().filter(|(term, _)| is_constant(pool, *term)).collect();
    pool.linear(constant, &parts)
}

/// The torque about a hinge, or the force along a slide: what the moments, or the forces, of both bodies have opposite
/// to each other along its axis. It is taken out of these, with the moments of such a force.
fn effort(pool: &mut Pool, tree: &Tree<'_>, forces: &mut [[Value; 2]], of: &Link) -> Id {
    let joint = &tree.joints[of.step.0];
    // Nothing acts about the angles of a ball.
    if joint.kind == Kind::Angles {
        return pool.zero();
    }
    // The axis is written by the axes of either end; of two that cross each is on its own.
    let ends = if joint.kind == Kind::Universal { of.step.1..of.step.1 + 1 } else { 0..2 };
    let mut efforts = Vec::new();
    for end in ends {
        let axis = numbers::constant(pool, &numbers::column(&joint.frames[end], 2));
        let axis = match [joint.parent, Some(joint.child)][end] {
            Some(body) => bodies::symbols(pool, &tree.bodies[body].axes).multiply(pool, &axis),
            None => axis,
        };
        efforts.extend(along(pool, tree, forces, of, (end, &axis)));
    }
    pool.sum(&efforts)
}

/// The efforts along an axis that is written by the axes of this end.
fn along(
    pool: &mut Pool,
    tree: &Tree<'_>,
    forces: &mut [[Value; 2]],
    of: &Link,
    (end, axis): (usize, &Value),
) -> Vec<Id> {
    let joint = &tree.joints[of.step.0];
    let block = usize::from(of.freedom == Freedom::Slide);
    let lead = (0..3).find(|&k| !pool.is_zero(axis.0[k])).unwrap_or(0);
    let mut efforts = Vec::new();
    for (term, by) in flat(pool, forces[joint.child][block].0[lead]).1 {
        let effort = pool.div(term, axis.0[lead]);
        let effort = pool.scale(by, effort);
        let along = axis.multiply(pool, &Value::scalar(effort));
        let back = along.negate(pool);
        let is_opposite = joint.parent.is_none_or(|parent| has(pool, &forces[parent][block], &back));
        if !has(pool, &forces[joint.child][block], &along) || !is_opposite {
            continue;
        }
        efforts.push(effort);
        forces[joint.child][block] = added(pool, &forces[joint.child][block], &back);
        if let Some(parent) = joint.parent {
            forces[parent][block] = added(pool, &forces[parent][block], &along);
        }
        if of.freedom == Freedom::Slide {
            take_moments(pool, tree, forces, (joint, end), &along);
        }
    }
    efforts
}

/// Takes the moments of a force out that acts on the child, and on the parent opposite to it, where the joint is on the
/// other end than the one whose axes it has.
fn take_moments(
    pool: &mut Pool,
    tree: &Tree<'_>,
    forces: &mut [[Value; 2]],
    (joint, end): (&Joint, usize),
    force: &Value,
) {
    let ends = [joint.parent, Some(joint.child)];
    let arm = |pool: &mut Pool, end: usize| match ends[end] {
        Some(body) => bodies::symbols(pool, &tree.bodies[body].axes).multiply(pool, &joint.at[end]),
        None => joint.at[end].clone(),
    };
    let other = 1 - end;
    let own = arm(pool, other);
    let place = |pool: &mut Pool, end: usize| match ends[end] {
        Some(body) => bodies::symbols(pool, &tree.bodies[body].place),
        None => Value::zero(pool, 3),
    };
    let (there, back) = (place(pool, other), place(pool, end).negate(pool));
    let reach = there.add(pool, &own).add(pool, &back);
    for (side, arm) in [(other, own), (end, reach)] {
        let Some(body) = ends[side] else { continue };
        // Less r x F on the child, less r x (-F) on the parent.
        let sign = if side == 1 { -1.0 } else { 1.0 };
        let moment = arm.cross(pool, force).scale(pool, sign);
        forces[body][0] = added(pool, &forces[body][0], &moment);
    }
}

/// The constant and the terms of a sum, those of sums among these as well.
fn flat(pool: &Pool, id: Id) -> (f64, Vec<(Id, f64)>) {
    match pool.node(id) {
        Node::Number(number) => (number.value(), Vec::new()),
        Node::Sum { constant, terms } => {
            let mut all = (constant.value(), Vec::new());
            for (term, by) in terms.iter() {
                let (constant, terms) = flat(pool, *term);
                all.0 += by.value() * constant;
                all.1.extend(terms.into_iter().map(|(term, own)| (term, own * by.value())));
            }
            all
        }
        _ => (0.0, vec![(id, 1.0)]),
    }
}

/// The sums of components, in which equal terms are one.
fn added(pool: &mut Pool, a: &Value, b: &Value) -> Value {
    let sum = |(&a, &b): (&Id, &Id)| {
        let ((first, mut terms), (second, others)) = (flat(pool, a), flat(pool, b));
        terms.extend(others);
        pool.linear(first + second, &terms)
    };
    Value(a.0.iter().zip(&b.0).map(sum).collect())
}

/// Whether sums have these terms.
fn has(pool: &Pool, sums: &Value, wanted: &Value) -> bool {
    wanted.0.iter().zip(&sums.0).all(|(&part, &sum)| {
        let all = flat(pool, sum).1;
        flat(pool, part).1.iter().all(|one| all.contains(one))
    })
}
