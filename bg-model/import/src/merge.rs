//! A robot of which each link is a body with a mass.
//!
//! Fixed joints make their links one. A chain of joints over links without mass becomes one joint, where one has the same
//! motion: two hinges a universal joint, three hinges through one point a spherical one, a slide and a hinge along one line a
//! cylindrical one. Other links without mass get a small one. What carries nothing is left out. Moments that no body has
//! are replaced. A joint whose limits exclude 0 starts in the middle. Each of these is a note.

use nalgebra::Matrix3;

use crate::number::number;
use crate::robot::{Inertia, Joint, Kind, Pose, Robot};

/// Of the whole mass: what a link without mass gets that has to stay.
const SMALL: f64 = 1e-6;

/// Its radius of gyration, m.
const RADIUS: f64 = 0.1;

/// How exactly axes meet and stand across each other.
const EXACT: f64 = 1e-9;

/// Merges; with `keep_fixed` fixed joints between links with mass stay.
#[must_use]
pub fn merge(mut robot: Robot, keep_fixed: bool) -> Robot {
    while let Some(at) = robot.joints.iter().position(|joint| is_merged(&robot, joint, keep_fixed)) {
        one_body(&mut robot, at);
    }
    while let Some(at) = robot.joints.iter().position(|joint| carries_nothing(&robot, joint)) {
        let joint = robot.joints.remove(at);
        let link = &robot.links[joint.child].name;
        robot.notes.push(format!(
            "Link `{link}` has no mass and carries nothing: it is left out with joint `{}`.",
            joint.name
        ));
    }
    while let Some((first, second)) = chained(&robot).into_iter().find(|&pair| combined(&robot, pair).is_some()) {
        if let Some(joint) = combined(&robot, (first, second)) {
            let (one, other) = (&robot.joints[first].name, &robot.joints[second].name);
            robot.notes.push(format!(
                "Joints `{one}` and `{other}` are one {} joint, `{}`, without their limits, damping and friction.",
                word(joint.kind),
                joint.name
            ));
            robot.joints[first] = joint;
            robot.joints.remove(second);
        }
    }
    give_masses(&mut robot);
    give_starts(&mut robot);
    forget_unused(&mut robot);
    robot
}

/// Puts the ground first and parents before their children.
///
/// # Errors
/// A ring of joints, with its links.
pub fn in_order_of_the_tree(robot: &mut Robot, ground: usize) -> Result<(), String> {
    let mut order = vec![ground];
    let mut next = 0;
    while let Some(&parent) = order.get(next) {
        order.extend(robot.joints.iter().filter(|joint| joint.parent == parent).map(|joint| joint.child));
        next += 1;
    }
    let lost: Vec<String> = (0..robot.links.len())
        .filter(|link| !order.contains(link))
        .map(|link| format!("`{}`", robot.links[link].name))
        .collect();
    if !lost.is_empty() {
        return Err(format!("{} carry each other in a ring", lost.join(", ")));
    }
    let place = |link: usize| order.iter().position(|&other| other == link).unwrap_or_default();
    for joint in &mut robot.joints {
        (joint.parent, joint.child) = (place(joint.parent), place(joint.child));
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends) {
        end.0 = place(end.0);
    }
    robot.joints.sort_by_key(|joint| joint.child);
    robot.links = order.iter().map(|&link| robot.links[link].clone()).collect();
    Ok(())
}

fn is_merged(robot: &Robot, joint: &Joint, keep_fixed: bool) -> bool {
    let is_heavy = |link: usize| robot.links[link].inertia.is_some();
    // What stands on the ground is ground.
    joint.kind == Kind::Fixed && !(keep_fixed && joint.parent != 0 && is_heavy(joint.child) && is_heavy(joint.parent))
}

/// Makes the child of a fixed joint a piece of its parent.
fn one_body(robot: &mut Robot, at: usize) {
    let fixed = robot.joints.remove(at);
    let frame = fixed.in_parent.then(&fixed.in_child.inverse());
    let child = robot.links[fixed.child].clone();
    let parent = &mut robot.links[fixed.parent];
    if let Some(inertia) = child.inertia.map(|inertia| inertia.seen_from(&frame)).filter(|_| fixed.parent != 0) {
        parent.inertia = Some(parent.inertia.map_or(inertia, |own| own.with(&inertia)));
    }
    parent.merged.push(child.name);
    parent.merged.extend(child.merged);
    for joint in robot.joints.iter_mut().filter(|joint| joint.parent == fixed.child) {
        (joint.parent, joint.in_parent) = (fixed.parent, frame.then(&joint.in_parent));
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends).filter(|end| end.0 == fixed.child) {
        *end = (fixed.parent, frame.then(&end.1));
    }
}

fn carries_nothing(robot: &Robot, joint: &Joint) -> bool {
    let is_held = |closed: &crate::robot::Loop| closed.ends.iter().any(|end| end.0 == joint.child);
    robot.links[joint.child].inertia.is_none()
        && !robot.joints.iter().any(|other| other.parent == joint.child)
        && !robot.loops.iter().any(is_held)
}

/// Pairs of joints with a link between that has no mass and carries nothing else.
fn chained(robot: &Robot) -> Vec<(usize, usize)> {
    let next = |first: &Joint| {
        let mut carried = (0..robot.joints.len()).filter(|&at| robot.joints[at].parent == first.child);
        let only = carried.next().filter(|_| robot.links[first.child].inertia.is_none());
        only.filter(|_| carried.next().is_none())
    };
    robot.joints.iter().enumerate().filter_map(|(first, joint)| Some((first, next(joint)?))).collect()
}

/// The one joint that leaves the motion of two in a chain, if there is one.
fn combined(robot: &Robot, (first, second): (usize, usize)) -> Option<Joint> {
    let (first, second) = (&robot.joints[first], &robot.joints[second]);
    // Both axes and both places in the frame of the link between, at the start.
    let between = first.in_child.inverse();
    let (place, other) = (first.in_child.place, second.in_parent.place);
    let (axis, other_axis) = (first.in_child.turned * first.axis, second.in_parent.turned * second.axis);
    let is_free = |joint: &Joint| joint.armature == 0.0 && joint.spring.is_none();
    if !(is_free(first) && is_free(second)) {
        return None;
    }
    let kind = match (first.kind, second.kind) {
        (Kind::Revolute, Kind::Revolute) if (place - other).norm() < EXACT && axis.dot(&other_axis).abs() < EXACT => {
            Kind::Universal
        }
        (Kind::Universal, Kind::Revolute) if (place - other).norm() < EXACT => Kind::Spherical,
        (Kind::Revolute, Kind::Prismatic) | (Kind::Prismatic, Kind::Revolute)
            if axis.cross(&other_axis).norm() < EXACT
                && axis.dot(&other_axis) > 0.0
                && axis.cross(&(other - place)).norm() < EXACT =>
        {
            Kind::Cylindrical
        }
        _ => return None,
    };
    if kind == Kind::Spherical && (first.in_child.turned * nalgebra::Vector3::y()).cross(&other_axis).norm() < EXACT {
        return None;
    }
    // The common frame, in the link between.
    let axes = match kind {
        Kind::Universal => Matrix3::from_columns(&[axis, other_axis, axis.cross(&other_axis)]),
        _ => first.in_child.turned,
    };
    let frame = Pose { turned: axes, place };
    let in_parent = first.in_parent.then(&between).then(&frame);
    let in_child = second.in_child.then(&second.in_parent.inverse()).then(&frame);
    Some(Joint {
        in_child,
        axis: first.axis,
        ..Joint::new(&second.name, kind, (first.parent, second.child), in_parent)
    })
}

fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::Universal => "universal",
        Kind::Spherical => "spherical",
        _ => "cylindrical",
    }
}

/// A mass for each link that moves, moments that a body can have.
fn give_masses(robot: &mut Robot) {
    let total: f64 = robot.links.iter().filter_map(|link| link.inertia).map(|inertia| inertia.mass).sum();
    let moving: Vec<usize> = robot.joints.iter().map(|joint| joint.child).collect();
    for link in moving {
        let link = &mut robot.links[link];
        let name = &link.name;
        let Some(inertia) = &mut link.inertia else {
            let mass = if total > 0.0 { SMALL * total } else { SMALL };
            let tensor = mass * RADIUS * RADIUS * Matrix3::identity();
            robot.notes.push(format!("Link `{name}` has no mass: here it has {} kg, for its joints.", number(mass)));
            link.inertia = Some(Inertia { mass, center: nalgebra::Vector3::zeros(), tensor });
            continue;
        };
        let moments = inertia.tensor.symmetric_eigenvalues();
        let is_possible = moments.min() > 0.0 && 2.0 * moments.max() <= moments.sum() * 1.01;
        if !is_possible {
            let mean = moments.mean();
            let moment = if mean > 0.0 { mean } else { inertia.mass * RADIUS * RADIUS };
            inertia.tensor = moment * Matrix3::identity();
            robot.notes.push(format!(
                "Link `{name}` has moments of inertia that no body has: here all are {} kg*m^2.",
                number(moment)
            ));
        }
    }
}

/// A start inside the limits.
fn give_starts(robot: &mut Robot) {
    for joint in &mut robot.joints {
        if let Some((least, most)) = joint.limits.filter(|(least, most)| *least > 0.0 || *most < 0.0) {
            joint.start = (least + most) / 2.0;
            let (name, start) = (&joint.name, number(joint.start));
            robot.notes.push(format!("Joint `{name}` starts at {start}, the middle of its limits: 0 is outside."));
        }
    }
}

/// Leaves out the links that no joint carries any more.
fn forget_unused(robot: &mut Robot) {
    let keep: Vec<usize> = (0..robot.links.len())
        .filter(|&link| link == 0 || robot.joints.iter().any(|joint| joint.child == link))
        .collect();
    let place = |link: usize| keep.iter().position(|&other| other == link).unwrap_or_default();
    for joint in &mut robot.joints {
        (joint.parent, joint.child) = (place(joint.parent), place(joint.child));
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends) {
        end.0 = place(end.0);
    }
    robot.links = keep.iter().map(|&link| robot.links[link].clone()).collect();
}
