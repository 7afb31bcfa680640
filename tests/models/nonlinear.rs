//! Nonlinear storages and switching resistors.

use bg_model::bond_graph;

bond_graph! {
    /// A mass on a hardening spring (Duffing). The energy is the law's antiderivative, found by the compiler.
    pub graph Duffing {
        /// Mass.
        param mass: kg = 1.5, above 0;
        /// Linear stiffness.
        param stiffness: N/m = 20, above 0;
        /// Cubic stiffness.
        param hardening: N/m^3 = 400, at least 0;
        /// Stretch at the start.
        param stretch: m = 0.4;
        1 motion: translation;
        I inertia = mass;
        C spring(q) = stiffness * q + hardening * q * q * q start stretch;
        motion -> inertia;
        motion -> spring;
        observe { x: m = spring.q; v: m/s = motion.flow; energy: J = spring.energy + inertia.energy;
            stored: J = stored_energy; }
    }

    /// A pendulum as a storage of its angle, the energy given.
    pub graph Pendulum {
        /// Mass.
        param mass: kg = 0.7, above 0;
        /// Length.
        param length: m = 1.1, above 0;
        /// Angle at the start.
        param angle: rad = 2.5;
        let weight: N*m = mass * 9.81 * length;
        1 swing: rotation;
        I inertia = mass * length * length;
        C height(a) = weight * sin(a) start angle energy weight * (1 - cos(a));
        swing -> inertia;
        swing -> height;
        observe { angle: rad = height.q; speed: rad/s = swing.flow; stored: J = stored_energy; }
    }

    /// A mass near the speed of light under a constant force: velocity as a nonlinear law of the momentum.
    pub graph RelativisticMass {
        /// Rest mass.
        param mass: kg = 2, above 0;
        /// Force.
        param force: N = 5;
        /// Speed of light (a slow one, for good numbers).
        param light: m/s = 3, above 0;
        1 motion: translation;
        Se push = force;
        I inertia(p) = p / sqrt(mass * mass + p * p / (light * light))
            energy light * light * (sqrt(mass * mass + p * p / (light * light)) - mass);
        push -> motion -> inertia;
        observe { v: m/s = motion.flow; stored: J = stored_energy; supplied: J = integral(supplied_power); }
    }

    /// A mass on a spring with a damper that resists the two directions of motion differently.
    pub graph UnequalDamper {
        /// Mass.
        param mass: kg = 1, above 0;
        /// Stiffness.
        param stiffness: N/m = 100, above 0;
        /// Resistance against motion along -x.
        param back: N*s/m = 5, at least 0;
        /// Resistance against motion along +x.
        param forth: N*s/m = 1, at least 0;
        /// Stretch at the start.
        param stretch: m = 1;
        1 motion: translation;
        I inertia = mass;
        C spring = stiffness start stretch;
        R damper(v) = if v < 0 { back * v } else { forth * v };
        motion -> inertia;
        motion -> spring;
        motion -> damper;
        observe { x: m = spring.q; v: m/s = motion.flow; stored: J = stored_energy;
            dissipated: J = integral(dissipated_power); }
    }

    /// A half-wave rectifier: an alternating voltage behind a resistor charges a capacitor through an ideal diode law.
    pub graph Rectifier {
        /// Amplitude of the source.
        param amplitude: V = 10;
        /// Angular frequency of the source.
        param frequency: rad/s = 300, above 0;
        /// Resistance of the diode in its forward direction.
        param forward: Ohm = 5, above 0;
        /// Capacitance.
        param capacitance: F = 1e-3, above 0;
        Se source = amplitude * sin(frequency * t);
        1 path: electrical;
        R diode(effort u) = if u < 0 { 0 } else { u / forward };
        C capacitor = capacitance;
        source -> path -> diode;
        path -> capacitor;
        observe { voltage: V = capacitor.effort; current: A = diode.flow; }
    }
}
