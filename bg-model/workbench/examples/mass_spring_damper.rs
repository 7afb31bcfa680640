//! A mass on a spring and a damper, pushed by a given force.
//!
//! The smallest model: one junction. Look at `stored` and `dissipated`, whose sum stays as it is while no force acts.
//! The force is an input and 0 unless it is given: `--input force=10` moves the place where the mass comes to rest to
//! 0.05 m.
//!
//!     cargo run --release --example mass_spring_damper -- --set damping=1

use bg_model::bond_graph;
use bg_workbench::Program;

bond_graph! {
    /// One 1-junction: the force, the mass, the spring and the damper share the velocity.
    pub graph MassSpringDamper {
        /// Mass.
        param mass: kg = 2, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 200, above 0;
        /// Damping of the damper.
        param damping: N*s/m = 4, at least 0;
        /// Stretch of the spring at the start.
        param stretch: m = 0.05;
        /// Velocity of the mass at the start.
        param speed: m/s = -0.3;
        /// Force on the mass along the stretch.
        input force: N;

        Se push = force;
        1 motion: translation;
        I inertia = mass start mass * speed;
        C spring = stiffness start stretch;
        R damper = damping;
        push -> motion -> inertia;
        motion -> spring;
        motion -> damper;

        observe {
            x: m = spring.q;
            v: m/s = motion.flow;
            spring_force: N = spring.effort;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    Program::of::<MassSpringDamper>().main(std::env::args_os())
}
