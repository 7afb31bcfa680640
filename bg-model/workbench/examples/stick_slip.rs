//! A mass that a belt carries along until its spring tears it off: stick and slip.
//!
//! Look at `force`: while the mass sticks the friction grows with the spring's pull, up to the static limit; then it
//! drops to that of sliding until the speeds are equal again. Both are events, found to rounding. A faster belt ends
//! the sticking.
//!
//!     cargo run --release --example stick_slip -- --t-end 5 --set belt=0.2

use bg_model::bond_graph;

bond_graph! {
    /// The belt's speed is given; between belt and mass is a 0-junction, whose 1-junction has the speed of sliding.
    pub graph StickSlip {
        /// Mass on the belt.
        param mass: kg = 2, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 50, above 0;
        /// Speed of the belt.
        param belt: m/s = 0.1;
        /// Friction at rest.
        param still: N = 6, at least 0;
        /// Friction while the mass slides.
        param kinetic: N = 4, at least 0;

        1 slide: translation;
        I body = mass start mass * belt;
        C spring = stiffness;
        Sf drum = belt;
        0 between: translation;
        1 slip: translation;
        drum -> between -> slide -> body;
        slide -> spring;
        between -> slip;
        friction rub on slip { coulomb kinetic; static still; }

        observe {
            x: m = spring.q;
            v: m/s = slide.flow;
            force: N = rub.effort;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<StickSlip>()
}
