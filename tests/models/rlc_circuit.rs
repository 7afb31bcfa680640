//! A series circuit of resistor, coil and capacitor on a voltage source.

use bg_model::bond_graph;

bond_graph! {
    /// One 1-junction: all elements of the loop share the current.
    pub graph RlcCircuit {
        /// Resistance.
        param resistance: Ohm = 10, at least 0;
        /// Inductance.
        param inductance: H = 0.05, above 0;
        /// Capacitance.
        param capacitance: F = 2e-5, above 0;
        /// Voltage of the source.
        input voltage: V;

        Se source = voltage;
        1 circuit: electrical;
        R resistor = resistance;
        I coil = inductance;
        C capacitor = capacitance;
        source -> circuit -> resistor;
        circuit -> coil;
        circuit -> capacitor;

        observe {
            current: A = circuit.flow;
            charge: C = capacitor.q;
            flux: Wb = coil.p;
            capacitor_voltage: V = capacitor.effort;
            stored: J = stored_energy;
            supplied: J = integral(source.effort * source.flow);
            dissipated: J = integral(resistor.power);
        }
    }
}
