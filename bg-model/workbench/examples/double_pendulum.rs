//! A double pendulum: two uniform rods that hang on compliant pins without damping.
//!
//! Look at `elbow_angle`, which never repeats itself, and at `stored` and `supplied`, which stay equal up to a
//! constant. The scene `rigid-pendulum` has pins that do not give: 7 states, and no fast oscillation in the pins.
//!
//!     cargo run --release --example double_pendulum -- --scene rigid-pendulum --set upper_angle=2.5

use bg_model::bond_graph;

bond_graph! {
    /// Angles are those of the rods from the downward vertical, about z.
    pub graph DoublePendulum {
        /// Mass of the upper rod.
        param upper_mass: kg = 1.2, above 0;
        /// Length of the upper rod.
        param upper_length: m = 0.5, above 0;
        /// Mass of the lower rod.
        param lower_mass: kg = 0.8, above 0;
        /// Length of the lower rod.
        param lower_length: m = 0.7, above 0;
        /// Angle of the upper rod at the start.
        param upper_angle: rad = 1.6;
        /// Angle of the lower rod at the start.
        param lower_angle: rad = 0.9;
        /// Stiffness of the pins.
        param stiffness: N/m = 1e5, above 0;
        /// Stiffness of the pins' held rotations.
        param tilt_stiffness: N*m/rad = 1e3, above 0;
        /// Gravitational acceleration, along -y.
        param gravity: m/s^2 = 9.81;

        gravity [0, -gravity, 0];
        ground { point O = [0, 0, 0]; }
        body upper {
            mass upper_mass;
            inertia [upper_mass * upper_length * upper_length / 12, 1e-4,
                upper_mass * upper_length * upper_length / 12];
            point top = [0, upper_length / 2, 0];
            point bottom = [0, -upper_length / 2, 0];
            start top at [0, 0, 0];
            start turned rotation_z(upper_angle);
        }
        body lower {
            mass lower_mass;
            inertia [lower_mass * lower_length * lower_length / 12, 1e-4,
                lower_mass * lower_length * lower_length / 12];
            point top = [0, lower_length / 2, 0];
            start top at [upper_length * sin(upper_angle), -upper_length * cos(upper_angle), 0];
            start turned rotation_z(lower_angle);
        }
        joint shoulder: revolute z (ground.O -> upper.top) { stiffness stiffness; tilt stiffness tilt_stiffness; }
        joint elbow: revolute z (upper.bottom -> lower.top) { stiffness stiffness; tilt stiffness tilt_stiffness; }

        observe {
            upper_angle: rad = shoulder.direction;
            elbow_angle: rad = elbow.direction;
            upper_position: m = upper.position;
            lower_position: m = lower.position;
            upper_velocity: m/s = upper.velocity;
            lower_velocity: m/s = lower.velocity;
            upper_spin: rad/s = upper.angular_velocity;
            lower_spin: rad/s = lower.angular_velocity;
            shoulder_gap: m = shoulder.gap;
            elbow_gap: m = elbow.gap;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
        }

        /// The angles of the rods, in the plane.
        scene RodAngles {
            observe { upper_angle: rad = shoulder.direction; elbow_angle: rad = elbow.direction; }
            tune { upper_angle, lower_angle, stiffness, gravity }
            expect planar;
            expect states = 14;
        }
        /// Rods on pins that do not give.
        scene RigidPendulum {
            rigid joints;
            observe {
                upper_angle: rad = shoulder.direction;
                elbow_angle: rad = elbow.direction;
                shoulder_gap: m = shoulder.gap;
                elbow_gap: m = elbow.gap;
                upper_position: m = upper.position;
                lower_position: m = lower.position;
                stored: J = stored_energy;
                supplied: J = integral(supplied_power);
            }
            expect planar;
            expect states = 6;
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<DoublePendulum>()
}
