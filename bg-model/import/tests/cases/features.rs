// The robot `features`, made by bg-import from `features.xml` (MJCF). SI units.
// - Mass and moments of `float` have the armature 0.02 of `float_free` in them, whose weight does not act.

use bg_model::bond_graph;

bond_graph! {
    /// The robot `features` of `features.xml`.
    pub graph Features {
        /// Angle of `pin` at the start.
        param pin_start: rad = 0;
        /// Angle of `tuned` at the start.
        param tuned_start: rad = 0;
        /// Travel of `leader` at the start.
        param leader_start: m = 0;

        gravity [0, 0, -9.81];
        ground {
            point pin = [2, 0, 1];
            point tuned = [4, 0, 1];
            point leader = [6, 0, 1];
            point follower = [7, 0, 1];
        }

        let float_place: m = [0, 0, 1];
        body float {
            mass 0.52;
            center [0.384615384615, 0.192307692308, 0.0961538461538];
            inertia [[0.0249615384615, -0.00153846153846, -7.69230769231e-4], [-0.00153846153846, 0.0282692307692, -3.84615384615e-4], [-7.69230769231e-4, -3.84615384615e-4, 0.0298461538462]];
            point float_lifted = [0.4, 0.2, 0.1];
            start at float_place;
        }
        drive float_lifted on float.float_lifted force = [0, 0, 1.4715];
        drive float_lifted_mass on float force = [0, 0, 0.1962];
        R float_drag = 0.8; float.rotation -> float_drag;
        joint float_brake: spherical (ground -> float) { stiffness 0; damping 0.8; }

        let rod_turned: 1 = rotation_y(pin_start);
        let rod_place: m = [2, 0, 1];
        body rod {
            mass 1;
            center [0.3, 0, 0];
            inertia [0.01, 0.05, 0.05];
            point hook = [0.5, 0, 0];
            point rod_lifted = [0.3, 0, 0];
            start at rod_place; start turned rod_turned;
        }
        drive rod_lifted on rod.rod_lifted force = [0, 0, 4.905];
        joint pin: revolute y (ground.pin -> rod) { rigid; }
        R pin_bearing(w) = 0.1 * w + 0.05 * w * abs(w) + 0.2 * pow(w, 3); pin.spin -> pin_bearing;
        C pin_spring(q) = 2 * q + 1 * q * abs(q) + 20 * pow(q, 3) start pin_start energy 2 * pow(q, 2) / 2 + 1 * abs(pow(q, 3)) / 3 + 20 * pow(q, 4) / 4; pin.spin -> pin_spring;

        let load_turned: 1 = rod_turned;
        let load_place: m = rod_place + rod_turned * [0.5, 0, 0];
        body load {
            mass 0.3;
            center [0.05, 0.1, -0.1];
            inertia [0.002, 0.003, 0.004];
            start at load_place; start turned load_turned;
        }
        joint hook: spherical (rod.hook -> load) { rigid; }
        R hook_bearing = 0.02; 1 hook_twist[3]: rotation; 0 hook_moment[3]: rotation;
        hook_twist -> hook_bearing; hook_twist -> hook_moment; rod.rotation -> hook_moment -> load.rotation;

        let timed_turned: 1 = rotation_y(tuned_start);
        let timed_place: m = [4, 0, 1];
        body timed {
            mass 1.5;
            center [0.2, 0, 0.1];
            inertia [0.01, 0.02, 0.02];
            start at timed_place; start turned timed_turned;
        }
        joint tuned: revolute y (ground.tuned -> timed) { rigid; }
        R tuned_bearing = 0.966666666667; tuned.spin -> tuned_bearing;
        C tuned_spring(q) = 4.47530864198 * q start tuned_start; tuned.spin -> tuned_spring;
        I tuned_rotor = 0.05; tuned.spin -> tuned_rotor;

        let left_place: m = [6, 0, 1] + [0, 0, leader_start];
        body left {
            mass 2;
            inertia [0.01, 0.01, 0.01];
            start at left_place;
        }
        joint leader: prismatic z (ground.leader -> left) { rigid; }

        let right_place: m = [7, 0, 1] + [0, 0, follower_start];
        body right {
            mass 1;
            inertia [0.01, 0.01, 0.01];
            start at right_place;
        }
        joint follower: prismatic z (ground.follower -> right) { rigid; }

        // `follower` follows `leader`.
        TF follower_ratio = -0.5; 0 follower_tie: translation; rSe follower_follows = 0;
        leader.slide -> follower_ratio -> follower_tie -> follower.slide; follower_follows -> follower_tie;
        let follower_start: m = 0.1 - 0.5 * leader_start;

        let potential: J = 9.81 * (
            float.mass * float.position.z - 0.15 * float.float_lifted.position.z - 0.02 * float.origin.position.z
            + rod.mass * rod.position.z - 0.5 * rod.rod_lifted.position.z
            + load.mass * load.position.z
            + timed.mass * timed.position.z
            + left.mass * left.position.z
            + right.mass * right.position.z
        );
        observe {
            pin: rad = pin.angle;
            tuned: rad = tuned.angle;
            leader: m = leader.travel;
            follower: m = follower.travel;
            float_position: m = float.origin.position;
            energy: J = stored_energy + potential;
        }

        scenes only;
        /// In the coordinates of its joints.
        scene Features {}
    }
}
