//! The mechanism: the five-link power hacksaw of the paper in the macro language.
//!
//! Every number stands in the paper's tables or is a documented assumption; both are parameters. The model types
//! [`Hacksaw`] and those of its scenes are generated from this description. What turns the crank and what is watched is
//! added to the mechanism where it is used: here a constant torque. Another graph, of this crate or another, begins with
//! `part hacksaw::Mechanism;`.

use bg_model::bond_graph;

bond_graph! {
    /// The hacksaw's links, joints and cutting contact. The crank is driven at `pin_o.spin`.
    pub part Mechanism {
        /// Crank angle at the start, from the x axis (outer dead centre).
        param crank_angle: rad = 0;
        /// Gravitational acceleration, along -y.
        param gravity: m/s^2 = 9.81;
        /// Density of all links (steel).
        param density: kg/m^3 = 7850, above 0;
        /// Offset of the rod out of the plane: z of the crank's pin A and the frame's pin B.
        param rod_offset: m = 0, at least -1e3, at most 1e3;

        /// Pin 1-2, translation: stiffness.
        param k_2: N/m = 1e7, at least 0;
        /// Pin 1-2, translation: damping.
        param r_2: N*s/m = 0.5, at least 0;
        /// Pin 1-2, rotation about x and y: stiffness.
        param k_2r: N*m/rad = 1e3, at least 0;
        /// Pin 1-2, rotation about x and y: damping.
        param r_2r: N*m*s/rad = 1e2, at least 0;
        /// Pin 2-3, translation: stiffness.
        param k_23: N/m = 1e7, at least 0;
        /// Pin 2-3, translation: damping.
        param r_23: N*s/m = 1e2, at least 0;
        /// Pin 2-3, rotation about x and y: stiffness.
        param k_23r: N*m/rad = 1e3, at least 0;
        /// Pin 2-3, rotation about x and y: damping.
        param r_23r: N*m*s/rad = 1e2, at least 0;
        /// Pin 3-4, translation: stiffness.
        param k_34: N/m = 1e8, at least 0;
        /// Pin 3-4, translation: damping.
        param r_34: N*s/m = 0.5, at least 0;
        /// Pin 3-4, rotation about x and y: stiffness.
        param k_34r: N*m/rad = 1e3, at least 0;
        /// Pin 3-4, rotation about x and y: damping.
        param r_34r: N*m*s/rad = 80, at least 0;
        /// Pin 1-5, translation: stiffness.
        param k_15: N/m = 1e6, at least 0;
        /// Pin 1-5, translation: damping.
        param r_15: N*s/m = 10, at least 0;
        /// Pin 1-5, rotation about x and y: stiffness.
        param k_15r: N*m/rad = 1e3, at least 0;
        /// Pin 1-5, rotation about x and y: damping.
        param r_15r: N*m*s/rad = 1e2, at least 0;
        /// Slot 4-5, y and z of the frame: stiffness.
        param k_45: N/m = 1e7, at least 0;
        /// Slot 4-5, y and z of the frame: damping.
        param r_45: N*s/m = 1e2, at least 0;
        /// Slot 4-5, rotation about x, y and z: stiffness.
        param k_45r: N*m/rad = 1e4, at least 0;
        /// Slot 4-5, rotation about x, y and z: damping.
        param r_45r: N*m*s/rad = 100, at least 0;
        /// Blade on work, y and z of the frame: stiffness.
        param k_work: N/m = 1e2, at least 0;
        /// Blade on work, y and z of the frame: damping.
        param r_work: N*s/m = 1e2, at least 0;
        /// Blade on work, cutting stroke (blade moves toward the crank, -x): resistance.
        param r_cut: N*s/m = 100, at least 0;
        /// Blade on work, return stroke: resistance.
        param r_return: N*s/m = 10, at least 0;

        /// Frame: x of a post's centre from the bar's centre, to both sides.
        param post_x: m = 0.185, at least -1e3, at most 1e3;
        /// Frame: y of the posts' centres from the bar's centre.
        param post_y: m = -0.08, at least -1e3, at most 1e3;
        /// Frame: x of the pin B on the bar's centre line.
        param b4_x: m = -0.2, at least -1e3, at most 1e3;
        /// Frame: y of the blade line from the bar's centre.
        param blade_y: m = -0.145, at least -1e3, at most 1e3;
        /// Guide: y of the arm's centre from the block's centre.
        param arm_y: m = 0.395, at least -1e3, at most 1e3;
        /// Guide: y of the pivot from the block's centre.
        param pivot_y: m = 0.745, at least -1e3, at most 1e3;
        /// Pivot O5 of the guide, x.
        param o5_x: m = 0.9, at least -1e3, at most 1e3;
        /// Pivot O5 of the guide, y.
        param o5_y: m = 0.745, at least -1e3, at most 1e3;
        /// Point D0 of the work, x.
        param work_x: m = 0.9, at least -1e3, at most 1e3;
        /// Point D0 of the work, y.
        param work_y: m = -0.145, at least -1e3, at most 1e3;

        gravity [0, -gravity, 0];
        ground {
            point O2 = [0, 0, 0];
            point O5 = [o5_x, o5_y, 0];
            point work = [work_x, work_y, 0];
        }

        body crank {
            cuboid [0.075, 0.04, 0.02];
            density density;
            point O = [-0.0375, 0, 0];
            point A = [0.0375, 0, rod_offset];
            start O at [0, 0, 0];
            start turned rotation_z(crank_angle);
        }
        body rod {
            cuboid [0.7, 0.04, 0.03];
            density density;
            point A = [-0.35, 0, 0];
            point B = [0.35, 0, 0];
            start A at [0.075 * cos(crank_angle), 0.075 * sin(crank_angle), rod_offset];
            start turned rotation_z(guess(0));
        }
        body frame {
            cuboid [0.4, 0.03, 0.03];
            cuboid [0.03, 0.13, 0.03] at [-post_x, post_y, 0];
            cuboid [0.03, 0.13, 0.03] at [post_x, post_y, 0];
            density density;
            point bar = [0, 0, 0];
            point B = [b4_x, 0, rod_offset];
            point blade = [0, blade_y, 0];
            start bar at [guess(0.9), o5_y - pivot_y, 0];
        }
        body guide {
            cuboid [0.1, 0.09, 0.03];
            cuboid [0.09, 0.7, 0.03] at [0, arm_y, 0];
            density density;
            point block = [0, 0, 0];
            point pivot = [0, pivot_y, 0];
            start pivot at [o5_x, o5_y, 0];
        }

        joint pin_o: revolute z (ground.O2 -> crank.O) {
            stiffness k_2; damping r_2; tilt stiffness k_2r; tilt damping r_2r; frame inertial;
        }
        joint pin_a: revolute z (crank.A -> rod.A) {
            stiffness k_23; damping r_23; tilt stiffness k_23r; tilt damping r_23r; frame inertial;
        }
        joint pin_b: revolute z (rod.B -> frame.B) {
            stiffness k_34; damping r_34; tilt stiffness k_34r; tilt damping r_34r; frame inertial;
        }
        joint pin_c: revolute z (ground.O5 -> guide.pivot) {
            stiffness k_15; damping r_15; tilt stiffness k_15r; tilt damping r_15r; frame inertial;
        }
        joint slot: prismatic x (frame.bar -> guide.block) {
            stiffness k_45; damping r_45; tilt stiffness k_45r; tilt damping r_45r; frame inertial;
        }
        contact cut (ground.work -> frame.blade along x) {
            x: R(v) = if v < 0 { r_cut * v } else { r_return * v };
            y: C = k_work, R = r_work;
            z: C = k_work, R = r_work;
        }
    }

    /// The five-link power hacksaw with compliant joints: crank 2, connecting rod 3, saw frame 4, guide 5 on the frame 1.
    pub graph Hacksaw {
        part Mechanism;
        /// Drive torque on the crank about z.
        param torque: N*m = 10;
        drive motor on pin_o torque = torque;

        observe {
            C2: m = crank.position; R2 = crank.orientation; p2: kg*m/s = crank.momentum; h2: kg*m^2/s = crank.angular_momentum;
            C3: m = rod.position; R3 = rod.orientation; p3: kg*m/s = rod.momentum; h3: kg*m^2/s = rod.angular_momentum;
            C4: m = frame.position; R4 = frame.orientation; p4: kg*m/s = frame.momentum; h4: kg*m^2/s = frame.angular_momentum;
            C5: m = guide.position; R5 = guide.orientation; p5: kg*m/s = guide.momentum; h5: kg*m^2/s = guide.angular_momentum;
            stored_energy: J = stored_energy;
            supplied_energy: J = integral(supplied_power);
            dissipated_energy: J = integral(dissipated_power);
            crank_speed: rad/s = pin_o.speed;
            slip: m/s = cut.speed;
            F12: N = pin_o.force; F23: N = pin_a.force; F34: N = pin_b.force; F15: N = pin_c.force;
            F45: N = slot.force; Fcut: N = cut.force;
            gap_12: m = norm(pin_o.gap); gap_23: m = norm(pin_a.gap); gap_34: m = norm(pin_b.gap);
            gap_15: m = norm(pin_c.gap);
            gap_45: m = norm([0, slot.y_offset, slot.z_offset]);
        }

        /// The paper's case: the motion in the plane, every parameter adjustable that keeps it there.
        scene Paper {
            tune all but { rod_offset }
            expect planar;
            expect states = 29;
        }
        /// Where the links are, and nothing else: no energies, no forces. Every parameter of the paper's case is adjustable.
        scene Motion {
            observe {
                C2: m = crank.position; R2 = crank.orientation; C3: m = rod.position; R3 = rod.orientation;
                C4: m = frame.position; R4 = frame.orientation; C5: m = guide.position; R5 = guide.orientation;
            }
            tune all but { rod_offset }
            expect planar;
            expect states = 29;
        }
        /// The three-dimensional motion, with the rod out of the plane where `rod_offset` puts it.
        scene Full {
            expect states = 81;
        }
        /// The angles of crank, rod, frame and guide only.
        scene Angles {
            observe {
                crank_angle: rad = crank.angle; rod_angle: rad = rod.angle;
                frame_angle: rad = frame.angle; guide_angle: rad = guide.angle;
            }
            tune { torque, r_cut, r_return }
            angles;
            expect planar;
            expect states = 24;
        }
        /// The ideal mechanism: rigid joints, whose reactions are solved for.
        scene Rigid {
            rigid joints;
            observe {
                C4: m = frame.position; frame_angle: rad = frame.direction; guide_angle: rad = guide.direction;
                crank_speed: rad/s = pin_o.speed; F34: N = pin_b.force;
                gap_23: m = norm(pin_a.gap); gap_34: m = norm(pin_b.gap); gap_15: m = norm(pin_c.gap);
            }
            tune { torque, crank_angle, r_cut, r_return }
            expect planar;
            expect states = 9;
        }
        /// The machine running free, the blade off the work.
        scene FreeRun {
            without { cut }
            observe {
                crank_speed: rad/s = pin_o.speed; C4: m = frame.position; F34: N = pin_b.force;
            }
            tune { torque, crank_angle }
            expect planar;
            expect states = 29;
        }
    }
}
