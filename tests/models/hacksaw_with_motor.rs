//! The power hacksaw, its crank driven by a direct-current motor through a gear.
//!
//! The mechanism is that of the application, the part `hacksaw::Mechanism`, with another drive.

bg_model::bond_graph! {
    /// Bond-graph words for the motor, mechanism words for the saw; the gear's output shaft is a bond on the crank's
    /// pin. The rotor has its own inertia, so that the shaft to the crank is a torsion spring with a damper.
    pub graph HacksawWithMotor {
        part hacksaw::Mechanism;
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
