// The robot `double-pendulum`, made by bg-import from `double_pendulum.urdf` (URDF). SI units.
// In `ground`: `world`, `stand`.
// In `upper_arm`: `elbow-housing`.
// In `forearm`: `tool`.
// - lines 53 and 62: `effort` of <limit> is not used: what drives a joint may give any effort; with
//   --actuators it is limited.
// - lines 53 and 62: `velocity` of <limit> is not used: speeds are not limited.
// - Link `camera` has no mass and carries nothing: it is left out with joint `tool_to_camera`.

use bg_model::bond_graph;

bond_graph! {
    /// The robot `double-pendulum` of `double_pendulum.urdf`.
    pub graph DoublePendulum {
        /// Angle of `shoulder` at the start.
        param shoulder_start: rad = 0;
        /// Angle of `elbow` at the start.
        param elbow_start: rad = 0;

        gravity [0, 0, -9.81];
        ground {
            point shoulder = [0.0921060994003, 0.0389418342309, 1.2] turned rotation_z(2.6707652202) * rotation_y(-0.158812739095) * rotation_x(-0.0290094050268);
        }

        let upper_arm_turned: 1 = rotation_z(2.6707652202) * rotation_y(-0.158812739095) * rotation_x(-0.0290094050268) * rotation_z(shoulder_start) * rotation_y(-0.629839533948) * rotation_z(-1.03037682652);
        let upper_arm_place: m = [0.0921060994003, 0.0389418342309, 1.2];
        body upper_arm {
            mass 2;
            center [0.02, -0.01, -0.2];
            inertia [[0.0278317702868, 0.00231946894548, -0.0011031695984], [0.00231946894548, 0.0258902811135, 0.00959832903276], [-0.0011031695984, 0.00959832903276, 0.0102779485996]];
            point shoulder = [0, 0, 0] turned rotation_z(1.03037682652) * rotation_y(0.629839533948);
            point elbow = [0.01, 0.02, -0.4] turned rotation_z(0.2) * rotation_x(1.5707963267948966);
            start at upper_arm_place; start turned upper_arm_turned;
        }
        joint shoulder: revolute z (ground.shoulder -> upper_arm.shoulder) { rigid; }
        R shoulder_bearing = 0.05; shoulder.spin -> shoulder_bearing;

        let forearm_turned: 1 = upper_arm_turned * rotation_z(0.2) * rotation_x(1.5707963267948966) * rotation_y(-elbow_start);
        let forearm_place: m = upper_arm_place + upper_arm_turned * [0.01, 0.02, -0.4];
        body forearm {
            mass 1.6;
            center [0.185982657803, 0.00708079561006, 0.00317175128056];
            inertia [[0.00376096490794, -0.00131248703189, -5.55837645742e-4], [-0.00131248703189, 0.0182864350695, 1.02700861709e-4], [-5.55837645742e-4, 1.02700861709e-4, 0.0196601136407]];
            start at forearm_place; start turned forearm_turned;
        }
        joint elbow: revolute y (forearm -> upper_arm.elbow) { rigid; }
        stop elbow_stop on elbow { at least -3; at most 3; restitution 0; start elbow_start; }

        let potential: J = 9.81 * (
            upper_arm.mass * upper_arm.position.z
            + forearm.mass * forearm.position.z
        );
        observe {
            shoulder: rad = shoulder.angle;
            elbow: rad = elbow.angle;
            energy: J = stored_energy + potential;
        }

        scenes only;
        /// In the coordinates of its joints.
        scene DoublePendulum {}
    }
}
