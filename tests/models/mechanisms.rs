//! Published mechanisms with rigid joints, of the library of multibody benchmarks of the IFToMM technical committee.
//!
//! M. Gonzalez, D. Dopico, U. Lugris, J. Cuadrado, "A benchmarking system for MBS simulation software", Multibody
//! System Dynamics 16 (2006); cases A02 and A05 of its library, as github RehabEngGroup/MBSbenchmarksInOpenSim
//! (c76fa61) has them. Andrews' squeezer (A03) and the pendulum (A01) are among the hard cases, Bricard's mechanism
//! (A04) in `bg-model/tests`.

use bg_model::bond_graph;

bond_graph! {
    /// A rod of 1 m and 1 kg that stands on a pin of the ground.
    part Post {
        param place: m = 0;
        param speed: m/s = 1;
        ground { point foot = [place, 0, 0]; }
        body rod {
            mass 1; inertia [1 / 12, 1e-3, 1 / 12];
            point foot = [0, -0.5, 0]; point head = [0, 0.5, 0];
            start foot at [place, 0, 0]; start velocity [speed / 2, 0, 0]; start spin [0, 0, -speed / 1];
        }
        joint pin: revolute z (ground.foot -> rod.foot) { rigid; }
        observe { energy: J = rod.kinetic_energy + 9.81 * rod.position.y; gap: m = norm(pin.gap) }
    }

    /// A loop more: a level rod to the next post, that post, and the pin between the two.
    part Square {
        param place: m = 1;
        param speed: m/s = 1;
        body rod {
            mass 1; inertia [1e-3, 1 / 12, 1 / 12];
            point left = [-0.5, 0, 0]; point right = [0.5, 0, 0];
            start right at [place, 1, 0]; start velocity [speed, 0, 0];
        }
        part post: Post { place = place; speed = speed; }
        joint pin: revolute z (rod.right -> post.rod.head) { rigid; }
        observe { energy: J = rod.kinetic_energy + 9.81 * rod.position.y; gap: m = norm(pin.gap); all of post }
    }

    /// Case A02, the N-four-bar mechanism, with two loops: all square at the start, the upper rods move at `speed`.
    pub graph DoubleFourBar {
        /// Speed of the upper rods at the start, along x.
        param speed: m/s = 1;
        gravity [0, -9.81, 0];
        part first: Post { speed = speed; }
        part square[i in 0..2]: Square { place = i + 1; speed = speed; }
        joint left: revolute z (first.rod.head -> square[0].rod.left) { rigid; }
        joint middle: revolute z (square[0].post.rod.head -> square[1].rod.left) { rigid; }
        observe { B0: m = first.rod.head.position; v0: m/s = first.rod.head.velocity; all of first; all of square }
        scenes only;
        scene DoubleFourBar { all reactions; expect planar; }
        scene FourBarsBySpeeds { expect planar; expect independent speeds; expect states = 15; }
    }

    /// A rod of the governor, 1 m and 0.3 kg, with 5 kg at its end, a point of mass.
    part Arm {
        param side: 1 = 1;
        param angle: rad = 0.5;
        param speed: rad/s = 1;
        let reach: m = (0.3 * 0.5 + 5 * 1) / 5.3;
        let across: kg*m^2 = 0.3 / 12 * 1.0001 + 0.3 * pow(reach - 0.5, 2) + 5 * pow(1 - reach, 2);
        body rod {
            mass 5.3; inertia [0.3 / 12 * 2e-4, across, across]; center [reach, 0, 0];
            point middle = [0.5, 0, 0];
            start at [side * 0.05, 0, 1];
            start turned rotation_y(angle);
            start velocity [0, speed * (side * 0.05 + reach * cos(angle)), 0]; start spin [0, 0, speed];
        }
    }

    /// Case A05, the stiff flyball governor: a slider on a turning shaft, held up by springs and dampers to the rods.
    pub graph FlyballGovernor {
        /// Speed of the shaft at the start.
        param speed: rad/s = 6.283185307179586;
        /// The rods' angle below the horizontal at the start.
        param lowered: rad = 0.5235987755982988;
        /// Stiffness between a rod and the slider.
        param stiffness: N/m = 8e5, above 0;
        /// Damping between a rod and the slider.
        param damping: N*s/m = 4e4, at least 0;
        gravity [0, 0, -9.81];
        ground { point O = [0, 0, 0]; }
        body shaft {
            cuboid [0.01, 0.01, 1] at [0, 0, 0.5] density 3000;
            point right = [0.05, 0, 1]; point left = [-0.05, 0, 1];
            start at [0, 0, 0]; start spin [0, 0, speed];
        }
        body slider {
            cuboid [0.1, 0.1, 0.1] density 3000;
            point right = [0.05, 0, 0]; point left = [-0.05, 0, 0];
            start at [0, 0, 0.5]; start spin [0, 0, speed];
        }
        part right: Arm { side = 1; angle = lowered; speed = speed; }
        part left: Arm { side = -1; angle = 3.141592653589793 - lowered; speed = speed; }
        joint bearing: revolute z (ground.O -> shaft) { rigid; }
        joint slide: prismatic z (shaft -> slider) { rigid; }
        joint right_hinge: revolute y (shaft.right -> right.rod) { rigid; }
        joint left_hinge: revolute y (shaft.left -> left.rod) { rigid; }
        spring right_spring (slider.right -> right.rod.middle) { stiffness stiffness; damping damping; length 0.5; }
        spring left_spring (slider.left -> left.rod.middle) { stiffness stiffness; damping damping; length 0.5; }
        observe {
            height: m = slide.travel;
            turned: rad = integral(bearing.speed);
            right: rad = asin(-right.rod.x_axis.z);
            left: rad = asin(-left.rod.x_axis.z);
            speed: rad/s = bearing.speed;
            climb: m/s = slider.velocity.z;
            right_speed: rad/s = right_hinge.speed;
            left_speed: rad/s = -left_hinge.speed;
            gap: m = norm(right_hinge.gap) + norm(left_hinge.gap) + norm(bearing.gap);
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
        scenes only;
        scene FlyballGovernor { expect states = 8; }
    }
}
