// The robot `four bar`, made by bg-import from `linkage.xml` (MJCF). SI units.
// In `fork`: `flag`.
// - The actuators are left out; each joint has an input of its own. With --actuators those that act on joints
//   are not.
// - Shapes touch nothing: there is no contact with the floor (--no-contacts says that you know it).
// - Link `fork_carrier1` has no mass: here it has 7.61503845163e-6 kg, for its joints.
// - Link `puck_carrier1` has no mass: here it has 7.61503845163e-6 kg, for its joints.
// - Link `puck_carrier2` has no mass: here it has 7.61503845163e-6 kg, for its joints.

use bg_model::bond_graph;

bond_graph! {
    /// The robot `four bar` of `linkage.xml`.
    pub graph FourBar {
        /// Angle of `crank_joint` at the start.
        param crank_joint_start: rad = 0;
        /// Angle of `pin` at the start.
        param pin_start: rad = 0;
        /// Angle of `rocker_joint` at the start.
        param rocker_joint_start: rad = 0;
        /// Angle of `tilt` at the start.
        param tilt_start: rad = 0;
        /// Travel of `puck_x` at the start.
        param puck_x_start: m = 0;
        /// Travel of `puck_y` at the start.
        param puck_y_start: m = 0;
        /// Angle of `puck_turn` at the start.
        param puck_turn_start: rad = 0;
        /// The stiffness of joints that close loops, chosen by the importer.
        param loop_stiffness: N/m = 1e6, at least 0;
        /// The damping of joints that close loops, chosen by the importer.
        param loop_damping: N*s/m = 100, at least 0;

        /// Drives `crank_joint`: a torque.
        input crank_joint_torque: N*m;
        /// Drives `pin`: a torque.
        input pin_torque: N*m;
        /// Drives `rocker_joint`: a torque.
        input rocker_joint_torque: N*m;
        /// Drives `pan`: a torque.
        input pan_torque: N*m;
        /// Drives `tilt`: a torque.
        input tilt_torque: N*m;
        /// Drives `puck_x`: a force.
        input puck_x_force: N;
        /// Drives `puck_y`: a force.
        input puck_y_force: N;
        /// Drives `puck_turn`: a torque.
        input puck_turn_torque: N*m;

        gravity [0, 0, -9.81];
        ground {
            point rocker_joint = [0.5, 0, 0];
            point pan = [0, 1, 0];
            point puck_x = [0, 2, 0];
        }

        let crank_turned: 1 = rotation_y(crank_joint_start);
        body crank {
            mass 0.284837733925;
            center [0, 0, 0.1];
            inertia [0.00125362113249, 0.00125362113249, 5.56271339196e-5];
            point pin = [0, 0, 0.2];
            start turned crank_turned;
        }
        joint crank_joint: revolute y (ground -> crank) { rigid; }
        drive crank_joint_motor on crank_joint torque = crank_joint_torque;

        let coupler_turned: 1 = crank_turned * rotation_y(pin_start);
        let coupler_place: m = crank_turned * [0, 0, 0.2];
        body coupler {
            mass 0.674272011415;
            center [0.25, 0, 0.05];
            inertia [[7.53722336365e-4, 0, -0.00310104173474], [0, 0.01625893101, 0], [-0.00310104173474, 0, 0.0156387226631]];
            point tie = [0.5, 0, 0.1];
            start at coupler_place; start turned coupler_turned;
        }
        joint pin: revolute y (crank.pin -> coupler) { rigid; }
        drive pin_motor on pin torque = pin_torque;

        let rocker_turned: 1 = rotation_y(rocker_joint_start);
        let rocker_place: m = [0.5, 0, 0];
        body rocker {
            mass 0.410501440069;
            center [0, 0, 0.15];
            inertia [0.00369987461208, 0.00369987461208, 8.07598751483e-5];
            point tie = [0, 0, 0.3];
            start at rocker_place; start turned rocker_turned;
        }
        joint rocker_joint: revolute y (ground.rocker_joint -> rocker) { rigid; }
        friction rocker_joint_friction on rocker_joint { coulomb 0.01; viscous 0.02; }
        drive rocker_joint_motor on rocker_joint torque = rocker_joint_torque;

        let fork_carrier1_turned: 1 = rotation_z(pan_start);
        let fork_carrier1_place: m = [0, 1, 0];
        body fork_carrier1 {
            mass 7.61503845163e-6;
            inertia [7.61503845163e-8, 7.61503845163e-8, 7.61503845163e-8];
            start at fork_carrier1_place; start turned fork_carrier1_turned;
        }
        joint pan: revolute z (ground.pan -> fork_carrier1) { rigid; }
        drive pan_motor on pan torque = pan_torque;

        let fork_turned: 1 = fork_carrier1_turned * rotation_y(tilt_start);
        let fork_place: m = fork_carrier1_place;
        body fork {
            mass 0.8;
            inertia [7.73333333333e-4, 0.00277333333333, 0.00333333333333];
            start at fork_place; start turned fork_turned;
        }
        joint tilt: revolute y (fork_carrier1 -> fork) { rigid; }
        drive tilt_motor on tilt torque = tilt_torque;

        let puck_carrier1_place: m = [0, 2, 0] + [puck_x_start, 0, 0];
        body puck_carrier1 {
            mass 7.61503845163e-6;
            inertia [7.61503845163e-8, 7.61503845163e-8, 7.61503845163e-8];
            start at puck_carrier1_place;
        }
        joint puck_x: prismatic x (ground.puck_x -> puck_carrier1) { rigid; }
        drive puck_x_motor on puck_x force = puck_x_force;

        let puck_carrier2_place: m = puck_carrier1_place + [0, puck_y_start, 0];
        body puck_carrier2 {
            mass 7.61503845163e-6;
            inertia [7.61503845163e-8, 7.61503845163e-8, 7.61503845163e-8];
            start at puck_carrier2_place;
        }
        joint puck_y: prismatic y (puck_carrier1 -> puck_carrier2) { rigid; }
        drive puck_y_motor on puck_y force = puck_y_force;

        let puck_turned: 1 = rotation_z(puck_turn_start);
        let puck_place: m = puck_carrier2_place;
        body puck {
            mass 1.25663706144;
            inertia [0.00330914426178, 0.00330914426178, 0.00628318530718];
            start at puck_place; start turned puck_turned;
        }
        joint puck_turn: revolute z (puck_carrier2 -> puck) { rigid; }
        drive puck_turn_motor on puck_turn torque = puck_turn_torque;

        let ball_place: m = [0, 3, 1];
        body ball {
            mass 4.18879020479;
            inertia [0.0167551608191, 0.0167551608191, 0.0167551608191];
            start at ball_place;
        }

        // `pan` follows `tilt`.
        TF pan_ratio = 1; 0 pan_tie: rotation; rSe pan_follows = 0;
        tilt.spin -> pan_ratio -> pan_tie -> pan.spin; pan_follows -> pan_tie;
        let pan_start: rad = 1 * tilt_start;

        joint tie: spherical (coupler.tie -> rocker.tie) { stiffness loop_stiffness; damping loop_damping; }

        let potential: J = 9.81 * (
            crank.mass * crank.position.z
            + coupler.mass * coupler.position.z
            + rocker.mass * rocker.position.z
            + fork_carrier1.mass * fork_carrier1.position.z
            + fork.mass * fork.position.z
            + puck_carrier1.mass * puck_carrier1.position.z
            + puck_carrier2.mass * puck_carrier2.position.z
            + puck.mass * puck.position.z
            + ball.mass * ball.position.z
        );
        observe {
            crank_joint: rad = crank_joint.angle;
            pin: rad = pin.angle;
            rocker_joint: rad = rocker_joint.angle;
            pan: rad = pan.angle;
            tilt: rad = tilt.angle;
            puck_x: m = puck_x.travel;
            puck_y: m = puck_y.travel;
            puck_turn: rad = puck_turn.angle;
            ball_position: m = ball.origin.position;
            energy: J = stored_energy + potential;
        }

        scenes only;
        /// In the coordinates of its joints.
        scene FourBar {}
    }
}
