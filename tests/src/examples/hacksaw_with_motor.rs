//! The power hacksaw, its crank driven by a direct-current motor through a gear.
//!
//! The mechanism is that of `hacksaw/src/mechanism.rs`, word for word from the parameter `crank_angle` to the contact
//! `cut`: a macro's input cannot be composed of two files. A test compares the two texts.

use bg_model::bond_graph;

bond_graph! {
    /// Bond-graph words for the motor, mechanism words for the saw; the gear's output shaft is a bond on the crank's pin.
    /// The rotor has its own inertia, so that the shaft to the crank is a torsion spring with a damper.
    pub graph HacksawWithMotor {
        /// Resistance of the winding.
        param winding: Ohm = 1.5, above 0;
        /// Inductance of the winding.
        param coil: H = 5e-3, above 0;
        /// Motor constant: torque per current.
        param constant: N*m/A = 0.12, above 0;
        /// Moment of inertia of the rotor.
        param rotor_inertia: kg*m^2 = 2e-4, above 0;
        /// Viscous resistance of the motor's bearing.
        param bearing: N*m*s/rad = 1e-5, at least 0;
        /// Turns of the motor for one turn of the crank.
        param ratio: 1 = 10, above 0;
        /// Torsional stiffness of the shaft to the crank.
        param shaft_stiffness: N*m/rad = 2e3, above 0;
        /// Torsional damping of the shaft to the crank.
        param shaft_damping: N*m*s/rad = 2, at least 0;
        /// Voltage at the motor's terminals.
        input voltage: V;

        /// Crank angle at the start, from the x axis (outer dead centre).
        param crank_angle: rad = 0;
        /// Gravitational acceleration, along -y.
        param gravity: m/s^2 = 9.81;
        /// Density of all links (steel).
        param density: kg/m^3 = 7850, above 0;
        /// Offset of the rod out of the plane: z of the crank's pin A and the frame's pin B.
        param rod_offset: m = 0;

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

        gravity [0, -gravity, 0];
        ground {
            point O2 = [0, 0, 0];
            point O5 = [0.9, 0.745, 0];
            point work = [0.9, -0.145, 0];
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
            cuboid [0.03, 0.13, 0.03] at [-0.185, -0.08, 0];
            cuboid [0.03, 0.13, 0.03] at [0.185, -0.08, 0];
            density density;
            point bar = [0, 0, 0];
            point B = [-0.2, 0, rod_offset];
            point blade = [0, -0.145, 0];
            start bar at [guess(0.9), 0, 0];
        }
        body guide {
            cuboid [0.1, 0.09, 0.03];
            cuboid [0.09, 0.7, 0.03] at [0, 0.395, 0];
            density density;
            point block = [0, 0, 0];
            point pivot = [0, 0.745, 0];
            start pivot at [0.9, 0.745, 0];
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

        Se supply = voltage;
        1 armature: electrical;
        I inductance = coil;
        R resistance = winding;
        GY motor = constant;
        1 rotor: rotation;
        I rotor_mass = rotor_inertia;
        R rotor_bearing = bearing;
        TF gear = 1 / ratio;
        0 shaft: rotation;
        1 shaft_twist: rotation;
        C shaft_spring = shaft_stiffness;
        R shaft_damper = shaft_damping;
        supply -> armature -> motor -> rotor -> gear -> shaft -> pin_o.spin;
        armature -> inductance;
        armature -> resistance;
        rotor -> rotor_mass;
        rotor -> rotor_bearing;
        shaft -> shaft_twist -> shaft_spring;
        shaft_twist -> shaft_damper;

        observe {
            current: A = armature.flow;
            motor_speed: rad/s = rotor.flow;
            crank_speed: rad/s = pin_o.speed;
            crank_torque: N*m = shaft.effort;
            electrical_energy: J = integral(supply.effort * supply.flow);
            shaft_energy: J = integral(shaft.effort * pin_o.spin.flow);
            spring_torque: N*m = shaft_spring.effort;
            heat: J = integral(resistance.power);
            friction: J = integral(rotor_bearing.power + shaft_damper.power);
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }

        /// The motor's current, all that an ammeter in its supply shows of the saw.
        scene Current {
            observe { current: A = armature.flow; }
            tune { winding, constant, shaft_stiffness, r_cut, r_return }
            expect planar;
            expect states = 32;
        }
    }
}
