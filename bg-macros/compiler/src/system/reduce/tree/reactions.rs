//! The reactions of joints whose bodies are in joint coordinates.
//!
//! In: a tree with its accelerations, the rows of its joints that something reads. Out: each of their reactions by
//! coordinates. Method: what a joint hands to the bodies that it carries is what accelerates these less what acts on
//! them beside it, summed from tip to ground (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 5.3). Where
//! the directions that it holds are proved to be perpendicular to each other and of length 1, a reaction is the
//! component of that along its own.

use std::collections::{BTreeMap, BTreeSet};

use super::bodies::{Body, symbols};
use super::joints::{Joint, Probe};
use super::loads::Tree;
use super::motion::Motion;
use super::numbers;
use super::recognition::at_places;
use super::recursion::Accelerations;
use crate::expr::{Id, Pool, Symbol, partial, same_polynomial, substitute};
use crate::system::Value;
use crate::system::equations::StateEquations;
use crate::system::link::{Freedom, Moved, Moves, up};
use crate::system::reduce::is_constant;
use crate::system::rigid::{rate_of_angular, square};

/// A row whose reaction is read.
#[derive(Clone, Debug)]
struct Row {
    multiplier: Symbol,
    /// What one unit of it is on the child, in inertial axes: a force.
    force: Value,
    /// A moment about its centre.
    moment: Value,
}

/// The rows of joints whose reactions are read, by joints.
#[derive(Clone, Debug, Default)]
pub(super) struct Wanted(BTreeMap<usize, Vec<Row>>);

impl Wanted {
    /// Those of the joints of which one of these multipliers is.
    pub fn of(equations: &mut StateEquations, tree: (&[Body], &[Joint]), read: &BTreeSet<Symbol>) -> Self {
        let (bodies, joints) = tree;
        let StateEquations { pool, states, reactions, .. } = equations;
        let mut wanted = BTreeMap::new();
        for (number, joint) in joints.iter().enumerate() {
            if !joint.rows.iter().any(|&row| read.contains(&reactions[row].multiplier)) {
                continue;
            }
            let body = &bodies[joint.child];
            let row = |&row: &usize| {
                let multiplier = reactions[row].multiplier;
                let [force, moment] = [&body.linear, &body.angular].map(|of| {
                    let rates: Vec<Id> = of.iter().map(|&state| states[state].rate).collect();
                    Value(partial(pool, &rates, multiplier))
                });
                Row { multiplier, force, moment }
            };
            wanted.insert(number, joint.rows.iter().map(row).collect());
        }
        Self(wanted)
    }

    /// Whether nothing reads one.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it has this one.
    pub fn has(&self, multiplier: &Symbol) -> bool {
        self.0.values().flatten().any(|row| row.multiplier == *multiplier)
    }

    /// Each reaction by coordinates; none where the directions of one are not proved to be as they have to.
    pub fn images(
        &self,
        pool: &mut Pool,
        tree: &Tree<'_>,
        (moved, motion, accelerations): (&[Moved], &Motion, &Accelerations),
        coordinates: &[Vec<Moves>],
    ) -> Option<BTreeMap<Symbol, Id>> {
        let mut images = BTreeMap::new();
        if self.0.is_empty() {
            return Some(images);
        }
        let wrenches = wrenches(pool, tree, moved, motion, accelerations);
        for (&number, rows) in &self.0 {
            let joint = &tree.joints[number];
            let moves = &coordinates[number];
            let (end, all) =
                [1, 0].into_iter().find_map(|end| Some((end, held(pool, tree, joint, moves, (end, rows))?)))?;
            let handed = handed(pool, tree, joint, (end, moves), (moved, motion, &wrenches))?;
            for held in all {
                let of = &handed[usize::from(held.is_inertial)][usize::from(!held.is_force)];
                images.insert(held.multiplier, held.direction.dot(pool, of));
            }
        }
        Some(images)
    }
}

/// Moment about a link's origin and force that accelerate it and all that it carries, in its axes.
fn wrenches(
    pool: &mut Pool,
    tree: &Tree<'_>,
    moved: &[Moved],
    motion: &Motion,
    accelerations: &Accelerations,
) -> Vec<[Value; 2]> {
    let mut wrenches: Vec<[Value; 2]> =
        moved.iter().map(|own| own.load.clone().map(|load| load.negate(pool))).collect();
    for seat in tree.seats {
        let Some(link) = seat.link else { continue };
        let [turning, there] = &accelerations.links[link];
        let spin = &motion.spins[link];
        let (beside, pulled) = (turning.cross(pool, &seat.centre), square(pool, spin).multiply(pool, &seat.centre));
        let centre = there.add(pool, &beside).add(pool, &pulled);
        let force = centre.multiply(pool, &Value::scalar(tree.bodies[seat.body].mass));
        let lever = seat.centre.cross(pool, &force);
        let moment = rate_of_angular(pool, &seat.central, spin, turning).add(pool, &lever);
        let [all, sum] = wrenches[link].clone();
        wrenches[link] = [all.add(pool, &moment), sum.add(pool, &force)];
    }
    for (k, link) in tree.links.iter().enumerate().rev() {
        let Some(parent) = link.parent else { continue };
        let [moment, force] = wrenches[k].clone().map(|part| up(pool, link, &moved[k], &part));
        let lever = moved[k].offset.cross(pool, &force);
        let [all, sum] = wrenches[parent].clone();
        wrenches[parent] = [all.add(pool, &moment).add(pool, &lever), sum.add(pool, &force)];
    }
    wrenches
}

/// Force and moment about the joint's place on one end that it hands to its child, in the parent's axes, then in
/// inertial axes; none where both are on one link.
fn handed(
    pool: &mut Pool,
    tree: &Tree<'_>,
    joint: &Joint,
    (end, moves): (usize, &[Moves]),
    (moved, motion, wrenches): (&[Moved], &Motion, &[[Value; 2]]),
) -> Option<[[Value; 2]; 2]> {
    let seat = |body: usize| tree.seats.iter().find(|seat| seat.body == body);
    let child = seat(joint.child)?;
    let below = joint.parent.and_then(seat);
    let link = child.link.filter(|_| !joint.steps().is_empty())?;
    let [moment, force] = &wrenches[link];
    let mut place = child.axes.transpose().multiply(pool, &joint.at[1]).add(pool, &child.centre);
    if let Some(slide) = joint.steps().iter().position(|step| step.freedom == Freedom::Slide).filter(|_| end == 0) {
        // A joint that slides turns about no other axis.
        place.0[2] = pool.sub(place.0[2], moves[slide].place);
    }
    let lever = place.cross(pool, force).negate(pool);
    let both = [force.clone(), moment.add(pool, &lever)];
    let inertial = both.clone().map(|part| motion.axes[link].multiply(pool, &part));
    let end = below.and_then(|seat| seat.link);
    let (mut above, mut parts) = (Some(link), both);
    while let Some(link) = above.filter(|_| above != end) {
        parts = parts.map(|part| up(pool, &tree.links[link], &moved[link], &part));
        above = tree.links[link].parent;
    }
    let inside = match below {
        Some(seat) => parts.map(|part| seat.axes.multiply(pool, &part)),
        None => parts,
    };
    Some([inside, inertial])
}

/// The direction of a reaction.
struct Held {
    multiplier: Symbol,
    is_force: bool,
    /// In the parent's axes, or inertial where it is constant there.
    direction: Value,
    is_inertial: bool,
}

/// The directions of a joint's reactions; none where they are not those of a joint that holds forces at its place on
/// this end and moments, each direction once.
fn held(
    pool: &mut Pool,
    tree: &Tree<'_>,
    joint: &Joint,
    moves: &[Moves],
    (end, rows): (usize, &[Row]),
) -> Option<Vec<Held>> {
    let probe = Probe::new(pool, 6 * tree.bodies.len());
    let unit = Value::identity(pool);
    let seen = |pool: &mut Pool, of: &Value, moves: &[Moves], axes: &Value| {
        let images = joint.motion(pool, tree.bodies, moves, Some(axes));
        Value(substitute(pool, &of.0, &|symbol| images.get(&symbol).copied()))
    };
    let arm = arm(pool, tree.bodies, joint, end);
    let mut all = Vec::new();
    let mut groups: [Vec<[Id; 3]>; 2] = [Vec::new(), Vec::new()];
    for row in rows {
        let lever = arm.cross(pool, &row.force).negate(pool);
        let moment = row.moment.add(pool, &lever);
        let is_force = !is_zero(pool, &row.force);
        let own = if is_force { &row.force } else { &moment };
        if is_force {
            let moment = seen(pool, &moment, &probe.moves, &probe.rotation);
            if !is_zero(pool, &moment) {
                return None;
            }
        }
        let inside = seen(pool, own, &probe.moves, &unit);
        let turned = probe.rotation.multiply(pool, &inside);
        let anywhere = seen(pool, own, &probe.moves, &probe.rotation);
        let is_inertial = joint.parent.is_some() && !are_same(pool, &turned, &anywhere);
        if is_inertial && !own.0.iter().all(|&id| is_constant(pool, id)) {
            return None;
        }
        groups[usize::from(!is_force)].push([inside.0[0], inside.0[1], inside.0[2]]);
        all.push(Held {
            multiplier: row.multiplier,
            is_force,
            direction: if is_inertial { own.clone() } else { seen(pool, own, moves, &unit) },
            is_inertial,
        });
    }
    let are_perpendicular = |directions: &Vec<[Id; 3]>| {
        let places = at_places(pool, &probe, directions)?;
        places.iter().all(|rows| numbers::are_perpendicular(rows)).then_some(())
    };
    groups.iter().try_for_each(are_perpendicular)?;
    Some(all)
}

/// The joint's place on one end, from the child's centre.
fn arm(pool: &mut Pool, bodies: &[Body], joint: &Joint, end: usize) -> Value {
    let child = &bodies[joint.child];
    if end == 1 {
        return symbols(pool, &child.axes).multiply(pool, &joint.at[1]);
    }
    let back = symbols(pool, &child.place).negate(pool);
    match joint.parent {
        Some(parent) => {
            let arm = symbols(pool, &bodies[parent].axes).multiply(pool, &joint.at[0]);
            symbols(pool, &bodies[parent].place).add(pool, &arm).add(pool, &back)
        }
        None => joint.at[0].add(pool, &back),
    }
}

fn is_zero(pool: &mut Pool, of: &Value) -> bool {
    let zero = pool.zero();
    of.0.iter().all(|&id| same_polynomial(pool, id, zero))
}

fn are_same(pool: &mut Pool, a: &Value, b: &Value) -> bool {
    a.0.iter().zip(&b.0).all(|(&a, &b)| same_polynomial(pool, a, b))
}
