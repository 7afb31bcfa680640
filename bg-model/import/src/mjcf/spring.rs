//! `springdamper`: a joint's stiffness and damping from a time constant t and a damping ratio d.
//!
//! With the inertia m that the joint feels in the file's pose where all others are free, stiffness m / (t d)^2 and
//! damping 2 m / t. Source: MuJoCo's XML reference, `joint/springdamper`; checked against MuJoCo 4.0.

use super::Reader;
use super::moved::Moved;
use crate::robot::Law;

impl Reader<'_> {
    /// Gives the joints that ask for it their springs and dampers.
    pub fn damp_springs(&mut self) {
        let asked = std::mem::take(&mut self.spring_dampers);
        if asked.is_empty() {
            return;
        }
        let moved = Moved::new(self);
        let Some(felt) = moved.yielding() else {
            let what = "is left out: some joint moves no mass, and with it no stiffness is known";
            self.robot.notes.push(format!("`springdamper` of <joint> {what}."));
            asked.iter().for_each(|(index, _)| self.robot.joints[*index].spring = None);
            return;
        };
        for (index, [time, ratio]) in asked {
            let inertia = felt(index);
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
}
