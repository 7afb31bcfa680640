//! The tree of links: where each hinge is and what each link's inertia is, in axes in which its own hinge is the third.
//!
//! In: bodies, hinges. Out: [`Link`]s, parents first. All of this is constant. The origin of a link is on its hinge,
//! where the offset from the parent has a component less. What turns about a hinge as it does about any line through
//! it, mass on the hinge and equal moments across it, is counted to the parent: nothing changes by it, and the
//! recursion has zeros there (Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, section 9.4).

use super::bodies::Body;
use super::joints::Hinge;
use super::numbers;
use crate::expr::{Id, Pool};
use crate::system::Value;

/// A body with the hinge that carries it.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub hinge: Hinge,
    /// The link that carries it; none on the ground.
    pub parent: Option<usize>,
    /// From the axes of its hinge to those of its parent.
    pub fixed: Value,
    /// From its own axes to its body's.
    pub axes: Value,
    /// Its origin, from its parent's, in the parent's axes.
    pub offset: Value,
    /// Its centre of mass, from its origin.
    pub centre: Value,
    /// Its tensor about its centre of mass.
    pub central: Value,
    pub mass: Id,
    /// What the recursion counts to it: mass, first moment, tensor about the origin.
    pub counted: (Id, Value, Value),
}

/// The links of the hinges of a tree: the hinges parents first.
pub(super) fn of(pool: &mut Pool, bodies: &[Body], hinges: &[Hinge]) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::new();
    // The origin of each link in its body's axes.
    let mut origins: Vec<Value> = Vec::new();
    for hinge in hinges {
        let body = &bodies[hinge.child];
        let parent = hinge.parent.and_then(|body| links.iter().position(|link| link.hinge.child == body));
        let (fixed, from) = match parent {
            Some(parent) => {
                let back = numbers::transposed(&links[parent].hinge.frames[1]);
                let back_origin = origins[parent].negate(pool);
                let from = hinge.at[0].add(pool, &back_origin);
                let turn = numbers::matrix(pool, &back);
                (numbers::product(&back, &hinge.frames[0]), turn.multiply(pool, &from))
            }
            None => (hinge.frames[0], hinge.at[0].clone()),
        };
        let axis = numbers::column(&fixed, 2);
        let along = numbers::constant(pool, &axis);
        let slid = from.dot(pool, &along);
        let slid = pool.neg(slid);
        let by = along.multiply(pool, &Value::scalar(slid));
        let mut offset = from.add(pool, &by);
        if let Some(k) = (0..3).find(|&k| axis[k].abs() == 1.0) {
            offset.0[k] = pool.zero();
        }
        let own = numbers::column(&hinge.frames[1], 2);
        let own = numbers::constant(pool, &own).multiply(pool, &Value::scalar(slid));
        let origin = hinge.at[1].add(pool, &own);
        let axes = numbers::matrix(pool, &hinge.frames[1]);
        let back = axes.transpose();
        let centre = back.multiply(pool, &origin).negate(pool);
        let tensor = body.mobility.inverse(pool);
        let central = back.multiply(pool, &tensor).multiply(pool, &axes);
        let central = symmetric(&central);
        let first = centre.multiply(pool, &Value::scalar(body.mass));
        let none = Value::zero(pool, 3);
        let about = steiner(pool, body.mass, &none, &centre);
        let about = central.add(pool, &about);
        let fixed = numbers::matrix(pool, &fixed);
        links.push(Link {
            hinge: hinge.clone(),
            parent,
            fixed,
            axes,
            offset,
            centre,
            central,
            mass: body.mass,
            counted: (body.mass, first, about),
        });
        origins.push(origin);
    }
    for index in (0..links.len()).rev() {
        lighten(pool, &mut links, index);
    }
    links
}

/// Counts to the parent what a hinge does not move.
fn lighten(pool: &mut Pool, links: &mut [Link], index: usize) {
    let zero = pool.zero();
    let link = links[index].clone();
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
    let about = own_about.add(pool, &symmetric(&turned)).add(pool, &shifted);
    let first = own_first.add(pool, &along).add(pool, &mass_there);
    links[parent].counted = (pool.add(own_mass, mass), first, about);
}

/// What a tensor about a point gains seen from elsewhere: the point is at `by`, where the first moment about it is
/// `first`.
fn steiner(pool: &mut Pool, mass: Id, first: &Value, by: &Value) -> Value {
    let moment = by.multiply(pool, &Value::scalar(mass));
    let twice = first.scale(pool, 2.0);
    let size = moment.add(pool, &twice).dot(pool, by);
    let size = Value::diagonal(pool, &[size; 3]);
    let half = moment.add(pool, first);
    let (one, other) = (half.outer(pool, by), by.outer(pool, first));
    let sum = one.add(pool, &other).negate(pool);
    symmetric(&size.add(pool, &sum))
}

/// A matrix whose lower half is the upper one, but for rounding.
pub(super) fn symmetric(of: &Value) -> Value {
    Value((0..9).map(|k| of.0[3 * (k / 3).min(k % 3) + (k / 3).max(k % 3)]).collect())
}
