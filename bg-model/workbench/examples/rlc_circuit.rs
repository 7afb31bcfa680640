//! A series circuit of resistor, coil and capacitor on a voltage source.
//!
//! Look at `current` and `capacitor_voltage` after the voltage is switched on: they ring at 159 Hz and die out. The
//! voltage is an input and 0 unless it is given.
//!
//!     cargo run --release --example rlc_circuit -- --t-end 0.05 --step 1e-4 --input voltage=12

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

fn main() -> std::process::ExitCode {
    bg_workbench::main::<RlcCircuit>()
}
