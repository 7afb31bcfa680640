// The robot `crane`, made by bg-import from `crane.xml` (MJCF). SI units.
// - Shapes touch nothing: there is no contact with the floor (--no-contacts says that you know it).

use bg_model::bond_graph;

bond_graph! {
    /// The robot `crane` of `crane.xml`.
    pub graph Crane {
        /// Travel of `rail` at the start.
        param rail_start: m = 0;
        /// Angle of `swing` at the start.
        param swing_start: rad = 0;

        gravity [0.5, 0, -9.81];
        ground {
            point rail = [0, 0, 2] turned rotation_z(-1.25890269921) * rotation_y(1.23474152745) * rotation_x(-2.02570799185);
        }

        let trolley_turned: 1 = rotation_z(0.523598775598) * rotation_y(0.174532925199) * rotation_x(-0.349065850399);
        let trolley_place: m = [0, 0, 2] + rotation_z(-1.25890269921) * rotation_y(1.23474152745) * rotation_x(-2.02570799185) * [0, 0, rail_start];
        body trolley {
            mass 4.06;
            center [0.0126108374384, 0, 0.0295566502463];
            inertia [[0.0151692293019, 1.61650969529e-4, 0.00138372043721], [1.61650969529e-4, 0.0188414347575, 9.75290858726e-5], [0.00138372043721, 9.75290858726e-5, 0.0157283901278]];
            point rail = [0, 0, 0] turned rotation_z(0.19739555985) * rotation_y(1.47305074706);
            point swing = [0.0576604444312, 0.02, -0.0664278760969] turned rotation_y(0.698131700798) * rotation_x(-0.785398163397);
            start at trolley_place; start turned trolley_turned;
        }
        joint rail: prismatic z (ground.rail -> trolley.rail) { rigid; }
        R rail_bearing = 3; rail.slide -> rail_bearing;
        C rail_spring(q) = 150 * q start rail_start - 0.1; rail.slide -> rail_spring;

        let jib_turned: 1 = trolley_turned * rotation_y(0.698131700798) * rotation_x(-0.785398163397) * rotation_z(swing_start) * rotation_x(0.785398163397);
        let jib_place: m = trolley_place + trolley_turned * [0.0576604444312, 0.02, -0.0664278760969] - jib_turned * [0.01, 0.02, 0];
        body jib {
            mass 1.93751587697;
            center [0.2, 0.0229111434507, 0.0270888565493];
            inertia [[0.00374701812062, 4.06914788456e-5, -0.00372420062382], [4.06914788456e-5, 0.0174413271978, 0.00120249341807], [-0.00372420062382, 0.00120249341807, 0.016469585563]];
            point swing = [0.01, 0.02, 0] turned rotation_x(-0.785398163397);
            point hook = [0.4, 0, 0.1] turned rotation_z(1.5707963267948966) * rotation_x(0.19739555985);
            start at jib_place; start turned jib_turned;
        }
        joint swing: revolute z (trolley.swing -> jib.swing) { rigid; }
        R swing_bearing = 0.2; swing.spin -> swing_bearing;
        I swing_rotor = 0.03; swing.spin -> swing_rotor;
        stop swing_stop on swing { at least -2.96705972839; at most 2.96705972839; restitution 0; start swing_start; }

        let load_turned: 1 = jib_turned * rotation_z(1.5707963267948966) * rotation_x(0.19739555985);
        let load_place: m = jib_place + jib_turned * [0.4, 0, 0.1];
        body load {
            mass 0.8;
            center [0.02, -0.01, -0.15];
            inertia [[0.004, 2e-4, -3e-4], [2e-4, 0.005, 1e-4], [-3e-4, 1e-4, 0.003]];
            start at load_place; start turned load_turned;
        }
        joint hook: spherical (jib.hook -> load) { rigid; }

        let potential: J = -dot(
            [0.5, 0, -9.81],
            trolley.mass * trolley.position
            + jib.mass * jib.position
            + load.mass * load.position
        );
        observe {
            rail: m = rail.travel;
            swing: rad = swing.angle;
            energy: J = stored_energy + potential;
        }

        scenes only;
        /// In the coordinates of its joints.
        scene Crane {}
    }
}
