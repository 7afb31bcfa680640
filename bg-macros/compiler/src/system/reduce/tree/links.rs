//! The tree of links: where each step of a joint is and what the inertia is that it moves, in axes in which its own
//! freedom is about or along the third.
//!
//! In: bodies, joints. Out: [`Link`]s, parents first, and the [`Seat`] of each body on one. All of this is constant.
//! The origin of a link that turns is on its hinge, where the offset from the parent has a component less. What turns
//! about a hinge as it does about any line through it, mass as it is along the hinge, is counted to the parent: nothing
//! changes by it, and the recursion has zeros there (Khalil and Dombre, Modeling, Identification and Control of Robots,
//! 2002, section 9.4).

use std::collections::BTreeMap;

use super::bodies::Body;
use super::joints::Joint;
use super::numbers::{self, Matrix};
use crate::expr::Pool;
use crate::system::Value;
use crate::system::link::{Freedom, Link};
use crate::system::rigid::Mass;

/// Where a body is on its link, or on the ground.
#[derive(Clone, Debug)]
pub(super) struct Seat {
    pub body: usize,
    pub link: Option<usize>,
    /// From the link's axes to the body's.
    pub axes: Value,
    /// Its centre of mass, from the link's origin, in the link's axes.
    pub centre: Value,
    /// Its tensor about its centre of mass, in the link's axes.
    pub central: Value,
}

/// What is known of the last link under a body: the rotation from the link's axes to the body's, and the link's origin
/// in the body's axes.
#[derive(Clone)]
struct Under {
    link: Option<usize>,
    axes: Matrix,
    origin: Value,
}

/// The links of the joints of a tree, and where bodies are on them; joints parents first.
pub(super) fn of(pool: &mut Pool, bodies: &[Body], joints: &[Joint]) -> (Vec<Link>, Vec<Seat>) {
    let mut links: Vec<Link> = Vec::new();
    let mut seats: Vec<Seat> = Vec::new();
    let mut under: BTreeMap<usize, Under> = BTreeMap::new();
    for (number, joint) in joints.iter().enumerate() {
        let below = joint.parent.map(|parent| under[&parent].clone());
        let mut link = below.as_ref().and_then(|below| below.link);
        // The axes and the place of what comes next, in the axes of the link under it and from its origin.
        let (mut frame, mut from) = match &below {
            Some(Under { axes, origin, .. }) => {
                let back = numbers::transposed(axes);
                let origin = origin.negate(pool);
                let from = joint.at[0].add(pool, &origin);
                (numbers::product(&back, &joint.frames[0]), numbers::matrix(pool, &back).multiply(pool, &from))
            }
            None => (joint.frames[0], joint.at[0].clone()),
        };
        for (index, step) in joint.steps().iter().enumerate() {
            frame = numbers::product(&frame, &step.before);
            let (offset, left) = placed(pool, step.freedom, &frame, from);
            links.push(Link {
                step: (number, index),
                freedom: step.freedom,
                parent: link,
                fixed: numbers::matrix(pool, &frame),
                offset,
                counted: Mass::none(pool),
            });
            (link, frame, from) = (Some(links.len() - 1), numbers::UNIT, left);
        }
        let axes = numbers::product(&joint.frames[1], &numbers::transposed(&frame));
        let by = numbers::matrix(pool, &axes).multiply(pool, &from).negate(pool);
        let origin = joint.at[1].add(pool, &by);
        let body = &bodies[joint.child];
        seats.push(seat(pool, body, joint.child, link, (&axes, &origin)));
        under.insert(joint.child, Under { link, axes, origin });
    }
    for seat in &seats {
        if let Some(link) = seat.link {
            count(pool, &mut links[link], &bodies[seat.body], seat);
        }
    }
    for index in (0..links.len()).rev() {
        lighten(pool, &mut links, index);
    }
    (links, seats)
}

/// The offset of a link whose place this is, with the place where its joint goes on from its origin: the origin of what
/// turns is moved along the axis.
fn placed(pool: &mut Pool, freedom: Freedom, frame: &Matrix, from: Value) -> (Value, Value) {
    if freedom != Freedom::Turn {
        return (from, Value::zero(pool, 3));
    }
    let axis = numbers::column(frame, 2);
    let along = numbers::constant(pool, &axis);
    let slid = from.dot(pool, &along);
    let back = pool.neg(slid);
    let by = along.multiply(pool, &Value::scalar(back));
    let mut offset = from.add(pool, &by);
    if let Some(k) = (0..3).find(|&k| axis[k].abs() == 1.0) {
        offset.0[k] = pool.zero();
    }
    let zero = pool.zero();
    (offset, Value(vec![zero, zero, slid]))
}

fn seat(pool: &mut Pool, body: &Body, index: usize, link: Option<usize>, (axes, origin): (&Matrix, &Value)) -> Seat {
    let axes = numbers::matrix(pool, axes);
    let back = axes.transpose();
    let centre = back.multiply(pool, origin).negate(pool);
    let tensor = body.mobility.inverse(pool);
    let central = back.multiply(pool, &tensor).multiply(pool, &axes);
    Seat { body: index, link, axes, centre, central: central.symmetric() }
}

/// Counts a body to its link.
fn count(pool: &mut Pool, link: &mut Link, body: &Body, seat: &Seat) {
    let own = Mass::central(pool, body.mass, &seat.central).seen(pool, &seat.centre);
    link.counted = link.counted.add(pool, &own);
}

/// Counts to the parent what a hinge does not move: the mass as it is along the hinge.
fn lighten(pool: &mut Pool, links: &mut [Link], index: usize) {
    let zero = pool.zero();
    let link = &mut links[index];
    if link.freedom != Freedom::Turn {
        return;
    }
    let Mass { first, second, .. } = &link.counted;
    let left = if link.counted.is_by_tensor(pool) { pool.neg(second.0[0]) } else { zero };
    let along = [first.0[2], pool.sub(second.0[8], left)].map(|part| Value(vec![zero, zero, part]));
    (link.counted.first.0[2], link.counted.second.0[8]) = (zero, left);
    let mass = std::mem::replace(&mut link.counted.mass, zero);
    let link = links[index].clone();
    let Some(parent) = link.parent else { return };
    let [first, spread] = along.map(|along| link.fixed.multiply(pool, &along));
    let axis = Value(vec![link.fixed.0[2], link.fixed.0[5], link.fixed.0[8]]);
    let second = spread.outer(pool, &axis).symmetric();
    let moved = Mass { mass, first, second }.seen(pool, &link.offset);
    links[parent].counted = links[parent].counted.add(pool, &moved);
}
