//! What a robot must satisfy before it becomes a text: loops that are closed, numbers that can be calculated with.

use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::ImportError;
use crate::number::number;
use crate::robot::{JointKind, Loop, Pose, Robot};

/// How far the ends of a loop may be apart at the start, in parts of the largest place of a link, or turned, rad: more
/// is no rounding.
const CLOSED: f64 = 1e-9;

/// Loops whose ends are apart at the start, from which no run begins.
pub fn tell_open_loops(robot: &mut Robot) {
    if robot.loops.is_empty() {
        return;
    }
    let mut places = vec![Pose::identity(); robot.links.len()];
    for joint in &robot.joints {
        let moved = match joint.kind {
            JointKind::Revolute => Rotation3::new(joint.axis * joint.start).into_inner(),
            _ => Matrix3::identity(),
        };
        let travel = if joint.kind == JointKind::Prismatic { joint.axis * joint.start } else { Vector3::zeros() };
        let motion = Pose { turned: moved, place: travel };
        places[joint.child] = places[joint.parent].then(&joint.in_parent).then(&motion).then(&joint.in_child.inverse());
    }
    let ends = |closed: &Loop| closed.ends.each_ref().map(|(link, pose)| places[*link].then(pose));
    let placed = places.iter().copied().chain(robot.loops.iter().flat_map(ends));
    let extent = placed.fold(0.0_f64, |extent, pose| extent.max(pose.place.amax()));
    for closed in &robot.loops {
        let [first, second] = ends(closed);
        let across = first.inverse().then(&second);
        let gap = if closed.kind == JointKind::Prismatic { across.place.xy().norm() } else { across.place.norm() };
        // The angle between the axes that are held.
        let turned = match closed.kind {
            JointKind::Spherical => 0.0,
            JointKind::Revolute => across.turned.column(2).xy().norm(),
            _ => (across.turned - Matrix3::identity()).amax(),
        };
        if gap > CLOSED * extent || turned > CLOSED {
            let (name, gap) = (&closed.name, number(gap));
            robot.notes.push(format!(
                "Loop `{name}` is open at the start, by {gap} m or by an angle: make starts of its joints guesses, or \
                 give them values that close it."
            ));
        }
    }
}

/// The largest number that products of four still keep finite, and the smallest that they keep above 0.
const LARGE: f64 = 1e70;

/// Refuses numbers whose products would be infinite or 0.
///
/// # Errors
/// There is one; it says of what.
pub fn refuse_what_is_not_finite(robot: &Robot) -> Result<(), ImportError> {
    let too_large = |what: String| Err(ImportError::TooLarge { what });
    let is_fine = |values: &[f64]| values.iter().all(|value| value.abs() < LARGE);
    for link in &robot.links {
        let values = link.inertia.map(|inertia| {
            let sizes = [inertia.mass, inertia.mass.recip()];
            [&sizes[..], inertia.center.as_slice(), inertia.tensor.as_slice()].concat()
        });
        let lifts = link.lifts.iter().flat_map(|(mass, place)| [*mass, place.x, place.y, place.z]).collect::<Vec<_>>();
        let drags = link.drags.iter().flat_map(|drag| {
            [&drag.force[..], &drag.torque, drag.areas.as_slice(), drag.turns.as_slice(), drag.place.as_slice()]
                .concat()
        });
        let parts = drags.chain(lifts).collect::<Vec<_>>();
        if !is_fine(&values.unwrap_or_default()) || !is_fine(&parts) {
            return too_large(format!("link `{}`", link.name));
        }
    }
    for joint in &robot.joints {
        let frames = [joint.in_parent, joint.in_child];
        let spring = joint.spring.map_or([0.0; 4], |spring| {
            let [a, b, c] = spring.law.0;
            [a, b, c, spring.rest]
        });
        let own = [joint.friction, joint.armature, joint.start, joint.effort.unwrap_or(0.0)];
        let limits = joint.limits.map_or([0.0; 2], |(least, most)| [least, most]);
        let limits: Vec<f64> = limits.into_iter().filter(|end| end.is_finite()).collect();
        let places = frames.iter().flat_map(|frame| [frame.place.as_slice(), frame.turned.as_slice()].concat());
        let values: Vec<f64> = places.chain(spring).chain(own).chain(limits).chain(joint.damping.0).collect();
        if !is_fine(&values) {
            return too_large(format!("joint `{}`", joint.name));
        }
    }
    for closed in &robot.loops {
        if !is_fine(&closed.ends.iter().flat_map(|end| end.1.place.as_slice().to_vec()).collect::<Vec<_>>()) {
            return too_large(format!("loop `{}`", closed.name));
        }
    }
    if !is_fine(robot.gravity.as_slice()) {
        return too_large("gravity".to_owned());
    }
    for actuator in &robot.actuators {
        let ranges = [actuator.control, actuator.force].into_iter().flatten().flat_map(|(least, most)| [least, most]);
        let factors = actuator.length.parts.iter().map(|part| part.1);
        let values: Vec<f64> =
            ranges.chain(actuator.gain).chain(actuator.bias).chain(factors).chain([actuator.length.constant]).collect();
        if !is_fine(&values) {
            return too_large(format!("actuator `{}`", actuator.name));
        }
    }
    for tendon in &robot.tendons {
        let spring = tendon.spring.map_or([0.0; 4], |spring| {
            let [a, b, c] = spring.law.0;
            [a, b, c, spring.rest]
        });
        let limits = tendon.limits.map_or([0.0; 2], |(least, most)| [least, most]);
        let limits = limits.into_iter().filter(|end| end.is_finite());
        let factors = tendon.length.parts.iter().map(|part| part.1);
        let own = [tendon.slack, tendon.friction];
        let values: Vec<f64> = factors.chain(limits).chain(spring).chain(tendon.damping.0).chain(own).collect();
        if !is_fine(&values) {
            return too_large(format!("tendon `{}`", tendon.name));
        }
    }
    let is_coupled = |coupling: &crate::robot::Coupling| is_fine(&coupling.polynomial);
    if robot.couplings.iter().all(is_coupled) { Ok(()) } else { too_large("what couples two joints".to_owned()) }
}
