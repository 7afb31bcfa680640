//! An orifice at rest: where every hydraulic model starts, and where the square root of its law has an infinite slope.
//!
//! Look at `flow`: `root(p, laminar)` is linear for small pressures, so the run starts without trouble. A smaller
//! `laminar` brings the law closer to the root.
//!
//!     cargo run --release --example orifice -- --t-end 1 --set laminar=10

use bg_model::bond_graph;

bond_graph! {
    /// A pump whose pressure rises from zero fills a tank through an orifice. The law is that of a sharp edge, q = c a
    /// sqrt(2 p / rho), linear where the flow is laminar.
    pub graph Orifice {
        /// Rise of the pump's pressure.
        param rise: Pa/s = 1e5;
        /// Capacity of the tank.
        param capacity: m^3/Pa = 3e-11, above 0;
        /// Area of the orifice.
        param area: m^2 = 1e-6, at least 0;
        /// Discharge coefficient.
        param discharge: 1 = 0.62, above 0;
        /// Density of the oil.
        param density: kg/m^3 = 870, above 0;
        /// Pressure over the orifice below which its flow is laminar.
        param laminar: Pa = 100, above 0;

        Se pump = rise * t;
        1 pipe: hydraulic;
        R orifice(effort p) = discharge * area * sqrt(2 / density) * root(p, laminar);
        0 tank: hydraulic;
        C air = capacity;
        pump -> pipe -> orifice;
        pipe -> tank -> air;

        observe {
            drop: Pa = orifice.effort;
            flow: m^3/s = orifice.flow;
            pressure: Pa = tank.effort;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<Orifice>()
}
