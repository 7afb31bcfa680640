//! A robot of which each link is a body with a mass.
//!
//! Fixed joints make their links one. A chain of joints over links without mass becomes one joint, where one has the
//! same motion and nothing is lost: two hinges a universal joint, three hinges through one point a spherical one, a
//! slide and a hinge along one line a cylindrical one. Other links without mass get a small one. What carries nothing
//! is left out. Moments that no body has are replaced. A joint whose limits exclude 0 starts in the middle. Each of
//! these is a note or a remark. All takes a time in proportion to the number of links.

use nalgebra::{Matrix3, Vector3};

use crate::number::number;
use crate::robot::{Drag, Inertia, Joint, JointKind, Pose, Robot};
use crate::{ImportError, Options, check, couple};

/// Of the whole mass: what a link without mass gets that has to stay. Of the largest moment: what a moment of 0 gets.
const SMALL: f64 = 1e-6;

/// The radius of gyration of a link without a size, m.
const RADIUS: f64 = 0.1;

/// What is nothing beside 1, in moments that a file gives with ten digits.
const NOTHING: f64 = 1e-9;

/// The density of an atom's nucleus, kg/m^3: moments of a denser ball come from rounding, or the file has a point mass.
const NUCLEAR: f64 = 2.3e17;

/// How much more than half their sum the largest moment may be: the language takes 1.01, and numbers are rounded.
const WIDER: f64 = 1.01 - 1e-9;

/// How exactly axes meet and stand across each other.
const EXACT: f64 = 1e-9;

/// Merges; with `keep_fixed` fixed joints between links with mass stay.
///
/// # Errors
/// Nothing moves, or numbers are too large to calculate with.
pub fn merge(mut robot: Robot, options: Options) -> Result<Robot, ImportError> {
    one_bodies(&mut robot, options.keep_fixed);
    leave_out_what_carries_nothing(&mut robot);
    if robot.joints.is_empty() {
        return Err(ImportError::NothingMoves { notes: robot.notes });
    }
    if !options.limits {
        robot.joints.iter_mut().for_each(|joint| joint.limits = None);
        robot.tendons.iter_mut().for_each(|tendon| tendon.limits = None);
    }
    couple::settle(&mut robot);
    combine(&mut robot);
    give_masses(&mut robot);
    give_starts(&mut robot);
    couple::start(&mut robot);
    start_tendons(&mut robot);
    forget_unused(&mut robot);
    check::tell_open_loops(&mut robot);
    check::refuse_what_is_not_finite(&robot)?;
    Ok(robot)
}

/// Puts the ground first and parents before their children.
///
/// # Errors
/// A ring of joints, with its links.
pub fn in_order_of_the_tree(robot: &mut Robot, ground: usize) -> Result<(), String> {
    let carried = robot.carried();
    let mut order = vec![ground];
    let mut next = 0;
    while let Some(&parent) = order.get(next) {
        order.extend(carried[parent].iter().map(|&joint| robot.joints[joint].child));
        next += 1;
    }
    let mut places = vec![None; robot.links.len()];
    for (place, &link) in order.iter().enumerate() {
        places[link] = Some(place);
    }
    let lost: Vec<String> = (0..robot.links.len())
        .filter(|&link| places[link].is_none())
        .map(|link| format!("`{}`", robot.links[link].name))
        .collect();
    if !lost.is_empty() {
        return Err(format!("{} carry each other in a ring", lost.join(", ")));
    }
    let place = |link: usize| places[link].unwrap_or_default();
    for joint in &mut robot.joints {
        (joint.parent, joint.child) = (place(joint.parent), place(joint.child));
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends) {
        end.0 = place(end.0);
    }
    let mut sorted: Vec<usize> = (0..robot.joints.len()).collect();
    sorted.sort_by_key(|&joint| robot.joints[joint].child);
    let mut moved = vec![0; sorted.len()];
    for (new, &old) in sorted.iter().enumerate() {
        moved[old] = new;
    }
    robot.joints.sort_by_key(|joint| joint.child);
    for coupling in &mut robot.couplings {
        (coupling.follower, coupling.leader) = (moved[coupling.follower], moved[coupling.leader]);
    }
    let lengths = robot.actuators.iter_mut().map(|actuator| &mut actuator.length);
    for part in lengths.chain(robot.tendons.iter_mut().map(|tendon| &mut tendon.length)).flat_map(|l| &mut l.parts) {
        part.0 = moved[part.0];
    }
    robot.links = order.iter().map(|&link| robot.links[link].clone()).collect();
    Ok(())
}

/// Makes the child of each fixed joint a piece of its parent; each parent before its children, so that a chain ends in
/// one link.
fn one_bodies(robot: &mut Robot, keep_fixed: bool) {
    // Where each link is now: in which other one, and its frame in that.
    let mut homes: Vec<(usize, Pose)> = (0..robot.links.len()).map(|link| (link, Pose::identity())).collect();
    let mut keeps = vec![true; robot.joints.len()];
    for (at, keep) in keeps.iter_mut().enumerate() {
        let joint = &mut robot.joints[at];
        let (home, frame) = homes[joint.parent];
        if home != joint.parent {
            (joint.parent, joint.in_parent) = (home, frame.then(&joint.in_parent));
        }
        let joint = robot.joints[at].clone();
        if is_merged(robot, &joint, keep_fixed) {
            *keep = false;
            homes[joint.child] = (joint.parent, joint.in_parent.then(&joint.in_child.inverse()));
            one_body(robot, &joint, &homes[joint.child].1);
        }
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends) {
        let (home, frame) = homes[end.0];
        if home != end.0 {
            *end = (home, frame.then(&end.1));
        }
    }
    robot.keep_joints(&keeps);
}

fn is_merged(robot: &Robot, joint: &Joint, keep_fixed: bool) -> bool {
    let is_heavy = |link: usize| robot.links[link].inertia.is_some();
    // What stands on the ground is ground.
    joint.kind == JointKind::Fixed
        && !(keep_fixed && joint.parent != 0 && is_heavy(joint.child) && is_heavy(joint.parent))
}

/// Gives what the child of a fixed joint has to its parent.
fn one_body(robot: &mut Robot, fixed: &Joint, frame: &Pose) {
    let child = std::mem::replace(&mut robot.links[fixed.child], crate::robot::Link::new(""));
    let parent = &mut robot.links[fixed.parent];
    if let Some(inertia) = child.inertia.map(|inertia| inertia.seen_from(frame)).filter(|_| fixed.parent != 0) {
        parent.inertia = Some(parent.inertia.map_or(inertia, |own| own.with(&inertia)));
    }
    if fixed.parent != 0 {
        let moved = |(mass, place): (f64, Vector3<f64>)| (mass, frame.place + frame.turned * place);
        parent.lifts.extend(child.lifts.into_iter().map(moved));
        let carried = |drag: Drag| Drag {
            place: frame.place + frame.turned * drag.place,
            axes: frame.turned * drag.axes,
            ..drag
        };
        parent.drags.extend(child.drags.into_iter().map(carried));
    }
    parent.merged.push(child.name);
    parent.merged.extend(child.merged);
}

/// Links without mass and moments that carry nothing, from the last one on.
fn leave_out_what_carries_nothing(robot: &mut Robot) {
    let mut needs: Vec<bool> = robot.links.iter().map(|link| link.inertia.is_some()).collect();
    for end in robot.loops.iter().flat_map(|closed| &closed.ends) {
        needs[end.0] = true;
    }
    let mut keeps = vec![true; robot.joints.len()];
    for (at, joint) in robot.joints.iter().enumerate().rev() {
        keeps[at] = needs[joint.child];
        needs[joint.parent] |= needs[joint.child];
        if !keeps[at] {
            let (link, joint) = (&robot.links[joint.child].name, &joint.name);
            robot
                .notes
                .push(format!("Link `{link}` has no mass and carries nothing: it is left out with joint `{joint}`."));
        }
    }
    robot.keep_joints(&keeps);
}

/// One joint in the place of two with a link between that has no mass and carries nothing else, as long as there are
/// such.
fn combine(robot: &mut Robot) {
    let mut is_coupled = vec![false; robot.joints.len()];
    for coupling in &robot.couplings {
        is_coupled[coupling.follower] = true;
        is_coupled[coupling.leader] = true;
    }
    for (joint, _) in robot.lengths().flat_map(|length| &length.parts) {
        is_coupled[*joint] = true;
    }
    let mut is_held = vec![false; robot.links.len()];
    for end in robot.loops.iter().flat_map(|closed| &closed.ends) {
        is_held[end.0] = true;
    }
    let carried = robot.carried();
    let mut keeps = vec![true; robot.joints.len()];
    for at in 0..robot.joints.len() {
        let mut first = at;
        while keeps[first] && !is_coupled[first] {
            let link = robot.joints[first].child;
            let [second] = carried[link][..] else { break };
            if robot.links[link].inertia.is_some() || is_held[link] || is_coupled[second] {
                break;
            }
            let Some(joint) = combined(robot, (first, second)) else { break };
            let (one, other) = (&robot.joints[first].name, &robot.joints[second].name);
            robot.notes.push(format!(
                "Joints `{one}` and `{other}` are one {} joint, `{}`, whose angles and travels have no outputs and no \
                 inputs.",
                word(joint.kind),
                joint.name
            ));
            keeps[first] = false;
            robot.joints[second] = joint;
            first = second;
        }
    }
    robot.keep_joints(&keeps);
}

/// The one joint that leaves the motion of two in a chain, if there is one.
fn combined(robot: &Robot, (first, second): (usize, usize)) -> Option<Joint> {
    let (first, second) = (&robot.joints[first], &robot.joints[second]);
    // Both axes and both places in the frame of the link between, at the start.
    let between = first.in_child.inverse();
    let (place, other) = (first.in_child.place, second.in_parent.place);
    let (axis, other_axis) = (first.in_child.turned * first.axis, second.in_parent.turned * second.axis);
    if !(first.is_bare() && second.is_bare()) {
        return None;
    }
    let kind = match (first.kind, second.kind) {
        (JointKind::Revolute, JointKind::Revolute)
            if (place - other).norm() < EXACT && axis.dot(&other_axis).abs() < EXACT =>
        {
            JointKind::Universal
        }
        (JointKind::Universal, JointKind::Revolute) if (place - other).norm() < EXACT => JointKind::Spherical,
        (JointKind::Revolute, JointKind::Prismatic) | (JointKind::Prismatic, JointKind::Revolute)
            if axis.cross(&other_axis).norm() < EXACT
                && axis.dot(&other_axis) > 0.0
                && axis.cross(&(other - place)).norm() < EXACT =>
        {
            JointKind::Cylindrical
        }
        _ => return None,
    };
    if kind == JointKind::Spherical && (first.in_child.turned * Vector3::y()).cross(&other_axis).norm() < EXACT {
        return None;
    }
    // The common frame, in the link between.
    let axes = match kind {
        JointKind::Universal => Matrix3::from_columns(&[axis, other_axis, axis.cross(&other_axis)]),
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

fn word(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Universal => "universal",
        JointKind::Spherical => "spherical",
        _ => "cylindrical",
    }
}

/// A mass for each link that moves, moments that a body can have.
fn give_masses(robot: &mut Robot) {
    let total: f64 = robot.links.iter().filter_map(|link| link.inertia).map(|inertia| inertia.mass).sum();
    let small = if total > 0.0 { SMALL * total } else { SMALL };
    for at in 0..robot.joints.len() {
        let link = &mut robot.links[robot.joints[at].child];
        let name = &link.name;
        let Some(inertia) = &mut link.inertia else {
            let tensor = small * RADIUS * RADIUS * Matrix3::identity();
            robot.notes.push(format!("Link `{name}` has no mass: here it has {} kg, for its joints.", number(small)));
            link.inertia = Some(Inertia { mass: small, center: Vector3::zeros(), tensor });
            continue;
        };
        if inertia.mass == 0.0 {
            robot.notes.push(format!(
                "Link `{name}` has moments of inertia and no mass: here it has {} kg, for its joints.",
                number(small)
            ));
            inertia.mass = small;
        }
        robot.notes.extend(possible(inertia, name));
    }
}

/// Makes moments such that a body can have them, and says what was changed.
fn possible(inertia: &mut Inertia, name: &str) -> Option<String> {
    let principal = inertia.tensor.symmetric_eigen();
    let moments = principal.eigenvalues;
    let size = moments.amax();
    let about_origin = inertia.mass * inertia.center.norm_squared();
    // A ball of the radius r has 0.4 m r^2.
    let is_point = size <= 0.15 * inertia.mass * (inertia.mass / NUCLEAR).powf(2.0 / 3.0);
    let is_body = 2.0 * moments.max() <= moments.sum() * WIDER;
    if is_point || is_body && moments.min() > -NOTHING * size && moments.min() < NOTHING * size {
        let reference = if is_point { about_origin } else { size };
        let floor = SMALL * if reference > 0.0 { reference } else { inertia.mass * RADIUS * RADIUS };
        for (k, moment) in moments.iter().enumerate().filter(|(_, moment)| is_point || **moment < NOTHING * size) {
            let axis = principal.eigenvectors.column(k);
            inertia.tensor += (floor - moment) * axis * axis.transpose();
        }
        let what =
            if is_point { "no moments of inertia: here all are" } else { "a moment of inertia of 0: here it is" };
        return Some(format!("Link `{name}` has {what} {} kg*m^2.", number(floor)));
    }
    if moments.min() > 0.0 && is_body {
        return None;
    }
    let mean = moments.mean();
    let moment = if mean > 1e-3 * size { mean } else { inertia.mass * RADIUS * RADIUS };
    inertia.tensor = moment * Matrix3::identity();
    Some(format!("Link `{name}` has moments of inertia that no body has: here all are {} kg*m^2.", number(moment)))
}

/// A start inside the limits.
fn give_starts(robot: &mut Robot) {
    for joint in &mut robot.joints {
        if let Some((least, most)) = joint.limits.filter(|(least, most)| *least > 0.0 || *most < 0.0) {
            let middle =
                if least.is_finite() && most.is_finite() { (least + most) / 2.0 } else { least.max(most.min(0.0)) };
            let middle = if middle.is_finite() { middle } else { most };
            joint.start = middle;
            let (name, start) = (&joint.name, number(joint.start));
            robot.remarks.push(format!("Joint `{name}` starts at {start}, inside of its limits: 0 is outside."));
        }
    }
}

/// Limits of tendons that do not exclude the start, from which no run begins.
fn start_tendons(robot: &mut Robot) {
    for tendon in &mut robot.tendons {
        let start = tendon.length.at(&robot.joints);
        if tendon.limits.take_if(|(least, most)| start < *least || start > *most).is_some() {
            let name = &tendon.name;
            robot.notes.push(format!("The limits of tendon `{name}` are left out: it starts outside of them."));
        }
    }
}

/// Leaves out the links that no joint carries any more.
fn forget_unused(robot: &mut Robot) {
    let mut is_kept = vec![false; robot.links.len()];
    is_kept[0] = true;
    for joint in &robot.joints {
        is_kept[joint.child] = true;
    }
    let mut places = vec![0; robot.links.len()];
    for (left, (place, _)) in places.iter_mut().zip(&is_kept).filter(|(_, kept)| **kept).enumerate() {
        *place = left;
    }
    for joint in &mut robot.joints {
        (joint.parent, joint.child) = (places[joint.parent], places[joint.child]);
    }
    for end in robot.loops.iter_mut().flat_map(|closed| &mut closed.ends) {
        end.0 = places[end.0];
    }
    let mut kept = is_kept.iter();
    robot.links.retain(|_| kept.next() == Some(&true));
}
