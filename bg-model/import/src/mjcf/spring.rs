//! What follows from the inertia that a joint moves in the file's pose.
//!
//! `springdamper`: with that inertia m, a time constant t and a damping ratio d, stiffness m / (t d)^2 and damping
//! 2 m / t. Along a length of several joints the inertia is 1 / sum(a^2 / m) of their factors a. Source: MuJoCo's XML
//! reference, `joint/springdamper` and `actuator/position/dampratio`; checked against MuJoCo 4.0.

use super::Reader;
use crate::robot::{Inertia, Kind, Law, Length};

impl Reader<'_> {
    /// Gives the joints that ask for it their springs and dampers.
    pub fn damp_springs(&mut self) {
        let asked = std::mem::take(&mut self.spring_dampers);
        if asked.is_empty() {
            return;
        }
        let moved = self.moved();
        for (index, [time, ratio]) in asked {
            let inertia = self.of_joint(index, &moved);
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

    /// The inertia that something feels along a length.
    pub fn inertia_along(&self, length: &Length) -> f64 {
        let moved = self.moved();
        let yields = |&(joint, each): &(usize, f64)| each * each / self.of_joint(joint, &moved);
        1.0 / length.parts.iter().map(yields).sum::<f64>()
    }

    /// The inertia that a joint moves along its axis, with its own.
    fn of_joint(&self, index: usize, moved: &[Option<Inertia>]) -> f64 {
        let joint = &self.robot.joints[index];
        self.along(index, moved[joint.child]) + joint.armature
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
