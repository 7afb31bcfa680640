//! Modulated elements, each in a graph with a closed solution.

use bg_model::bond_graph;

bond_graph! {
    /// Two inertias coupled by a gyrator whose modulus follows the time. It only turns the two momenta into each other.
    pub graph ModulatedGyrator {
        /// First inertia.
        param first: kg = 2, above 0;
        /// Second inertia.
        param second: kg = 0.5, above 0;
        /// Largest modulus.
        param modulus: N*s/m = 3;
        /// Angular frequency of the modulus.
        param frequency: rad/s = 2, above 0;
        1 left: translation;
        1 right: translation;
        I a = first start 1;
        I b = second;
        MGY coupling = modulus * cos(frequency * t);
        left -> a;
        left -> coupling -> right -> b;
        observe { a: kg*m/s = a.p; b: kg*m/s = b.p; stored: J = stored_energy; }
    }

    /// An inertia and a spring coupled by a lever whose ratio follows the time.
    pub graph ModulatedLever {
        /// Mass.
        param mass: kg = 2, above 0;
        /// Stiffness.
        param stiffness: N/m = 50, above 0;
        /// Largest ratio.
        param ratio: 1 = 0.8;
        /// Angular frequency of the ratio.
        param frequency: rad/s = 3, above 0;
        1 left: translation;
        1 right: translation;
        I inertia = mass start 1;
        C spring = stiffness;
        MTF lever = ratio * cos(frequency * t);
        left -> inertia;
        left -> lever -> right -> spring;
        observe { p: kg*m/s = inertia.p; q: m = spring.q; stored: J = stored_energy; }
    }

    /// A coil that empties through a resistance that follows the time.
    pub graph ModulatedResistance {
        /// Inductance.
        param inductance: H = 0.5, above 0;
        /// Mean resistance.
        param resistance: Ohm = 2, above 0;
        /// Angular frequency of the resistance.
        param frequency: rad/s = 5, above 0;
        1 circuit: electrical;
        I coil = inductance start 1;
        MR wire = resistance * (1 + 0.5 * sin(frequency * t));
        circuit -> coil;
        circuit -> wire;
        observe { flux: Wb = coil.p; lost: J = integral(wire.power); stored: J = stored_energy; }
    }

    /// A feedback force on an oscillator (more stiffness) and a feedback current on a capacitor (decay).
    pub graph ModulatedSources {
        /// Mass.
        param mass: kg = 1, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 30, above 0;
        /// Stiffness of the feedback.
        param gain: N/m = 20;
        /// Capacitance.
        param capacitance: F = 0.02, above 0;
        /// Conductance of the feedback.
        param conductance: S = 0.03;
        1 motion: translation;
        I inertia = mass;
        C spring = stiffness start 0.2;
        MSe feedback = -gain * spring.q;
        motion -> inertia;
        motion -> spring;
        feedback -> motion;
        0 node: electrical;
        C capacitor = capacitance start 0.5;
        MSf drain = -conductance * capacitor.effort;
        drain -> node -> capacitor;
        observe {
            x: m = spring.q;
            charge: C = capacitor.q;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
        }
    }
}
