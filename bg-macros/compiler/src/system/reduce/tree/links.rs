//! The tree of links: where each step of a joint is and what the inertia is that it moves, in axes in which its own
//! freedom is about or along the third.
//!
//! In: bodies, joints. Out: [`Link`]s, parents first, and the [`Seat`] of each body on one. All of this is constant. The
//! origin of a link that turns is on its hinge, where the offset from the parent has a component less. What turns about
//! a hinge as it does about any line through it, mass on the hinge and equal moments across it, is counted to the
//! parent: nothing changes by it, and the recursion has zeros there (Khalil and Dombre, Modeling, Identification and
//! Control of Robots, 2002, section 9.4).

use std::collections::BTreeMap;

use super::bodies::Body;
use super::joints::Joint;
use super::numbers::{self, Matrix};
use crate::expr::Pool;
use crate::system::Value;
use crate::system::link::{Freedom, Link, steiner};

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
                counted: (pool.zero(), Value::zero(pool, 3), Value::zero(pool, 9)),
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
    let (mass, first, about) = link.counted.clone();
    let moment = seat.centre.multiply(pool, &Value::scalar(body.mass));
    let none = Value::zero(pool, 3);
    let shifted = steiner(pool, body.mass, &none, &seat.centre);
    let own = seat.central.add(pool, &shifted);
    link.counted = (pool.add(mass, body.mass), first.add(pool, &moment), about.add(pool, &own));
}

/// Counts to the parent what a hinge does not move.
fn lighten(pool: &mut Pool, links: &mut [Link], index: usize) {
    let zero = pool.zero();
    let link = links[index].clone();
    if link.freedom != Freedom::Turn {
        return;
    }
    let (mass, first, about) = link.counted;
    let moment = about.0[4];
    let (mut left, mut rest) = (first.clone(), about.clone());
    left.0[2] = zero;
    rest.0[0] = pool.sub(about.0[0], moment);
    rest.0[4] = zero;
    links[index].counted = (zero, left, rest);
    let Some(parent) = link.parent else { return };
    let along = link.fixed.multiply(pool, &Value(vec![zero, zero, first.0[2]]));
    let equal = Value::diagonal(pool, &[moment, moment, zero]);
    let turned = link.fixed.multiply(pool, &equal).multiply(pool, &link.fixed.transpose());
    let shifted = steiner(pool, mass, &along, &link.offset);
    let mass_there = link.offset.multiply(pool, &Value::scalar(mass));
    let (own_mass, own_first, own_about) = links[parent].counted.clone();
    let about = own_about.add(pool, &turned.symmetric()).add(pool, &shifted);
    let first = own_first.add(pool, &along).add(pool, &mass_there);
    links[parent].counted = (pool.add(own_mass, mass), first, about);
}
