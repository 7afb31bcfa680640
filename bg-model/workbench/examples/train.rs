//! A train: twenty wagons on springs between their hooks, each a part, and what makes them swing against each other.
//!
//! Look at `wagon[0].speed` and `wagon[19].speed`: the train starts in its mode number `mode`, so that each wagon
//! swings with one frequency, 2 sqrt(stiffness / mass) sin(pi mode / 40). With `coupler_damping` the swinging dies out
//! and the train stands.
//!
//!     cargo run --release --example train -- --set mode=3 --set coupler_damping=2e4

use bg_model::bond_graph;

bond_graph! {
    /// A wagon that rolls without friction.
    pub part Wagon {
        /// Mass of the wagon.
        param mass: kg = 2e4, above 0;
        /// Speed at the start.
        param start_speed: m/s = 0;
        port hook: translation;
        I body = mass start mass * start_speed;
        hook -> body;
        observe { speed: m/s = hook.flow; travel: m = integral(hook.flow) }
    }

    /// A spring with a damper between two hooks.
    pub part Coupler {
        /// Stiffness of the spring.
        param stiffness: N/m = 5e6, above 0;
        /// Damping beside it.
        param damping: N*s/m = 0, at least 0;
        port rear: translation;
        port front: translation;
        0 force: translation; 1 stretch: translation; C spring = stiffness; R damper = damping;
        rear -> force -> front; force -> stretch -> spring; stretch -> damper;
        observe { pull: N = force.effort }
    }

    /// Twenty wagons in a row, free at both ends.
    pub graph Train {
        /// Mass of each wagon.
        param wagon_mass: kg = 2e4, above 0;
        /// Stiffness of each coupler.
        param coupler_stiffness: N/m = 5e6, above 0;
        /// Damping of each coupler.
        param coupler_damping: N*s/m = 0, at least 0;
        /// Number of the mode in which the train starts.
        param mode: 1 = 1, at least 0, at most 19;
        /// Largest speed at the start.
        param amplitude: m/s = 0.1;

        part wagon[i in 0..20]: Wagon {
            mass = wagon_mass;
            start_speed = amplitude * cos(3.141592653589793 * mode * (i + 0.5) / 20);
        }
        part coupler[19]: Coupler { stiffness = coupler_stiffness; damping = coupler_damping; }
        for i in 0..19 {
            wagon[i].hook -> coupler[i].rear;
            coupler[i].front -> wagon[i + 1].hook;
        }

        observe { all of wagon; middle: N = coupler[9].pull; stored: J = stored_energy }

        /// The speeds of the first wagon and of the last one.
        scene EndsOfTheTrain {
            observe { wagon[0].speed; wagon[19].speed }
            tune all but { wagon_mass }
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<Train>()
}
