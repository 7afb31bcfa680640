//! Drives on joints and on points: torque, force, speed.

use bg_model::bond_graph;

bond_graph! {
    /// Three wheels on pins without friction and a block on a slide.
    pub graph Drives {
        /// Torque on the first wheel, force on the block.
        param torque: N*m = 0.6;
        /// Force along the slide.
        param force: N = 4;
        /// Speed that the second wheel is to reach.
        param speed: rad/s = 7;
        /// Stiffness of the coupling to the second wheel.
        param coupling: N*m/rad = 3, above 0;
        /// Damping of the coupling to the second wheel.
        param coupling_damping: N*m*s/rad = 0.2, at least 0;
        ground { point A = [0, 0, 0]; point B = [0, 1, 0]; point C = [0, 2, 0]; }
        body wheel { cylinder radius 0.2 length 0.05 along z density 2700; }
        body geared { cylinder radius 0.2 length 0.05 along z density 2700; start at [0, 1, 0]; }
        body block { mass 2; inertia [0.1, 0.1, 0.1]; start at [0, 2, 0]; }
        joint first: revolute z (ground.A -> wheel) { stiffness 1e4; tilt stiffness 1e3; }
        joint second: revolute z (ground.B -> geared) { stiffness 1e4; tilt stiffness 1e3; }
        joint third: prismatic x (ground.C -> block) { stiffness 1e4; tilt stiffness 1e3; }
        drive twist on first torque = torque;
        drive turn on second speed = speed { stiffness coupling; damping coupling_damping; }
        drive push on third force = force;
        observe {
            wheel_speed: rad/s = first.speed;
            geared_speed: rad/s = second.speed;
            block_speed: m/s = block.velocity.x;
            travel: m = third.travel;
            turning: kg*m^2/s = wheel.angular.p.z;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }

    /// A free plate pushed at its corner: the force turns it as well.
    pub graph PushedPlate {
        /// Force along y at the corner.
        param force: N = 3;
        body plate { mass 1.5; inertia [0.2, 0.3, 0.4]; center [0.1, 0, 0]; point corner = [0.6, 0, 0];
            start at [1, 2, 3]; }
        drive push on plate.corner force = [0, force, 0];
        observe {
            velocity: m/s = plate.velocity;
            h: kg*m^2/s = plate.angular_momentum;
            corner: m = plate.corner.position;
            corner_velocity: m/s = plate.corner.velocity;
            axis = plate.x_axis;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
        }
    }
}
