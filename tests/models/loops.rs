//! Algebraic loops and storages in derivative causality.

use bg_model::bond_graph;

bond_graph! {
    /// A bridge of resistors with a coil across: five algebraic variables and one state.
    pub graph Bridge {
        /// Voltage of the source.
        param voltage: V = 10;
        /// Resistance from the source to the first side.
        param first: Ohm = 100, above 0;
        /// Resistance from the source to the second side.
        param second: Ohm = 220, above 0;
        /// Resistance from the first side to the ground.
        param third: Ohm = 330, above 0;
        /// Resistance from the second side to the ground.
        param fourth: Ohm = 470, above 0;
        /// Resistance of the coil.
        param winding: Ohm = 10, above 0;
        /// Inductance across the bridge.
        param coil: H = 0.5, above 0;
        Se source = voltage;
        0 top: electrical; 0 left: electrical; 0 right: electrical;
        1 upper_left: electrical; 1 upper_right: electrical; 1 across: electrical;
        R R1 = first; R R2 = second; R R3 = third; R R4 = fourth; R R5 = winding; I L = coil;
        source -> top -> upper_left -> left -> R3; upper_left -> R1;
        top -> upper_right -> right -> R4; upper_right -> R2;
        left -> across -> right; across -> R5; across -> L;
        observe {
            current: A = across.flow;
            left: V = left.effort;
            right: V = right.effort;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }

    /// A mass that a lever moves along a line: the ratio changes with the angle, so the mass feels the square of the
    /// speed.
    pub graph Lever {
        /// Moment of inertia of the lever.
        param inertia: kg*m^2 = 0.4, above 0;
        /// Its length.
        param length: m = 0.5, above 0;
        /// The mass at its end.
        param mass: kg = 3, above 0;
        /// Stiffness of the spring at its pivot.
        param stiffness: N*m/rad = 12, above 0;
        1 lever: rotation;
        C spring = stiffness start 0.9;
        I J = inertia;
        MTF arm = length * cos(spring.q);
        1 end: translation;
        I m = mass;
        lever -> J; lever -> spring; lever -> arm -> end -> m;
        observe {
            angle: rad = spring.q;
            speed: rad/s = lever.flow;
            force: N = m.effort;
            momentum: kg*m/s = m.p;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }

    /// A coil behind a resistor, with a conductance beside it that is larger one way: a loop whose solution has two
    /// branches.
    pub graph Clipped {
        /// Amplitude of the source.
        param amplitude: V = 10;
        /// Its frequency.
        param frequency: rad/s = 40, above 0;
        /// Resistance in series.
        param series: Ohm = 5, above 0;
        /// Conductance beside the coil where its voltage is negative.
        param forward: S = 2, above 0;
        /// Conductance beside the coil where its voltage is positive.
        param backward: S = 0.01, above 0;
        /// Inductance.
        param coil: H = 0.1, above 0;
        MSe source = amplitude * sin(frequency * t);
        1 line: electrical;
        R R1 = series;
        0 node: electrical;
        I L = coil;
        R clip(effort u) = if u < 0 { forward * u } else { backward * u };
        source -> line -> R1; line -> node -> L; node -> clip;
        observe {
            voltage: V = node.effort;
            current: A = L.flow;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }

    /// A capacitor charged through a resistor and a diode: a loop that is not linear.
    pub graph Charger {
        /// Amplitude of the source.
        param amplitude: V = 10;
        /// Its frequency.
        param frequency: rad/s = 31.4;
        /// Resistance in series.
        param series: Ohm = 0.5, above 0;
        /// Saturation current of the diode.
        param saturation: A = 0.1, above 0;
        /// Its thermal voltage: soft, so that polynomials can follow it.
        param thermal: V = 1, above 0;
        /// Capacitance.
        param capacitance: F = 0.1, above 0;
        /// Resistance of the load.
        param resistance: Ohm = 10, above 0;
        MSe source = amplitude * sin(frequency * t);
        1 line: electrical;
        R R1 = series;
        R diode(effort u) = saturation * (exp(u / thermal) - 1);
        0 output;
        C C1 = capacitance;
        R load = resistance;
        source -> line -> R1; line -> diode; line -> output -> C1; output -> load;
        observe {
            voltage: V = output.effort;
            current: A = line.flow;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }

    /// Three throttles, laminar and turbulent, that meet in a node without volume: from a pump, to a tank and to an
    /// accumulator.
    pub graph Manifold {
        /// Pressure of the pump.
        param pump: Pa = 2e7;
        /// What each throttle has at small flows.
        param laminar: Pa*s/m^3 = 1e9, at least 0;
        /// What it has beside at large ones.
        param turbulent: Pa*s^2/m^6 = 1e13, above 0;
        /// The accumulator's volume for each pressure.
        param compliance: m^3/Pa = 1e-10, above 0;
        Se source = pump;
        1 supply: hydraulic; 0 node; 1 drain: hydraulic; 1 side: hydraulic;
        R A(f) = laminar * f + turbulent * f * abs(f);
        R B(effort p) = 2 * p / (laminar + sqrt(laminar * laminar + 8 * turbulent * abs(p)));
        R D(effort p) = 2 * p / (laminar + sqrt(laminar * laminar + 2 * turbulent * abs(p)));
        C accumulator = compliance;
        source -> supply -> A; supply -> node -> drain -> B; node -> side -> D; side -> accumulator;
        observe {
            node: Pa = node.effort;
            filling: m^3/s = side.flow;
            pressure: Pa = accumulator.effort;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}
