//! `springdamper`: a joint's stiffness and damping from a time constant t and a damping ratio d.
//!
//! With the inertia m of all that the joint moves, in the file's pose, stiffness m / (t d)^2 and damping 2 m / t.
//! Source: MuJoCo's XML reference, `joint/springdamper`; checked against MuJoCo 4.0.

use super::Reader;
use crate::robot::{Inertia, Kind, Law};

impl Reader<'_> {
    /// Gives the joints that ask for it their springs and dampers.
    pub fn damp_springs(&mut self) {
        let asked = std::mem::take(&mut self.spring_dampers);
        if asked.is_empty() {
            return;
        }
        let moved = self.moved();
        for (index, [time, ratio]) in asked {
            let inertia = self.along(index, moved[self.robot.joints[index].child]) + self.robot.joints[index].armature;
            let joint = &mut self.robot.joints[index];
            if let Some(spring) = &mut joint.spring {
                spring.law = Law([inertia / (time * ratio).powi(2), 0.0, 0.0]);
            }
            if self.settings.dampers {
                joint.damping = Law([2.0 * inertia / time, 0.0, 0.0]);
            }
            joint.spring = joint.spring.filter(|spring| self.settings.springs && !spring.law.is_zero());
        }
    }

    /// Each link with all that it carries, seen from the ground.
    fn moved(&self) -> Vec<Option<Inertia>> {
        let seen =
            |(link, place): (&crate::robot::Link, &crate::robot::Pose)| link.inertia.map(|own| own.seen_from(place));
        let mut moved: Vec<Option<Inertia>> = self.robot.links.iter().zip(&self.places).map(seen).collect();
        for joint in self.robot.joints.iter().rev() {
            if let Some(child) = moved[joint.child] {
                moved[joint.parent] = Some(moved[joint.parent].map_or(child, |parent| parent.with(&child)));
            }
        }
        moved
    }

    /// The inertia that a joint moves along its axis.
    fn along(&self, index: usize, moved: Option<Inertia>) -> f64 {
        let joint = &self.robot.joints[index];
        let Some(Inertia { mass, center, tensor }) = moved else { return 0.0 };
        if joint.kind == Kind::Prismatic {
            return mass;
        }
        let frame = self.places[joint.child].then(&joint.in_child);
        let axis = frame.turned * joint.axis;
        let lever = axis.cross(&(center - frame.place));
        axis.dot(&(tensor * axis)) + mass * lever.norm_squared()
    }
}
