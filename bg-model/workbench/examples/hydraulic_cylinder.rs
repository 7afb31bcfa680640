//! A hydraulic cylinder that lifts a load: pump, compressible oil, throttle to the tank.
//!
//! Look at `pressure`: the oil is a stiff spring under the load, so it rings before the load moves steadily. The pump's
//! flow is an input; without one the load sinks through the throttle.
//!
//!     cargo run --release --example hydraulic_cylinder -- --t-end 0.5 --step 1e-3 --input pump_flow=2e-4

use bg_model::bond_graph;

bond_graph! {
    /// The 0-junction is the chamber with its pressure; the piston's area is the transformer to the rod. The throttle
    /// obeys the law of a sharp-edged orifice, q = c a sqrt(2 p / rho), with the sign of the pressure. Below the
    /// transition pressure the flow is laminar: the root's infinite slope at zero is no physics.
    pub graph HydraulicCylinder {
        /// Area of the piston.
        param area: m^2 = 2e-3, above 0;
        /// Volume of the oil under pressure.
        param volume: m^3 = 5e-4, above 0;
        /// Bulk modulus of the oil.
        param bulk_modulus: Pa = 1.4e9, above 0;
        /// Density of the oil.
        param density: kg/m^3 = 870, above 0;
        /// Area of the orifice to the tank.
        param orifice: m^2 = 1e-6, at least 0;
        /// Discharge coefficient of the orifice.
        param discharge: 1 = 0.62, above 0;
        /// Pressure over the orifice at which its flow becomes turbulent.
        param transition: Pa = 1e4, above 0;
        /// Mass of piston, rod and load.
        param mass: kg = 150, above 0;
        /// Viscous friction of the piston.
        param friction: N*s/m = 4e3, at least 0;
        /// Force of the load against the motion.
        param load: N = 3000;
        /// Volume flow of the pump.
        input pump_flow: m^3/s;

        let compressibility: m^3/Pa = volume / bulk_modulus;
        Sf pump = pump_flow;
        0 chamber: hydraulic;
        C oil = compressibility start compressibility * load / area;
        let turbulent = discharge * orifice * sqrt(2 / density);
        R throttle(effort p) = if p < -transition {
            -turbulent * sqrt(-p)
        } else if p < transition {
            turbulent * p / sqrt(transition)
        } else {
            turbulent * sqrt(p)
        };
        TF piston(effort p) = p * area;
        1 rod: translation;
        I inertia = mass;
        R seal = friction;
        Se weight = -load;
        pump -> chamber -> piston -> rod -> inertia;
        chamber -> oil;
        chamber -> throttle;
        rod -> seal;
        weight -> rod;

        observe {
            pressure: Pa = chamber.effort;
            leakage: m^3/s = throttle.flow;
            speed: m/s = rod.flow;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<HydraulicCylinder>()
}
